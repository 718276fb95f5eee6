#include "results/landscape.hpp"

#include "core/find.hpp"
#include "results/columns.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <numeric>

namespace elamin {
namespace {

/// "minimum:1", or which of its images.
std::string called(const Landscape& l, const NodeImage& i) {
  if (i.node < 0) return "none";
  const LandscapeNode& n = l.node(i);
  return n.images.size() == 1 ? n.label : fmt::format("{} ({} of {})", n.label, i.image + 1, n.images.size());
}

/// The numbers of the nodes, minima first, then by energy.
std::vector<int> in_order(const Landscape& l) {
  std::vector<int> order(l.nodes.size());
  std::iota(order.begin(), order.end(), 0);
  const auto rank = [&](int n) { return std::pair(l.node({n}).index(), l.node({n}).energy()); };
  std::stable_sort(order.begin(), order.end(), [&](int a, int b) { return rank(a) < rank(b); });
  return order;
}

const Pass* pass_of(const Landscape& l, const NodeImage& saddle) {
  for (const Pass& p : l.passes)
    if (p.saddle == saddle) return &p;
  return nullptr;
}

/// From the higher and from the lower minimum up to the saddle.
std::array<std::optional<double>, 2> barriers(const Landscape& l, const Pass& p) {
  std::array<std::optional<double>, 2> up;
  const double top = l.node(p.saddle).energy();
  for (const NodeImage& m : p.minima)
    if (const double e = m.node < 0 ? 0 : top - l.node(m).energy(); m.node >= 0) (up[0] ? up[1] : up[0]) = e;
  if (up[0] && up[1] && *up[0] > *up[1]) std::swap(up[0], up[1]);
  return up;
}


Json image_of(const Landscape& l, const NodeImage& i) {
  return i.node < 0 ? Json(nullptr) : Json{{"node", l.node(i).label}, {"image", i.image + 1}};
}

Json tree_json(const Landscape& l, const LandscapeTree& t) {
  Json leaves = Json::array(), lines = Json::array();
  for (const LandscapeTree::Leaf& leaf : t.leaves)
    leaves.push_back({{"label", called(l, leaf.minimum)}, {"x", leaf.x}, {"energy", json_of(leaf.y)}});
  for (const auto& line : t.lines) lines.push_back(line);
  return {{"leaves", leaves}, {"lines", lines}};
}

}  // namespace

std::vector<std::string> landscape_columns(const std::vector<std::string>& observables) {
  std::vector<std::string> columns = node_columns(observables);
  for (const char* more : {"multiplicity", "barrier", "barrier_back", "minima", "saddles", "euler", "what"}) columns.emplace_back(more);
  return columns;
}

Table landscape_table(const Landscapes& all, const std::vector<std::string>& observables,
                      const std::function<std::vector<double>(const PathPoint&)>& observe) {
  Table table{landscape_columns(observables), {}};
  const auto short_row = [&](const std::string& label, double load_factor) -> Row& {
    Row row(table.columns.size());
    row[0] = label, row[1] = load_factor;
    return table.rows.emplace_back(std::move(row));
  };
  const auto put = [&](Row& row, const char* column, Cell value) {
    row[table.column(column)] = std::move(value);
  };
  for (const Landscape& l : all.at) {
    Row& graph = short_row("graph", l.load_factor);
    put(graph, "minima", l.minima()), put(graph, "saddles", l.saddles()), put(graph, "euler", l.euler());
    for (const int k : in_order(l)) {
      const LandscapeNode& n = l.node({k});
      PathPoint p = n.images.front().point;
      p.label = n.label;
      Row row = node_row(p, observe(p));
      row.resize(table.columns.size());
      put(row, "multiplicity", static_cast<int>(n.images.size()));
      if (const double up = l.barrier({k, 0}); n.index() == 0) put(row, "barrier", up);
      if (const Pass* pass = pass_of(l, {k, 0})) {
        const auto up = barriers(l, *pass);
        put(row, "barrier", cell_of(up[0])), put(row, "barrier_back", cell_of(up[1]));
        put(row, "what", fmt::format("joins {} and {}", called(l, pass->minima[0]), called(l, pass->minima[1])));
      }
      table.rows.push_back(std::move(row));
    }
  }
  for (std::size_t k = 0; k < all.changes.size(); ++k)
    put(short_row(fmt::format("change:{}", k + 1), all.changes[k].load_factor), "what", all.changes[k].what);
  return table;
}

LandscapeTree tree_of(const Landscape& l) {
  struct Part { std::vector<NodeImage> leaves; double x = 0, y = 0; };
  std::vector<const Pass*> passes;
  for (const Pass& p : l.passes)
    if (p.minima[0].node >= 0 && p.minima[1].node >= 0) passes.push_back(&p);
  const auto energy = [&](const NodeImage& i) { return l.node(i).energy(); };
  std::stable_sort(passes.begin(), passes.end(), [&](const Pass* a, const Pass* b) { return energy(a->saddle) < energy(b->saddle); });
  LandscapeTree tree;
  std::vector<NodeImage> order;                                 // of the leaves, from the left: known after the first round
  for (const bool draws : {false, true}) {
    std::vector<Part> parts;
    for (const NodeImage& m : l.images(0))
      parts.push_back({{m}, 1.0 + static_cast<double>(std::find(order.begin(), order.end(), m) - order.begin()), energy(m)});
    if (draws)
      for (const Part& p : parts) tree.leaves.push_back({p.leaves.front(), p.x, p.y});
    for (const Pass* p : passes) {
      const auto part_of = [&](const NodeImage& m) {
        const auto has = [&](const Part& q) { return contains(q.leaves, m); };
        return std::find_if(parts.begin(), parts.end(), has);
      };
      auto a = part_of(p->minima[0]), b = part_of(p->minima[1]);
      if (a == b) continue;
      if (b->y < a->y) std::swap(a, b);                         // the lower one on the left
      const double top = energy(p->saddle);
      if (draws) tree.lines.push_back({{a->x, a->y}, {a->x, top}, {b->x, top}, {b->x, b->y}});
      a->leaves.insert(a->leaves.end(), b->leaves.begin(), b->leaves.end());
      a->x = (a->x + b->x) / 2, a->y = top;
      parts.erase(b);
    }
    for (const Part& p : parts)
      if (!draws) order.insert(order.end(), p.leaves.begin(), p.leaves.end());
  }
  return tree;
}

Json landscape_json(const Landscapes& all, const std::function<std::string(const Landscape&, const NodeImage&)>& file) {
  Json j{{"landscapes", Json::array()}, {"changes", Json::array()}, {"notes", all.notes}};
  for (const Landscape& l : all.at) {
    Json nodes = Json::array(), edges = Json::array();
    for (const int k : in_order(l)) {
      const LandscapeNode& n = l.node({k});
      Json states = Json::array();
      for (int i = 0; i < static_cast<int>(n.images.size()); ++i) states.push_back(file(l, {k, i}));
      nodes.push_back({{"label", n.label}, {"index", n.index()}, {"energy", json_of(n.energy())}, {"multiplicity", n.images.size()},
                       {"barrier", n.index() == 0 ? json_of(l.barrier({k, 0})) : Json(nullptr)},
                       {"eigenvalues", std::vector<double>(n.spectrum.begin(), n.spectrum.end())},
                       {"zero_modes", n.images.front().point.stability.zero_modes}, {"states", states}});
    }
    for (const Pass& p : l.passes) {
      const auto up = barriers(l, p);
      edges.push_back({{"saddle", image_of(l, p.saddle)}, {"minima", {image_of(l, p.minima[0]), image_of(l, p.minima[1])}},
                       {"barrier", json_of(up[0])}, {"barrier_back", json_of(up[1])}});
    }
    j["landscapes"].push_back({{"load_factor", l.load_factor}, {"minima", l.minima()}, {"saddles", l.saddles()}, {"euler", l.euler()},
                               {"nodes", nodes}, {"edges", edges}, {"tree", tree_json(l, tree_of(l))}});
  }
  for (const LandscapeChange& c : all.changes)
    j["changes"].push_back({{"load_factor", json_of(c.load_factor)}, {"nodes", c.nodes}, {"what", c.what},
                            {"event", c.event.empty() ? Json(nullptr) : Json(c.event)}});
  return j;
}

}  // namespace elamin
