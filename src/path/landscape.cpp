#include "path/landscape.hpp"

#include "core/find.hpp"
#include "core/interrupt.hpp"
#include "energy/step_limits.hpp"
#include "model/entities.hpp"
#include "path/arc.hpp"
#include "path/deflation.hpp"
#include "path/jump.hpp"
#include "path/limits.hpp"
#include "path/saddle.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <random>

namespace elamin {

using namespace limits;

namespace {


/// Centres of particles and bodies: 3 × count.
Field centres(const State& s) {
  Field x(3, s.particles() + static_cast<Eigen::Index>(s.bodies.size()));
  x.leftCols(s.particles()) = s.position;
  for (std::size_t b = 0; b < s.bodies.size(); ++b) x.col(s.particles() + static_cast<Eigen::Index>(b)) = s.bodies[b].position.hi;
  return x;
}

Vector sums_of_distances(const State& s) {
  const Field x = centres(s);
  Vector sums(x.cols());
  for (Eigen::Index i = 0; i < x.cols(); ++i) sums[i] = (x.colwise() - x.col(i)).colwise().norm().sum();
  std::sort(sums.begin(), sums.end());
  return sums;
}

/// A reflection or half turn that takes the places at rest to themselves: signs of the coordinates about the middle, and where each particle goes.
struct Reflection {
  Vec3 middle, signs;
  std::vector<int> to;

  State of(const State& s) const {
    State image = s;
    const ExactVector center{middle, Vec3::Zero()};
    for (std::size_t i = 0; i < to.size(); ++i) {
      const ExactVector off = s.at(static_cast<Eigen::Index>(i)) - center;
      image.set(to[i], center + ExactVector{signs.cwiseProduct(off.hi), signs.cwiseProduct(off.lo)});
    }
    return image;
  }
};

/// Those of particles that are alike in size; none where there are bodies.
std::vector<Reflection> reflections_of(const Model& model) {
  std::vector<Reflection> all;
  if (!model.bodies.empty() || model.particles() == 0) return all;
  const Field& x = model.start.position;
  const Vec3 middle = (x.rowwise().minCoeff() + x.rowwise().maxCoeff()) / 2;
  const double close = landscape::same_rest * span(model);
  std::vector<int> order(static_cast<std::size_t>(x.cols()));
  for (std::size_t i = 0; i < order.size(); ++i) order[i] = static_cast<int>(i);
  std::sort(order.begin(), order.end(), [&](int a, int b) { return x(0, a) < x(0, b); });
  for (int bits = 1; bits < 8; ++bits) {
    Reflection r{middle, {bits & 1 ? -1.0 : 1.0, bits & 2 ? -1.0 : 1.0, bits & 4 ? -1.0 : 1.0}, {}};
    for (Eigen::Index i = 0; i < x.cols(); ++i) {
      const Vec3 y = middle + r.signs.cwiseProduct(x.col(i) - middle);
      auto j = std::lower_bound(order.begin(), order.end(), y[0] - close, [&](int a, double v) { return x(0, a) < v; });
      while (j != order.end() && x(0, *j) <= y[0] + close && (x.col(*j) - y).norm() > close) ++j;
      if (j == order.end() || x(0, *j) > y[0] + close) break;
      r.to.push_back(*j);
    }
    if (static_cast<Eigen::Index>(r.to.size()) == x.cols()) all.push_back(std::move(r));
  }
  return all;
}

const char* kind_of(int index) { return index == 0 ? "minimum" : index == 1 ? "saddle" : "stationary"; }

class Explorer {
 public:
  Explorer(Newton& newton, double load_factor, const LandscapeOptions& options, const std::vector<Reflection>& reflections,
           std::vector<std::string>& notes)
      : newton_(newton), energy_(newton.energy()), options_(options), reflections_(reflections), notes_(notes) {
    found_.load_factor = load_factor;
  }

  Landscape& found() { return found_; }

  /// The node of an equilibrium, which may be a new one; none: it is critical.
  NodeImage add(Equilibrium e) {
    const int index = e.point.stability.negative;
    if (e.point.stability.critical > 0 || !e.point.report.converged()) return {};
    LandscapeNode node{"", {}, spectrum_of(e), sums_of_distances(e.point.state)};
    const double near = landscape::same_place * span(energy_.model()) * std::sqrt(static_cast<double>(energy_.dofs())) +
                        left_by_rounding(newton_, e.point.state, e.zero_modes);
    for (std::size_t n = 0; n < found_.nodes.size(); ++n) {
      LandscapeNode& known = found_.nodes[n];
      if (known.index() != index) continue;
      for (std::size_t k = 0; k < known.images.size(); ++k)
        if (apart(known.images[k], e) <= near) return {static_cast<int>(n), static_cast<int>(k)};
      if (!alike(known, e, node)) continue;
      if (e.zero_modes.cols() > 0) return {static_cast<int>(n), 0};           // it has moved along them
      known.images.push_back(std::move(e));
      return {static_cast<int>(n), static_cast<int>(known.images.size()) - 1};
    }
    node.images.push_back(std::move(e));
    reflect(node, near);
    found_.nodes.push_back(std::move(node));
    return {static_cast<int>(found_.nodes.size()) - 1, 0};
  }

  /// Everything that walks from the nodes lead to, nodes that they find included.
  void grow() {
    for (bool more = true; more && !full();) {
      more = false;
      expanded_.resize(found_.nodes.size(), 0);
      for (std::size_t n = 0; n < found_.nodes.size() && !full(); ++n)
        for (expanded_.resize(found_.nodes.size(), 0); expanded_[n] < found_.nodes[n].images.size() && !full(); more = true)
          expand({static_cast<int>(n), static_cast<int>(expanded_[n]++)});
    }
  }

  void start_at_random() {
    std::mt19937_64 random(options_.seed);
    const auto number = [&] { return static_cast<double>(random() >> 11) * 0x1p-52 - 1; };      // in [−1, 1)
    const std::size_t bases = found_.nodes.size();
    for (int k = 0; k < options_.starts && bases > 0 && !full(); ++k) {
      const Equilibrium base = found_.nodes[static_cast<std::size_t>(k) % bases].images.front();
      State state = base.point.state;
      const EigenPairs soft = soft_modes(newton_, state, base.zero_modes, 2 * options_.modes);
      Vector p = soft.vectors * Vector::NullaryExpr(soft.values.size(), [&] { return number(); });
      const double turn = distortion(energy_, state, p);
      energy_.kinematics().retract(state, p, landscape::nudge * std::abs(number()) / (turn > 0 ? turn : movement(energy_, p)));
      if (energy_.collision_free_step(base.point.state, state) < 1) continue;
      if (const Report report = go_down(newton_, state); report.converged()) add(assess(newton_, state, report)), grow();
    }
  }

  void deflate_known() {
    if (options_.deflate == 0 || full()) return;
    std::vector<State> known;
    for (const LandscapeNode& n : found_.nodes)
      for (const Equilibrium& e : n.images) known.push_back(e.point.state);
    PathOptions asked;
    asked.to = found_.load_factor, asked.deflate = options_.deflate;
    std::vector<std::string> told;
    for (const PathPoint& p : deflate(newton_, known, asked, told)) add(assess(newton_, p.state, p.report));
    grow();
  }

  /// Lines between minima that no chain of saddles joins.
  void join() {
    for (int k = 0; options_.strings && k < landscape::most_strings && !full(); ++k) {
      const std::vector<NodeImage> minima = found_.images(0);
      const std::vector<int> part = parts(minima);
      std::size_t i = 1;
      while (i < minima.size() && (part[i] == part[0] || contains(tried_, minima[i]))) ++i;
      if (i >= minima.size()) break;
      tried_.push_back(minima[i]);
      const Equilibrium a = found_.at(minima[0]), b = found_.at(minima[i]);
      for (Equilibrium& e : passes_between(newton_, a.point.state, b.point.state, a.zero_modes)) add(std::move(e));
      grow();
    }
    const std::vector<NodeImage> minima = found_.images(0);
    const std::vector<int> part = parts(minima);
    if (std::any_of(part.begin(), part.end(), [&](int p) { return p != part[0]; })) note("not all minima are joined by the saddles that were found");
  }

 private:
  // What was not found.
  void note(const std::string& what) {
    if (!interrupted()) notes_.push_back(fmt::format("load factor {:.10g}: {}", found_.load_factor, what));
  }

  bool full() {
    if (interrupted()) return true;
    if (static_cast<int>(found_.nodes.size()) < options_.most) return false;
    if (!std::exchange(told_full_, true))
      note(fmt::format("there are {} nodes; landscape.most allows no more", options_.most));
    return true;
  }

  Vector spectrum_of(const Equilibrium& e) {
    return soft_modes(newton_, e.point.state, e.zero_modes, landscape::spectrum + e.point.stability.negative).values;
  }

  double apart(const Equilibrium& a, const Equilibrium& b) const {
    Vector d = energy_.kinematics().difference(a.point.state, b.point.state);
    if (a.zero_modes.cols() > 0) d -= a.zero_modes * (a.zero_modes.transpose() * d);
    return d.norm();
  }

  bool alike(const LandscapeNode& known, const Equilibrium& e, const LandscapeNode& seen) const {
    const EnergyTerms& terms = known.images.front().point.energy;
    const double stiffest = infinity_norm(known.spectrum), length = span(energy_.model());
    const double off = landscape::same_energy * terms.size() + stiffest * std::pow(landscape::same_place * length, 2);
    return std::abs(terms.total() - e.point.energy.total()) <= off && known.spectrum.size() == seen.spectrum.size() &&
           infinity_norm(known.spectrum - seen.spectrum) <= landscape::same_stiffness * stiffest &&
           infinity_norm(known.distances - seen.distances) <= landscape::same_distance * length * static_cast<double>(seen.distances.size());
  }

  // Images by reflections that are equilibria, at other places.
  void reflect(LandscapeNode& node, double near) {
    const Equilibrium first = node.images.front();
    for (const Reflection& r : reflections_) {
      State state = r.of(first.point.state);
      energy_.kinematics().prescribe(state, found_.load_factor);
      energy_.evaluate(state, false);
      if (!(energy_.relative(energy_.gradient()) <= std::sqrt(newton_.tolerance()))) continue;
      const Report report = newton_.correct(state, first.zero_modes, nullptr, equilibrium::most_iterations);
      if (!report.converged()) continue;
      Equilibrium e = assess(newton_, state, report);
      const auto there = [&](const Equilibrium& known) { return apart(known, e) <= near; };
      if (e.point.stability.negative != node.index() || std::any_of(node.images.begin(), node.images.end(), there)) continue;
      if (alike(node, e, LandscapeNode{"", {}, spectrum_of(e), sums_of_distances(state)})) node.images.push_back(std::move(e));
    }
  }

  void expand(const NodeImage& from) {
    const Equilibrium here = found_.at(from);
    const Eigen::MatrixXd& held = here.zero_modes;
    const int index = here.point.stability.negative;
    const EigenPairs soft = soft_modes(newton_, here.point.state, held, std::max(options_.modes, index));
    const int count = static_cast<int>(soft.values.size());
    const auto go = [&](const Vector& first, const Vector& up) {
      if (full()) return;
      if (std::optional<Equilibrium> e = walk(newton_, here.point.state, {first, up}, held)) add(std::move(*e));
    };
    if (index == 0)
      for (int i = 0; i < std::min(count, options_.modes); ++i)
        for (const double sign : {1.0, -1.0}) go(sign * soft.vectors.col(i), sign * soft.vectors.col(i));
    if (index == 1 && count > 0) {
      Pass pass{from, {}};
      for (const int side : {0, 1}) pass.minima[static_cast<std::size_t>(side)] = descend(here, (side ? -1.0 : 1.0) * soft.vectors.col(0));
      if (!interrupted()) found_.passes.push_back(pass);
    }
    if (index > 1)
      for (int i = 0; i < std::min(index, count); ++i)
        for (int j = 0; j < std::min(index, count); ++j)
          for (const double sign : {1.0, -1.0})
            if (i != j) go(sign * soft.vectors.col(i), soft.vectors.col(j));
  }

  // The minimum below; a saddle that symmetry leads to is left along its lowest mode.
  NodeImage descend(const Equilibrium& from, Vector first) {
    std::optional<Equilibrium> e = from;
    for (int k = 0; k < landscape::most_leaves; ++k) {
      e = walk(newton_, e->point.state, {first, {}}, from.zero_modes);
      if (!e) break;
      const NodeImage to = add(*e);
      if (to.node < 0 || found_.node(to).index() == 0) return to;
      first = soft_modes(newton_, e->point.state, from.zero_modes, 1).vectors.col(0);
    }
    note("the way down from a saddle ends at no minimum that was found");
    return {};
  }

  // The number of the part that each minimum belongs to.
  std::vector<int> parts(const std::vector<NodeImage>& minima) const {
    std::vector<int> part(minima.size());
    for (std::size_t i = 0; i < part.size(); ++i) part[i] = static_cast<int>(i);
    for (const Pass& p : found_.passes) {
      const auto a = std::find(minima.begin(), minima.end(), p.minima[0]), b = std::find(minima.begin(), minima.end(), p.minima[1]);
      if (a == minima.end() || b == minima.end()) continue;
      const int from = part[static_cast<std::size_t>(b - minima.begin())], to = part[static_cast<std::size_t>(a - minima.begin())];
      std::replace(part.begin(), part.end(), from, to);
    }
    return part;
  }

  Newton& newton_;
  Energy& energy_;
  const LandscapeOptions& options_;
  const std::vector<Reflection>& reflections_;
  std::vector<std::string>& notes_;
  Landscape found_;
  std::vector<std::size_t> expanded_;              // images, by node
  std::vector<NodeImage> tried_;                   // minima to which a line from the first one has led
  bool told_full_ = false;
};

/// An equilibrium at another load factor; `at` empty: it ends. Where its index changes: what it was and what it is, −1 where it ends.
struct Followed {
  struct Change { double load_factor; int from, to; };
  std::optional<Equilibrium> at;
  std::vector<Change> changes;
};

Followed follow(Newton& newton, const Equilibrium& from, double to) {
  const double way = to - from.point.state.load_factor, least = landscape::least_part * std::abs(way);
  Followed f{from, {}};
  for (double step = landscape::first_part * way; f.at->point.state.load_factor != to && !interrupted();) {
    const double here = f.at->point.state.load_factor, left = to - here;
    const bool last = std::abs(step) >= (1 - landscape::same_load) * std::abs(left);
    Equilibrium next = continue_to(newton, *f.at, last ? to : here + step);
    const int before = f.at->point.stability.negative, after = next.point.report.converged() ? next.point.stability.negative : -1;
    if (after != before && std::abs(step) / 2 > least) {
      step = (last ? left : step) / 2;
      continue;
    }
    if (after != before) f.changes.push_back({here + (last ? left : step) / 2, before, after});
    if (after < 0) {
      f.at.reset();
      break;
    }
    f.at = std::move(next), step *= 2;
  }
  return f;
}

/// What follows nodes from one load factor to the next and says what becomes of them.
class Follower {
 public:
  Follower(Newton& newton, const std::vector<PathEvent>& events, Landscapes& out) : newton_(newton), events_(events), out_(out) {}

  // Those of a that are at b, too. A label is kept where the kind is.
  void onward(const Landscape& a, Explorer& b) {
    from_ = a.load_factor, to_ = b.found().load_factor;
    for (const LandscapeNode& n : a.nodes) {
      Followed f = follow(newton_, n.images.front(), to_);
      for (const Followed::Change& c : f.changes)
        happened_.push_back({c.load_factor, n.label, c.to < 0 ? "ends" : fmt::format("goes from index {} to {}", c.from, c.to)});
      if (!f.at) continue;
      const bool same_kind = kind_of(f.at->point.stability.negative) == std::string(kind_of(n.index()));
      kept_.push_back({b.add(std::move(*f.at)).node, same_kind ? n.label : ""});
    }
  }
  void keep_labels(Landscape& b) const {
    for (const auto& [node, label] : kept_)
      if (node >= 0 && b.nodes[static_cast<std::size_t>(node)].label.empty()) b.nodes[static_cast<std::size_t>(node)].label = label;
  }
  // Where the nodes of b begin that are not followed; one that was there at a is added to it.
  bool back(Explorer& a, const Landscape& b) {
    bool more = false;
    for (std::size_t k = 0; k < b.nodes.size() && !interrupted(); ++k) {
      if (std::any_of(kept_.begin(), kept_.end(), [&](const Kept& kept) { return kept.node == static_cast<int>(k); })) continue;
      Followed f = follow(newton_, b.nodes[k].images.front(), from_);
      for (const Followed::Change& c : f.changes)
        happened_.push_back({c.load_factor, b.nodes[k].label, c.to < 0 ? "begins" : fmt::format("goes from index {} to {}", c.to, c.from)});
      if (!f.at) continue;
      const std::size_t before = a.found().nodes.size();
      a.add(std::move(*f.at)), more = more || a.found().nodes.size() > before;
    }
    return more;
  }
  // What happened at one load factor is one change; an event of the path there explains it.
  void tell() {
    const double close = landscape::together * std::abs(to_ - from_), way = to_ > from_ ? 1 : -1;
    std::stable_sort(happened_.begin(), happened_.end(), [&](const auto& x, const auto& y) { return way * x.load_factor < way * y.load_factor; });
    std::vector<bool> used(events_.size(), false);
    for (std::size_t k = 0, end; k < happened_.size(); k = end) {
      LandscapeChange change{happened_[k].load_factor, {}, "", ""};
      std::vector<std::string> told;
      for (end = k; end < happened_.size() && std::abs(happened_[end].load_factor - change.load_factor) <= close; ++end)
        change.nodes.push_back(happened_[end].label), told.push_back(happened_[end].label + " " + happened_[end].what);
      for (std::size_t i = 0; i < events_.size(); ++i) {
        if (std::abs(events_[i].load_factor - change.load_factor) > close) continue;
        used[i] = true;
        if (change.event.empty()) change.event = events_[i].label;
      }
      change.what = fmt::format("{}; {}", fmt::join(told, ", "),
                                change.event.empty() ? "no event of the path is there" : change.event + " of the path");
      out_.changes.push_back(std::move(change));
    }
    for (std::size_t i = 0; i < events_.size(); ++i) {
      const bool between = way * events_[i].load_factor > way * from_ && way * events_[i].load_factor <= way * to_;
      if (between && !used[i] && !events_[i].label.starts_with("contact:"))
        out_.notes.push_back(fmt::format("load factor {:.10g}: {} of the path makes or ends no node that was found", events_[i].load_factor,
                                         events_[i].label));
    }
  }

 private:
  struct Kept { int node; std::string label; };
  struct Happened { double load_factor; std::string label, what; };
  Newton& newton_;
  const std::vector<PathEvent>& events_;
  Landscapes& out_;
  double from_ = 0, to_ = 0;
  std::vector<Kept> kept_;
  std::vector<Happened> happened_;
};

/// Labels of those that have none, by energy.
void name_nodes(Landscape& l, std::array<int, 3>& numbers) {
  std::vector<LandscapeNode*> nodes;
  for (LandscapeNode& n : l.nodes)
    if (n.label.empty()) nodes.push_back(&n);
  std::stable_sort(nodes.begin(), nodes.end(), [](const LandscapeNode* a, const LandscapeNode* b) { return a->energy() < b->energy(); });
  for (LandscapeNode* n : nodes) n->label = fmt::format("{}:{}", kind_of(n->index()), ++numbers[static_cast<std::size_t>(std::min(n->index(), 2))]);
}

}  // namespace

std::vector<NodeImage> Landscape::images(int index) const {
  std::vector<NodeImage> all;
  for (int n = 0; n < static_cast<int>(nodes.size()); ++n)
    for (int k = 0; k < static_cast<int>(node({n, 0}).images.size()); ++k)
      if (index < 0 || node({n, 0}).index() == index) all.push_back({n, k});
  return all;
}

int Landscape::euler() const {
  int sum = 0;
  for (const NodeImage& i : images(-1)) sum += node(i).index() % 2 ? -1 : 1;
  return sum;
}

double Landscape::barrier(const NodeImage& minimum) const {
  double least = infinity;
  for (const Pass& p : passes)
    if (!(p.minima[0] == p.minima[1]) && (p.minima[0] == minimum || p.minima[1] == minimum))
      least = std::min(least, node(p.saddle).energy());
  return least - node(minimum).energy();
}

Landscapes explore(Newton& newton, const std::vector<State>& known, const std::vector<PathEvent>& events,
                   const std::vector<double>& load_factors, const LandscapeOptions& options, const std::function<void(const std::string&)>& tell) {
  Landscapes all;
  const std::vector<Reflection> reflections = reflections_of(newton.energy().model());
  std::unique_ptr<Explorer> before;
  std::array<int, 3> numbers{};
  for (const double load_factor : load_factors) {
    if (interrupted()) break;
    auto here = std::make_unique<Explorer>(newton, load_factor, options, reflections, all.notes);
    Follower follower(newton, events, all);
    if (before) follower.onward(before->found(), *here);
    for (const State& s : known) {
      State state = s;
      if (state.load_factor != load_factor) continue;
      newton.energy().evaluate(state);
      const Report report = newton.correct(state, assess(newton, state, {}).zero_modes);
      if (report.converged()) here->add(assess(newton, state, report));
    }
    here->grow(), here->deflate_known(), here->start_at_random(), here->join();
    if (before) follower.keep_labels(here->found());
    name_nodes(here->found(), numbers);
    if (before) {
      if (follower.back(*before, here->found())) {                // nodes that were missed there
        before->grow();
        name_nodes(before->found(), numbers);
      }
      follower.tell();
      all.at.push_back(before->found());
    }
    const Landscape& l = here->found();
    if (tell) tell(fmt::format("load factor {:.10g}: {} minima, {} saddles, {} nodes", load_factor, l.minima(), l.saddles(), l.nodes.size()));
    before = std::move(here);
  }
  if (before) all.at.push_back(before->found());
  return all;
}

}  // namespace elamin
