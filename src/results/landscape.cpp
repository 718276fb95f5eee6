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
  std::ranges::stable_sort(order, {}, [&](int n) { return std::pair(l.nodes[n].index(), l.nodes[n].energy()); });
  return order;
}

/// From the higher and from the lower minimum up to the saddle.
std::vector<std::optional<double>> barriers(const Landscape& l, const Pass& p) {
  std::vector<std::optional<double>> up;
  for (const NodeImage& m : p.minima)
    if (m.node >= 0) up.push_back(l.node(p.saddle).energy() - l.node(m).energy());
  std::ranges::sort(up);
  up.resize(2);
  return up;
}

Json image_of(const Landscape& l, const NodeImage& i) {
  return i.node < 0 ? Json(nullptr) : Json{{"node", l.node(i).label}, {"image", i.image + 1}};
}

/// A disconnectivity diagram: a leaf for each minimum, where its energy is, and lines up to the lowest saddles over which minima are reached
/// from each other; x counts the leaves, y is the energy. Source: Becker & Karplus 1997, J. Chem. Phys. 106, 1495.
Json tree_of(const Landscape& l) {
  struct Part { std::vector<NodeImage> leaves; double x = 0, y = 0; };
  std::vector<const Pass*> passes;
  for (const Pass& p : l.passes)
    if (p.minima[0].node >= 0 && p.minima[1].node >= 0) passes.push_back(&p);
  std::ranges::stable_sort(passes, {}, [&](const Pass* p) { return l.node(p->saddle).energy(); });
  Json leaves = Json::array(), lines = Json::array();
  std::vector<NodeImage> order;                                 // of the leaves, from the left: known after the first round
  for (const bool draws : {false, true}) {
    std::vector<Part> parts;
    for (const NodeImage& m : l.images(0)) {
      const double x = 1.0 + static_cast<double>(std::ranges::find(order, m) - order.begin()), y = l.node(m).energy();
      parts.push_back({{m}, x, y});
      if (draws) leaves.push_back({{"label", called(l, m)}, {"x", x}, {"energy", json_of(y)}});
    }
    for (const Pass* p : passes) {
      const auto part_of = [&](const NodeImage& m) {
        return std::ranges::find_if(parts, [&](const Part& q) { return contains(q.leaves, m); });
      };
      auto a = part_of(p->minima[0]), b = part_of(p->minima[1]);
      if (a == b) continue;
      if (b->y < a->y) std::swap(a, b);                         // the lower one on the left
      const double top = l.node(p->saddle).energy();
      if (draws) lines.push_back({{a->x, a->y}, {a->x, top}, {b->x, top}, {b->x, b->y}});
      a->leaves.insert(a->leaves.end(), b->leaves.begin(), b->leaves.end());
      a->x = (a->x + b->x) / 2, a->y = top;
      parts.erase(b);
    }
    for (const Part& p : parts)
      if (!draws) order.insert(order.end(), p.leaves.begin(), p.leaves.end());
  }
  return {{"leaves", leaves}, {"lines", lines}};
}

}  // namespace

Table landscape_table(const Landscapes& all, const std::vector<std::string>& observables,
                      const std::function<std::vector<double>(const PathPoint&)>& observe) {
  Table table{node_columns(observables), {}};
  for (const char* more : {"multiplicity", "barrier", "barrier_back", "minima", "saddles", "euler", "what"}) table.columns.emplace_back(more);
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
      if (const auto pass = std::ranges::find(l.passes, NodeImage{k, 0}, &Pass::saddle); pass != l.passes.end()) {
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
                               {"nodes", nodes}, {"edges", edges}, {"tree", tree_of(l)}});
  }
  for (const LandscapeChange& c : all.changes)
    j["changes"].push_back({{"load_factor", json_of(c.load_factor)}, {"nodes", c.nodes}, {"what", c.what},
                            {"event", c.event.empty() ? Json(nullptr) : Json(c.event)}});
  return j;
}

}  // namespace elamin
