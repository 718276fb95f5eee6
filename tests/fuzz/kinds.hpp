#pragma once
// What the kinds of input are read by. Each text is read, or refused with a sentence; anything else is a crash.
#include "core/error.hpp"
#include "input/grains.hpp"
#include "input/read.hpp"
#include "input/settings.hpp"
#include "input/state_supplement.hpp"
#include "lammps/data.hpp"
#include "lammps/script/interpreter.hpp"
#include "lammps/script/report.hpp"
#include "lammps/script/translation.hpp"

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <map>
#include <string>

namespace elamin {

/// Reads a text that stands in `file`; that of problems may be another's name, beside which they find what they refer to.
using Take = void (*)(const std::string& text, const std::string& file);

inline void take_script(const std::string&, const std::string& file) {
  script::ReadingOptions options;
  options.most_commands = 5000;
  const script::Reading reading = script::read_script(file, options);
  if (script::report(reading, {}).empty()) std::abort();
  for (const script::Pass& pass : reading.passes) script::translated(reading, pass, {}, "p.data");
}

inline const std::map<std::string, Take> kinds{
    {"problem", [](const std::string& text, const std::string& file) { read_problem_text(text, file); }},
    {"setting", [](const std::string& text, const std::string& file) {                    // its first line, of the problem behind it
       const std::size_t end = std::min(text.find('\n'), text.size());
       read_problem_text(text.substr(end), file, {parse_setting(text.substr(0, end))});
     }},
    {"data", [](const std::string&, const std::string& file) { read_lammps_data(file); }},
    {"grains", [](const std::string&, const std::string& file) { read_grains(file); }},
    {"state", [](const std::string& text, const std::string& file) {
       std::ofstream(std::filesystem::path(file).replace_extension("json")) << text;
       read_supplement(file);
     }},
    {"script", take_script}};

/// Whether it is refused, in a sentence.
inline bool refused(Take take, const std::string& text, const std::string& file) {
  try {
    take(text, file);
    return false;
  } catch (const InputError& error) {
    if (error.mistakes().empty() || std::string(error.what()).empty()) std::abort();
  } catch (const OutputError&) {
  }
  return true;
}

/// Ends the program with the names of all kinds where `name` is none.
inline Take kind_named(const char* name) {
  const auto found = kinds.find(name ? name : "");
  if (found != kinds.end()) return found->second;
  std::fputs("the kind of input must be one of:", stderr);
  for (const auto& [known, unused] : kinds) std::fprintf(stderr, " %s", known.c_str());
  std::fputs("\n", stderr);
  std::exit(1);
}

}  // namespace elamin
