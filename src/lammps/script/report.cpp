#include "lammps/script/report.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <map>

namespace elamin::script {

std::string report(const Reading& reading, const std::vector<Note>& notes) {
  std::map<std::string, int> taken;
  std::map<std::string, std::map<std::string, int>> ignored;   // why → command
  std::vector<const Told*> skipped;
  for (const Told& t : reading.told) {
    if (t.fate == Told::Fate::taken) taken[t.command] += t.count;
    if (t.fate == Told::Fate::ignored) ignored[t.why][t.command] += t.count;
    if (t.fate == Told::Fate::not_understood) skipped.push_back(&t);
  }
  const auto list = [](const std::map<std::string, int>& counts) {
    std::string text;
    std::size_t line = 4;
    for (const auto& [command, n] : counts) {
      const std::string item = n > 1 ? fmt::format("{} ({})", command, n) : command;
      if (line + item.size() > 116) text += "\n    ", line = 4;
      text += item + (command == counts.rbegin()->first ? "" : ", ");
      line += item.size() + 2;
    }
    return text;
  };
  const std::size_t files = reading.files.size(), data = reading.data_files.size();
  std::string text = fmt::format("{}: {} commands of {} file{}{}\n", reading.files.front(), reading.commands, files, files == 1 ? "" : "s",
                                 data == 0 ? "" : data == 1 ? ", and a data file" : fmt::format(", and {} data files", data));
  if (!taken.empty()) text += "taken:\n    " + list(taken) + "\n";
  if (!ignored.empty()) text += "ignored:\n";
  for (const auto& [why, commands] : ignored) text += fmt::format("    {}: {}\n", list(commands), why);
  if (!skipped.empty()) text += "not understood, left out:\n";
  for (const Told* t : skipped) text += fmt::format("    {}: {}: {}\n", reading.place(t->first), t->command, t->why);
  std::vector<Note> all = reading.notes;
  for (const Note& n : notes)
    if (std::none_of(all.begin(), all.end(), [&](const Note& o) { return o.where == n.where && o.text == n.text; })) all.push_back(n);
  if (!all.empty()) text += "to know:\n";
  // One sentence once, with the first of its places.
  std::vector<std::pair<Note, int>> told;
  for (const Note& n : all) {
    const auto same = std::find_if(told.begin(), told.end(), [&](const auto& o) { return o.first.text == n.text; });
    if (same == told.end()) told.push_back({n, 1});
    else ++same->second;
  }
  for (const auto& [n, count] : told)
    text += fmt::format("    {}{}{}\n", n.where.line > 0 ? reading.place(n.where) + ": " : "",
                        count > 1 ? fmt::format("and {} more: ", count - 1) : "", n.text);
  return text;
}

}  // namespace elamin::script
