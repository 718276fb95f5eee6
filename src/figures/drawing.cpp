#include "figures/drawing.hpp"

#include "core/error.hpp"
#include "core/text.hpp"

#include <fmt/format.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cmath>
#include <cstdio>
#include <memory>
#include <string_view>

namespace elamin {

namespace {

long hundredths(double x) { return std::lround(100 * x); }

// The shortest text of a number of hundredths.
std::string text_of(long n) {
  std::string t = fmt::format("{}{}.{:02}", n < 0 ? "-" : "", std::labs(n) / 100, std::labs(n) % 100);
  while (t.back() == '0') t.pop_back();
  if (t.back() == '.') t.pop_back();
  if (t.starts_with("0.")) t.erase(0, 1);
  if (t.starts_with("-0.")) t.erase(1, 1);
  return t.empty() ? "0" : t;
}
std::string text_of(double x) { return text_of(hundredths(x)); }

// Two numbers behind a letter or each other; a minus or a point's own sign divides them, too.
std::string pair(long x, long y) {
  const std::string second = text_of(y);
  return text_of(x) + (second[0] == '-' ? "" : " ") + second;
}

// M, then relative moves: rounded places, not rounded moves, so that nothing adds up.
std::string path_data(const Polyline& line, bool closed) {
  std::string d;
  long x = 0, y = 0;
  for (std::size_t i = 0; i < line.size(); ++i) {
    const long to_x = hundredths(line[i].x()), to_y = hundredths(line[i].y());
    if (i == 0) d += "M" + pair(to_x, to_y);
    else if (to_x != x || to_y != y || line.size() == 2) d += "l" + pair(to_x - x, to_y - y);
    x = to_x, y = to_y;
  }
  return closed ? d + "z" : d;
}

std::string stroke(const Pen& pen) {
  if (!(pen.width > 0)) return "";
  std::string s = fmt::format(" stroke=\"{}\" stroke-width=\"{}\"", pen.colour, text_of(pen.width));
  if (!pen.dashes.empty()) s += fmt::format(" stroke-dasharray=\"{}\"", pen.dashes);
  return s;
}

}  // namespace

void Drawing::lines(const std::vector<Polyline>& lines, const Pen& pen) {
  std::string d;
  for (const Polyline& line : lines)
    if (line.size() > 1) d += path_data(line, false);
  if (!d.empty()) body_ += fmt::format("<path fill=\"none\"{} d=\"{}\"/>\n", stroke(pen), d);
}

void Drawing::area(const Polyline& corners, const std::string& fill, const Pen& pen) {
  body_ += fmt::format("<path fill=\"{}\"{} d=\"{}\"/>\n", fill.empty() ? "none" : fill, stroke(pen), path_data(corners, true));
}

void Drawing::circle(const Vec2& center, double radius, const std::string& fill, const Pen& pen) {
  body_ += fmt::format("<circle cx=\"{}\" cy=\"{}\" r=\"{}\" fill=\"{}\"{}/>\n", text_of(center.x()), text_of(center.y()), text_of(radius),
                       fill.empty() ? "none" : fill, stroke(pen));
}

// Ends of lines without length: far shorter than circles.
void Drawing::discs(const std::vector<Vec2>& centers, double radius, const std::string& colour) {
  std::string d;
  for (const Vec2& c : centers) d += "M" + pair(hundredths(c.x()), hundredths(c.y())) + "h0";
  if (!d.empty()) body_ += fmt::format("<path stroke-linecap=\"round\"{} d=\"{}\"/>\n", stroke({colour, 2 * radius}), d);
}

void Drawing::words(const Vec2& at, const std::string& words, Anchor anchor, double size, bool turned) {
  static const std::array<const char*, 3> anchors{"start", "middle", "end"};
  const std::string x = text_of(at.x()), y = text_of(at.y());
  body_ += fmt::format("<text x=\"{}\" y=\"{}\" font-size=\"{}\" text-anchor=\"{}\"{}>{}</text>\n", x, y, text_of(size),
                       anchors[static_cast<std::size_t>(anchor)], turned ? fmt::format(" transform=\"rotate(-90 {} {})\"", x, y) : "", as_markup(words));
}

void Drawing::clip(const Vec2& corner, const Vec2& opposite) {
  const Vec2 lo = corner.cwiseMin(opposite), size = (opposite - corner).cwiseAbs();
  ++clips_;
  body_ += fmt::format("<clipPath id=\"c{}\"><rect x=\"{}\" y=\"{}\" width=\"{}\" height=\"{}\"/></clipPath>\n<g clip-path=\"url(#c{})\">\n", clips_,
                       text_of(lo.x()), text_of(lo.y()), text_of(size.x()), text_of(size.y()), clips_);
}

std::string Drawing::svg(double width, double height, const std::string& title) const {
  const std::string w = text_of(width), h = text_of(height);
  return fmt::format("<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"{}pt\" height=\"{}pt\" viewBox=\"0 0 {} {}\" "
                     "font-family=\"Helvetica, Arial, 'Liberation Sans', sans-serif\" stroke-linejoin=\"round\">\n<title>{}</title>\n"
                     "<rect width=\"{}\" height=\"{}\" fill=\"#ffffff\"/>\n{}</svg>\n",
                     w, h, w, h, as_markup(title), w, h, body_);
}

double width_of(const std::string& words, double size) {
  double width = 0;
  for (const char c : words) {
    if ((static_cast<unsigned char>(c) & 0xC0) == 0x80) continue;          // goes on with a letter of UTF-8
    if (std::string_view("ijltfI.,:;|'!() ").find(c) != std::string_view::npos) width += 0.29;
    else if (std::string_view("mwMW").find(c) != std::string_view::npos) width += 0.83;
    else if (c >= 'A' && c <= 'Z') width += 0.69;
    else width += 0.55;
  }
  return width * size;
}

const std::string& colour(int index) {
  static const std::array<std::string, 7> colours{"#0072b2", "#d55e00", "#009e73", "#cc79a7", "#e69f00", "#56b4e9", "#000000"};
  return colours[static_cast<std::size_t>(index) % colours.size()];
}

Polyline thinned(const Polyline& line, double tolerance) {
  if (line.size() < 3) return line;
  std::vector<bool> kept(line.size(), false);
  kept.front() = kept.back() = true;
  std::vector<std::pair<std::size_t, std::size_t>> open{{0, line.size() - 1}};
  while (!open.empty()) {
    const auto [first, last] = open.back();
    open.pop_back();
    const Vec2 chord = line[last] - line[first];
    const double length = chord.norm();
    double most = 0;
    std::size_t at = first;
    for (std::size_t i = first + 1; i < last; ++i) {
      const Vec2 d = line[i] - line[first];
      const double along = length > 0 ? std::clamp(d.dot(chord) / (length * length), 0.0, 1.0) : 0.0;
      if (const double off = (d - along * chord).norm(); off > most) most = off, at = i;
    }
    if (most <= tolerance) continue;
    kept[at] = true;
    open.emplace_back(first, at), open.emplace_back(at, last);
  }
  Polyline rest;
  for (std::size_t i = 0; i < line.size(); ++i)
    if (kept[i]) rest.push_back(line[i]);
  return rest;
}

void write_pdf(const std::string& svg, const std::string& file) {
  const std::unique_ptr<std::FILE, int (*)(std::FILE*)> input(std::tmpfile(), std::fclose);
  if (!input || std::fwrite(svg.data(), 1, svg.size(), input.get()) != svg.size() || std::fflush(input.get()) != 0)
    throw OutputError(file + ": cannot be written: there is no room for a temporary file");
  std::rewind(input.get());
  posix_spawn_file_actions_t actions;
  posix_spawn_file_actions_init(&actions);
  posix_spawn_file_actions_adddup2(&actions, fileno(input.get()), STDIN_FILENO);
  std::string words[] = {"rsvg-convert", "--format=pdf", "--output=" + file};
  char* arguments[] = {words[0].data(), words[1].data(), words[2].data(), nullptr};
  pid_t child = 0;
  const int failed = posix_spawnp(&child, arguments[0], &actions, nullptr, arguments, environ);
  posix_spawn_file_actions_destroy(&actions);
  if (failed == ENOENT)
    throw InputError(file + ": a PDF is made by rsvg-convert, which is not installed; it is in the Debian package librsvg2-bin "
                            "(an .svg needs nothing)");
  int status = -1;
  if (failed || waitpid(child, &status, 0) < 0 || status != 0) throw InputError(file + ": cannot be written: rsvg-convert has failed");
}

}  // namespace elamin
