#pragma once
// Runs elamin and keeps what it says: as a process, or in this one, which takes 20 ms less.
#include "command_line.hpp"
#include "processor_time.hpp"

#include <array>
#include <cstdio>
#include <fstream>
#include <stdexcept>
#include <string>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>
#include <utility>
#include <vector>
#include <wordexp.h>

struct Answer {
  int status = -1;
  std::string text;        // standard output and error
};

/// Runs a command of the shell.
inline Answer shell_says(const std::string& command) {
  Answer answer;
  std::FILE* pipe = popen((command + " 2>&1").c_str(), "r");
  std::array<char, 4096> buffer;
  for (std::size_t n; (n = std::fread(buffer.data(), 1, buffer.size(), pipe)) > 0;) answer.text.append(buffer.data(), n);
  const int status = pclose(pipe);
  answer.status = WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
  return answer;
}

/// Runs `elamin ARGUMENTS` as a process.
inline Answer program_says(const std::string& arguments) { return shell_says("'" ELAMIN_PROGRAM "' " + arguments); }

/// While it lives, what goes to standard output and error goes to a file.
class Caught {
 public:
  Caught() {
    std::fflush(nullptr);
    for (std::size_t k = 0; k < kept_.size(); ++k) kept_[k] = dup(streams[k]), dup2(fileno(file_), streams[k]);
  }
  ~Caught() { give_back(); }
  Caught(const Caught&) = delete;
  Caught& operator=(const Caught&) = delete;

  std::string text() {
    give_back();
    std::string all(static_cast<std::size_t>(std::ftell((std::fseek(file_, 0, SEEK_END), file_))), '\0');
    std::rewind(file_);
    all.resize(std::fread(all.data(), 1, all.size(), file_));
    return all;
  }

 private:
  static constexpr std::array streams{STDOUT_FILENO, STDERR_FILENO};

  void give_back() {
    std::fflush(nullptr);
    for (std::size_t k = 0; k < kept_.size(); ++k)
      if (kept_[k] >= 0) dup2(kept_[k], streams[k]), close(std::exchange(kept_[k], -1));
  }

  std::FILE* file_ = std::tmpfile();
  std::array<int, 2> kept_;
};

/// While it lives, this process may use so many seconds more of processor time (0: without limit); then SIGXCPU ends it.
class TimeLimit {
 public:
  explicit TimeLimit(int seconds) {
    getrlimit(RLIMIT_CPU, &before_);
    if (seconds == 0) return;
    rlimit limit = before_;
    limit.rlim_cur = static_cast<rlim_t>(std::clock() / CLOCKS_PER_SEC + 1 + slower * seconds);
    setrlimit(RLIMIT_CPU, &limit);
  }
  ~TimeLimit() { setrlimit(RLIMIT_CPU, &before_); }
  TimeLimit(const TimeLimit&) = delete;
  TimeLimit& operator=(const TimeLimit&) = delete;

 private:
  rlimit before_;
};

/// What `elamin ARGUMENTS` does, in this process; the words are split as a shell does. `seconds` of processor time at the most, unless 0; with the
/// sanitizers `slower` times as many.
inline Answer elamin_says(const std::string& arguments, int seconds = 0) {
  wordexp_t words;
  if (wordexp(("elamin " + arguments).c_str(), &words, WRDE_NOCMD | WRDE_UNDEF) != 0) throw std::invalid_argument("not words alone: " + arguments);
  Answer answer;
  {
    const TimeLimit limit(seconds);
    Caught caught;
    answer.status = elamin::command_line(static_cast<int>(words.we_wordc), words.we_wordv);
    answer.text = caught.text();
  }
  wordfree(&words);
  return answer;
}

/// Rows of a CSV file without quoted cells, header first.
inline std::vector<std::vector<std::string>> csv_rows(const std::string& file) {
  std::ifstream in(file);
  std::vector<std::vector<std::string>> rows;
  for (std::string line; std::getline(in, line);) {
    rows.emplace_back(1);
    bool quoted = false;
    for (const char c : line)
      if (c == '"') quoted = !quoted;
      else if (c == ',' && !quoted) rows.back().emplace_back();
      else rows.back().back() += c;
  }
  return rows;
}
