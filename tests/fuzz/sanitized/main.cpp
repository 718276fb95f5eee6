// Reads texts that are damaged at random, all in one process, where what reads is compiled with the address and undefined-behaviour sanitizers:
//
//     damaged_inputs KIND COUNT [FROM] < NAMES_OF_FILES
//
// The files are what is damaged. Each text is read or refused in 10 s and 1 GB; the first that is not ends the program, and is left as it was read (status 1).
#include "../kinds.hpp"
#include "../mutations.hpp"
#include "core/parallel.hpp"
#include "scratch_directory.hpp"

#include <csignal>
#include <iostream>

#include <sanitizer/common_interface_defs.h>
#include <sys/time.h>

using namespace elamin;

extern "C" const char* __asan_default_options() { return "detect_leaks=0:hard_rss_limit_mb=1000:exitcode=1"; }

namespace {

constexpr int most_seconds = 10;                         // of the processor, for one text

std::string name, left;                                  // of the text that is being read, and where it lies
long now = 0;

void tell() { std::fprintf(stderr, "%s %ld is neither read nor refused; it is left in %s\n", name.c_str(), now, left.c_str()); }

void too_long(int) {
  std::fprintf(stderr, "not within %d s\n", most_seconds);
  tell();
  std::_Exit(1);
}

}  // namespace

int main(int count, char** arguments) {
  const Take take = kind_named(count > 2 ? arguments[1] : nullptr);
  name = arguments[1];
  const long texts = std::atol(arguments[2]), from = count > 3 ? std::atol(arguments[3]) : 0;
  const bool by_name = name == "problem" || name == "setting";
  std::vector<std::string> files, seeds;
  for (std::string file; std::getline(std::cin, file);) files.push_back(file), seeds.push_back(text_of(file));
  if (files.empty()) return std::fputs("no files to damage\n", stderr), 1;

  const ScratchDirectory scratch;
  if (name == "script") std::filesystem::copy(std::filesystem::path(files[0]).parent_path(), scratch / ".");      // what they read
  left = (std::filesystem::temp_directory_path() / ("elamin_fuzz." + name)).string();
  __sanitizer_set_death_callback(tell);
  std::signal(SIGPROF, too_long);
  set_threads(1);

  long refusals = 0;
  for (now = from; now < from + texts; ++now) {
    Mutations mutations(now);
    const std::size_t seed = mutations.pick(seeds.size());
    std::string text = seeds[seed];
    if (name == "setting") text.insert(0, mutations.setting(text) + "\n");
    else mutations.change(text, seeds);
    std::ofstream(left, std::ios::binary) << text;
    const itimerval time{{0, 0}, {most_seconds, 0}};
    setitimer(ITIMER_PROF, &time, nullptr);
    refusals += refused(take, text, by_name ? files[seed] : scratch.file("damaged.data", text));
  }
  std::filesystem::remove(left);
  std::printf("%s: %ld read, %ld refused\n", name.c_str(), texts - refusals, refusals);
  return refusals == 0 || refusals == texts;                 // both ends are reached
}
