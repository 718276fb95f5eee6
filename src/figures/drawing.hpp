#pragma once
// Lines, areas and words on a sheet of paper, written as SVG. Lengths are points (1/72 inch); y grows downwards.
#include "core/types.hpp"

#include <string>
#include <vector>

namespace elamin {

using Vec2 = Eigen::Vector2d;
using Polyline = std::vector<Vec2>;

struct Pen {
  std::string colour = "#000000";
  double width = 0.5;
  std::string dashes = "";             // lengths of dashes and gaps; "": a full line
};

/// Of a word at a point: which part of it is there.
enum class Anchor { start, middle, end };

/// The same calls make the same text, bit by bit: lengths are rounded to a hundredth of a point.
class Drawing {
 public:
  /// Open lines, or areas with an outline; "": no fill.
  void lines(const std::vector<Polyline>& lines, const Pen& pen);
  void area(const Polyline& corners, const std::string& fill, const Pen& pen);
  void circle(const Vec2& center, double radius, const std::string& fill, const Pen& pen);
  /// Discs of one radius and colour.
  void discs(const std::vector<Vec2>& centers, double radius, const std::string& colour);
  /// turned: upwards along the page's side.
  void words(const Vec2& at, const std::string& words, Anchor anchor, double size, bool turned = false);
  /// What is drawn between these two is seen only in a rectangle.
  void clip(const Vec2& corner, const Vec2& opposite);
  void end_clip() { body_ += "</g>\n"; }

  std::string svg(double width, double height, const std::string& title) const;

 private:
  std::string body_;
  int clips_ = 0;
};

/// About how wide words are in a sans-serif typeface of this size.
double width_of(const std::string& words, double size);

/// Okabe and Ito's colours, which the colour-blind tell apart: blue, vermillion, bluish green, reddish purple, orange, sky blue, black; then
/// again. Source: Okabe, Ito 2008, Color Universal Design.
const std::string& colour(int index);

/// Leaves out of a line what is nearer to it than `tolerance` [Douglas, Peucker 1973].
Polyline thinned(const Polyline& line, double tolerance);

/// Writes a figure as a PDF, lines as lines and words as text, by the program rsvg-convert. Throws InputError, which names its
/// package, if that is not there, or if the file cannot be written.
void write_pdf(const std::string& svg, const std::string& file);

}  // namespace elamin
