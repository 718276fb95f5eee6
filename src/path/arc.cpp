#include "path/arc.hpp"

#include "model/entities.hpp"

#include <algorithm>
#include <cmath>

namespace elamin {

namespace {
constexpr int most_iterations = 16;           // of a corrector
constexpr double least_cosine = 0.1;          // between the directions at two samples of a segment
}  // namespace

double span(const Model& model) {
  return std::max(sides_of(model.start).maxCoeff(), largest_size(model));
}

Direction direction_of(const Equilibrium& e, const Metric& metric, const Direction& along) {
  const double steep = e.tangent.norm() / metric.length;       // |dx/dλ| Λ/L may be beyond all bounds, not its inverse
  const double size = std::hypot(steep, 1 / metric.load);
  Direction d{e.tangent / size, 1 / size};
  if (metric.dot(d.x, d.load, along.x, along.load) < 0) d.x = -d.x, d.load = -d.load;
  return d;
}

double cosine(const Direction& a, const Direction& b, const Metric& metric) { return metric.dot(a.x, a.load, b.x, b.load); }

double Arc::position(const State& state) const {
  const Vector x = newton_.energy().kinematics().difference(from_.point.state, state);
  return metric_.dot(x, state.load_factor - from_.point.state.load_factor, direction_.x, direction_.load);
}

double Arc::distance(const State& state) const {
  const double s = position(state);
  const Vector x = newton_.energy().kinematics().difference(from_.point.state, state) - s * direction_.x;
  const double load = state.load_factor - from_.point.state.load_factor - s * direction_.load;
  return std::sqrt(metric_.dot(x, load, x, load));
}

Equilibrium Arc::at(double s, const Equilibrium& nearest) const {
  Energy& energy = newton_.energy();
  const Kinematics& kinematics = energy.kinematics();
  const Direction d = direction_of(nearest, metric_, direction_);
  const double step = (s - position(nearest.point.state)) / std::max(cosine(d, direction_, metric_), least_cosine);
  State state = nearest.point.state;
  kinematics.prescribe(state, state.load_factor + step * d.load);
  kinematics.retract(state, d.x, step);
  Equilibrium failed;
  failed.point.state = state;
  failed.point.report.why = "the step would carry something through something else";
  if (energy.passage(nearest.point.state, state) < 1) return failed;
  const Plane plane{direction_.x / (metric_.length * metric_.length), direction_.load / (metric_.load * metric_.load),
                    metric_.length, metric_.load};
  const Report report = newton_.correct(state, nearest.zero_modes, &nearest.point.state, most_iterations, &plane);
  failed.point.state = state;
  if (energy.passage(nearest.point.state, state) < 1) return failed;
  failed.point.report = report;
  return report.converged() ? assess(newton_, state, report) : failed;
}

}  // namespace elamin
