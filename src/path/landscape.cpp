#include "path/landscape.hpp"

#include "core/find.hpp"
#include "core/interrupt.hpp"
#include "core/near_pairs.hpp"
#include "energy/step_limits.hpp"
#include "path/arc.hpp"
#include "path/deflation.hpp"
#include "path/jump.hpp"
#include "path/limits.hpp"
#include "path/saddle.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <list>
#include <numeric>
#include <random>
#include <set>

namespace elamin {

using namespace limits;

namespace {

Vector sums_of_distances(const State& s) {
  const Eigen::Index particles = s.particles(), bodies = std::ssize(s.bodies);
  Field x(3, particles + bodies);
  x.leftCols(particles) = s.position;
  for (Eigen::Index b = 0; b < bodies; ++b) x.col(particles + b) = s.bodies[b].position.hi;
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
  for (int bits = 1; bits < 8; ++bits) {
    Reflection r{middle, {bits & 1 ? -1.0 : 1.0, bits & 2 ? -1.0 : 1.0, bits & 4 ? -1.0 : 1.0}, {}};
    const Field images = (r.signs.asDiagonal() * (x.colwise() - middle)).colwise() + middle;
    r.to = points_at(images, x, landscape::same_rest * span(model));
    if (!contains(r.to, -1)) all.push_back(std::move(r));
  }
  return all;
}

std::string_view kind_of(int index) { return index == 0 ? "minimum" : index == 1 ? "saddle" : "stationary"; }

class Explorer {
 public:
  Explorer(Newton& newton, double load_factor, const LandscapeOptions& options, const std::vector<Reflection>& reflections,
           std::vector<std::string>& notes)
      : newton_(newton), energy_(newton.energy()), options_(options), reflections_(reflections), notes_(notes), found_{load_factor, {}, {}} {}

  Landscape& found() { return found_; }

  /// The node of an equilibrium, which may be a new one; none: it is critical.
  NodeImage add(const Equilibrium& e) {
    if (e.point.stability.critical > 0 || !e.point.report.converged()) return {};
    LandscapeNode node = node_of(e);
    const double near = landscape::same_place * span(energy_.model()) * std::sqrt(static_cast<double>(energy_.dofs())) +
                        left_by_rounding(newton_, e.point.state, e.zero_modes);
    for (int n = 0; n < std::ssize(found_.nodes); ++n) {
      LandscapeNode& known = found_.nodes[n];
      if (known.index() != node.index()) continue;
      if (const auto k = image_at(known, e, near); k < std::ssize(known.images)) return {n, static_cast<int>(k)};
      if (!alike(known, node)) continue;
      if (e.zero_modes.cols() > 0) return {n, 0};                             // it has moved along them
      known.images.push_back(e);
      return {n, static_cast<int>(known.images.size()) - 1};
    }
    reflect(node, near);
    found_.nodes.push_back(std::move(node));
    return {static_cast<int>(found_.nodes.size()) - 1, 0};
  }

  /// Everything that walks from the nodes lead to, nodes that they find included.
  void grow() {
    for (bool more = true; more && !full();) {
      more = false;
      for (int n = 0; n < std::ssize(found_.nodes); ++n)
        for (; found_.nodes[n].expanded < std::ssize(found_.nodes[n].images) && !full(); more = true) expand({n, found_.nodes[n].expanded++});
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
      energy_.kinematics().retract(state, p, landscape::nudge * std::abs(number()) / step_size(energy_, state, p));
      if (energy_.collision_free_step(base.point.state, state) < 1) continue;
      if (const Report report = go_down(newton_, state); report.converged()) add(assess(newton_, state, report)), grow();
    }
  }

  void deflate_known() {
    if (options_.deflate == 0 || full()) return;
    std::vector<State> known;
    for (const NodeImage& i : found_.images(-1)) known.push_back(found_.at(i).point.state);
    PathOptions asked;
    asked.to = found_.load_factor, asked.deflate = options_.deflate;
    std::vector<std::string> told;
    for (const PathPoint& p : deflate(newton_, known, asked, told)) add(assess(newton_, p.state, p.report));
    grow();
  }

  /// Lines between minima that no chain of saddles joins.
  void join() {
    std::vector<NodeImage> tried;                              // minima to which a line from the first one has led
    for (int k = 0;; ++k) {
      const std::vector<NodeImage> minima = found_.images(0);
      const std::vector<int> part = parts(minima);
      if (std::ranges::all_of(part, [&](int p) { return p == part[0]; })) return;
      std::size_t i = 1;
      while (i < minima.size() && (part[i] == part[0] || contains(tried, minima[i]))) ++i;
      if (!options_.strings || k == landscape::most_strings || full() || i == minima.size())
        return note("not all minima are joined by the saddles that were found");
      tried.push_back(minima[i]);
      const Equilibrium a = found_.at(minima[0]), b = found_.at(minima[i]);
      for (const Equilibrium& e : passes_between(newton_, a.point.state, b.point.state, a.zero_modes)) add(e);
      grow();
    }
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

  LandscapeNode node_of(const Equilibrium& e) {
    const int modes = landscape::spectrum + e.point.stability.negative;
    return {"", {e}, soft_modes(newton_, e.point.state, e.zero_modes, modes).values, sums_of_distances(e.point.state)};
  }

  // Which of the images is at the place of an equilibrium; as many as there are where none is.
  std::ptrdiff_t image_at(const LandscapeNode& node, const Equilibrium& e, double near) const {
    const auto there = std::ranges::find_if(node.images, [&](const Equilibrium& image) {
      Vector d = energy_.kinematics().difference(image.point.state, e.point.state);
      if (image.zero_modes.cols() > 0) d -= image.zero_modes * (image.zero_modes.transpose() * d);
      return d.norm() <= near;
    });
    return there - node.images.begin();
  }

  bool alike(const LandscapeNode& a, const LandscapeNode& b) const {
    const double stiffest = infinity_norm(a.spectrum), length = span(energy_.model());
    const double off = landscape::same_energy * a.images.front().point.energy.size() + stiffest * std::pow(landscape::same_place * length, 2);
    return std::abs(a.energy() - b.energy()) <= off && a.spectrum.size() == b.spectrum.size() &&
           infinity_norm(a.spectrum - b.spectrum) <= landscape::same_stiffness * stiffest &&
           infinity_norm(a.distances - b.distances) <= landscape::same_distance * length * static_cast<double>(a.distances.size());
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
      const Equilibrium e = assess(newton_, state, report);
      const bool is_new = e.point.stability.negative == node.index() && image_at(node, e, near) == std::ssize(node.images);
      if (is_new && alike(node, node_of(e))) node.images.push_back(e);
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
      if (const auto e = walk(newton_, here.point.state, {first, up}, held)) add(*e);
    };
    if (index == 0)
      for (int i = 0; i < std::min(count, options_.modes); ++i)
        for (const double sign : {1.0, -1.0}) go(sign * soft.vectors.col(i), sign * soft.vectors.col(i));
    if (index == 1 && count > 0) {
      const Pass pass{from, {descend(here, soft.vectors.col(0)), descend(here, -soft.vectors.col(0))}};
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
    std::iota(part.begin(), part.end(), 0);
    const auto number = [&](const NodeImage& m) { return static_cast<std::size_t>(std::ranges::find(minima, m) - minima.begin()); };
    for (const Pass& p : found_.passes)
      if (const auto a = number(p.minima[0]), b = number(p.minima[1]); a < part.size() && b < part.size())
        std::ranges::replace(part, int{part[b]}, int{part[a]});
    return part;
  }

  Newton& newton_;
  Energy& energy_;
  const LandscapeOptions& options_;
  const std::vector<Reflection>& reflections_;
  std::vector<std::string>& notes_;
  Landscape found_;
  bool told_full_ = false;
};

/// What follows nodes from one load factor to the next and says what becomes of them.
class Follower {
 public:
  Follower(Newton& newton, const std::vector<PathEvent>& events, Landscapes& out) : newton_(newton), events_(events), out_(out) {}

  // Those of a that are at b, too. A label is kept where the kind is.
  void onward(const Landscape& a, Explorer& b) {
    from_ = a.load_factor, to_ = b.found().load_factor;
    for (const LandscapeNode& n : a.nodes) {
      const auto there = follow(n, to_);
      if (!there) continue;
      const int node = b.add(*there).node;
      kept_.insert(node);
      if (node < 0 || kind_of(there->point.stability.negative) != kind_of(n.index())) continue;
      if (std::string& label = b.found().nodes[node].label; label.empty()) label = n.label;
    }
  }
  // Where the nodes of b begin that are not followed; one that was there at a is added to it.
  bool back(Explorer& a, const Landscape& b) {
    const std::size_t before = a.found().nodes.size();
    for (int k = 0; k < std::ssize(b.nodes) && !interrupted(); ++k)
      if (!contains(kept_, k))
        if (const auto there = follow(b.nodes[k], from_)) a.add(*there);
    return a.found().nodes.size() > before;
  }
  // What happened at one load factor is one change; an event of the path there explains it.
  void tell() {
    const double close = landscape::together * std::abs(to_ - from_), way = to_ > from_ ? 1 : -1;
    const auto near = [close](double load_factor) { return [=](const auto& at) { return std::abs(at.load_factor - load_factor) <= close; }; };
    std::ranges::stable_sort(happened_, {}, [&](const Happened& h) { return way * h.load_factor; });
    std::vector<LandscapeChange> changes;
    for (const Happened& h : happened_) {
      if (changes.empty() || !near(h.load_factor)(changes.back())) changes.push_back({h.load_factor, {}, "", ""});
      changes.back().nodes.push_back(h.label);
      changes.back().what += (changes.back().what.empty() ? "" : ", ") + h.label + " " + h.what;
    }
    for (LandscapeChange& c : changes) {
      const auto event = std::ranges::find_if(events_, near(c.load_factor));
      if (event != events_.end()) c.event = event->label;
      c.what += c.event.empty() ? "; no event of the path is there" : "; " + c.event + " of the path";
    }
    for (const PathEvent& e : events_) {
      const bool between = way * e.load_factor > way * from_ && way * e.load_factor <= way * to_;
      if (between && !e.label.starts_with("contact:") && std::ranges::none_of(changes, near(e.load_factor)))
        out_.notes.push_back(fmt::format("load factor {:.10g}: {} of the path makes or ends no node that was found", e.load_factor, e.label));
    }
    out_.changes.insert(out_.changes.end(), changes.begin(), changes.end());
  }

 private:
  // The node at another load factor, onward or back; nothing where it ends.
  std::optional<Equilibrium> follow(const LandscapeNode& n, double to) {
    Equilibrium at = n.images.front();
    const double way = to - at.point.state.load_factor;
    for (double step = landscape::first_part * way; at.point.state.load_factor != to && !interrupted();) {
      const double here = at.point.state.load_factor, left = to - here;
      const bool last = std::abs(step) >= (1 - landscape::same_load) * std::abs(left);
      if (last) step = left;
      Equilibrium next = continue_to(newton_, at, last ? to : here + step);
      const int before = at.point.stability.negative, after = next.point.report.converged() ? next.point.stability.negative : -1;
      if (after != before && std::abs(step) / 2 > landscape::least_part * std::abs(way)) {
        step /= 2;
        continue;
      }
      const auto [first, second] = to == to_ ? std::pair(before, after) : std::pair(after, before);
      const std::string what = second < 0 ? "ends" : first < 0 ? "begins" : fmt::format("goes from index {} to {}", first, second);
      if (after != before) happened_.push_back({here + step / 2, n.label, what});
      if (after < 0) return {};
      at = std::move(next), step *= 2;
    }
    return at;
  }

  struct Happened { double load_factor; std::string label, what; };
  Newton& newton_;
  const std::vector<PathEvent>& events_;
  Landscapes& out_;
  double from_ = 0, to_ = 0;
  std::set<int> kept_;                             // nodes that are those before
  std::vector<Happened> happened_;
};

/// Labels of those that have none, by energy.
void name_nodes(Landscape& l, std::array<int, 3>& numbers) {
  std::vector<LandscapeNode*> nodes;
  for (LandscapeNode& n : l.nodes)
    if (n.label.empty()) nodes.push_back(&n);
  std::ranges::stable_sort(nodes, {}, [](const LandscapeNode* n) { return n->energy(); });
  for (LandscapeNode* n : nodes) n->label = fmt::format("{}:{}", kind_of(n->index()), ++numbers[std::min(n->index(), 2)]);
}

}  // namespace

std::vector<NodeImage> Landscape::images(int index) const {
  std::vector<NodeImage> all;
  for (int n = 0; n < std::ssize(nodes); ++n)
    for (int k = 0; k < std::ssize(nodes[n].images); ++k)
      if (index < 0 || nodes[n].index() == index) all.push_back({n, k});
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
  std::list<Explorer> explorers;
  Explorer* before = nullptr;
  std::array<int, 3> numbers{};
  for (const double load_factor : load_factors) {
    if (interrupted()) break;
    Explorer* const here = &explorers.emplace_back(newton, load_factor, options, reflections, all.notes);
    Follower follower(newton, events, all);
    if (before) follower.onward(before->found(), *here);
    for (State state : known) {
      if (state.load_factor != load_factor) continue;
      newton.energy().evaluate(state);
      const Report report = newton.correct(state, assess(newton, state, {}).zero_modes);
      if (report.converged()) here->add(assess(newton, state, report));
    }
    here->grow(), here->deflate_known(), here->start_at_random(), here->join();
    name_nodes(here->found(), numbers);
    if (before) {
      if (follower.back(*before, here->found())) before->grow();  // from nodes that were missed there
      name_nodes(before->found(), numbers);
      follower.tell();
    }
    const Landscape& l = here->found();
    if (tell) tell(fmt::format("load factor {:.10g}: {} minima, {} saddles, {} nodes", load_factor, l.minima(), l.saddles(), l.nodes.size()));
    before = here;
  }
  for (Explorer& e : explorers) all.at.push_back(std::move(e.found()));
  return all;
}

}  // namespace elamin
