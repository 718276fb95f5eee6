#include "results/closing.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace elamin {
namespace {

std::string shown(const Cell& cell, const char* format) {
  const auto number = as_number(cell);
  return number ? fmt::format(fmt::runtime(format), *number) : "-";
}

// The entries of a row by name; empty where the table has no such column.
struct Entries {
  const std::vector<std::string>& columns;
  const Row& row;
  Cell operator[](const std::string& name) const {
    const int i = column_index(columns, name);
    return i < 0 ? Cell{} : row[static_cast<std::size_t>(i)];
  }
};

std::string trimmed(std::string line) {
  line.erase(line.find_last_not_of(' ') + 1);
  return line + "\n";
}

}  // namespace

std::string closing_table(const Table& events, const Ink& ink) {
  constexpr std::size_t most = 40;
  if (events.rows.empty()) return "No events on the path.\n";
  const std::size_t count = events.rows.size() > most ? most - 5 : events.rows.size();
  std::size_t widest = 5;
  for (std::size_t k = 0; k < count; ++k) widest = std::max(widest, csv_text(Entries{events.columns, events.rows[k]}["label"]).size());
  constexpr auto line = "{:<{}}  {:>14}  {:>12}  {:>14}  {:>8}  {:<6}{}";
  std::string text = ink.strong(fmt::format(line, "event", widest, "load factor", "multiplicity", "energy", "negative", "stable", "")) + "\n";
  for (std::size_t k = 0; k < count; ++k) {
    const Entries e{events.columns, events.rows[k]};
    const Cell what = e["what"];
    const auto* words = std::get_if<std::string>(&what);
    text += trimmed(fmt::format(line, csv_text(e["label"]), widest, shown(e["lambda"], "{:.10g}"), shown(e["multiplicity"], "{:.0f}"),
                                shown(e["energy"], "{:.7g}"), shown(e["negative"], "{:.0f}"),
                                as_number(e["stable"]).value_or(0) != 0 ? "yes" : "no", words && !words->empty() ? "  " + *words : ""));
  }
  if (count < events.rows.size()) text += fmt::format("… and {} more in events.csv\n", events.rows.size() - count);
  return text;
}

std::string closing_values(const Table& path, const std::vector<std::string>& observables, const Ink& ink) {
  if (path.rows.empty()) return "";
  const Entries last{path.columns, path.rows.back()};
  std::string text;
  if (column_index(path.columns, "time") >= 0) {
    for (const char* name : {"time", "kinetic", "energy"}) text += fmt::format("{}{} {}", text.empty() ? "" : "  ", name, shown(last[name], "{:.7g}"));
  } else {
    const bool stable = as_number(last["stable"]).value_or(0) != 0;
    text = fmt::format("energy {}  residual {}  {}", shown(last["energy"], "{:.10g}"), shown(last["residual"], "{:.0e}"),
                       stable ? ink.good("stable") : ink.warning("not stable"));
  }
  text += "\n";
  std::size_t widest = 0;
  for (const std::string& name : observables) widest = std::max(widest, name.size());
  for (const std::string& name : observables) text += fmt::format("  {:<{}}  {}\n", name, widest, shown(last[name], "{:.10g}"));
  return text;
}

std::string closing_modes(const std::vector<Mode>& modes, const Ink& ink) {
  if (modes.empty()) return "";
  std::string text = ink.strong(fmt::format("{:>4}  {:>16}", "mode", "eigenvalue")) + "\n";
  for (std::size_t k = 0; k < modes.size(); ++k)
    text += trimmed(fmt::format("{:>4}  {:>16.10g}  {}", k + 1, modes[k].eigenvalue, modes[k].zero_mode));
  return text;
}

}  // namespace elamin
