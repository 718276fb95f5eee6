#include "lammps/script/mixing.hpp"

#include <algorithm>
#include <cmath>

namespace elamin::script {

const PairStyle* style_of(const Run& run, PairCoefficient::Law law) {
  using Law = PairCoefficient::Law;
  for (const PairStyle& s : run.pairs.styles)
    if ((law == Law::lj) == s.name.starts_with("lj/") && (law == Law::rounded) == s.name.starts_with("body")) return &s;
  return &run.pairs.styles.front();
}

std::vector<PairCoefficient> mixed(const Run& run, const std::vector<int>& types) {
  using Law = PairCoefficient::Law;
  if (run.pairs.styles.empty()) return {};
  std::vector<PairCoefficient> all;
  for (const Law law : {Law::hertz, Law::lj, Law::rounded}) {
    const auto last = [&](int i, int j) -> const PairCoefficient* {
      const PairCoefficient* found = nullptr;
      for (const PairCoefficient& c : run.pairs.coefficients)
        if (c.law == law && c.covers(i, j)) found = &c;
      return found;
    };
    const PairStyle& style = *style_of(run, law);
    for (std::size_t a = 0; a < types.size(); ++a)
      for (std::size_t b = a + 1; b < types.size(); ++b) {
        const auto named = [&](const PairCoefficient& c) { return c.covers(types[a], types[b]); };
        const auto& said = run.pairs.coefficients;
        if (last(types[a], types[b])) continue;
        if ((run.pairs.hybrid || run.pairs.overlay) && std::any_of(said.begin(), said.end(), named)) continue;   // of any style, or none
        const PairCoefficient *p = last(types[a], types[a]), *q = last(types[b], types[b]);
        if (!p || !q) continue;
        PairCoefficient m = *q;
        m.first = {types[a], types[a]}, m.second = {types[b], types[b]};
        m.mixed = true, m.text = "mixed of types " + std::to_string(types[a]) + " and " + std::to_string(types[b]);
        const auto mean = [&](double x, double y) { return style.mix == PairStyle::Mix::geometric ? std::sqrt(x * y) : (x + y) / 2; };
        if (law == Law::hertz) {
          if (p->effective_modulus && q->effective_modulus)
            m.effective_modulus = std::sqrt(*p->effective_modulus * *q->effective_modulus);
          else if (!p->effective_modulus && !q->effective_modulus && (p->youngs_modulus == 0 || q->youngs_modulus == 0))
            m.youngs_modulus = 0;
          else if (!p->effective_modulus && !q->effective_modulus) {
            const auto soft = [](const PairCoefficient& c) { return (1 - c.poissons_ratio * c.poissons_ratio) / c.youngs_modulus; };
            m.effective_modulus = 1 / (soft(*p) + soft(*q));
          } else continue;
          m.unlike = p->damping != q->damping;
        } else if (law == Law::lj) {
          if (style.mix == PairStyle::Mix::sixthpower) {
            const double s = std::pow(p->sigma, 6) + std::pow(q->sigma, 6);
            m.epsilon = s > 0 ? 2 * std::sqrt(p->epsilon * q->epsilon) * std::pow(p->sigma * q->sigma, 3) / s : 0;
            m.sigma = std::pow(s / 2, 1.0 / 6), m.cutoff = std::pow((std::pow(p->cutoff, 6) + std::pow(q->cutoff, 6)) / 2, 1.0 / 6);
            m.inner_cutoff = std::pow((std::pow(p->inner_cutoff, 6) + std::pow(q->inner_cutoff, 6)) / 2, 1.0 / 6);
          } else {
            m.epsilon = std::sqrt(p->epsilon * q->epsilon), m.sigma = mean(p->sigma, q->sigma), m.cutoff = mean(p->cutoff, q->cutoff);
            m.inner_cutoff = mean(p->inner_cutoff, q->inner_cutoff);
          }
        } else m.k_n = std::sqrt(p->k_n * q->k_n), m.k_na = std::sqrt(p->k_na * q->k_na);
        all.push_back(std::move(m));
      }
  }
  return all;
}

bool nothing(const PairCoefficient& c) {
  if (c.law == PairCoefficient::Law::hertz) return c.effective_modulus.value_or(c.youngs_modulus) == 0;
  return c.law == PairCoefficient::Law::lj ? c.epsilon == 0 || c.cutoff == 0 || c.sigma == 0 : false;
}

int excluded(const std::array<double, 3>& lj, const std::array<double, 3>& coul, bool granular, bool& partial) {
  int deepest = 0;
  bool gap = false;
  for (std::size_t c = 0; c < 3; ++c) {
    const bool out = lj[c] == 0 && (!granular || coul[c] == 0);
    if (out && deepest == static_cast<int>(c)) deepest = static_cast<int>(c) + 1;
    else if (out) gap = true;
    if (!out && lj[c] != 1) partial = true;
  }
  return gap ? -1 : deepest;
}

}  // namespace elamin::script
