// Commands that say which command is next, and variables.
#include "lammps/script/interpreter.hpp"

#include "core/suggest.hpp"
#include "core/text.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <sstream>

namespace elamin::script::command {
namespace {

/// A file of `ID value` lines behind a line with how many there are; comments and empty lines before that.
std::map<long long, double> numbers_of_atoms(const Interpreter& in, const std::string& name, std::size_t word) {
  const std::string text = elamin::read_data(in.path_of(name, word), "file of numbers of atoms");
  std::istringstream lines{std::string(without_mark(text))};
  std::map<long long, double> of_id;
  long long count = -1;
  const auto wrong = [&](const std::string& what) { throw Wrong(word, in_quotes(name) + ": " + what); };
  for (std::string line; count != 0 && std::getline(lines, line);) {
    line = line.substr(0, line.find('#'));
    if (line.find_first_not_of(" \t\r") == std::string::npos) continue;
    std::istringstream words(line);
    std::string more;
    if (count < 0) {
      if (!(words >> count) || count < 0 || words >> more) wrong("begins with no number of lines");
      continue;
    }
    long long id = 0;
    std::string number;
    if (!(words >> id >> number) || words >> more) wrong("a line is not `ID value`: " + in_quotes(line));
    double value = 0;
    if (!reads_as(number, value) || !std::isfinite(value)) wrong(in_quotes(number) + " is no number");
    of_id[id] = value, --count;
  }
  if (count != 0) wrong("ends before all its lines have come");
  return of_id;
}

/// The first word of each line of a file, without comments.
std::vector<std::string> first_words(const Interpreter& in, const std::string& name, std::size_t word) {
  const std::string text = elamin::read_data(in.path_of(name, word), "file of values");
  std::istringstream lines{std::string(without_mark(text))};
  std::vector<std::string> all;
  std::string first;
  for (std::string line; std::getline(lines, line);)
    if (std::istringstream words(line.substr(0, line.find('#'))); words >> first) all.push_back(first);
  if (all.empty()) throw Wrong(word, in_quotes(name) + " holds no value");
  return all;
}

}  // namespace

void include(Interpreter& in) {
  in.wants(2, "include FILE", 2);
  in.begin_file(in.word(1), 1, true);
}

void jump(Interpreter& in) {
  in.wants(2, "jump FILE or SELF LABEL", 3);
  if (in.failed) return;                         // after a mistake what follows is read once
  if (in.jump_skip) {
    in.jump_skip = false;
    return;
  }
  if (in.word(1) == "SELF") in.frames.back().next = 0;
  else in.begin_file(in.word(1), 1, false);
  if (in.size() == 3) in.label = in.word(2);
}

void label(Interpreter& in) { in.wants(2, "label ID", 2); }

void quit(Interpreter& in) { in.ended = true; }

void print(Interpreter& in) {
  in.ignore(because::output);
  if (in.size() < 2) return;
  try {
    substituted(in.word(1), in.substitution());   // which may draw random numbers
  } catch (const Wrong&) {
  } catch (const NeedsPositions&) {
  }
}

void clear(Interpreter& in) {
  in.end_pass();
  in.world = World();
}

void next(Interpreter& in) {
  in.wants(2, "next VARIABLE …");
  bool over = false;
  for (std::size_t i = 1; i < in.size(); ++i) {
    const auto found = in.names.variables.find(in.word(i));
    if (found == in.names.variables.end()) throw Wrong(i, "there is no variable " + in_quotes(in.word(i)));
    Variable& v = found->second;
    if (v.style != Variable::Style::loop && v.style != Variable::Style::index)
      throw Wrong(i, in_quotes(in.word(i)) + " is no variable of style loop or index");
    ++v.which;
    over = over || (v.style == Variable::Style::index ? v.which >= v.words.size() : v.first + static_cast<long long>(v.which) > v.last);
  }
  if (!over) return;
  for (std::size_t i = 1; i < in.size(); ++i) in.names.variables.erase(in.word(i));
  in.jump_skip = true;
}

void condition_of_if(Interpreter& in) {
  in.wants(4, "if CONDITION then COMMAND … [elif CONDITION COMMAND …] [else COMMAND …]");
  const Substitution by = in.substitution();
  const std::vector<Word> words = in.words;
  const Where where = in.where;
  const auto holds = [&](std::size_t i) { return condition(substituted(words[i].text, by), i); };
  if (words[2].text != "then") throw Wrong(2, in_quotes(words[2].text) + " stands where \"then\" is wanted");
  std::size_t i = 3;
  bool take = holds(1), done = false;
  const std::size_t first_frame = in.frames.size();
  while (i < words.size()) {
    const std::string& w = words[i].text;
    if (w == "elif" && !words[i].quoted) {
      if (i + 1 >= words.size()) throw Wrong(i, "a condition is missing behind \"elif\"");
      done = done || take;
      take = !done && holds(i + 1);
      i += 2;
    } else if (w == "else" && !words[i].quoted) {
      take = !done && !take;
      done = true;
      ++i;
    } else {
      if (take) in.execute(w, where);
      if (in.ended || in.label || in.frames.size() < first_frame) return;        // a jump leaves the rest
      ++i;
      if (in.frames.size() == first_frame) continue;
      const bool last = i == words.size() || (!words[i].quoted && (words[i].text == "elif" || words[i].text == "else"));
      if (!last) throw Wrong(i, "a command behind an include in the same if would come before what is included; put it into a line of its own");
      return;
    }
  }
}

void variable(Interpreter& in) {
  in.wants(3, "variable NAME STYLE …");
  const std::string name = in.word(1), style = in.word(2);
  if (name.empty() || !std::all_of(name.begin(), name.end(), [](unsigned char c) { return std::isalnum(c) || c == '_'; }))
    throw Wrong(1, in_quotes(name) + " is no name of a variable; letters, digits and _ are");
  auto& variables = in.names.variables;
  Variable v;
  if (style == "delete") {
    variables.erase(name);
    return;
  }
  const auto rest = [&] {
    std::vector<std::string> words;
    for (std::size_t i = 3; i < in.size(); ++i) words.push_back(in.word(i));
    return words;
  };
  if (style == "index" || style == "file" || style == "loop" || style == "uloop") {
    if (variables.count(name)) return;           // as LAMMPS does: the first one stays
    in.wants(4, "variable NAME index WORD …, file FILE, or loop [FIRST] LAST [pad]", style == "file" ? 4 : std::string::npos);
    if (style == "index") v.style = Variable::Style::index, v.words = rest();
    else if (style == "file") v.style = Variable::Style::index, v.words = first_words(in, in.word(3), 3);
    else {
      v.style = Variable::Style::loop;
      std::size_t n = in.size();
      if (in.word(n - 1) == "pad") v.pad = true, --n;
      if (n < 4 || n > 5) throw Wrong(2, "a loop is: variable NAME loop [FIRST] LAST [pad]");
      v.last = in.integer(n - 1, 1, 1000000000000);
      v.first = n == 5 ? in.integer(3, 0, v.last) : 1;
    }
  } else if (style == "string") {
    in.wants(4, "variable NAME string TEXT", 4);
    v.style = Variable::Style::string, v.words = rest();
  } else if (style == "equal" || style == "atom") {
    in.wants(4, "variable NAME " + style + " FORMULA, a formula with blanks in quotes", 4);
    v.style = style == "equal" ? Variable::Style::equal : Variable::Style::atom, v.words = rest();
  } else if (style == "format") {
    in.wants(5, "variable NAME format VARIABLE %g", 5);
    v.style = Variable::Style::format, v.words = rest();
  } else if (style == "atomfile") {
    in.wants(4, "variable NAME atomfile FILE", 4);
    v.style = Variable::Style::atomfile, v.of_id = numbers_of_atoms(in, in.word(3), 3);
  } else if (style == "getenv" || style == "world" || style == "universe" || style == "python" || style == "internal" || style == "timer" || style == "vector") {
    throw Wrong(2, fmt::format("variables of style {} come from outside of the script; write the value itself: variable {} string …", style,
                               name), true);
  } else {
    const std::vector<std::string> known{"index", "file", "loop", "uloop", "string", "equal", "atom", "atomfile", "format", "delete"};
    throw Wrong(2, in_quotes(style) + " is no style of a variable; there are: " + listed(known) + did_you_mean(style, known), true);
  }
  variables[name] = std::move(v);
}

}  // namespace elamin::script::command
