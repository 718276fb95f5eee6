#include "results/progress.hpp"

#include <fmt/format.h>

#include <sys/ioctl.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>

namespace elamin {
namespace {

constexpr double redraw = 0.05;   // seconds between two drawings of the overwritten line

std::size_t width(std::FILE* out) {
  winsize size{};
  return ioctl(fileno(out), TIOCGWINSZ, &size) == 0 && size.ws_col > 1 ? size.ws_col - 1u : 79u;
}

std::string shown(const Cell& cell, const char* format) {
  const auto number = as_number(cell);
  return number ? fmt::format(fmt::runtime(format), *number) : "-";
}

}  // namespace

std::string progress_line(const PathPoint& p) {
  const std::string stability = p.stability.stable         ? "stable"
                                : p.report.status == Status::not_converged ? "no equilibrium"
                                : p.stability.negative > 0 ? fmt::format("unstable ({})", p.stability.negative)
                                                           : "critical";
  const auto number = [](const char* format, double v) { return std::isfinite(v) ? fmt::format(fmt::runtime(format), v) : "not finite"; };
  return fmt::format("step {:4}  load factor {:<10.7g}  energy {:<12}  residual {}  {}{}{}", p.step, p.state.load_factor,
                     number("{:.6g}", p.energy.total()), number("{:.0e}", p.report.residual), stability, p.label.empty() ? "" : "  ", p.label);
}

Progress::Style Progress::style_for(std::FILE* out, bool quiet) {
  return quiet ? Style::silent : isatty(fileno(out)) ? Style::terminal : Style::plain;
}

Progress::Progress(std::FILE* out, Style style, double from, double to)
    : out_(out), style_(style), span_(std::abs(to - from)) {}

void Progress::show(const PathPoint& p) {
  if (style_ != Style::silent) show(progress_line(p), p.state.load_factor, !p.label.empty());
}

void Progress::show(const std::string& text, double at, bool event) {
  if (style_ == Style::silent) return;
  const double now = clock_.seconds();
  if (style_ == Style::terminal) {
    if (!event && !first_ && now - last_time_ < redraw) return;
    std::string line = text;
    if (!event && line.size() > width(out_)) line.resize(width(out_));
    fmt::print(out_, "\r{}\x1b[K{}", line, event ? "\n" : "");
    pending_ = !event;
  } else {
    const bool tenth = std::abs(at - last_) >= 0.1 * span_ * (1 - 1e-9) && span_ > 0;
    if (!event && !first_ && !tenth && now - last_time_ < 1) return;
    fmt::print(out_, "{}\n", text);
  }
  std::fflush(out_);
  first_ = false, last_ = at, last_time_ = now;
}

void Progress::finish() {
  if (pending_) fmt::print(out_, "\r\x1b[K"), std::fflush(out_);
  pending_ = false, style_ = Style::silent;
}

std::string closing_table(const Table& events) {
  if (events.rows.empty()) return "No events on the path.\n";
  const auto at = [&](const Row& row, const char* name) -> Cell {
    const int i = column_index(events.columns, name);
    return i < 0 ? Cell{} : row[i];
  };
  std::size_t widest = 5;
  for (const Row& row : events.rows) widest = std::max(widest, csv_text(at(row, "label")).size());
  std::string text = fmt::format("{:<{}}  {:>14}  {:>12}  {:>14}  {:>8}  {}\n", "event", widest, "load factor",
                                 "multiplicity", "energy", "negative", "stable");
  for (const Row& row : events.rows) {
    const Cell what = at(row, "what");
    const auto* words = std::get_if<std::string>(&what);
    text += fmt::format("{:<{}}  {:>14}  {:>12}  {:>14}  {:>8}  {:<6}{}{}", csv_text(at(row, "label")), widest,
                        shown(at(row, "lambda"), "{:.10g}"), shown(at(row, "multiplicity"), "{:.0f}"),
                        shown(at(row, "energy"), "{:.7g}"), shown(at(row, "negative"), "{:.0f}"),
                        as_number(at(row, "stable")).value_or(0) != 0 ? "yes" : "no", words && !words->empty() ? "  " : "",
                        words ? *words : "");
    text.erase(text.find_last_not_of(' ') + 1) += "\n";
  }
  return text;
}

}  // namespace elamin
