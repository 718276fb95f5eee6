// What libFuzzer calls with inputs that it grows by the code that they reach. Each is read, or refused with a sentence; anything else is a crash.
// ELAMIN_FUZZ_KIND: what they are (tests/fuzz/coverage/run).
#include "core/error.hpp"
#include "core/parallel.hpp"
#include "input/grains.hpp"
#include "input/read.hpp"
#include "input/state_supplement.hpp"
#include "lammps/data.hpp"
#include "lammps/script/interpreter.hpp"
#include "lammps/script/report.hpp"
#include "lammps/script/translation.hpp"

#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <map>
#include <string>

#include <unistd.h>

namespace {

using namespace elamin;
using Take = void (*)(const std::string& text, const std::string& file);

void take_script(const std::string&, const std::string& file) {
  const script::Reading reading = script::read_script(file, {.most_commands = 5000});
  if (script::report(reading, {}).empty()) std::abort();
  for (const script::Pass& pass : reading.passes) script::translated(reading, pass, {}, "p.data");
}

const std::map<std::string, Take> kinds{
    {"problem", [](const std::string& text, const std::string& file) { read_problem_text(text, file); }},
    {"data", [](const std::string&, const std::string& file) { read_lammps_data(file); }},
    {"grains", [](const std::string&, const std::string& file) { read_grains(file); }},
    {"state", [](const std::string& text, const std::string& file) {
       std::ofstream(std::filesystem::path(file).replace_extension("json")) << text;
       read_supplement(file);
     }},
    {"script", take_script}};

Take take = nullptr;
std::string folder;

}  // namespace

extern "C" int LLVMFuzzerInitialize(int*, char***) {
  const char* kind = std::getenv("ELAMIN_FUZZ_KIND");
  const auto found = kinds.find(kind ? kind : "");
  if (found == kinds.end()) {
    std::fputs("ELAMIN_FUZZ_KIND must be one of:", stderr);
    for (const auto& [name, unused] : kinds) std::fprintf(stderr, " %s", name.c_str());
    std::fputs("\n", stderr);
    std::exit(1);
  }
  take = found->second;
  folder = std::filesystem::temp_directory_path() / ("elamin_fuzz_" + std::to_string(getpid()));
  std::filesystem::create_directory(folder);
  std::atexit([] { std::filesystem::remove_all(folder); });
  set_threads(1);
  return 0;
}

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* bytes, std::size_t size) {
  const std::string text(reinterpret_cast<const char*>(bytes), size), file = folder + "/in.data";
  std::ofstream(file) << text;
  try {
    take(text, file);
  } catch (const InputError& error) {
    if (error.mistakes().empty() || std::string(error.what()).empty()) std::abort();
  } catch (const OutputError&) {
  }
  return 0;
}
