#pragma once
// What can be asked of the Hessian at a state: is it positive definite, its inertia, its lowest eigenpairs.
#include "core/dense.hpp"
#include "energy/energy.hpp"
#include "solve/cholesky.hpp"
#include "solve/pivoted.hpp"
#include "solve/shifts.hpp"

#include <optional>
#include <string>

namespace elamin {

/// Numbers of eigenvalues below zero and at zero, "zero" within the rounding of a form that is summed element by element.
struct Inertia {
  int negative = 0, zero = 0;
  bool positive_definite() const { return negative == 0 && zero == 0; }
};

/// Both factorisations of one energy's Hessian with their symbolic analyses, which are made anew only when contacts change
/// its pattern. All calls speak of the Hessian of the energy's last evaluation.
class Factors {
 public:
  explicit Factors(Energy& energy);

  /// σ = 16 ε ‖H‖₁, with the stiffest bond for the norm where more than that cancels: a factor of the assembled Hessian does not tell
  /// eigenvalues within ±σ from zero; inertia() does, and the values of lowest() and nearest_zero() are better known. [force/length]
  double zero_level() const;
  /// By LLᵀ of H − σI alone where that succeeds, or the pivoted factor of H where no eigenvalue is near zero. Else the eigenvectors
  /// within some σ are found and the signs on their span told by forms (see inertia.cpp). Leaves what solve_holding needs, which is of use if
  /// no eigenvalue is zero. Where there is no factor at all (see why_none), all dofs count as zero.
  Inertia inertia();
  /// Which of the two comes first depends on the last inertia, and with it the rounding of what follows: what has been told of it elsewhere.
  /// `soft`: the modes that it had to resolve, for factorize_resolving().
  void expect(bool indefinite, const Eigen::MatrixXd& soft) { indefinite_ = indefinite, soft_ = soft; }
  const Eigen::MatrixXd& soft() const { return soft_; }
  void carry(Archive& archive) { archive(indefinite_, soft_); }
  /// Factorises H + τI with the smallest τ ≥ 0 of a short list (none, σ, then growing from a guess) that makes
  /// it positive definite; returns τ.  The factor is then in cholesky(). None where there is no such thing: see why_none().
  [[nodiscard]] std::optional<double> make_positive(double guess);
  /// The same from `shift` on, `growth` times larger each time: first_shift() of try_cholesky().
  [[nodiscard]] std::optional<double> make_positive_from(double shift, double growth = 2);
  /// Why no factor of the Hessian can be made, of whatever shift: "" if one can.
  std::string why_none() const;
  /// The `count` lowest eigenpairs, by block inverse iteration with Rayleigh–Ritz on a few guard vectors more, which
  /// finds multiple eigenvalues as such; values are Rayleigh quotients formed element by element (Energy::quadratic_form).
  /// `guess`: a shift that may make the Hessian positive definite, as of make_positive. `accuracy`: of the eigenvalues,
  /// relative to the largest of them. `start`: vectors that may be near, dofs × any number.
  EigenPairs lowest(int count, double guess = 0, double accuracy = 1e-11, const Eigen::MatrixXd& start = {});

  /// The eigenpairs nearest to zero in the space orthogonal to `held`, as many as `start` has columns, by block inverse
  /// iteration with the factor of the Hessian itself: where eigenvalues all but vanish a step or two give all digits.
  EigenPairs nearest_zero(const Eigen::MatrixXd& start, const Eigen::MatrixXd& held);
  /// The same as far as a few rounds tell with the factors that solve_holding has.
  EigenPairs soft_pairs(Eigen::MatrixXd start, int rounds);
  /// Of the eigenvalues nearest to zero the absolute values, ascending, by two rounds of it from fixed vectors: to a factor of two or so, but as smooth in the
  /// state as the Hessian.
  Vector soft_values(int count);
  /// Takes out of such pairs what the rounding of the factor, E ~ ε‖H‖, has put in of other soft modes, E/μ of a mode of stiffness μ and E²/μ of its energy:
  /// R = HX − XS has none of it, and X − H⊥⁻¹R but (E/μ)², by iterative refinement (see inertia.cpp); right after nearest_zero.
  void refine(EigenPairs& pairs);

  /// Factorises the Hessian as it is, definite or not, for solutions of
  ///   H p + Z μ = b,   Zᵀ p = 0
  /// where the columns of `held` (orthonormal, dofs × m) keep still: zero modes, critical modes. H may be singular along
  /// them. False if there is no factor (see why_none); all solutions are then zero.
  bool factorize_holding(const Eigen::MatrixXd& held);
  /// The same for the steps of a corrector: where nothing is held, the modes whose signs the last inertia() had to resolve are resolved here, too, so
  /// that solutions along them are not rounding.
  bool factorize_resolving(const Eigen::MatrixXd& held);
  /// The gradient of the last evaluation (dofs), for solutions after that: its parts along the modes that are resolved formed element by element, and
  /// none where that is rounding.
  Vector gradient() const;
  /// p of the system above; the factors must be those of factorize_holding (or of inertia, then Z is empty).
  Vector solve_holding(const Vector& b);
  /// p of |H| p = b, |H| being H with the signs of its negative eigenvalues changed, where the last inertia() had to tell signs that a factor
  /// cannot; none elsewhere. Along zero eigenvalues motions are
  /// held as by hold_zero_modes. cholesky() then holds H + σI.
  [[nodiscard]] std::optional<Vector> solve_convex(const Vector& b);
  /// (p, δ) of the system that has one row and one column more, in the space orthogonal to `held`,
  ///   H p + c δ = b,   r·p + d δ = β,
  /// with the factors of factorize_holding: mixed block elimination, which is stable although H be singular to rounding,
  /// as at a limit point.  Source: Govaerts & Pryce 1993, IMA J. Numer. Anal. 13, algorithm BEM.
  struct Bordered { Vector p; double delta; };
  Bordered solve_bordered(const Vector& column, const Vector& row, double corner, const Vector& b, double beta);

  Cholesky& cholesky() { return cholesky_.factor; }
  PivotedFactor& pivoted() { return pivoted_.factor; }
  int factorizations() const { return factorizations_; }
  /// Time spent in analyses, factorisations and solves so far.
  double seconds() const {
    return cholesky_.factor.seconds() + pivoted_.factor.seconds() + bordered_.factor.seconds() + beside_.factor.seconds();
  }
  [[nodiscard]] bool try_cholesky(double shift) { return attempt(cholesky_, shift); }
  [[nodiscard]] bool try_pivoted(double shift) { return attempt(pivoted_, shift); }

 private:
  /// A factorisation, and the pattern of the Hessian and the number of borders that it has analysed.
  template <class F> struct Analysed {
    F factor;
    int version = -1;
    Eigen::Index borders = 0;
  };
  template <class F> [[nodiscard]] bool attempt(Analysed<F>& in, double shift, const Eigen::MatrixXd& borders = {});
  [[nodiscard]] bool pivot_near(double first, double next);
  [[nodiscard]] bool pivot_beside(Analysed<PivotedFactor>& in, const Eigen::MatrixXd& held);
  using Solve = std::function<Eigen::MatrixXd(const Eigen::MatrixXd&)>;
  [[nodiscard]] std::optional<Eigen::MatrixXd> soft_modes(double bound, const Solve& solve);
  [[nodiscard]] std::optional<Inertia> resolve(Eigen::MatrixXd x, bool positive);
  Vector solve_resolved(const Vector& b);
  Vector solve_shifted(const Vector& b);
  Eigen::MatrixXd krylov(const Eigen::MatrixXd& x);
  double smallest();
  Energy& energy_;
  double stiffest_ = 0;                          // bond with a free end [force/length]
  Analysed<Cholesky> cholesky_;
  Analysed<PivotedFactor> pivoted_, bordered_, beside_;
  int factorizations_ = 0;
  struct Near {                                  // of the last inertia that needed it, as in inertia.cpp
    Eigen::MatrixXd x, w, r, t;                  // X, H⊥⁻¹R, R, T
    Vector error;                                // of the eigenvalues of T by rounding
    Solve outside;                               // H⊥⁻¹, or near to it
  } near_;
  Eigen::MatrixXd soft_;                         // X of the last inertia, where that needed it
  bool indefinite_ = false;                      // the last inertia had a negative eigenvalue: try the pivoted factor first
  Factorization* holder_ = nullptr;              // the factor of factorize_holding; none: solutions are zero, or …
  bool resolved_ = false;                        // … those of solve_resolved
  double shift_ = 0;                             // of the holder: of H + τI where that told the inertia
};

}  // namespace elamin
