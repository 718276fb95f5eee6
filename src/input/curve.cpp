#include "input/curve.hpp"

#include "core/find.hpp"
#include "core/suggest.hpp"
#include "input/check.hpp"
#include "input/parts.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>

namespace elamin {
namespace {

constexpr std::array kinds_of_curve{"limit", "branch", "contact", "jump"};
constexpr std::array labels_of_curve{"cusp", "turn", "symmetric", "hilltop", "double", "meeting", "contact"};

}  // namespace

void describe(Keys& keys, CurveTable& t) {
  keys.about("An event of the path, followed as a second parameter changes: a curve of load factors. The path is traced at `from` and ends "
             "at the event.");
  keys.must("of", t.of, "the event: limit:1, branch:1, contact:1, or another one of them by its number; jump:1: the one at which that snap begins");
  keys.must("second", t.second,
            "a key whose value is a number, such as \"beam.column.youngs_modulus\", \"support.top.displacement.3\" or \"constants.t\"");
  keys.must("from", t.from, "its value where the curve begins");
  keys.must("to", t.to, "… and where it ends");
  keys.may("steps", t.steps, "no step of the curve changes it by more than such a part", Range{1, most_steps});
  keys.may("stops", t.stops, "values of it that are met besides");
  keys.one_or_more("until", t.until, "ends at the first of these, such as \"turn:1\", if it comes before `to`");
}

std::optional<double> second_of(const std::string& at) {
  return number_behind("second=", at);
}

bool is_of_curve(const std::string& at) { return at.starts_with("second=") || at.starts_with("curve."); }

std::string wrong_at_curve(const Problem& p, const std::string& at) {
  if (!p.curve) return in_quotes(at) + " is a point of a curve; there is no [curve]";
  if (at == "curve.start" || at == "curve.end" || (at.starts_with("curve.") && is_numbered(at.substr(6), labels_of_curve))) return "";
  if (const auto second = second_of(at)) {
    const auto [lo, hi] = std::minmax(p.curve->from, p.curve->to);
    if (*second >= lo && *second <= hi) return "";
    return fmt::format("lies outside the curve, which runs from {} to {}", p.curve->from, p.curve->to);
  }
  return fmt::format("must be \"second=0.5\", \"curve.start\", \"curve.end\" or one of \"curve.{}:1\" on a curve, is {}",
                     fmt::join(labels_of_curve, ":1\", \"curve."), in_quotes(at));
}

void check_curve(Problem& p, Mistakes& mistakes) {
  if (!p.curve) return;
  CurveTable& t = *p.curve;
  if (p.study != StudyType::path) mistakes.add(t.place, "is of an event of a path; give study.type = \"path\" or leave it out");
  if (!p.stages.empty()) mistakes.add(t.place, "is of paths without stages");
  if (t.place.broken) return;
  if (!is_numbered(t.of, kinds_of_curve))
    mistakes.add(t.place, "of", "must be a limit point, a branch point, a contact or a snap, such as \"limit:1\", \"branch:1\", \"contact:1\" or \"jump:1\", " +
                                    ("is " + in_quotes(t.of)));
  else if (const std::string kind = t.of.substr(0, t.of.find(':')); kind != "jump" && !contains(p.path.locate, kind) && !p.path.place.broken)
    mistakes.add(t.place, "of", in_quotes(kind) + " is not among path.locate; only located events can be followed");
  else if (kind == "jump" && p.path.when_unstable != WhenUnstable::jump)
    mistakes.add(t.place, "of", "is a snap, which a path has with path.when_unstable = \"jump\"");
  for (const std::string& label : t.until)
    if (!is_numbered(label, labels_of_curve))
      mistakes.add(t.place, "until", fmt::format("must be \"{}:1\" or such, is {}", fmt::join(labels_of_curve, ":1\", \""), in_quotes(label)));
  if (t.from == t.to) mistakes.add(t.place, "to", fmt::format("is the same value as from, {}; a curve leads from one to another", t.to));
  if (t.stops)
    for (const double s : *t.stops)
      if (s < std::min(t.from, t.to) || s > std::max(t.from, t.to))
        mistakes.add(t.place, "stops", fmt::format("{} lies outside the curve, which runs from {} to {}", s, t.from, t.to));
}

}  // namespace elamin
