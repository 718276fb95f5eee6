// The program as a process: signals, streams, memory, ranks. What it does is in command_line.
#include "command_line.hpp"
#include "core/error.hpp"
#include "core/interrupt.hpp"
#include "core/memory.hpp"
#include "core/say.hpp"
#include "solve/ranks.hpp"
#include "study/run.hpp"

#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <ctime>
#include <exception>
#include <new>
#include <string_view>

#include <fcntl.h>
#include <poll.h>
#include <pthread.h>
#include <sys/resource.h>
#include <unistd.h>

namespace {

// The first signal asks, a second one ends at once. Some senders give one signal twice, to the process and to its group.
extern "C" void on_interrupt(int) {
  constexpr double one_signal = 0.05;           // seconds
  static volatile std::sig_atomic_t asked = 0;
  static timespec first;
  timespec now;
  clock_gettime(CLOCK_MONOTONIC, &now);
  if (asked) {
    const double since = static_cast<double>(now.tv_sec - first.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec - first.tv_nsec);
    if (since > one_signal) _exit(elamin::exit_interrupted);
    return;
  }
  first = now;
  asked = 1;
  elamin::interrupt_requested = true;
}

// Signals that ask the program to end. They are blocked before the constructors of libraries run, of which OpenBLAS's begins threads.
sigset_t asking;
void block_signals() {
  sigemptyset(&asking);
  for (const int signal : {SIGINT, SIGTERM, SIGHUP}) sigaddset(&asking, signal);
  pthread_sigmask(SIG_BLOCK, &asking, nullptr);
}

// What is thrown where nothing catches it, in a constructor of a library or a thread of OpenMP, ends the program; a lack of memory does so in a sentence.
std::terminate_handler end_by_default;
[[noreturn]] void end_uncaught() {
  try {
    if (std::current_exception()) throw;
  } catch (const std::bad_alloc&) {
    constexpr std::string_view sentence = "elamin: there is not enough memory\n";
    [[maybe_unused]] const ssize_t written = write(STDERR_FILENO, sentence.data(), sentence.size());
    _exit(elamin::exit_not_converged);
  } catch (...) {
  }
  end_by_default();
  std::abort();
}
void before_libraries() {
  block_signals();
  end_by_default = std::set_terminate(end_uncaught);
}
extern "C" void* wait_for_signals(void*) {
  for (int signal = 0;;)
    if (sigwait(&asking, &signal) == 0) on_interrupt(signal);
}
[[gnu::section(".preinit_array"), gnu::used]] void (*const first_of_all)() = before_libraries;

// What was closed leads nowhere: else a file of results would get its number, and what is printed with it.
void open_standard_streams() {
  for (const int descriptor : {STDIN_FILENO, STDOUT_FILENO, STDERR_FILENO})
    if (fcntl(descriptor, F_GETFD) == -1 && open("/dev/null", O_RDWR) != descriptor) _exit(elamin::exit_not_converged);
}

// Ctrl-C, kill and a terminal that is closed (not under nohup) stop a run in order; a reader that has gone, as of `| head`, stops nothing.
// A thread of its own waits for them, and all others block them: while METIS orders unknowns it has a handler of its own for SIGTERM, which takes it away.
void take_signals() {
  if (std::signal(SIGHUP, on_interrupt) == SIG_IGN) std::signal(SIGHUP, SIG_IGN), sigdelset(&asking, SIGHUP);
  std::signal(SIGINT, on_interrupt);
  std::signal(SIGTERM, on_interrupt);
  constexpr std::size_t stack = 1 << 18;         // next to nothing of a limited memory
  pthread_attr_t small;
  pthread_t waits;
  pthread_attr_init(&small), pthread_attr_setstacksize(&small, stack), pthread_attr_setdetachstate(&small, PTHREAD_CREATE_DETACHED);
  if (pthread_create(&waits, &small, wait_for_signals, nullptr) != 0) pthread_sigmask(SIG_UNBLOCK, &asking, nullptr);
  pthread_attr_destroy(&small);
  std::signal(SIGPIPE, SIG_IGN);
  std::signal(SIGXFSZ, SIG_IGN);                 // a file that has grown to its limit is one that cannot be written
}

// OpenBLAS begins with a thread for each core, that are not used here, and each of them waits without end for memory that a limit keeps from it.
void without_idle_threads(char** argv) {
  const char* const one_thread = "OPENBLAS_NUM_THREADS";
  const auto limited = [](auto what) {
    rlimit limit;
    return getrlimit(what, &limit) == 0 && limit.rlim_cur != RLIM_INFINITY;
  };
  const char* const now = std::getenv(one_thread);
  if ((now && std::strcmp(now, "1") == 0) || !(limited(RLIMIT_AS) || limited(RLIMIT_DATA))) return;
  setenv(one_thread, "1", 1), execv("/proc/self/exe", argv);
}

// The status of a program that has printed all it had to: a standard output that is full is an error, a pipe that nobody reads is none.
int when_printed(int status) {
  const bool failed = std::ferror(stdout) != 0;
  if (std::fflush(stdout) == 0 && !failed) return status;
  pollfd out{STDOUT_FILENO, POLLOUT, 0};
  if (poll(&out, 1, 0) > 0 && (out.revents & POLLERR)) return status;
  std::fputs("elamin: standard output cannot be written, and is not whole\n", stderr);
  return status == elamin::exit_done ? elamin::exit_not_converged : status;
}

// MUMPS ends the program by itself where memory is short, with status 0 at times.
bool main_has_ended = false;
void on_exit_of_a_library() {
  if (main_has_ended) return;
  std::fputs("elamin: a library ended the program, in most cases since there is not enough memory; what was found until then is kept, and elamin resume goes on from there\n", stderr);
  std::fflush(nullptr);
  _exit(elamin::exit_not_converged);
}

// Under mpirun rank 0 answers, and the others serve it; a sweep all of them run.
int answer_together(int argc, char** argv) {
  using namespace elamin;
  Ranks* all = nullptr;
  try {
    all = join_ranks();
  } catch (const InputError& error) {
    complain("{}\n", error.what());
    return exit_wrong_input;
  }
  if (!all) return command_line(argc, argv);
  int status = exit_done;
  if (all->rank() == 0) status = command_line(argc, argv), all->release(Ranks::Release::end);
  else
    while (all->serve() == Ranks::Release::sweep) status = command_line(argc, argv), all->close();
  leave_ranks();
  return status;
}

}  // namespace

int main(int argc, char** argv) {
  without_idle_threads(argv);
  elamin::keep_freed_memory();
  elamin::hold_memory_back();
  open_standard_streams();
  take_signals();
  std::atexit(on_exit_of_a_library);
  int status = elamin::exit_not_converged;
  try {
    status = when_printed(answer_together(argc, argv));
  } catch (const std::exception& error) {        // before the command line was understood
    elamin::complain("elamin: {}\n", elamin::told(error));
  }
  main_has_ended = true;
  return status;
}
