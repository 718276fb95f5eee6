// What libFuzzer calls with inputs that it grows by the code that they reach. ELAMIN_FUZZ_KIND: what they are (tests/fuzz/coverage/run).
#include "../kinds.hpp"
#include "core/parallel.hpp"

#include <cstdint>

#include <unistd.h>

namespace {

elamin::Take take = nullptr;
std::string folder;

}  // namespace

extern "C" int LLVMFuzzerInitialize(int*, char***) {
  take = elamin::kind_named(std::getenv("ELAMIN_FUZZ_KIND"));
  folder = std::filesystem::temp_directory_path() / ("elamin_fuzz_" + std::to_string(getpid()));
  std::filesystem::create_directory(folder);
  std::atexit([] { std::filesystem::remove_all(folder); });
  elamin::set_threads(1);
  return 0;
}

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* bytes, std::size_t size) {
  const std::string text(reinterpret_cast<const char*>(bytes), size), file = folder + "/in.data";
  std::ofstream(file) << text;
  elamin::refused(take, text, file);
  return 0;
}
