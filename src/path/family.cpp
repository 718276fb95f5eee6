#include "path/family.hpp"

#include "path/arc.hpp"
#include "path/limits.hpp"
#include "path/root.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <set>

namespace elamin {

using namespace limits;

namespace {

// How modes change the angles of a model in a plane, angles × modes [1]: unlike displacements the same whatever holds a ring in its plane.
Eigen::MatrixXd changes_of_angles(const Energy& energy, const State& state, const Eigen::MatrixXd& modes) {
  const Model& model = energy.model();
  Eigen::MatrixXd change = Eigen::MatrixXd::Zero(model.plane_normal ? static_cast<Eigen::Index>(model.angles.size()) : 0, modes.cols());
  if (change.rows() == 0) return change;
  const Vec3 normal = Vec3::Unit(*model.plane_normal);
  const auto rotation = [&](int i, int j, const Field& v) {
    const Vec3 d = (state.at(j) - state.at(i)).hi;
    return normal.dot(d.cross(Vec3(v.col(j) - v.col(i)))) / d.squaredNorm();
  };
  for (Eigen::Index m = 0; m < modes.cols(); ++m) {
    const Field v = energy.kinematics().extend(modes.col(m));
    for (std::size_t k = 0; k < model.angles.size(); ++k) {
      const auto [i, j, l] = model.angles[k].particles;
      change(static_cast<Eigen::Index>(k), m) = rotation(j, l, v) - rotation(i, j, v);
    }
  }
  return change;
}

// Whether a mode changes angles by more than rounding, as a rigid motion does not.
bool bends(const Energy& energy, const Vector& change, const Vector& mode) {
  return change.norm() * span(energy.model()) > equilibrium::rigid * mode.norm();
}

// The angles of a model in a plane [rad], with their signs.
Vector angles_of(const Model& model, const State& s) {
  const Vec3 normal = Vec3::Unit(*model.plane_normal);
  Vector angles(static_cast<Eigen::Index>(model.angles.size()));
  for (std::size_t k = 0; k < model.angles.size(); ++k) {
    const auto [i, j, l] = model.angles[k].particles;
    const Vec3 u = (s.at(j) - s.at(i)).hi, v = (s.at(l) - s.at(j)).hi;
    angles[static_cast<Eigen::Index>(k)] = std::atan2(normal.dot(u.cross(v)), u.dot(v));
  }
  return angles;
}

// By how much every angle of a model in a plane has opened from one state to another [rad].
Vector opened(const Model& model, const State& from, const State& to) {
  return (angles_of(model, to) - angles_of(model, from)).unaryExpr([](double change) { return std::remainder(change, 2 * pi); });
}

}  // namespace

EigenPairs nearly_neutral(Newton& newton, const Equilibrium& e, int count) {
  newton.energy().evaluate(e.point.state);
  const EigenPairs pairs = newton.factors().lowest(e.point.stability.negative + count + 1);
  EigenPairs found{Vector(0), Eigen::MatrixXd(pairs.vectors.rows(), 0)};
  for (Eigen::Index j = 0; j < pairs.values.size(); ++j) {
    double next = std::numeric_limits<double>::infinity();
    for (Eigen::Index i = 0; i < pairs.values.size(); ++i)
      if (i != j) next = std::min(next, std::abs(pairs.values[i]));
    if (!(std::abs(pairs.values[j]) <= equilibrium::next_to_nothing * next) || !std::isfinite(next)) continue;
    found.vectors = side_by_side(found.vectors, pairs.vectors.col(j));
    found.values.conservativeResize(found.vectors.cols());
    found.values[found.values.size() - 1] = pairs.values[j];
  }
  return found;
}

void take_nearly_neutral(Newton& newton, Equilibrium& e, int count, const Eigen::MatrixXd& before) {
  Stability& s = e.point.stability;
  const EigenPairs pairs = nearly_neutral(newton, e, count);
  for (Eigen::Index j = 0; j < pairs.values.size(); ++j) {
    const Vector& v = pairs.vectors.col(j);
    if (before.cols() > 0 && (before.transpose() * v).norm() < equilibrium::same_mode) continue;
    if (e.zero_modes.cols() > 0 && (e.zero_modes.transpose() * v).norm() > 0.5) continue;      // it is one already
    e.zero_modes = side_by_side(e.zero_modes, v);
    ++s.zero, ++s.critical;
    s.stable = false;
    if (pairs.values[j] < 0) --s.negative, s.negative_rigid = std::min(s.negative_rigid, s.negative);
  }
}

void name_neutral(Stability& s) {
  s.zero_modes.push_back(fmt::format("neutral: equilibria side by side at the same load factor ({} direction{})", s.critical, s.critical > 1 ? "s" : ""));
  s.critical = 0;
  s.stable = s.negative == 0;
}

void hold_family(Newton& newton, Equilibrium& e, int count, const Eigen::MatrixXd& before) {
  e.family = count;
  if (e.point.stability.critical < count) take_nearly_neutral(newton, e, count - e.point.stability.critical, before);
  if (e.point.stability.critical == 0) return;
  name_neutral(e.point.stability);
  newton.factors().factorize_holding(phase_conditions(newton.energy(), e.point.state, e.zero_modes));
  e.tangent = newton.factors().solve_holding(-newton.energy().load_derivative());
}

Eigen::MatrixXd phase_conditions(const Energy& energy, const State& state, const Eigen::MatrixXd& modes) {
  const Eigen::MatrixXd change = changes_of_angles(energy, state, modes);
  if (change.rows() == 0 || modes.cols() == 0) return modes;
  const Model& model = energy.model();
  const Vec3 normal = Vec3::Unit(*model.plane_normal);
  Eigen::MatrixXd rows = modes;
  for (Eigen::Index j = 0; j < modes.cols(); ++j) {
    if (!bends(energy, change.col(j), modes.col(j))) continue;
    Field row = Field::Zero(3, energy.kinematics().sites());
    const auto add = [&](int from, int to, double part) {         // ∂(rotation of a bond)/∂x
      const Vec3 d = (state.at(to) - state.at(from)).hi, rate = part * normal.cross(d) / d.squaredNorm();
      row.col(to) += rate, row.col(from) -= rate;
    };
    for (std::size_t k = 0; k < model.angles.size(); ++k) {
      const auto [a, b, c] = model.angles[k].particles;
      add(b, c, change(static_cast<Eigen::Index>(k), j)), add(a, b, -change(static_cast<Eigen::Index>(k), j));
    }
    rows.col(j) = energy.kinematics().restrict(row).normalized();
  }
  return orthonormal(rows);
}

Report correct_in_phase(const Energy& energy, const Equilibrium& from, State& state,
                        const std::function<Report(State&, const Eigen::MatrixXd& held)>& correct) {
  const Eigen::MatrixXd& modes = from.zero_modes;
  const Eigen::MatrixXd held = phase_conditions(energy, from.point.state, modes), change = changes_of_angles(energy, from.point.state, modes);
  Report report = correct(state, held);
  for (Eigen::Index j = 0; j < modes.cols() && change.rows() > 0; ++j) {
    if (!bends(energy, change.col(j), modes.col(j))) continue;
    double shift = 0, before = 0;
    for (int k = 0; k < equilibrium::most_shifts && report.converged(); ++k) {
      const double drift = change.col(j).normalized().dot(opened(energy.model(), from.point.state, state));
      if (std::abs(drift) <= equilibrium::drifted || (k > 0 && !(std::abs(drift) < std::abs(before) / 2))) break;
      shift = k == 0 ? -drift / change.col(j).norm() : shift * drift / (before - drift);
      before = drift;
      energy.kinematics().retract(state, modes.col(j), shift);
      report = correct(state, held);
    }
  }
  return report;
}

Eigen::MatrixXd symmetric_modes(const Energy& energy, const State& state, const Eigen::MatrixXd& modes) {
  if (modes.cols() != 2) return canonical_modes(energy.kinematics(), modes);
  const Eigen::MatrixXd change = changes_of_angles(energy, state, modes);
  if (change.rows() == 0) return canonical_modes(energy.kinematics(), modes);
  const Vector size = change.rowwise().norm();
  const double most = size.maxCoeff();
  Eigen::Index k = 0;
  while (size[k] < (1 - equilibrium::alike_angles) * most) ++k;
  if (!(most > 0)) return canonical_modes(energy.kinematics(), modes);
  Eigen::MatrixXd both(modes.rows(), 2);
  both.col(0) = (modes * change.row(k).transpose()).normalized();
  both.col(1) = modes * Eigen::Vector2d(-change(k, 1), change(k, 0)).normalized();
  return both;
}

Vector symmetric_direction(const Energy& energy, const State& state, const Eigen::MatrixXd& modes) {
  const Eigen::MatrixXd change = changes_of_angles(energy, state, modes);
  if (modes.cols() != 2 || change.rows() == 0) return modes.col(0);
  const Eigen::Vector2d by_second = change.transpose() * change.col(1);
  if (!(by_second.norm() > 0)) return modes.col(0);
  return (modes * Eigen::Vector2d(by_second[1], -by_second[0])).normalized();
}

// From one such place to the next a mode of m waves moves by π/m of its amplitude over N; steps are an eighth of twice that, for m = 2.
bool rest_in_family(Newton& newton, Equilibrium& e) {
  Energy& energy = newton.energy();
  if (e.zero_modes.cols() != 1) return false;
  const Vector along = e.zero_modes.col(0);
  const Eigen::MatrixXd change = changes_of_angles(energy, e.point.state, along);
  energy.evaluate(e.point.state);
  if (change.rows() == 0 || !bends(energy, change, along) || std::abs(along.dot(energy.gradient())) <= equilibrium::no_force * energy.force_scale()) return false;
  const Eigen::MatrixXd held = phase_conditions(energy, e.point.state, along);
  const auto force = [&](double t) -> std::optional<Sample> {
    Sample sample{t, 0, e};
    Plane same_load{Vector::Zero(energy.dofs()), 1};
    same_load.guided = true;
    energy.kinematics().retract(sample.e.point.state, along, t);
    if (!newton.correct(sample.e.point.state, held, nullptr, equilibrium::most_iterations, &same_load).converged()) return {};
    const EigenPairs here = nearly_neutral(newton, sample.e, 1);         // along it what is left of other forces does no work
    if (here.values.size() != 1) return {};
    sample.f = std::copysign(1.0, here.vectors.col(0).dot(along)) * here.vectors.col(0).dot(energy.gradient());
    return sample;
  };
  std::optional<Sample> last = force(0);
  if (!last) return false;
  Vector shape = angles_of(energy.model(), e.point.state);
  shape.array() -= shape.mean();
  const double step = -std::copysign(pi / 2 * shape.norm() / (static_cast<double>(shape.size()) * change.norm()), last->f);
  for (int k = 1; k <= equilibrium::most_along; ++k) {
    std::optional<Sample> next = force(k * step);
    if (!next) return false;
    if ((next->f < 0) == (last->f < 0)) {
      last = std::move(next);
      continue;
    }
    const std::optional<Sample> rest = find_zero(*last, *next, [&](double) { return equilibrium::at_rest * std::abs(step); }, [&](double t, const Sample&) { return force(t); });
    if (!rest) return false;
    State state = rest->e.point.state;
    const Report report = newton.correct(state, held);
    if (!report.converged()) return false;
    e = assess(newton, state, report);
    hold_family(newton, e, 1, along);
    return e.zero_modes.cols() == 1;
  }
  return false;
}

namespace {

// The equilibrium of the same family that is farther along its mode, which is told in the same direction; nothing where the mode turns too much on the way.
std::optional<Equilibrium> neighbour_in_family(Newton& newton, const Equilibrium& from, double along) {
  const Energy& energy = newton.energy();
  State state = from.point.state;
  energy.kinematics().retract(state, from.zero_modes.col(0), along);
  if (energy.collision_free_step(from.point.state, state) < 1) return {};
  const Report report = newton.correct(state, phase_conditions(energy, from.point.state, from.zero_modes), &from.point.state, equilibrium::most_iterations);
  if (!report.converged()) return {};
  Equilibrium to = assess(newton, state, report);
  hold_family(newton, to, from.family, from.zero_modes);
  if (to.zero_modes.cols() != 1 || to.point.stability.negative != from.point.stability.negative) return {};
  const double cosine = from.zero_modes.col(0).dot(to.zero_modes.col(0));
  if (std::abs(cosine) < equilibrium::same_mode) return {};
  if (cosine < 0) to.zero_modes *= -1;
  return to;
}

}  // namespace

bool opens_along(const Energy& energy, const Equilibrium& e, const ContactSet& contacts) {
  return std::any_of(contacts.begin(), contacts.end(), [&](const ContactKey& key) {
    Vector row;
    double by_load = 0;
    return slope(energy, key, e.point.state, 0, row, by_load) && (row.transpose() * e.zero_modes).norm() > equilibrium::oblique * row.norm() * e.zero_modes.cwiseAbs().maxCoeff();
  });
}

bool move_from_contacts(Newton& newton, Equilibrium& e) {
  Energy& energy = newton.energy();
  if (e.family != 1) return false;
  const double size = energy.kinematics().smallest_size(), most = newton.tolerance() * std::max(energy.force_scale(), energy.force_floor());
  std::set<TouchKey> loaded;
  for (const Touch& t : energy.touches(e.point.state))
    if (t.force.norm() > most) loaded.insert(t.key());
  const double farthest = equilibrium::farthest * size;
  const auto room = [&](const State& state) {
    double least = farthest;
    for (const Touch& t : energy.touches(state, farthest))
      if (!loaded.count(t.key())) least = std::min(least, t.gap);
    return least;
  };
  const double before = room(e.point.state);
  if (before > equilibrium::near * size) return false;
  Equilibrium from = e;
  if (from.zero_modes.cols() == 0) {                                    // what it touches makes it stiff, on one side
    energy.evaluate(from.point.state);
    from.zero_modes = newton.factors().lowest(1).vectors;
  }
  if (from.zero_modes.cols() != 1) return false;
  for (const double side : {1.0, -1.0}) {
    Equilibrium best = from;
    double here = before, step = side * size / (2 * best.zero_modes.cwiseAbs().maxCoeff());
    const double shortest = equilibrium::least_along * std::abs(step);
    for (int k = 0; k < equilibrium::most_apart && here < farthest && std::abs(step) >= shortest; ++k) {
      std::optional<Equilibrium> next = neighbour_in_family(newton, best, step);
      const double there = next ? room(next->point.state) : here;
      if (next && there > here) best = std::move(*next), here = there, step *= 1.5;
      else step /= 3;
    }
    if (here - before > equilibrium::apart * size) return e = std::move(best), true;
  }
  return false;
}

}  // namespace elamin
