#pragma once
#include "solve/factors.hpp"
#include "solve/report.hpp"

#include <cmath>
#include <functional>
#include <limits>
#include <optional>

namespace elamin {

struct NewtonOptions {
  double tolerance = 1e-10;        // residual, relative to the largest internal force
  int max_iterations = 200;
};

/// How minimise() goes. long_steps: as described at Newton, the fewest iterations. downhill: exact Hessian, the energy falls
/// at every step, simplified Newton corrections bend a step back that stretched the structure; it stays in the valley that
/// it starts in, which is what a snap from an unstable state wants. stationary: long steps that do not leave a saddle; converged means a small residual
/// alone, which is what a branch wants that is about to lose stability.
enum class Pace { long_steps, downhill, stationary };

/// A hyperplane across a branch, in the space of positions and load factor, through the state that a corrector begins at:
///   row · Δx + corner Δλ = 0.
/// The correction's size is |(Δx, Δλ)|² = |Δx|²/length² + Δλ²/load². With a `condition` it is the surface c(x, λ) = 0 instead, row and
/// corner being ∂c/∂x and ∂c/∂λ.
struct Plane {
  Vector row;                      // dofs
  double corner = 0;
  double length = 1, load = 1;
  /// c at a state, which puts its derivatives there into row and corner; converged means |c| ≤ close, too.
  std::function<double(const State&, Plane&)> condition = {};
  double close = 0;
  bool guided = false;             // forces along held directions are not asked to vanish: they guide the state
};

/// Newton's method. Both calls leave the state where they got to, prescribed coordinates as they are, and evaluate the
/// energy with its exact Hessian there.
///
/// Slender structures stretch 10³–10⁶ times less willingly than they bend: a straight step that turns a bond by θ stretches
/// it by θ²/2, and the force of that stretch would stiffen the next Hessian beyond use. So the Hessian after a step takes
/// the axial forces that the step's linearisation predicted (Energy::evaluate with `from`), which is Newton's method on
/// the mixed energy of positions and axial forces, and steps are judged by the energy less what was not predicted of it:
/// the number of iterations does not grow with slenderness. At an equilibrium both Hessians are the same.
/// Source: Magisano, Leonetti, Garcea 2017, Int. J. Numer. Meth. Engng 109; turns of a bond are kept below 0.3 a step.
///
/// Where the Hessian is indefinite, Newton steps go with H + μP: P is what compression takes from H in bonds, angles and contacts, μ ≤ 1. Unlike
/// H + τI that leaves soft motions soft, however stiff others are: a sheet that wrinkles takes as many steps as it has turns to make.
///
/// Rigid bodies that nothing holds are kept from drifting by steady_bodies.
///
/// Hertz contacts open and close within a run: the Hessian is continuous, but no more. Steps end before anything passes
/// through anything (Energy::passage); what overlaps too deeply is driven out by the same method, whose error in an overlap
/// shrinks to a third a step while it is large, and quadratically once the set of contacts has settled.
class Newton {
 public:
  explicit Newton(Energy& energy, NewtonOptions options = {});

  /// Finds a minimum: converged means a small residual and (but see Pace) no negative eigenvalue. A saddle is left along its negative
  /// curvature. Steps lower the energy (Armijo on what was predicted); where rounding hides the energy's change, they
  /// must lower the residual. Not more than `most` iterations, where that is less than the options allow.
  [[nodiscard]] Report minimise(State& state, Pace pace = Pace::long_steps, int most = std::numeric_limits<int>::max());

  /// Finds the stationary point near the state, stable or not. Directions in the columns of `held` (orthonormal,
  /// dofs × m) keep their value: zero modes, or the critical modes at an event. `from`: the equilibrium that a predictor
  /// led here from, if one did. With a `plane` the load factor is an unknown too, and the state moves on the plane.
  /// Not converged if the steps do not shrink, or after `most` iterations.
  [[nodiscard]] Report correct(State& state, const Eigen::MatrixXd& held = {}, const State* from = nullptr,
                 int most = std::numeric_limits<int>::max(), Plane* plane = nullptr);

  /// Moves the state from a saddle down along ± direction (dofs), sign as given, until the energy rises or what is
  /// glued turns by a third of a radian. False if no lower energy is found.
  [[nodiscard]] bool leave_saddle(State& state, const Vector& direction);

  Energy& energy() { return energy_; }
  Factors& factors() { return factors_; }
  double tolerance() const { return options_.tolerance; }

 private:
  /// A step p = −M⁻¹g + (a direction of negative curvature), M = H + τI, with what the model predicts along it.
  struct Step {
    Vector p, g, hp;             // hp = H p
    double energy, slope, curvature;
    double energy_rounding = 0;
    bool resolved = false;       // M as in Factors::solve_convex
    bool leaves = false;         // a saddle: there the gradient grows, and its sign along p tells what the energy's rounding hides
    double predicted(double alpha) const { return alpha * slope + alpha * alpha / 2 * curvature; }
    /// Rounding hides the change of energy that the step would make.
    bool hidden(double alpha) const { return std::abs(predicted(alpha)) <= energy_rounding; }
  };
  /// Why a run ends.
  struct Halt {
    Status status;
    std::string why;
  };
  /// What one iteration of minimise() hands to the next.
  struct Descent {
    Pace pace;
    int most;                    // iterations
    double step_bound;                // of a step, as far as the last ones could be taken [length]
    double shift = 0;            // the last one: a guess for the next [force/length]
    double pressed = 1;          // part of what compression takes that the last indefinite Hessian was taken without: a guess, too
    bool eased = false;          // the last step was one without compression; …
    bool refused = false;        // … and none of it could be taken: the next one takes a shift
    double moved = 0;            // by the last step [length]
    int rises = 0;               // eased steps in a row that made the residual larger
    int unseen = 0;              // steps whose change of energy rounding hid
    bool left = false;           // a saddle, in the last iteration
    bool linearised = false;     // previous holds where the last step came from
    State previous = {};
    std::optional<State> settled_at = {};   // a minimum by the tolerance, whose forces still bend the structure …
    double least = 0;                       // … and its residual
    Report report = {};
    const State* from() const { return linearised ? &previous : nullptr; }
  };
  /// Of a step: how much of it may be tried first, and how much of that what is in the way has left.
  struct Part { double first, free; };
  class Effort;
  [[nodiscard]] std::optional<Halt> iterate(State& state, Descent& descent);
  void look(const State& state, Descent& descent);
  bool is_minimum(State& state, Descent& descent);
  [[nodiscard]] bool still_bends(State& state, Descent& descent);
  Halt a_minimum() const;
  [[nodiscard]] std::optional<Halt> advance(State& state, Descent& descent, Step step);
  [[nodiscard]] std::optional<Step> shorter_step(const State& state, Descent& descent, const Step& step, double alpha);
  Part part_of(const State& state, const Step& step) const;
  double residual() const;
  void record(Report& report, double step, double shift) const;
  [[nodiscard]] Report finish(const State& state, Report report, const Halt& halt);
  std::optional<Halt> must_halt(const State& state, const Report& report, int most) const;
  std::optional<Halt> no_factor() const;
  Halt without_factor() const;
  double part_within_rotation(const State& state, const Vector& p, double load_change = 0) const;
  double free_part(const State& state, const Vector& p, double part) const;
  Step newton_step(const Vector& g, double shift);
  [[nodiscard]] std::optional<Step> step_within(double step_bound, const Vector& g, double& shift);
  [[nodiscard]] bool resolve_softest(const Vector& g, const Descent& descent, Step& step);
  bool take(const State& from, const Step& step, double alpha, Pace pace, State& to);
  [[nodiscard]] bool comes_nearer(const Step& step, double alpha);
  [[nodiscard]] bool take_downhill(const State& from, const Step& step, double alpha, State& to);
  [[nodiscard]] bool take_long(const State& from, const Step& step, double alpha, State& to);
  [[nodiscard]] std::optional<double> without_compression(const State& state, const Vector& g, Descent& descent);
  [[nodiscard]] std::optional<double> make_convex(State& state, const Vector& g, Descent& descent, bool settled, bool& left);
  void polish(State& state, Report& report, const std::function<double(State&)>& step);

  Energy& energy_;
  NewtonOptions options_;
  Factors factors_;
  double extent_;                  // of everything there is: no step is longer
};

}  // namespace elamin
