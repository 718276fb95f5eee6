#include "path/beside_contact.hpp"

#include "core/dense.hpp"
#include "model/entities.hpp"
#include "path/arc.hpp"
#include "path/limits.hpp"

#include <algorithm>
#include <cmath>
#include <functional>

namespace elamin {

using namespace limits;

namespace {

// How far before a place where a contact is lost it bears no more than rounding: a critical point that is nearer cannot be told from the contact's.
// most: the farthest; before: the state that much before.
double where_it_fades(Energy& energy, const ContactKey& key, const std::function<State(double)>& before, double most) {
  double by = most;
  for (int k = 0; k < contact_event::most_closing; ++k) {
    const double part = borne(energy, key, before(by));
    if (!(part > 2 * contact_event::unloaded)) break;
    by *= std::pow(contact_event::unloaded / part, 2.0 / 3);    // Hertz: F ∝ overlap^(3/2)
  }
  return by;
}

// What two entities do to each other jumps there in its stiffness, so that the branch has a kink: `at` gets what is true
// just before it, `beyond` what is true behind. way, load_change: to the kink.
void look_both_ways(Newton& newton, ContactChange& change, const std::vector<ContactKey>& keys, const Vector& way, double load_change) {
  Energy& energy = newton.energy();
  const Kinematics& kinematics = energy.kinematics();
  const State& state = change.at.point.state;
  const auto rate = [&](const ContactKey& key, const Vector& x, double load, double part) {
    return (gap(energy, key, moved_by(kinematics, state, x, load, part)) - gap(energy, key, moved_by(kinematics, state, x, load, -part))) / (2 * part);
  };
  double part = 0;
  for (const ContactKey& key : keys) {
    const double size = size_of(energy.model(), key.particle), moved = std::abs(rate(key, way, load_change, 1e-4));
    const double least = key.feature >= 0 ? contact_event::least_beside * size : std::max(contact_event::exact_rounding * size, coordinate_rounding(key, state));
    if (!(contact_event::most_beside * moved > least)) return;
    // Stiff bodies overlap by hardly more than that in all.
    double beside = std::min(contact_event::beside * size / moved, contact_event::most_beside);
    if (key.feature < 0 && !change.after.count(key))
      beside = where_it_fades(energy, key, [&](double by) { return moved_by(kinematics, state, way, load_change, -by); }, beside);
    part = std::max(part, beside);
  }
  const auto side = [&](double where) {
    Equilibrium e = assess(newton, moved_by(kinematics, state, way, load_change, where), change.at.point.report);
    e.point.state = state, e.point.energy = change.at.point.energy;
    return e;
  };
  change.at = side(-part);
  change.beyond = side(part);
  const Vector& tangent = change.beyond->tangent;
  // Over as long a way; where nothing moves beyond, over as large a change of the load factor.
  const bool moves = tangent.norm() * std::abs(load_change) > epsilon * way.norm();
  const double small = part * std::max(moves || load_change == 0 ? way.norm() / std::max(tangent.norm(), 1e-300) : 0.0, std::abs(load_change));
  int ahead = 0, back = 0;
  for (const ContactKey& key : keys) {
    const double r = rate(key, tangent, 1, small) * (change.after.count(key) ? -1 : 1);       // > 0: to the side beyond
    ++(r > 0 ? ahead : back);
  }
  // What floats only beyond has no tangent there to tell.
  const bool free = change.beyond->point.stability.zero > change.at.point.stability.zero;
  if (ahead == 0 || back == 0) change.onward = free ? (load_change < 0 ? -1 : 1) : back == 0 ? 1 : -1;
}

// The Morse index a little behind contacts that have just been made, of an equilibrium in the direction that the branch takes if they are stiff; nothing where none
// is found. load_change: the scale of the load factor.
std::optional<int> index_behind(Newton& newton, const Equilibrium& at, const std::vector<ContactKey>& made, double load_change) {
  const std::optional<Rates> rates = along_contacts(newton, at, made, load_change);
  if (!rates) return {};
  const Energy& energy = newton.energy();
  const Metric metric{rates->x.norm() * std::abs(load_change), std::abs(load_change)};
  const double size = std::sqrt(metric.dot(rates->x, rates->load, rates->x, rates->load));
  const Arc arc(newton, at, {rates->x / size, rates->load / size}, metric);
  for (double part = contact_event::onward.front(); part >= contact_event::least_beside; part /= 100) {
    const Equilibrium e = arc.at(part, at);
    // An overlap by rounding is none: of stiff contacts the index may change before it is more.
    const auto closed = [&](const ContactKey& key) { return gap(energy, key, e.point.state) < -contact_event::rounding * size_of(energy.model(), key.particle); };
    if (e.point.report.converged() && std::all_of(made.begin(), made.end(), closed) && arc.distance(e.point.state) < part) return e.point.stability.negative;
  }
  return {};
}

// What is true where these contacts change as long as they are open: by rounding they may be closed there, and a stiff contact that overlaps by rounding alone may
// have more stiffness than the structure. They are opened across their surfaces: along the branch they may overlap by no more anywhere.
Equilibrium opened(Newton& newton, const Equilibrium& at, const std::vector<ContactKey>& changed, double load_change) {
  Energy& energy = newton.energy();
  State open = at.point.state;
  Vector row;
  double by_load = 0;
  bool closed = false;
  for (const ContactKey& key : changed) {
    if (key.feature >= 0) return at;
    if (!(gap(energy, key, at.point.state) < 0) || !slope(energy, key, at.point.state, load_change, row, by_load) || row.isZero(0)) continue;
    energy.kinematics().retract(open, row, std::max(contact_event::rounding * size_of(energy.model(), key.particle), coordinate_rounding(key, open)) / row.squaredNorm());
    closed = true;
  }
  if (!closed) return at;
  Equilibrium e = assess(newton, open, at.point.report);
  e.point.state = at.point.state, e.point.energy = at.point.energy, e.family = at.family;
  return e;
}

}  // namespace

void find_beyond(Newton& newton, ContactChange& change, const std::vector<ContactKey>& changed, const Vector& way, double load_change, int negative) {
  if (change.at.slack) return;
  std::vector<ContactKey> here = changed;
  change.at = opened(newton, change.at, changed, load_change);
  const int at = change.at.point.stability.negative;
  // Where contacts of particles are made the index has changed before.
  std::erase_if(here, [&](const ContactKey& key) { return key.feature < 0 && (at != negative ? change.after.count(key) > 0 : negative == 0 || !change.after.count(key)); });
  if (here.empty()) return;
  const Equilibrium open = change.at;
  look_both_ways(newton, change, here, way, load_change);
  const bool bodies = std::any_of(here.begin(), here.end(), [](const ContactKey& key) { return key.feature >= 0; });
  if (!change.beyond || bodies || at != negative) return;
  // An overlap as large as the way's may be far beyond those that the branch comes to.
  const bool stays = change.beyond->point.stability.negative == at || index_behind(newton, open, here, load_change) == at;
  if (stays) change.at = open, change.beyond.reset(), change.onward = 0;
}

std::optional<Equilibrium> onward_from(Newton& newton, const Equilibrium& at, const std::vector<ContactKey>& here, const ContactSet& before, double ahead,
                                       int negative) {
  if (at.slack) return {};
  Energy& energy = newton.energy();
  const Kinematics& kinematics = energy.kinematics();
  const std::optional<Rates> rates = along_contacts(newton, at, here, ahead);
  const Vector tangent = rates ? Vector(rates->x / rates->load) : at.tangent;
  for (const double part : contact_event::onward) {
    const double change = part * ahead;
    State state = moved_by(kinematics, at.point.state, change * tangent, change, 1);
    const Report report = newton.correct(state, at.zero_modes);
    if (!report.converged() || energy.collision_free_step(at.point.state, state) < 1) continue;
    Equilibrium e = assess(newton, state, report);
    const double reach = std::max({tangent.norm(), at.tangent.norm(), e.tangent.norm()}) * std::abs(change);
    if (e.point.stability.negative != negative || kinematics.difference(at.point.state, state).norm() > 2 * reach) continue;
    const auto closed = [&](const ContactKey& key) { return gap(energy, key, state) < 0; };
    const auto changed = [&](const ContactKey& key) { return closed(key) != (before.count(key) > 0); };
    if (std::any_of(here.begin(), here.end(), closed) && std::any_of(here.begin(), here.end(), changed)) return e;
  }
  return {};
}

std::optional<Rates> along_contacts(Newton& newton, const Equilibrium& at, const std::vector<ContactKey>& made, double load) {
  Energy& energy = newton.energy();
  Factors& factors = newton.factors();
  const Eigen::Index m = static_cast<Eigen::Index>(made.size());
  Eigen::MatrixXd normals(at.tangent.size(), m), yields(at.tangent.size(), m);
  Vector closing(m), row;
  energy.evaluate(at.point.state);
  if (!factors.factorize_holding(at.zero_modes)) return {};
  for (Eigen::Index k = 0; k < m; ++k) {
    double by_load = 0;
    if (!slope(energy, made[static_cast<std::size_t>(k)], at.point.state, load, row, by_load)) return {};
    normals.col(k) = row, yields.col(k) = factors.solve_holding(row);
    closing[k] = -(row.dot(at.tangent) + by_load);
  }
  const Vector force = solved(normals.transpose() * yields, closing);      // per λ' = 1
  if (!force.allFinite() || force.minCoeff() * force.maxCoeff() <= 0) return {};
  const double sense = force[0] > 0 ? 1 : -1;
  return Rates{sense * (at.tangent + yields * force), sense};
}

}  // namespace elamin
