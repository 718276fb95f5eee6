#include "catch.hpp"
#include "chain.hpp"
#include "core/parallel.hpp"
#include "energy/energy.hpp"
#include "energy/load_difference.hpp"
#include "core/exact.hpp"
#include "laws/check_law.hpp"

using namespace elamin;

namespace {

// A bent chain with driven points, single directions, dead loads and weights of both kinds.
Model loaded_model() {
  Model m = chain(9, 50, 0.4, 1, Vec3(1, 0.2, -0.3));
  hold(m, 0, 1);
  hold(m, 7, 8, {true, false, true}, Vec3(-0.5, 0, 0.3));
  m.loads.push_back({"", {3, 4}, Vec3(0.1, -0.2, 0.3), Scaling()});
  m.loads.push_back({"", {5}, Vec3(0, 0.3, 0.1), Scaling::constant()});
  m.gravity.push_back({"", {2, 3, 4, 5}, Vec3(0.1, 0, -0.4), Scaling::constant()});
  m.gravity.push_back({"", {4, 5}, Vec3(0, 0.2, 0.4), Scaling()});
  return m;
}

}  // namespace

TEST_CASE("the assembled energy agrees with its differences", "[energy]") {
  const Model model = loaded_model();
  Energy energy(model);
  const State state = bent(energy, 0.7, 0.2);
  energy.evaluate(state);
  const Vector g = energy.gradient();
  const SparseMatrix lower = energy.hessian();
  const Eigen::MatrixXd H = Eigen::MatrixXd(lower).selfadjointView<Eigen::Lower>();
  CHECK(energy.last_terms().total() == energy.value(state));
  CHECK(energy.dofs() == 5 * 3 + 2);
  const double scale = H.norm();
  for (int k = 0; k < energy.dofs(); ++k) {
    const auto along = [&](double s) {
      State moved = state;
      energy.kinematics().retract(moved, Vector::Unit(energy.dofs(), k), s);
      return moved;
    };
    const double slope = difference([&](double s) { return energy.value(along(s)); }, difference_step);
    CHECK(std::abs(slope - g[k]) <= difference_error * scale);
    const Vector column = difference([&](double s) -> Vector { energy.evaluate(along(s), false); return energy.gradient(); }, difference_step);
    CHECK((column - H.col(k)).cwiseAbs().maxCoeff() <= difference_error * scale);
  }
}

TEST_CASE("∂g/∂λ agrees with differences in the load factor", "[energy]") {
  const Model model = loaded_model();
  Energy energy(model);
  const State state = bent(energy, 0.7, 0.2);
  energy.evaluate(state);
  const Vector exact = energy.load_derivative();
  const double scale = Eigen::MatrixXd(energy.hessian()).norm();
  CHECK((exact - load_difference(energy, state, difference_step)).cwiseAbs().maxCoeff() <= difference_error * scale);
  CHECK(exact.norm() > 0);
}

TEST_CASE("products element by element agree with the assembled Hessian", "[energy]") {
  const Model model = loaded_model();
  Energy energy(model);
  energy.evaluate(bent(energy, 0.7, 0.2));
  const Eigen::MatrixXd H = Eigen::MatrixXd(energy.hessian()).selfadjointView<Eigen::Lower>();
  Vector v(energy.dofs());
  for (Eigen::Index k = 0; k < v.size(); ++k) v[k] = std::cos(2.3 * static_cast<double>(k));
  CHECK((energy.multiply(v) - H * v).norm() <= 64 * epsilon * H.norm() * v.norm());
  CHECK(std::abs(energy.quadratic_form(v) - v.dot(H * v)) <= 64 * epsilon * H.norm() * v.squaredNorm());
}

TEST_CASE("the form of a bond keeps the digits of its stiffness across", "[energy]") {
  const double K = 1e6, strain = 1e-11;
  Model model = chain(2, K, 0, 1, Vec3(1, -2, 0.7));
  model.angles.clear(), model.angle_types.clear();
  const Vec3 n = Vec3(1, -2, 0.7).normalized();
  hold(model, 0, 0);
  model.start.position.col(1) = model.start.position.col(0) + (1 + strain) * n;
  model.start.low.setZero();
  Energy energy(model);
  energy.evaluate(model.start);
  const Vec3 across = n.cross(Vec3::UnitX()).normalized();
  const double r = (model.start.at(1) - model.start.at(0)).hi.norm();
  const Exact stretch = length(model.start.at(1) - model.start.at(0)) + -1.0;
  const double exact = 2 * K * stretch.value() / r;             // 2K (1 − r₀/r)
  CHECK(std::abs(energy.form(across, across).value / exact - 1) <= 1e-12);
  CHECK(std::abs(energy.form(across, across).value - exact) <= 8 * epsilon * energy.form(across, across).size);
  const Eigen::MatrixXd H = Eigen::MatrixXd(energy.hessian()).selfadjointView<Eigen::Lower>();
  CHECK(std::abs(across.dot(H * across) - exact) > 1e-9 * exact);              // which the Hessian's entries do not
}

TEST_CASE("forces of all particles are minus the gradient and balance the loads", "[energy]") {
  const Model model = loaded_model();
  Energy energy(model);
  const State state = bent(energy, 0.7, 0.2);
  const Field forces = energy.forces(state);
  energy.evaluate(state);
  CHECK((energy.kinematics().restrict(forces) + energy.gradient()).norm() == 0);
  Vec3 loads = Vec3::Zero();
  for (const Load& l : model.loads) loads += l.force * static_cast<double>(l.particles.size()) * l.scaling.at(0.7);
  for (const Gravity& g : model.gravity)
    for (const int p : g.particles) loads += model.mass(p) * g.acceleration * g.scaling.at(0.7);
  CHECK((forces.rowwise().sum() - loads).norm() <= 64 * epsilon * energy.force_scale());
}

TEST_CASE("a plane takes its normal out of the dofs", "[energy]") {
  Model model = chain(5, 1, 1, 1);
  model.plane_normal = 1;
  hold(model, 0, 0);
  CHECK(Energy(model).dofs() == 4 * 2);
}

TEST_CASE("prescribed coordinates are where the load factor puts them", "[energy]") {
  Model model = chain(3, 1, 1, 1);
  hold(model, 2, 2, {true, false, true}, Vec3(0.25, 0, -0.5));
  Support constant;
  constant.particles = {0}, constant.displacement = Vec3(0, 0.125, 0), constant.scaling = Scaling::constant();
  model.supports.push_back(constant);
  const Kinematics kinematics(model);
  State state = model.start;
  kinematics.prescribe(state, 0.5);
  CHECK(state.position.col(2) == Vec3(0.125, 0, 1.75));
  CHECK(state.position.col(0) == Vec3(0, 0.125, 0));
  CHECK(state.load_factor == 0.5);
  kinematics.prescribe(state, 0.25);
  CHECK(state.position.col(2) == Vec3(0.0625, 0, 1.875));
}

TEST_CASE("same bits for any number of threads", "[energy]") {
  Model model = chain(30000, 50, 0.4, 1, Vec3(1, 0.2, -0.3));
  hold(model, 0, 1);
  Energy energy(model);
  const State state = bent(energy, 0, 0.2);
  set_threads(1);
  energy.evaluate(state);
  const Vector g = energy.gradient();
  const SparseMatrix H = energy.hessian();
  const double e = energy.last_terms().total();
  for (const int threads : {2, 4}) {
    set_threads(threads);
    energy.evaluate(state);
    CHECK(e == energy.last_terms().total());
    CHECK(g == energy.gradient());
    CHECK(std::equal(H.valuePtr(), H.valuePtr() + H.nonZeros(), energy.hessian().valuePtr()));
  }
}

TEST_CASE("what the last evaluation has left is not made again, and anything else is", "[energy]") {
  Model model = chain(20, 50, 0.4, 1, Vec3(1, 0.2, -0.3));
  hold(model, 0, 1);
  Energy energy(model), plain(model);
  const State a = bent(energy, 0, 0.2), b = bent(energy, 0, 0.3);
  const auto is_at = [&](const State& state) {
    energy.be_at(state), plain.evaluate(state);
    CHECK(energy.gradient() == plain.gradient());
    CHECK(energy.hessian().toDense() == plain.hessian().toDense());
    CHECK(energy.last_terms().total() == plain.last_terms().total());
  };
  is_at(a), is_at(a), is_at(b);
  energy.evaluate(a, false), is_at(b);                   // the gradient is of another state
  energy.evaluate(b, true, {.from = &a}), is_at(b);      // the Hessian has other forces
  energy.changeable_hessian() *= 2, is_at(b);
  State driven = b;
  driven.load_factor = 0.5, is_at(driven);
}
