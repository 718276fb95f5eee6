#pragma once
// What Ipopt asks for: the energy, its derivatives, the gaps of hard contacts. For ipopt.cpp only.
#include "solve/contact_equilibrium.hpp"
#include "solve/ipopt.hpp"

#include <IpTNLP.hpp>

#include <vector>

namespace elamin {

/// What one run leaves to the next.
struct IpoptMemory {
  double barrier = 0;                            // μ; 0: not yet known
  double close = 0;                              // residual at which the equilibrium is looked for by Newton's method; 0: not known
};

/// E as a function of y = (q − q₀)/ℓ in units of e: (E − E₀ + S)/e, S the size of E's terms, so that what rounding does to
/// E is seen; subject to c/ℓ ≥ 0 for the gaps that may close near q₀. ℓ: the mean diameter, e: the largest stiffness times ℓ².
///
/// The Hessian takes the axial forces that the last step predicted (see Newton): with a watchdog that lets the energy rise for a
/// few steps the number of iterations does not grow with slenderness. At an equilibrium it is the exact one.
///
/// A trial point is refused if something has passed through something on the way to it, or if it is so far away that a gap that
/// is not looked at might have closed. Where contacts change the pattern, or the gaps must be looked for anew, the run ends,
/// and another one begins where it stands.
class IpoptProblem final : public Ipopt::TNLP {
 public:
  using Index = Ipopt::Index;
  using Number = Ipopt::Number;
  IpoptProblem(Energy& energy, ContactEquilibrium& equilibrium, const State& start, const IpoptOptions& options,
               IpoptMemory& memory, Report& report);

  /// How the run ended: at an equilibrium; interrupted; because a new one must begin; what has escaped, or "".
  bool reached() const { return reached_; }
  bool stale() const { return stale_; }
  const std::string& escaped() const { return escaped_; }
  /// Where it stands, with the forces of hard contacts as Ipopt knows them, or as they are at an equilibrium.
  const State& state() const { return state_; }

  bool get_nlp_info(Index& n, Index& m, Index& jacobian, Index& hessian, IndexStyleEnum& style) override;
  bool get_bounds_info(Index n, Number* lo, Number* hi, Index m, Number* gap_lo, Number* gap_hi) override;
  bool get_starting_point(Index n, bool, Number* y, bool, Number*, Number*, Index m, bool with_forces, Number* force) override;
  bool eval_f(Index, const Number* y, bool renewed, Number& f) override;
  bool eval_grad_f(Index n, const Number* y, bool renewed, Number* g) override;
  bool eval_g(Index, const Number* y, bool renewed, Index m, Number* gap) override;
  bool eval_jac_g(Index, const Number* y, bool renewed, Index, Index, Index* row, Index* column, Number* value) override;
  [[nodiscard]] bool eval_h(Index, const Number* y, bool renewed, Number factor, Index m, const Number* multiplier, bool, Index entries,
              Index* row, Index* column, Number* value) override;
  [[nodiscard]] bool intermediate_callback(Ipopt::AlgorithmMode mode, Index iteration, Number, Number, Number, Number mu, Number, Number shift,
                             Number, Number, Index, const Ipopt::IpoptData* data, Ipopt::IpoptCalculatedQuantities*) override;
  void finalize_solution(Ipopt::SolverReturn, Index, const Number*, const Number*, const Number*, Index, const Number*,
                         const Number*, Number, const Ipopt::IpoptData*, Ipopt::IpoptCalculatedQuantities*) override {}

 private:
  [[nodiscard]] bool move(const Number* y, bool renewed);
  bool passes() const;
  [[nodiscard]] bool differentiate(const Number* y, bool renewed);
  [[nodiscard]] bool measure(const Number* y, bool renewed);
  void remember(const State& accepted);
  double force_scale() const;
  void look(double moved);
  [[nodiscard]] bool settle();

  Energy& energy_;
  ContactEquilibrium& equilibrium_;
  IpoptOptions options_;
  IpoptMemory& memory_;
  Report& report_;
  State origin_, at_, state_, before_;           // q₀; y; the last one accepted; the one before
  std::vector<State> trail_;                     // the last ones accepted, in a ring
  std::size_t next_ = 0;
  double length_ = 1, unit_ = 1, offset_ = 0;    // ℓ, e, E₀ − S
  double freedom_ = 0, extent_ = 0;              // how far particles may move; of everything
  std::vector<HardForce> contacts_;              // whose gaps are looked at …
  std::vector<HardGap> gaps_;                    // … and these, at at_
  Vector step_;                                  // y
  Vector gradient_;                              // by y, as the Hessian of energy_ when differentiated_
  bool arrived_ = false, free_ = true;           // at_ is at step_; the way there is free
  bool differentiated_ = false, measured_ = false;   // the last evaluation of energy_ was at at_; gaps_ are those of at_
  bool stale_ = false, reached_ = false;
  std::string escaped_;
  int version_ = 0;                              // of the pattern
  int waited_ = 0, lost_ = 0;                     // iterations in which contacts were undecided; in a row in which nothing moved
};

}  // namespace elamin
