#pragma once
// Runs the program and keeps what it says.
#include "processor_time.hpp"

#include <array>
#include <cstdio>
#include <fstream>
#include <sstream>
#include <string>
#include <sys/wait.h>
#include <vector>

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

/// Runs `elamin ARGUMENTS`; `seconds` of processor time at the most, unless 0; with the sanitizers `slower` times as many.
inline Answer elamin_says(const std::string& arguments, int seconds = 0) {
  const std::string limit = seconds > 0 ? "ulimit -t " + std::to_string(slower * seconds) + "; " : "";
  return shell_says(limit + "'" ELAMIN_PROGRAM "' " + arguments);
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
