#include "results/terminal.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>

namespace elamin {

namespace {

constexpr double redraw = 0.05;   // seconds between two drawings of the overwritten line

std::size_t letters(const std::string& words) {
  const auto begins = [](char c) { return (static_cast<unsigned char>(c) & 0xC0) != 0x80; };        // a character of UTF-8
  return static_cast<std::size_t>(std::count_if(words.begin(), words.end(), begins));
}

// What cannot be told must not end the run: whether everything was, the program looks at its end.
void tell(std::FILE* out, const std::string& words) {
  std::fputs(words.c_str(), out);
  std::fflush(out);
}

std::string stability(const PathPoint& p) {
  if (p.stability.stable) return "stable";
  if (p.report.status == Status::not_converged) return "no equilibrium";
  return p.stability.negative > 0 ? fmt::format("unstable ({})", p.stability.negative) : "critical";
}

std::string counted(int n, const char* what) { return fmt::format("{} {}{}", n, what, n == 1 ? "" : "s"); }

// "████▌     ", in eighths of a letter.
std::string bar(double part) {
  constexpr int cells = 16;
  static const std::array<const char*, 8> eighths{"", "▏", "▎", "▍", "▌", "▋", "▊", "▉"};
  const int filled = static_cast<int>(8 * cells * std::clamp(part, 0.0, 1.0));
  std::string text;
  for (int k = 0; k < filled / 8; ++k) text += "█";
  text += eighths[filled % 8];
  return text + std::string(static_cast<std::size_t>(cells - (filled + 7) / 8), ' ');
}

std::string clock_time(double seconds) {
  const auto s = static_cast<long>(std::ceil(seconds));
  return s < 3600 ? fmt::format("{}:{:02}", s / 60, s % 60) : fmt::format("{}:{:02}:{:02}", s / 3600, s / 60 % 60, s % 60);
}

}  // namespace

std::string number_text(const char* format, double v) { return std::isfinite(v) ? fmt::format(fmt::runtime(format), v) : "not finite"; }

std::string progress_line(const PathPoint& p, int contacts) {
  return fmt::format("step {:4}  load factor {:<10.7g}  energy {:<12}  residual {}  {}{}{}  {}{}", p.step, p.state.load_factor,
                     number_text("{:.6g}", p.energy.total()), number_text("{:.0e}", p.report.residual), stability(p),
                     p.label.empty() ? "" : "  ", p.label, counted(p.report.iterations, "iteration"),
                     contacts > 0 ? "  " + counted(contacts, "contact") : "");
}

Progress::Style Progress::style_for(std::FILE* out, bool quiet) {
  return quiet ? Style::silent : is_terminal(out) ? Style::terminal : Style::plain;
}

Progress::Progress(std::FILE* out, Style style, double from, double to, bool steady)
    : out_(out), style_(style), ink_(out), from_(from), to_(to), steady_(steady) {}

void Progress::enter(int part, int parts, double from, double to) { part_ = part, parts_ = parts, from_ = last_ = from, to_ = to; }

double Progress::done(double at) const {
  const double part = to_ != from_ ? std::clamp((at - from_) / (to_ - from_), 0.0, 1.0) : 0;
  return (part_ + part) / parts_;
}

bool Progress::due(double at) {
  const bool tenth = std::abs(at - last_) >= 0.1 * std::abs(to_ - from_) * (1 - 1e-9) && to_ != from_;
  return first_ || tenth || clock_.seconds() - last_time_ >= 1;
}

void Progress::show(const PathPoint& p, int contacts) {
  const bool event = !p.label.empty();
  const double at = p.state.load_factor;
  if (style_ == Style::plain) {
    if (event || due(at)) keep(progress_line(p, contacts)), last_ = at;
  } else if (style_ == Style::terminal) {
    const auto ink = p.stability.stable ? &Ink::good : p.report.status == Status::not_converged ? &Ink::bad : &Ink::warning;
    if (event)
      keep(fmt::format("load factor {:<14.10g} {}{}{}", at, p.stability.stable ? "" : (ink_.*ink)(stability(p)) + "  ",
                       ink_.strong(p.label), p.what.empty() ? "" : "  " + p.what));
    draw(at, {{fmt::format("load factor {:.4g}", at)}, {stability(p), ink}, {fmt::format("step {}", p.step)},
              {contacts > 0 ? counted(contacts, "contact") : ""}, {counted(p.report.iterations, "iteration")}});
  }
}

void Progress::show(const std::string& line, double at) {
  if (style_ == Style::plain && !line.empty() && due(at)) keep(line), last_ = at;
  if (style_ == Style::terminal) draw(at, {{line}});
}

void Progress::wait(const std::string& line, const std::vector<std::string>& pieces) {
  if (style_ == Style::plain) keep(line);
  if (style_ != Style::terminal) return;
  std::vector<Piece> all;
  for (const std::string& p : pieces) all.push_back({p});
  draw(last_, all.empty() ? std::vector<Piece>{{line}} : std::move(all));
}

void Progress::keep(const std::string& line) {
  if (style_ == Style::silent) return;
  tell(out_, fmt::format("{}{}{}\n", pending_ ? "\r" : "", line, style_ == Style::terminal ? "\x1b[K" : ""));
  pending_ = false, first_ = false, last_time_ = clock_.seconds();
}

void Progress::draw(double at, std::vector<Piece> pieces) {
  const double now = clock_.seconds();
  last_ = at;
  if (pending_ && now - last_time_ < redraw) return;
  const double part = done(at);
  if (steady_ && part > 0.01 && part < 1 && now > 1) pieces.push_back({clock_time(now / part * (1 - part)) + " left"});
  std::string line = from_ == to_ && parts_ == 1 ? "" : fmt::format("{}▏{:3.0f} %  ", bar(part), std::floor(100 * part));
  std::size_t room = static_cast<std::size_t>(terminal_width(out_)), used = letters(line);
  for (const Piece& p : pieces) {
    const std::size_t wide = letters(p.words);
    if (p.words.empty() || used + wide > room) continue;
    line += (p.ink ? (ink_.*p.ink)(p.words) : p.words) + "  ", used += wide + 2;
  }
  line.erase(line.find_last_not_of(' ') + 1);
  tell(out_, fmt::format("\r{}\x1b[K", line));
  pending_ = true, first_ = false, last_time_ = now;
}

void Progress::finish() {
  if (pending_) tell(out_, "\r\x1b[K");
  pending_ = false, style_ = Style::silent;
}

namespace {

std::string shown(const Cell& cell, const char* format) {
  const auto number = as_number(cell);
  return number ? fmt::format(fmt::runtime(format), *number) : "-";
}

// The entries of a row by name; empty where the table has no such column.
struct NamedCells {
  const Table& table;
  const Row& row;
  Cell operator[](const std::string& name) const {
    const int i = table.column(name);
    return i < 0 ? Cell{} : row[i];
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
  for (std::size_t k = 0; k < count; ++k) widest = std::max(widest, csv_text(NamedCells{events, events.rows[k]}["label"]).size());
  constexpr auto line = "{:<{}}  {:>14}  {:>12}  {:>14}  {:>8}  {:<6}{}";
  std::string text = ink.strong(fmt::format(line, "event", widest, "load factor", "multiplicity", "energy", "negative", "stable", "")) + "\n";
  for (std::size_t k = 0; k < count; ++k) {
    const NamedCells e{events, events.rows[k]};
    const Cell what = e["what"];
    const auto* words = std::get_if<std::string>(&what);
    text += trimmed(fmt::format(line, csv_text(e["label"]), widest, shown(e["lambda"], "{:.10g}"), shown(e["multiplicity"], "{:.0f}"),
                                shown(e["energy"], "{:.7g}"), shown(e["negative"], "{:.0f}"),
                                as_number(e["stable"]).value_or(0) != 0 ? "yes" : "no", words && !words->empty() ? "  " + *words : ""));
  }
  if (count < events.rows.size()) text += fmt::format("… and {} more in events.csv\n", events.rows.size() - count);
  return text;
}

std::string closing_curve(const Table& curve, const std::string& second) {
  std::string text;
  for (const Row& row : curve.rows) {
    const NamedCells e{curve, row};
    const std::string label = csv_text(e["label"]), what = csv_text(e["what"]);
    if (!label.empty())
      text += fmt::format("{}: {} {}, load factor {}{}\n", label, second, shown(e["second"], "{:.10g}"), shown(e["lambda"], "{:.10g}"),
                          what.empty() ? "" : ": " + what);
  }
  return text;
}

std::string closing_landscape(const Table& landscape, const Ink& ink) {
  constexpr auto line = "{:<14}  {:>8}  {:>14}  {:>12}  {:>14}  {}";
  std::string text = ink.strong(trimmed(fmt::format(line, "node", "negative", "energy", "multiplicity", "barrier", "")));
  for (const Row& row : landscape.rows) {
    const NamedCells e{landscape, row};
    const std::string label = csv_text(e["label"]), lambda = shown(e["lambda"], "{:.10g}");
    const Cell cell = e["what"];
    const auto* words = std::get_if<std::string>(&cell);
    const std::string what = words ? *words : "";
    if (label == "graph")
      text += fmt::format("load factor {}: minima {}, saddles {}\n", lambda, csv_text(e["minima"]), csv_text(e["saddles"]));
    else if (label.starts_with("change:"))
      text += fmt::format("load factor {}: {}\n", lambda, what);
    else
      text += trimmed(fmt::format(line, label, shown(e["negative"], "{:.0f}"), shown(e["energy"], "{:.10g}"), csv_text(e["multiplicity"]),
                                  shown(e["barrier"], "{:.8g}"), what));
  }
  return text;
}

std::string closing_values(const Table& path, const std::vector<std::string>& observables, const Ink& ink) {
  if (path.rows.empty()) return "";
  const NamedCells last{path, path.rows.back()};
  std::string text;
  if (path.column("time") >= 0) {
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
