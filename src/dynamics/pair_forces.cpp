#include "dynamics/pair_forces.hpp"

#include "core/near_pairs.hpp"
#include "laws/cohesion.hpp"
#include "laws/hertz_contact.hpp"

#include <algorithm>

namespace elamin {

namespace {
constexpr double alike = 2;                      // ratio of reaches up to which one grid is good
constexpr std::int64_t most_cells = 8;           // for every particle; more: they are far apart, see core/near_pairs
}

PairList::PairList(const Model& model, const ContactRules& rules, double skin) : model_(model), rules_(rules), skin_(skin) {
  double smallest = infinity, largest = 0;
  for (int i = 0; i < model.particles(); ++i) {
    if (!(rules.cutoff_radius(i) > 0)) continue;
    members_.push_back(i);
    smallest = std::min(smallest, rules.cutoff_radius(i)), largest = std::max(largest, rules.cutoff_radius(i));
  }
  cell_ = 2 * largest + skin;
  alike_ = largest <= alike * smallest;
  cell_of_.resize(model.particles()), sorted_.resize(model.particles());
  at_ = Columns(model.particles()), far_.resize(padded(model.particles()));
}

void PairList::find(const Columns& x) {
  for (auto& list : pairs_) list.clear();
  if (members_.empty()) return;
  alike_ ? find_on_grid(x) : find_at_all_sizes(x);
}

void PairList::offer(int i, int j, double squared) {
  const auto within = [&](double distance) { return squared <= (distance + skin_) * (distance + skin_); };
  if (const int t = rules_.hertz(i, j); t >= 0 && model_.contacts[t].effective_modulus > 0 &&
                                        within((model_.diameter[i] + model_.diameter[j]) / 2))
    pairs_[0].push_back({i, j, t});
  if (const int t = rules_.lj(i, j); t >= 0 && model_.contacts[t].epsilon != 0 && within(model_.contacts[t].cutoff))
    pairs_[1].push_back({i, j, t});
}

void PairList::find_on_grid(const Columns& x) {
  Vec3 lo = Vec3::Constant(infinity), hi = -lo;
  for (const int i : members_) lo = lo.cwiseMin(x.at(i)), hi = hi.cwiseMax(x.at(i));
  const Vec3 cells = ((hi - lo) / cell_).array().floor() + 1;
  if (!(cells.prod() <= static_cast<double>(most_cells * static_cast<std::int64_t>(members_.size()) + 1000)))
    return find_at_all_sizes(x);
  const int nx = static_cast<int>(cells[0]), ny = static_cast<int>(cells[1]), nz = static_cast<int>(cells[2]);
  const double per_length = 1 / cell_;
  const auto along = [&](double a, double from, int n) { return std::min(static_cast<int>((a - from) * per_length), n - 1); };
  start_.assign(static_cast<std::size_t>(nx) * ny * nz + 1, 0);
  for (const int i : members_) {
    cell_of_[i] = (along(x.z[i], lo[2], nz) * ny + along(x.y[i], lo[1], ny)) * nx + along(x.x[i], lo[0], nx);
    ++start_[cell_of_[i] + 1];
  }
  for (std::size_t c = 1; c < start_.size(); ++c) start_[c] += start_[c - 1];
  for (const int i : members_) {
    const int at = start_[cell_of_[i]]++;
    sorted_[at] = i, at_.x[at] = x.x[i], at_.y[at] = x.y[i], at_.z[at] = x.z[i], far_[at] = rules_.cutoff_radius(i);
  }
  for (std::size_t c = start_.size() - 1; c > 0; --c) start_[c] = start_[c - 1];
  start_[0] = 0;
  // Of two particles the one that is sorted first looks for the other: in the cells behind its own. Cells side by side are
  // one stretch of particles.
  int at = 0;
  for (int cz = 0; cz < nz; ++cz)
    for (int cy = 0; cy < ny; ++cy)
      for (int cx = 0; cx < nx; ++cx) {
        const int row = (cz * ny + cy) * nx, left = std::max(cx - 1, 0), right = std::min(cx + 1, nx - 1) + 1;
        std::array<std::pair<int, int>, 5> stretches;
        int count = 1;                                            // the first one: what follows here and in the next cell
        stretches[0].second = start_[row + right];
        const auto add = [&](int y, int z) {
          if (y >= 0 && y < ny && z < nz) stretches[count++] = {start_[(z * ny + y) * nx + left], start_[(z * ny + y) * nx + right]};
        };
        add(cy + 1, cz), add(cy - 1, cz + 1), add(cy, cz + 1), add(cy + 1, cz + 1);
        for (const int end = start_[row + cx + 1]; at < end; ++at) {
          stretches[0].first = at + 1;
          for (int k = 0; k < count; ++k) search(at, stretches[k].first, stretches[k].second);
        }
      }
}

// The particles from `begin` to `end`, as sorted, that are near the one at `at`.
void PairList::search(int at, int begin, int end) {
  const Triple<Lanes> own{at_.x[at], at_.y[at], at_.z[at]};
  const Lanes cutoff = far_[at] + skin_;
  for (int j = begin; j < end; j += Lanes::count) {
    const Triple<Lanes> d = at_.load(j) - own;
    const Lanes far = Lanes::load(&far_[j]) + cutoff, squared = dot(d, d);
    unsigned near = below(squared, far * far);
    if (end - j < Lanes::count) near &= (1u << (end - j)) - 1;
    for (int k = 0; near != 0; ++k, near >>= 1)
      if (near & 1) offer(std::min(sorted_[at], sorted_[j + k]), std::max(sorted_[at], sorted_[j + k]), squared[k]);
  }
}

void PairList::find_at_all_sizes(const Columns& x) {
  Field centers(3, model_.particles());
  x.copy_to(centers);
  std::vector<double> radii(model_.particles(), 0.0);
  for (const int i : members_) radii[i] = rules_.cutoff_radius(i) + skin_ / 2;
  for (const auto& [i, j] : near_pairs(centers, radii, [](int, int) { return true; })) offer(i, j, (x.at(j) - x.at(i)).squaredNorm());
}

namespace {

bool damps(const ContactDamping& d) { return d.model != ContactDamping::Model::none && d.coefficient > 0; }
bool rubs(const ContactDamping& d) { return damps(d) && d.tangential > 0 && d.friction > 0; }

// b − a of the rows of four pairs.
[[gnu::always_inline]] inline Triple<Lanes> differences(const Rows& rows, const int* first, const int* second) {
  return columns_of(rows.row[second[0]] - rows.row[first[0]], rows.row[second[1]] - rows.row[first[1]],
                    rows.row[second[2]] - rows.row[first[2]], rows.row[second[3]] - rows.row[first[3]]);
}

// The first `count` of four pairs: + on the second particle, − on the first.
[[gnu::always_inline]] inline void push(Rows& force, const Triple<Lanes>& f, const int* first, const int* second, int count) {
  Lanes row[4] = {f.x, f.y, f.z, Lanes(0.0)};
  transpose(row[0], row[1], row[2], row[3]);
  for (int k = 0; k < count; ++k) force.row[second[k]] += row[k], force.row[first[k]] -= row[k];
}

[[gnu::always_inline]] inline void add_torque(Rows& torque, const Triple<Lanes>& t, const int* particle, int count) {
  Lanes row[4] = {t.x, t.y, t.z, Lanes(0.0)};
  transpose(row[0], row[1], row[2], row[3]);
  for (int k = 0; k < count; ++k) torque.row[particle[k]] += row[k];
}

}  // namespace

PairForces::PairForces(const Model& model, const ContactRules& rules, double skin) : model_(model), list_(model, rules, skin), hertz_(model.contacts.size()) {
  for (const double d : model.diameter) radius_.push_back(d / 2);
  for (const PairContact& c : model.contacts) {
    if (c.law != PairContact::Law::hertz) continue;
    damped_ = damped_ || damps(c.damping);
    rubs_ = rubs_ || elamin::rubs(c.damping);
  }
}

void PairForces::put(const PairList::Pair& pair) {
  const auto [i, j, t] = pair;
  Hertz& to = hertz_[t];
  const double ri = radius_[i], rj = radius_[j];
  const double stiffness = hertz_stiffness(model_.contacts[t].effective_modulus, ri, rj);
  to.first.push_back(i), to.second.push_back(j);
  to.cutoff.push_back(ri + rj), to.stiffness.push_back(stiffness);
  if (!damps(model_.contacts[t].damping)) return;
  const double mi = model_.mass(i), mj = model_.mass(j);
  to.coefficient.push_back(DampedContact(model_.contacts[t].damping, mi * mj / (mi + mj), stiffness, ri * (rj / (ri + rj))).coefficient);
}

void PairForces::Cohesive::clear() {
  first.clear(), second.clear();
  for (std::vector<double>* column : {&cutoff, &epsilon, &sigma, &inner, &force, &a, &b}) column->clear();
}

void PairForces::find(const Columns& x) {
  list_.find(x);
  for (Hertz& h : hertz_) h.first.clear(), h.second.clear(), h.cutoff.clear(), h.stiffness.clear(), h.coefficient.clear();
  for (const PairList::Pair& p : list_.hertz()) put(p);
  cohesive_.clear(), smooth_.clear();
  for (const PairList::Pair& p : list_.lj()) {
    const PairContact& c = model_.contacts[p.table];
    const bool smooth = c.cutoff_style == CutoffStyle::smooth;
    Cohesive& to = smooth ? smooth_ : cohesive_;                // shifted: the same force
    to.first.push_back(p.first), to.second.push_back(p.second);
    to.cutoff.push_back(c.cutoff), to.epsilon.push_back(c.epsilon), to.sigma.push_back(c.sigma);
    if (!smooth) continue;
    const Cohesion::Shell t = Cohesion{c.epsilon, c.sigma, c.cutoff, c.cutoff_style, c.inner_cutoff}.shell();
    to.inner.push_back(c.inner_cutoff), to.force.push_back(t.force), to.a.push_back(t.a), to.b.push_back(t.b);
  }
  closed_.resize(std::max(list_.hertz().size(), list_.lj().size()) + 8);
}

void PairForces::add(const Movement& movement, Pushes& pushes) {
  for (std::size_t t = 0; t < hertz_.size(); ++t) {
    if (hertz_[t].first.empty()) continue;
    const ContactDamping& d = model_.contacts[t].damping;
    if (elamin::rubs(d)) add<true, true>(hertz_[t], d, movement, pushes);
    else if (damps(d)) add<true, false>(hertz_[t], d, movement, pushes);
    else add<false, false>(hertz_[t], d, movement, pushes);
  }
  if (!cohesive_.first.empty()) add<false>(cohesive_, movement, pushes);
  if (!smooth_.first.empty()) add<true>(smooth_, movement, pushes);
}

int PairForces::find_closed(const std::vector<int>& first, const std::vector<int>& second, const std::vector<double>& cutoff,
                            const Rows& x) {
  const int pairs = static_cast<int>(first.size());
  int count = 0, p = 0;
  for (; p + 4 <= pairs; p += 4) {
    const Triple<Lanes> d = differences(x, &first[p], &second[p]);
    const Lanes limit = Lanes::load(&cutoff[p]);
    const unsigned closed = below(dot(d, d), limit * limit);
    for (int k = 0; k < 4; ++k) closed_[count] = p + k, count += closed >> k & 1;
  }
  for (; p < pairs; ++p) {
    const Lanes d = x.row[second[p]] - x.row[first[p]];
    closed_[count] = p, count += d[0] * d[0] + d[1] * d[1] + d[2] * d[2] < cutoff[p] * cutoff[p];
  }
  for (int k = 0; k < 3; ++k) closed_[count + k] = count > 0 ? closed_[count - 1] : 0;
  return count;
}

template <bool damped, bool rubs>
void PairForces::add(const Hertz& pairs, const ContactDamping& damping, const Movement& movement, Pushes& pushes) {
  const int roots = DampedContact(damping, 1, 1, 1).roots;
  const int count = find_closed(pairs.first, pairs.second, pairs.cutoff, movement.position);
  for (int at = 0; at < count; at += 4) {
    const int* c = &closed_[at];
    const int first[4] = {pairs.first[c[0]], pairs.first[c[1]], pairs.first[c[2]], pairs.first[c[3]]};
    const int second[4] = {pairs.second[c[0]], pairs.second[c[1]], pairs.second[c[2]], pairs.second[c[3]]};
    const int used = std::min(count - at, 4);
    const Triple<Lanes> d = differences(movement.position, first, second);
    const Lanes r = sqrt(dot(d, d)), inv = inverse(r), overlap = max(Lanes::gather(pairs.cutoff.data(), c) - r, Lanes(0.0));
    const Lanes elastic = HertzContact::push(overlap, Lanes::gather(pairs.stiffness.data(), c));
    push(pushes.force, (elastic * inv) * d, first, second, used);
    if constexpr (damped) {
      const Triple<Lanes> n = inv * d, v = differences(movement.velocity, first, second);
      const Lanes along = dot(v, n);
      const Lanes eta = damping_coefficient(overlap, Lanes::gather(pairs.coefficient.data(), c), roots);
      const Lanes slow = -(eta * along);
      Triple<Lanes> f = slow * n;
      if constexpr (rubs) {
        Lanes radii[2];
        Triple<Lanes> turning{0.0, 0.0, 0.0};
        for (const int side : {0, 1}) {
          const int* p = side ? second : first;
          radii[side] = Lanes::gather(radius_.data(), p);
          turning = turning + radii[side] * columns_of(movement.angular_velocity.row[p[0]], movement.angular_velocity.row[p[1]],
                                                       movement.angular_velocity.row[p[2]], movement.angular_velocity.row[p[3]]);
        }
        const Triple<Lanes> rub = friction(n, v, along, turning, elastic + slow, Lanes(damping.tangential) * eta, Lanes(damping.friction));
        f = f + rub;
        const Triple<Lanes> t = cross(n, rub);
        for (const int side : {0, 1})
          add_torque(pushes.torque, (Lanes(0.5) * overlap - radii[side]) * t, side ? second : first, used);
      }
      push(pushes.damping, f, first, second, used);
    }
  }
}

template <bool smooth>
void PairForces::add(const Cohesive& pairs, const Movement& movement, Pushes& pushes) {
  const int count = find_closed(pairs.first, pairs.second, pairs.cutoff, movement.position);
  for (int at = 0; at < count; at += 4) {
    const int* c = &closed_[at];
    const int first[4] = {pairs.first[c[0]], pairs.first[c[1]], pairs.first[c[2]], pairs.first[c[3]]};
    const int second[4] = {pairs.second[c[0]], pairs.second[c[1]], pairs.second[c[2]], pairs.second[c[3]]};
    const Triple<Lanes> d = differences(movement.position, first, second);
    const Lanes q = dot(d, d), depth = Lanes::gather(pairs.epsilon.data(), c), sigma = Lanes::gather(pairs.sigma.data(), c);
    Lanes f;
    if constexpr (smooth) {                                     // the shell's force, and what the other adds to it inside
      const Lanes r = sqrt(q), inner = Lanes::gather(pairs.inner.data(), c), cutoff = Lanes::gather(pairs.cutoff.data(), c), within = min(r, inner);
      const Lanes u = min(max(cutoff - r, Lanes(0.0)), cutoff - inner);
      const Lanes shell = u * u * (Lanes::gather(pairs.a.data(), c) + Lanes::gather(pairs.b.data(), c) * u);
      f = (Cohesion::push(within * within, depth, sigma) * within - Lanes::gather(pairs.force.data(), c) + shell) / r;
    } else {
      f = Cohesion::push(q, depth, sigma);
    }
    push(pushes.force, f * d, first, second, std::min(count - at, 4));
  }
}

}  // namespace elamin
