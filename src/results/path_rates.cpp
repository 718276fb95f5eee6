#include "results/path_rates.hpp"

#include "model/entities.hpp"
#include "path/equilibrium.hpp"
#include "solve/contact_equilibrium.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace elamin {
namespace {

constexpr double largest_distortion = 0.1;     // of the longest step: how far it turns or stretches a bond, turns a body, moves a grain by its size
constexpr int least_halvings = 12, most_halvings = 40;
constexpr double just = 1e-8;          // touching: a gap in sizes, a hard contact's force in parts of the largest
constexpr int refinements = 2;
constexpr double no_work = 1e-6;       // of loads on a critical mode, relative: a branch point, else a limit point

/// The limit of D(h), D(h/2), D(h/4), … whose errors go with even powers of h: of all entries of Neville's tableau the one that differs
/// least from its neighbours.
class Limit {
 public:
  void add(double d) {
    std::vector<double> row{d};
    double power = 1;
    for (const double above : row_) {
      power *= 4;
      row.push_back(row.back() + (row.back() - above) / (power - 1));
      const double error = std::max(std::abs(row.back() - row.end()[-2]), std::abs(row.back() - above));
      if (error < error_) error_ = error, best_ = row.back();
    }
    row_ = std::move(row);
  }
  double value() const { return best_; }

 private:
  std::vector<double> row_;
  double best_ = std::numeric_limits<double>::quiet_NaN(), error_ = infinity;
};

}  // namespace

// Whether a contact is made or lost here whose stiffness sets in at once: a hard one, one of a body.
bool PathRates::corner(const State& state) {
  Energy& energy = newton_.energy();
  const Model& model = energy.model();
  const double size = largest_size(model);
  if (any_hard(model)) energy.evaluate(state, false);            // the scale of forces
  for (const HardForce& contact : any_hard(model) ? energy.hard_contacts(state, just * size) : std::vector<HardForce>{}) {
    const auto same = [&](const HardForce& h) { return key(h) == key(contact); };
    const auto closed = std::find_if(state.hard.begin(), state.hard.end(), same);
    HardGap gap;
    if (closed != state.hard.end() ? energy.relative(Vector::Constant(1, closed->force)) <= just
                                   : hard_gap(model, contact, state, gap) && gap.value <= just * model.diameter[contact.particle])
      return true;
  }
  if (model.rounded.empty() && model.bodies.empty()) return false;
  const std::vector<Touch> touches = energy.touches(state, just * size);
  return std::any_of(touches.begin(), touches.end(), [&](const Touch& t) {
    return (is_body(model, t.particle) || (t.other >= 0 && is_body(model, t.other))) && std::abs(t.gap) <= just * size_of(model, t.particle);
  });
}

std::optional<PathRates::Tangent> PathRates::tangent(const State& state) {
  if (corner(state)) return std::nullopt;
  Energy& energy = newton_.energy();
  const Equilibrium e = assess(newton_, state, {});
  Tangent t{e.tangent, {}, 1};
  const bool critical = e.point.stability.critical > 0;
  if (!state.hard.empty()) {
    if (critical) return std::nullopt;
    ContactEquilibrium held(energy);
    const ContactEquilibrium::Tangent closed = held.tangent(state, e.zero_modes);
    t.q = closed.q, t.force = closed.force;
  } else if (critical) {
    const Vector load = energy.load_derivative(), work = e.zero_modes.transpose() * load;
    if (!(work.norm() > no_work * load.norm())) return std::nullopt;
    t.q = e.zero_modes * work.normalized(), t.load = 0;
  } else if (energy.dofs() > 0) {
    // Of a slender structure the solution has half the digits; the residual formed element by element gives the rest.
    for (int k = 0; k < refinements; ++k) t.q += newton_.factors().solve_holding(-energy.load_derivative() - energy.multiply(t.q));
  }
  if (!t.q.allFinite() || !t.force.allFinite()) return std::nullopt;
  return t;
}

/// The steps along a tangent: as long as `largest_distortion` allows, and so often halved that contacts stay closed at the last ones.
PathRates::Steps PathRates::steps(const State& state, const Tangent& t) {
  Energy& energy = newton_.energy();
  const Kinematics& kinematics = energy.kinematics();
  const Model& model = energy.model();
  Field v = kinematics.extend(t.q, state);
  for (int site = 0; site < kinematics.sites(); ++site) v.col(site) += t.load * kinematics.drive(site);
  std::vector<bool> bonded(kinematics.sites(), false);
  double rate = 2 * largest_distortion * t.load / std::max(1.0, std::abs(state.load_factor));
  for (const Bond& b : model.bonds) {
    const auto [i, j] = b.particles;
    rate = std::max(rate, (v.col(j) - v.col(i)).norm() / (state.at(j) - state.at(i)).hi.norm());
    bonded[i] = bonded[j] = true;
  }
  const auto of_wall = [&](int w) {
    const Wall& wall = model.walls[w];
    return std::abs(t.load * wall.scaling.rate) * (wall.displacement.norm() + std::abs(wall.radius_change));
  };
  for (int site = 0; site < kinematics.sites(); ++site)
    if (!bonded[site] && kinematics.size(site) > 0) rate = std::max(rate, v.col(site).norm() / kinematics.size(site));
  if (const double size = kinematics.smallest_size(); size > 0)
    for (int w = 0; w < static_cast<int>(model.walls.size()); ++w) rate = std::max(rate, of_wall(w) / size);
  Steps steps{largest_distortion / rate, least_halvings};
  const auto of_entity = [&](int e) {
    if (!is_body(model, e)) return v.col(e).norm();
    const int body = e - model.particles();
    return v.col(kinematics.place_of(body)).norm() + v.col(kinematics.rotation_of(body)).norm();
  };
  for (const Touch& touch : energy.touches(state)) {
    const double closing = of_entity(touch.particle) + (touch.other >= 0 ? of_entity(touch.other) : of_wall(touch.wall));
    if (touch.bears || !(closing > 0 && touch.gap < 0)) continue;
    const double overlaps = steps.longest * closing / -touch.gap;            // that the longest step goes through
    steps.halvings = std::max(steps.halvings, least_halvings / 2 + static_cast<int>(std::log2(std::max(1.0, overlaps))));
  }
  steps.halvings = std::min(steps.halvings, most_halvings);
  return steps;
}

std::vector<double> PathRates::at(const State& state) {
  const std::optional<Tangent> t = tangent(state);
  const std::size_t count = probe_.observed().size();
  if (!t) return std::vector<double>(1 + count, std::numeric_limits<double>::quiet_NaN());
  const Kinematics& kinematics = newton_.energy().kinematics();
  const auto values_at = [&](double step) {
    State moved = state;
    kinematics.prescribe(moved, state.load_factor + step * t->load);
    kinematics.retract(moved, t->q, step);
    for (std::size_t k = 0; k < moved.hard.size(); ++k) moved.hard[k].force += step * t->force[static_cast<Eigen::Index>(k)];
    return probe_(moved);
  };
  std::vector<Limit> limits(count);
  const Steps steps = this->steps(state, *t);
  double step = steps.longest;
  for (int k = 0; k <= steps.halvings; ++k, step /= 2) {
    const std::vector<double> ahead = values_at(step), behind = values_at(-step);
    for (std::size_t i = 0; i < count; ++i) limits[i].add((ahead[i] - behind[i]) / (2 * step));
  }
  std::vector<double> rates{t->load};
  for (const Limit& limit : limits) rates.push_back(limit.value());
  return rates;
}

}  // namespace elamin
