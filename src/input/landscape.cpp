#include "input/landscape.hpp"

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

constexpr std::string_view before_label = "landscape.";
constexpr std::array labels_of_landscape{"minimum", "saddle", "stationary", "change"};

}  // namespace

void describe(Keys& keys, LandscapeTable& t) {
  keys.about("A study of the energy landscape: minima and saddles at given load factors of a path, which minima a saddle joins, and how high "
             "it is above them.");
  keys.may("at", t.at, "the load factors, in the order of the path; by default the end of the path");
  keys.may("modes", t.modes, "soft modes of each minimum that are followed uphill, both ways", Range{0, most_modes});
  keys.may("starts", t.starts, "random starts besides, from which the energy goes down", Range{0, most_steps});
  keys.may("seed", t.seed, "of the random starts", Range{0, range::id.hi});
  keys.may("deflate", t.deflate, "further equilibria to look for by deflation", Range{0, most_branches});
  keys.may("most", t.most, "nodes of one landscape; then no further ones are looked for", Range{1, most_steps});
  keys.may("strings", t.strings, "whether minima that no saddle joins are joined by a line, whose highest states lead to saddles");
  keys.may_file("run", t.run, "the directory of a stored run of the same structure, whose states at these load factors are known besides");
}

std::vector<double> landscape_load_factors(const Problem& p) {
  return p.landscape ? p.landscape->at.value_or(std::vector{p.path.to}) : std::vector<double>{};
}

bool is_of_landscape(const std::string& at) { return at.starts_with(before_label); }

std::optional<InLandscape> in_landscape(const std::string& at) {
  if (!is_of_landscape(at)) return {};
  const std::string rest = at.substr(before_label.size()), label = rest.substr(0, rest.find('@'));
  const std::optional<double> load_factor = number_behind("@", rest.substr(label.size()));
  const bool known = is_numbered(label, labels_of_landscape) || label == "graph";
  return known && (load_factor || label == rest) ? std::optional(InLandscape{label, load_factor}) : std::nullopt;
}

std::string wrong_at_landscape(const Problem& p, const std::string& at) {
  if (p.study != StudyType::landscape) return in_quotes(at) + " is of a landscape; the study is none";
  const auto place = in_landscape(at);
  if (!place)
    return fmt::format("must be \"landscape.graph\" or one of \"landscape.{}:1\", with \"@0.5\" behind it for another load factor than the last, "
                       "is {}",
                       fmt::join(labels_of_landscape, ":1\", \"landscape."), in_quotes(at));
  const std::vector<double> all = landscape_load_factors(p);
  if (place->load_factor && !contains(all, *place->load_factor))
    return fmt::format("has a load factor, {}, that is none of landscape.at, {}", *place->load_factor, fmt::join(all, ", "));
  return "";
}

void check_landscape(Problem& p, Mistakes& mistakes) {
  if (p.landscape && p.study != StudyType::landscape)
    return mistakes.add(p.landscape->place, "is of another study; give study.type = \"landscape\" or leave it out");
  if (!p.landscape) return;
  LandscapeTable& t = *p.landscape;
  if (!p.stages.empty()) mistakes.add(p.stages.front().place, "stages have no landscape; go on from a stored state instead");
  if (t.place.broken || !t.at) return;
  const double way = p.path.to - p.path.from;
  const auto [lo, hi] = std::minmax(p.path.from, p.path.to);
  for (std::size_t k = 0; k < t.at->size(); ++k) {
    const double here = (*t.at)[k];
    if (p.path.method == PathMethod::load_steps && !p.path.place.broken && (here < lo || here > hi))
      mistakes.add(t.place, "at", fmt::format("{} lies outside the path, whose load factors run from {} to {}", here, lo, hi));
    if (k > 0 && !((here - (*t.at)[k - 1]) * way > 0))
      mistakes.add(t.place, "at", fmt::format("{} stands behind {}; they must follow each other as on the path, from {} to {}", here,
                                              (*t.at)[k - 1], p.path.from, p.path.to));
  }
}

}  // namespace elamin
