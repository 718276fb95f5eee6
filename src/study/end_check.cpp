#include "study/end_check.hpp"

#include "solve/factors.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>

namespace elamin {

namespace {

constexpr int random_directions = 3;
constexpr double of_energy = 1e-12;             // of the parts, to which two sums of them agree
constexpr double nearest = 1e-7, farthest = 1e-3;     // of the smallest particle or body, that a direction is followed
constexpr double above_rounding = 1e4;          // D(t) over its rounding, that t is chosen for
constexpr double within_rounding = 10;          // less than that many times it means nothing
constexpr double roughly = 1e-3;                // of eigenvectors: whatever the direction, its energies tell the truth

/// Energies of parts, and of what no part has.
struct Energies {
  Vector parts;
  EnergyTerms terms;
};

class Neighbourhood {
 public:
  Neighbourhood(Energy& energy, const State& here)
      : energy_(energy), here_(here), external_(!energy.model().bodies.empty() || !energy.model().pressures.empty()), middle_(at(here)),
        rounding_(4 * epsilon * (middle_.parts.cwiseAbs().sum() + others_size() +
                                 energy.force_floor() * energy.kinematics().mean_size() * static_cast<double>(middle_.parts.size()))) {}

  double rounding() const { return rounding_; }
  const Energies& middle() const { return middle_; }

  /// D(t), each part by itself: they cancel before they are summed.
  double second_difference(const Vector& v, double t) const {
    const Energies up = moved(v, t), down = moved(v, -t);
    long double sum = 0;
    const auto add = [&](long double above, long double below, long double here) { sum += (above - here) + (below - here); };
    for (Eigen::Index k = middle_.parts.size(); k-- > 0;) add(up.parts[k], down.parts[k], middle_.parts[k]);
    if (external_) add(up.terms.external, down.terms.external, middle_.terms.external);
    for (std::size_t k = 0; k < middle_.terms.own.size(); ++k) add(up.terms.own[k].second, down.terms.own[k].second, middle_.terms.own[k].second);
    return static_cast<double>(sum);
  }

 private:
  Energies at(const State& state) const {
    Energies e{energy_.shares(state), {}};
    if (external_ || !energy_.model().own.empty() || &state == &here_) e.terms = energy_.terms(state);
    return e;
  }
  Energies moved(const Vector& v, double t) const {
    State state = here_;
    energy_.kinematics().retract(state, v, t);
    return at(state);
  }
  double others_size() const {
    double size = external_ ? std::abs(middle_.terms.external) : 0;
    for (const auto& [name, value] : middle_.terms.own) size += std::abs(value);
    return size;
  }

  Energy& energy_;
  const State& here_;
  bool external_;                               // of bodies and pressures it is not linear
  Energies middle_;
  double rounding_;
};

}  // namespace

EndCheck check_end(const Model& model, const PathPoint& point, double tolerance) {
  EndCheck check;
  const auto fail = [&](const std::string& why) {
    check.passed = false;
    check.what += (check.what.empty() ? "" : "; ") + why;
  };
  Energy energy(model);
  energy.evaluate(point.state);
  const EnergyTerms terms = energy.last_terms();
  check.residual = energy.relative(energy.gradient());
  if (const double told = std::max(tolerance, point.report.residual); !(check.residual <= 2 * told) && std::isfinite(point.report.residual))
    fail(fmt::format("the residual is {:.3g}, not {:.3g}", check.residual, point.report.residual));

  const Neighbourhood around(energy, point.state);
  const Vector& parts = around.middle().parts;
  long double inner = 0;
  for (Eigen::Index k = parts.size(); k-- > 0;) inner += parts[k];
  double told = terms.total() - terms.external;
  for (const auto& [name, value] : terms.own) told -= value;
  const double size = parts.cwiseAbs().sum() + terms.size() + point.energy.size();
  check.energy_error = std::max(std::abs(static_cast<double>(inner - static_cast<long double>(told))), std::abs(point.energy.total() - terms.total()));
  if (!(check.energy_error <= of_energy * size)) fail(fmt::format("the energy is {:.17g}, not {:.17g}", terms.total(), point.energy.total()));

  if (!point.stability.stable || !point.state.hard.empty() || energy.dofs() == 0 || !std::isfinite(size)) return check;
  std::mt19937_64 engine(static_cast<std::uint64_t>(energy.dofs()));
  std::vector<Vector> directions;
  Factors factors(energy);
  if (const EigenPairs lowest = factors.lowest(1, 0, roughly); lowest.vectors.cols() > 0) directions.push_back(lowest.vectors.col(0));
  for (int k = 0; k < random_directions; ++k)
    directions.push_back(Vector::NullaryExpr(energy.dofs(), [&] { return static_cast<double>(engine() >> 11) * 0x1p-52 - 1; }));
  for (std::size_t k = 0; k < directions.size(); ++k) {
    Vector& v = directions[k];
    if (const double largest = v.cwiseAbs().maxCoeff(); largest > 0) v /= largest;
    const double told_curvature = energy.quadratic_form(v);
    const double size_here = energy.kinematics().smallest_size();
    const double wanted = std::sqrt(above_rounding * around.rounding() / std::max(std::abs(told_curvature), std::numeric_limits<double>::min()));
    const double t = std::clamp(wanted, nearest * size_here, farthest * size_here);
    const double near = around.second_difference(v, t), rise = (16 * near - around.second_difference(v, 2 * t)) / 12;
    const double least = within_rounding * around.rounding();
    if (std::abs(rise) <= least) continue;
    ++check.directions;
    if (std::max(rise, near) < -least) fail(fmt::format("called stable, but the energy falls along {}: by {:.3g} over {:.3g}", k == 0 ? "the lowest mode" : "a random direction", -rise, t));
  }
  return check;
}

}  // namespace elamin
