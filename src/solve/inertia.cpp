// Signs of eigenvalues that the assembled Hessian cannot tell.
//
// A chain of N links stretches EA L²/EI times less willingly than it bends, and bends in its shortest wave N⁴ times less willingly than
// in its longest: the eigenvalue that decides its stability may be 10¹⁰ … 10¹⁶ times smaller than ‖H‖, and H, summed and rounded, knows
// it to ε ‖H‖ only. Forms vᵀHv of smooth v, summed element by element from differences of v, know it far better (Energy::form). So let the
// columns of X, orthonormal, span the eigenvectors whose sign is in doubt, and X⊥ what is orthogonal to them. In the basis (X, X⊥)
//   H = [ S  Rᵀ ]       S = XᵀHX,   R = HX − XS,
//       [ R  H⊥ ]
// and by Haynsworth's theorem (1968, Linear Algebra Appl. 1, 73) the inertia of H is that of H⊥ and of its Schur complement
//   T = S − Rᵀ H⊥⁻¹ R,
// for any X whatever. H⊥ has no small eigenvalue: a factor of H with borders X tells its inertia. T is small; S is formed element by
// element, and RᵀH⊥⁻¹R is of second order in the error of X (Parlett 1980, The Symmetric Eigenvalue Problem, §11.7), so that it need not be
// known well; X ← X − H⊥⁻¹R makes it vanish, but for the rounding of HX. An eigenvalue of T is zero if it is within the error of its own
// form (BilinearForm::size, ε) plus the second-order term plus what forces out of balance, g, leave of a motion that costs nothing: it goes
// on a curve, a rotation at the rate φ on one of curvature φ, and vᵀHv = −g·x'' then, |x''| ≤ φ. So X spans the eigenvectors to
// eigenvalues up to 2|g|φ too. A body that is nearly a straight line rotates about it with a huge φ. Where free rotations alone leave a sign in doubt, it is told
// with them taken out of H; the columns of U, orthonormal, span them:
//   T' of (I − UUᵀ) H (I − UUᵀ),   T' = T − ABᵀ − BAᵀ + ACAᵀ,   A = XᵀU,   B = XᵀHU,   C = UᵀHU.
// An eigenvalue has a sign where those of T and T' have it.
#include "core/interrupt.hpp"
#include "energy/step_limits.hpp"
#include "model/entities.hpp"
#include "model/rigid_motion.hpp"
#include "solve/factors.hpp"
#include "solve/limits.hpp"
#include "solve/ritz.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

namespace elamin {

namespace {

// Curvatures φ of paths of unit speed that may cost nothing [1/length]: of what is glued its rotation, as bonds see it and as a whole, of
// what touches its way around the other.
class Curvature {
 public:
  explicit Curvature(const Energy& energy) : energy_(energy) {
    const Model& model = energy.model();
    for (const RigidMotion& m : free_rigid_motions(model, energy.evaluated())) {
      if (m.translation || m.size == 0) continue;
      if (rotations_.size() == limits::most_rotations) break;
      const Vector u = energy.kinematics().restrict(m.velocity_field(energy.kinematics().sites()));
      if (u.norm() > 0) rotations_.push_back({u.normalized(), m.twist.tail<3>().norm() / m.size / u.norm()});
    }
    touching_ = may_touch(model);
  }

  /// φ along v of what is bent or touches.
  double of(const Vector& v) const {
    const double bent = distortion(energy_, energy_.evaluated(), v);
    return touching_ ? std::max(bent, movement(energy_, v)) : bent;
  }

  /// φ along v of free rotations.
  double of_rotations(const Vector& v) const {
    double most = 0;
    for (const auto& [u, rate] : rotations_) most = std::max(most, std::abs(u.dot(v)) * rate);
    return most;
  }

  /// T', see above.
  Eigen::MatrixXd without_rotations(const Eigen::MatrixXd& x, const Eigen::MatrixXd& t) const {
    Eigen::MatrixXd u(x.rows(), std::ssize(rotations_));
    for (Eigen::Index k = 0; k < u.cols(); ++k) u.col(k) = rotations_[k].u;
    u = orthonormal(u);
    const auto forms = [&](const Eigen::MatrixXd& left) {
      return Eigen::MatrixXd::NullaryExpr(left.cols(), u.cols(), [&](Eigen::Index i, Eigen::Index k) { return energy_.form(left.col(i), u.col(k)).value; }).eval();
    };
    const Eigen::MatrixXd a = x.transpose() * u, b = forms(x), c = forms(u), twice = a * b.transpose();
    return t - twice - twice.transpose() + a * (c + c.transpose()) / 2 * a.transpose();
  }

  /// The largest of unit vectors, but for bonds.
  double largest() const {
    double most = touching_ ? 1 / energy_.kinematics().smallest_size() : 0.0;
    for (const auto& [u, rate] : rotations_) most = std::max(most, rate);
    return most;
  }

 private:
  const Energy& energy_;
  bool touching_ = false;
  struct Rotation { Vector u; double rate; };
  std::vector<Rotation> rotations_;
};

// |g|; and contacts that count as open may press what stands in a row, which is a saddle of nothing.
double out_of_balance_of(const Energy& energy) { return std::max(energy.gradient().norm(), energy.no_force()); }

}  // namespace

// The eigenvectors to eigenvalues within ± bound, near enough to span them, by block inverse iteration with a factor near zero; none if
// there are too many, or nothing is known of them yet.
std::optional<Eigen::MatrixXd> Factors::soft_modes(double bound, const Solve& solve) {
  const int n = energy_.dofs();
  for (int block = std::min(n, 6);; block = std::min(n, 2 * block)) {
    Eigen::MatrixXd x = starting_block(n, block);
    Eigen::Index inside = 0, before = -1;
    Vector values;
    for (int k = 0; k < limits::most_rounds && !interrupted(); ++k) {
      x = orthonormal(solve(x));
      values = rotate_to_ritz(energy_, x);
      inside = (values.array().abs() <= bound).count();
      if (std::exchange(before, inside) == inside && k >= limits::least_rounds) break;
    }
    if (values.size() == 0) return {};                            // interrupted
    if (inside < block || block == n) {
      Eigen::MatrixXd soft(n, inside);
      for (Eigen::Index j = 0, k = 0; j < block; ++j)
        if (std::abs(values[j]) <= bound) soft.col(k++) = x.col(j);
      return soft;
    }
    if (block >= limits::most_doubtful || interrupted()) return {};
  }
}

// Signs of the eigenvalues in the span of X, and of the rest; leaves what solve_holding needs. None: there is no factor. `positive`: there
// is a Cholesky factor F of H + σI. Then H⊥ is positive definite, its eigenvalues are beyond 4σ, and F on X⊥ is H⊥ to a quarter:
//   H⊥⁻¹ b ≈ F⁻¹b − Y (XᵀY)⁻¹ XᵀF⁻¹b,   Y = F⁻¹X.
std::optional<Inertia> Factors::resolve(Eigen::MatrixXd x, bool positive) {
  constexpr int most = 12;
  int below = 0;
  if (positive) {
    const Eigen::MatrixXd y = cholesky().solve(x);
    near_.outside = [this, x, y, within = Eigen::MatrixXd(x.transpose() * y)](const Eigen::MatrixXd& b) -> Eigen::MatrixXd {
      const Eigen::MatrixXd z = cholesky().solve(b);
      return z - y * solved(within, x.transpose() * z);
    };
  } else {
    if (!pivot_beside(beside_, x)) return {};
    below = beside_.factor.negative() - static_cast<int>(x.cols());
    near_.outside = [this](const Eigen::MatrixXd& b) { return beside_.factor.solve(b); };
  }
  const double out_of_balance = out_of_balance_of(energy_);
  const Curvature curvature(energy_);
  Inertia inertia;
  double before = infinity;
  for (int k = 0;; ++k) {
    const Eigen::Index m = x.cols();
    Eigen::MatrixXd s(m, m), r(x.rows(), m), w(x.rows(), m);
    Vector size(m), bend(m), spin(m);
    for (Eigen::Index j = 0; j < m; ++j) {
      r.col(j) = energy_.multiply(x.col(j));
      for (Eigen::Index i = 0; i <= j; ++i) {
        const BilinearForm form = energy_.form(x.col(i), x.col(j));
        s(i, j) = s(j, i) = form.value;
        if (i == j) size[j] = form.size;
      }
      bend[j] = curvature.of(x.col(j)), spin[j] = std::max(bend[j], curvature.of_rotations(x.col(j)));
    }
    r -= x * s;
    r -= x * (x.transpose() * r);
    w = near_.outside(r);
    w -= x * (x.transpose() * w);
    const Eigen::MatrixXd product = r.transpose() * w, second = (product + product.transpose()) / 2;
    const EigenPairs small = symmetric_eigen(s - second);
    const Eigen::MatrixXd& v = small.vectors;
    const Vector& t = small.values;
    const auto parts = [&](const Eigen::MatrixXd& of, const Vector& each) -> Vector { return of.cwiseAbs2().transpose() * each; };
    // A translation stretches nothing, but for what rounds the modes themselves: the ε in x of ‖Hx‖.
    const auto rounding_of_forms = [&](const Eigen::MatrixXd& of) -> Vector { return (limits::form_rounding * epsilon * parts(of, size)).array() + epsilon * zero_level(); };
    const auto unknown_of = [&](const Eigen::MatrixXd& of) -> Vector { return (of.transpose() * second * of).diagonal().cwiseAbs(); };
    const auto error_of = [&](const Eigen::MatrixXd& of, const Vector& curved) -> Vector {
      return rounding_of_forms(of) + 2 * out_of_balance * parts(of, curved) + unknown_of(of);
    };
    const Vector of_forms = rounding_of_forms(v), unknown = unknown_of(v), error = error_of(v, spin), held = error_of(v, bend);
    struct Known { Eigen::Index negative, positive; };
    const auto known = [](const Vector& values, const Vector& to) {
      return Known{(values.array() < -to.array()).count(), (values.array() > to.array()).count()};
    };
    Known sure = known(t, error);
    if (const Known still = known(t, held); still.negative + still.positive > sure.negative + sure.positive) {
      const EigenPairs balanced = symmetric_eigen(curvature.without_rotations(x, s - second));
      const Known there = known(balanced.values, error_of(balanced.vectors, bend));
      sure = {std::max(sure.negative, std::min(still.negative, there.negative)), std::max(sure.positive, std::min(still.positive, there.positive))};
    }
    inertia = {below + static_cast<int>(sure.negative), static_cast<int>(m - sure.negative - sure.positive)};
    const bool clear = (t.array().abs() > error.array() || unknown.array() <= (error - unknown).array()).all();
    near_.x = x, near_.w = w, near_.r = r, near_.t = s - second, near_.error = of_forms;
    const bool rounded = !(unknown.sum() < std::exchange(before, unknown.sum()) / 2);
    if (clear || rounded || k == most || interrupted()) return inertia;
    x = orthonormal((x - w) * v);
  }
}

Inertia Factors::inertia() {
  const double sigma = zero_level();
  const Inertia unknown{0, energy_.dofs()};
  if (energy_.dofs() == 0) return {};
  const auto by_cholesky = [&](const Eigen::MatrixXd& b) { return cholesky().solve(b); };
  const auto by_pivoted = [&](const Eigen::MatrixXd& b) { return pivoted().solve(b); };
  std::optional<Eigen::MatrixXd> soft;
  bool looked = false, positive = false;
  const auto doubtful = [&] { return std::max(limits::doubtful * sigma, 2 * out_of_balance_of(energy_) * Curvature(energy_).largest()); };
  resolved_ = false, shift_ = 0, soft_.resize(energy_.dofs(), 0);
  if (indefinite_ && try_pivoted(0) && pivoted().negative() > 0) {
    holder_ = &pivoted();
    const double bound = doubtful();
    if (smallest() > 2 * bound) return {pivoted().negative(), 0};                       // the factor stays for solutions
    soft = soft_modes(bound, by_pivoted), looked = true;
  }
  if (!looked) {
    indefinite_ = false;
    holder_ = &cholesky();
    if (try_cholesky(-sigma)) return shift_ = -sigma, Inertia{};
    holder_ = nullptr;
    if ((positive = try_cholesky(sigma))) soft = soft_modes(doubtful(), by_cholesky);
    else if (pivot_near(0, sigma)) soft = soft_modes(doubtful(), by_pivoted);
    else return unknown;
  }
  Inertia inertia;
  if (soft && soft->cols() == 0) {
    if (!pivot_near(0, sigma)) return unknown;
    holder_ = &pivoted();
    inertia.negative = pivoted().negative();
  } else if (soft) {
    const std::optional<Inertia> resolved = resolve(*soft, positive);
    if (!resolved) return unknown;
    inertia = *resolved;
    resolved_ = true, soft_ = near_.x;
  } else {                                                      // too many: what a factor cannot tell, or forces out of balance may leave, is zero
    const double level = std::max(sigma, 2 * out_of_balance_of(energy_) * Curvature(energy_).largest());
    if (!pivot_near(level, 1.5 * level)) return unknown;
    inertia.negative = pivoted().negative();
    if (!pivot_near(-level, -1.5 * level)) return unknown;
    inertia.zero = std::max(0, pivoted().negative() - inertia.negative);
    holder_ = &pivoted();
  }
  indefinite_ = inertia.negative > 0;
  return inertia;
}

// Of the eigenvalues' absolute values the least, by inverse iteration with the pivoted factor: good to a factor of two or so,
// and where one is zero to rounding, as small as that.
double Factors::smallest() {
  Vector x = starting_block(energy_.dofs(), 1).col(0).normalized();
  double estimate = 0;
  for (int k = 0; k < 3; ++k) {
    x = pivoted().solve(x);
    estimate = 1 / x.norm();
    x *= estimate;
  }
  return estimate;
}

// |H|⁻¹ b with |T| for T, its zero eigenvalues held; after inertia(), where that resolved them.
std::optional<Vector> Factors::solve_convex(const Vector& b) {
  if (!resolved_) return {};
  const EigenPairs t = symmetric_eigen(near_.t);
  Vector y = near_.outside(b);
  y -= near_.x * (near_.x.transpose() * y);
  Vector along = t.vectors.transpose() * (near_.x.transpose() * b - near_.r.transpose() * y);
  const double hold = limits::hold_zero_modes * zero_level();
  for (Eigen::Index j = 0; j < along.size(); ++j) along[j] /= std::abs(t.values[j]) <= near_.error[j] ? hold : std::abs(t.values[j]);
  return y + (near_.x - near_.w) * (t.vectors * along);
}

// H⁻¹ b by the factor of H + τI that told the inertia: wrong by τ/(μ + τ) of its part along the mode of the lowest eigenvalue μ, which is what one
// more solution shows. Where that is much, by a factor of H itself.
Vector Factors::solve_shifted(const Vector& b) {
  const Vector p = holder_->solve(b);
  const double wrong = holder_->solve(Vector(shift_ * p)).norm();
  return wrong > limits::shifted * p.norm() && factorize_holding({}) ? holder_->solve(b) : p;
}

// H⁻¹ b in the basis (X, X⊥), refined with products formed element by element. What is left of b along X is xᵀb − xᵀHp, a form: in H p, summed and
// rounded, it drowns, and softness would make motions of it.
Vector Factors::solve_resolved(const Vector& b) {
  const Eigen::MatrixXd& x = near_.x;
  const auto once = [&](const Vector& right, const Vector& along) -> Vector {
    Vector y = near_.outside(right);
    y -= x * (x.transpose() * y);
    const Vector c = solved(near_.t, along - near_.r.transpose() * y);
    return y + (x - near_.w) * c;
  };
  Vector p = Vector::Zero(b.size()), left = b, along = x.transpose() * b, before;
  for (int k = 0; k <= limits::most_refinements; ++k) {
    const Vector correction = once(left, along);
    if (k > 1 && !(correction.norm() < before.norm() / 2)) break;
    p += correction, before = correction;
    if (k > 0 && correction.norm() <= limits::refined * p.norm()) break;
    left = b - energy_.multiply(p);
    for (Eigen::Index j = 0; j < x.cols(); ++j) along[j] = x.col(j).dot(b) - energy_.form(x.col(j), p).value;
  }
  return p;
}

}  // namespace elamin
