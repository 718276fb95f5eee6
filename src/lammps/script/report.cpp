#include "lammps/script/report.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <map>

namespace elamin::script {
namespace {

using Counts = std::map<std::string, int>;      // of commands

/// `command (2), other`, with a break where a line would be longer than `width`.
std::string list(const Counts& counts, std::size_t width) {
  std::string text;
  std::size_t line = 4;
  for (const auto& [command, n] : counts) {
    const std::string item = n > 1 ? fmt::format("{} ({})", command, n) : command;
    if (line + item.size() > width) text += "\n    ", line = 4;
    text += item + (command == counts.rbegin()->first ? "" : ", ");
    line += item.size() + 2;
  }
  return text;
}

std::map<std::string, Counts> ignored_in(const Reading& reading) {
  std::map<std::string, Counts> by_reason;
  for (const Told& t : reading.told)
    if (t.fate == Told::Fate::ignored) by_reason[t.why][t.command] += t.count;
  return by_reason;
}

/// One sentence once, with the first of its places.
std::vector<std::string> sentences(const Reading& reading, const std::vector<Note>& notes) {
  std::vector<Note> all = reading.notes;
  for (const Note& n : notes)
    if (std::none_of(all.begin(), all.end(), [&](const Note& o) { return o.where == n.where && o.text == n.text; })) all.push_back(n);
  std::vector<std::pair<Note, int>> told;
  for (const Note& n : all) {
    const auto same = std::find_if(told.begin(), told.end(), [&](const auto& o) { return o.first.text == n.text; });
    if (same == told.end()) told.push_back({n, 1});
    else ++same->second;
  }
  std::vector<std::string> texts;
  for (const auto& [n, count] : told)
    texts.push_back(fmt::format("{}{}{}", n.where.line > 0 ? reading.place(n.where) + ": " : "",
                                count > 1 ? fmt::format("and {} more: ", count - 1) : "", n.text));
  return texts;
}

}  // namespace

std::string report(const Reading& reading, const std::vector<Note>& notes) {
  constexpr std::size_t width = 116;
  Counts taken;
  std::vector<const Told*> skipped;
  for (const Told& t : reading.told) {
    if (t.fate == Told::Fate::taken) taken[t.command] += t.count;
    if (t.fate == Told::Fate::not_understood) skipped.push_back(&t);
  }
  const std::size_t files = reading.files.size(), data = reading.data_files.size();
  std::string text = fmt::format("{}: {} commands of {} file{}{}\n", reading.files.front(), reading.commands, files, files == 1 ? "" : "s",
                                 data == 0 ? "" : data == 1 ? ", and a data file" : fmt::format(", and {} data files", data));
  if (!taken.empty()) text += "taken:\n    " + list(taken, width) + "\n";
  const auto left_out = ignored_in(reading);
  if (!left_out.empty()) text += "ignored:\n";
  for (const auto& [why, commands] : left_out) text += fmt::format("    {}: {}\n", list(commands, width), why);
  if (!skipped.empty()) text += "not understood, left out:\n";
  for (const Told* t : skipped) text += fmt::format("    {}: {}: {}\n", reading.place(t->first), t->command, t->why);
  const std::vector<std::string> told = sentences(reading, notes);
  if (!told.empty()) text += "to know:\n";
  for (const std::string& t : told) text += "    " + t + "\n";
  return text;
}

std::vector<std::string> notes_of(const Reading& reading, const std::vector<Note>& notes) {
  std::vector<std::string> all;
  for (const auto& [why, commands] : ignored_in(reading))
    all.push_back(fmt::format("{}: {} ignored: {}", reading.files.front(), list(commands, std::string::npos), why));
  for (std::string& t : sentences(reading, notes)) all.push_back(std::move(t));
  return all;
}

}  // namespace elamin::script
