// Problem files, files of grains and stored states that are damaged in every way, and --set with anything: each is read, or refused with a sentence; what is
// read runs for a moment. A process of its own takes many of them, with a limit of time and of memory on each.
//   elamin_tests "[fuzz]"             what the tests try
//   ELAMIN_FUZZ=1000000 elamin_tests "damaged problems*"     more; ELAMIN_FUZZ_FROM=K begins with the K-th; one alone is left as elamin_fuzz.toml among the temporary files
#include "catch.hpp"
#include "core/error.hpp"
#include "core/interrupt.hpp"
#include "core/parallel.hpp"
#include "core/timing.hpp"
#include "input/grains.hpp"
#include "input/state_supplement.hpp"
#include "mutations.hpp"
#include "scratch_directory.hpp"
#include "study/prepare.hpp"
#include "study/single.hpp"

#include <algorithm>
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <new>

#include <fcntl.h>
#include <sys/mman.h>
#include <sys/resource.h>
#include <sys/time.h>
#include <sys/wait.h>
#include <unistd.h>

namespace {

using namespace elamin;
namespace fs = std::filesystem;

constexpr int most_seconds = 30;                         // of the processor, that one input may take
constexpr double gigabyte = 1e9, most_memory = 4;   // of the process that takes it
constexpr double moment = 0.3;                      // seconds that what is read runs before it is asked to stop
constexpr int one_runs = 4;                         // of so many that are read

/// What a process that may die has done; shared with the one that waits for it.
struct Tally {
  long next = 0, read = 0, refused = 0, ran = 0;
};

long number_in(const char* name, long otherwise) {
  const char* const text = std::getenv(name);
  return text ? std::atol(text) : otherwise;
}

/// Seeds, and what becomes of the damaged ones.
class Inputs {
 public:
  Inputs() {
    for (const char* folder : {"problems", "problems/static"})
      for (const auto& entry : fs::directory_iterator(fs::path(ELAMIN_ROOT) / folder))
        if (entry.path().extension() == ".toml") files_.push_back(entry.path().string());
    std::sort(files_.begin(), files_.end());
    for (const std::string& file : files_) problems_.push_back(text_of(file));
    grains_.push_back(text_of(std::string(ELAMIN_ROOT) + "/problems/helix_8.csv"));
    for (const auto& entry : fs::directory_iterator(std::string(ELAMIN_ROOT) + "/tests/fuzz/states")) states_.push_back(text_of(entry.path().string()));
    std::sort(states_.begin(), states_.end());
  }

  void operator()(long number, Tally& tally) {
    Mutations mutations(number);
    try {
      switch (number % 10) {
        case 0: grains(mutations); break;
        case 1: state(mutations); break;
        default: problem(mutations, number, tally);
      }
      ++tally.read;
    } catch (const InputError& e) {
      if (e.mistakes().empty() || std::string(e.what()).empty()) std::abort();
      ++tally.refused;
    } catch (const OutputError&) {
      ++tally.refused;
    } catch (const std::bad_alloc&) {
      ++tally.refused;
    }
  }

 private:
  void grains(Mutations& mutations) {
    std::string text = grains_[0];
    mutations.change(text, grains_);
    read_grains(scratch_.file("grains.csv", text));
  }
  void state(Mutations& mutations) {
    std::string text = states_[mutations.pick(states_.size())];
    mutations.change(text, states_);
    scratch_.file("state.json", text);
    read_supplement(scratch_.file("state.data", ""));
  }
  void problem(Mutations& mutations, long number, Tally& tally) {
    const std::size_t seed = mutations.pick(files_.size());
    std::string text = problems_[seed];
    std::vector<Setting> settings;
    if (number % 10 == 2) settings = {parse_setting(mutations.setting(text))};
    else mutations.change(text, problems_);
    if (number_in("ELAMIN_FUZZ", 0) == 1) scratch_.file("../elamin_fuzz.toml", text + (settings.empty() ? "" : "\n# --set " + settings[0].key + "=" + settings[0].value));
    const PreparedRuns runs = prepare_runs(parse_document(text, files_[seed]), settings);
    if (runs.runs.empty()) std::abort();
    if (number % one_runs != 0) return;
    const Stopwatch watch;
    const std::function<bool()> enough = [&] { return watch.seconds() > moment; };
    stop_asked = &enough;
    const SingleResult result = run_single(runs.runs.front().problem, runs.runs.front().model, {.directory = scratch_ / "run", .force = true, .models = runs.runs.front().models});
    stop_asked = nullptr;
    for (const Row& row : result.path.rows)
      for (std::size_t c = 0; c < row.size(); ++c)
        if (const bool* stable = std::get_if<bool>(&row[c]); stable && *stable && result.path.columns[c] == "stable")
          if (const int energy = result.path.column("energy"); energy >= 0 && !as_number(row[static_cast<std::size_t>(energy)])) std::abort();
    ++tally.ran;
  }

  std::vector<std::string> files_, problems_, grains_, states_;
  ScratchDirectory scratch_;
};

}  // namespace

TEST_CASE("damaged problems, grains, states and settings are read or refused, what is read runs without a crash, and stops when it is asked", "[fuzz]") {
  const long from = number_in("ELAMIN_FUZZ_FROM", 0), count = number_in("ELAMIN_FUZZ", 4000);
  auto* const tally = static_cast<Tally*>(mmap(nullptr, sizeof(Tally), PROT_READ | PROT_WRITE, MAP_SHARED | MAP_ANONYMOUS, -1, 0));
  REQUIRE(tally != MAP_FAILED);
  *tally = {};
  tally->next = from;
  while (tally->next < from + count) {
    const pid_t child = fork();
    REQUIRE(child >= 0);
    if (child == 0) {
#ifndef __SANITIZE_ADDRESS__                          // which maps far more than it uses
      const auto bytes = static_cast<rlim_t>(most_memory * gigabyte);
      const rlimit limit{bytes, bytes};
      setrlimit(RLIMIT_AS, &limit);
#endif
      const int nowhere = open("/dev/null", O_WRONLY);
      dup2(nowhere, STDOUT_FILENO), dup2(nowhere, STDERR_FILENO);
      for (const int deadly : {SIGSEGV, SIGABRT, SIGFPE, SIGILL, SIGBUS, SIGTERM, SIGINT, SIGPROF}) std::signal(deadly, SIG_DFL);
      set_threads(1);
      Inputs inputs;
      while (tally->next < from + count) {
        const itimerval time{{0, 0}, {most_seconds, 0}};
        setitimer(ITIMER_PROF, &time, nullptr);                 // and then SIGPROF
        inputs(tally->next, *tally);
        ++tally->next;
      }
      _exit(0);
    }
    int status = 0;
    waitpid(child, &status, 0);
    if (WIFEXITED(status) && WEXITSTATUS(status) == 0) continue;
    FAIL_CHECK("input " << tally->next << " ends with " << (WIFSIGNALED(status) ? "signal " : "status ") << (WIFSIGNALED(status) ? WTERMSIG(status) : WEXITSTATUS(status)));
    ++tally->next;
  }

  CHECK(tally->read > count / 20);                   // both ends are reached
  CHECK(tally->refused > count / 20);
  CHECK(tally->ran > count / 400);

  if (std::getenv("ELAMIN_FUZZ")) std::printf("%ld inputs: %ld read, %ld refused, %ld ran for a moment\n", count, tally->read, tally->refused, tally->ran);
  munmap(tally, sizeof(Tally));
}
