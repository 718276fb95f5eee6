#include "solve/nlopt_algorithms.hpp"

#include "core/suggest.hpp"
#include "solve/limits.hpp"
#include "solve/nlopt.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <vector>

namespace elamin {

namespace {

using Kind = NloptAlgorithm::Kind;

constexpr NloptAlgorithm algorithms[]{
    {"LD_LBFGS", NLOPT_LD_LBFGS, Kind::gradient},
    {"LD_TNEWTON", NLOPT_LD_TNEWTON, Kind::gradient},
    {"LD_TNEWTON_RESTART", NLOPT_LD_TNEWTON_RESTART, Kind::gradient},
    {"LD_TNEWTON_PRECOND", NLOPT_LD_TNEWTON_PRECOND, Kind::gradient},
    {"LD_TNEWTON_PRECOND_RESTART", NLOPT_LD_TNEWTON_PRECOND_RESTART, Kind::gradient},
    {"LD_VAR1", NLOPT_LD_VAR1, Kind::gradient},
    {"LD_VAR2", NLOPT_LD_VAR2, Kind::gradient},
    {"LD_MMA", NLOPT_LD_MMA, Kind::gradient},
    {"LD_CCSAQ", NLOPT_LD_CCSAQ, Kind::gradient},
    {"LD_SLSQP", NLOPT_LD_SLSQP, Kind::gradient, 1, limits::nlopt::dense},
    {"LN_COBYLA", NLOPT_LN_COBYLA, Kind::derivative_free, 1, limits::nlopt::quadratic},
    {"LN_BOBYQA", NLOPT_LN_BOBYQA, Kind::derivative_free, 2, limits::nlopt::quadratic},
    {"LN_NEWUOA", NLOPT_LN_NEWUOA, Kind::derivative_free, 2, limits::nlopt::quadratic},
    {"LN_PRAXIS", NLOPT_LN_PRAXIS, Kind::derivative_free, 2, limits::nlopt::quadratic},
    {"LN_NELDERMEAD", NLOPT_LN_NELDERMEAD, Kind::derivative_free, 1, limits::nlopt::simplex},
    {"LN_SBPLX", NLOPT_LN_SBPLX, Kind::derivative_free, 1, limits::nlopt::simplex},
    {"G_MLSL", NLOPT_G_MLSL, Kind::global, 1, limits::nlopt::global},
    {"G_MLSL_LDS", NLOPT_G_MLSL_LDS, Kind::global, 1, limits::nlopt::global},
    {"GN_DIRECT", NLOPT_GN_DIRECT, Kind::global, 1, limits::nlopt::global},
    {"GN_DIRECT_L", NLOPT_GN_DIRECT_L, Kind::global, 1, limits::nlopt::global},
    {"GN_CRS2_LM", NLOPT_GN_CRS2_LM, Kind::global, 1, limits::nlopt::global},
    {"GN_ISRES", NLOPT_GN_ISRES, Kind::global, 1, limits::nlopt::global},
    {"GN_ESCH", NLOPT_GN_ESCH, Kind::global, 1, limits::nlopt::global},
};

std::string names_of(Kind kind) {
  std::string names;
  for (const NloptAlgorithm& a : algorithms)
    if (a.kind == kind) names += (names.empty() ? "" : ", ") + std::string(a.name);
  return names;
}

}  // namespace

std::span<const NloptAlgorithm> nlopt_algorithms() { return algorithms; }

const NloptAlgorithm* nlopt_algorithm_of(const std::string& name) {
  for (const NloptAlgorithm& a : algorithms)
    if (a.name == name) return &a;
  return nullptr;
}

std::string nlopt_refuses(const std::string& algorithm, int dofs, bool hard) {
  const NloptAlgorithm* a = nlopt_algorithm_of(algorithm);
  if (!a) {
    std::vector<std::string> names;
    for (const NloptAlgorithm& known : algorithms) names.push_back(known.name);
    const std::string meant = did_you_mean(algorithm, names);
    return fmt::format("NLopt has no algorithm \"{}\" that is of use here{} There are {}; without derivatives, for "
                       "small problems, {}; global, for small problems, {}",
                       algorithm, meant.empty() ? "." : meant, names_of(Kind::gradient), names_of(Kind::derivative_free), names_of(Kind::global));
  }
  if (hard) return fmt::format("NLopt's {} knows no hard contacts; use \"ipopt\", or an elastic contact", a->name);
  if (dofs > 0 && dofs < a->least)
    return fmt::format("NLopt's {} needs at least {} free dofs, there {} {}; LD_LBFGS or \"newton\" can", a->name, a->least,
                       dofs == 1 ? "is" : "are", dofs);
  if (dofs > a->most)
    return fmt::format("NLopt's {} {}; {} free dofs are too many for it, {} are not; {} can", a->name,
                       a->kind == Kind::global ? "looks for minima all over a box"
                       : a->kind == Kind::gradient ? "keeps a dense matrix"
                                                   : "does without derivatives",
                       dofs, a->most, "LD_LBFGS, LD_TNEWTON_PRECOND_RESTART, \"newton\" or \"ipopt\"");
  return "";
}

}  // namespace elamin
