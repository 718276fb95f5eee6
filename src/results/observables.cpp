#include "results/observables.hpp"

#include "core/error.hpp"
#include "core/find.hpp"
#include "laws/rounded/rigid_step.hpp"
#include "laws/rounded/rotation.hpp"
#include "model/entities.hpp"
#include "results/fields.hpp"
#include "results/path_rates.hpp"
#include "results/shape_measures.hpp"

#include <algorithm>
#include <limits>
#include <map>
#include <set>

namespace elamin {

namespace {

constexpr double flat = 1e-12;                        // an area of the square of all there is

double component(const Vec3& v, Component c) {
  switch (c) {
    case Component::x: return v[0];
    case Component::y: return v[1];
    case Component::z: return v[2];
    case Component::norm: return length_of(v);
    case Component::c11: return v[0];
    case Component::c22: return v[1];
    case Component::c12: return v[2];
    case Component::most: return principal(v)[0];
    case Component::least: return principal(v)[1];
  }
  return 0;
}

/// Bears a force as a hard contact does, or overlaps by more than rounding: what an event has located as touching is not closed, whichever sign its gap has.
bool closed(const Model& model, const Touch& t) {
  constexpr double rounding = 1e-12;                  // of the size
  return t.bears || t.gap < -rounding * size_of(model, t.particle);
}

bool is_number(Quantity q) { return q > Quantity::angular_velocity && q != Quantity::contact_force && !of_sheets(q); }
bool of_bodies(Quantity q) { return q == Quantity::rotation || q == Quantity::torque || q == Quantity::angular_velocity; }
Vec3 as_vector(double scalar) { return {scalar, 0, 0}; }

/// One number of many; what is a number stands in x.
double reduced(const std::vector<Vec3>& values, Component c, Reduce reduce) {
  double least = infinity, most = -infinity;
  ExactSum all;
  ExactSum sums[3];
  for (const Vec3& v : values) {
    const double value = component(v, c);
    least = std::min(least, value), most = std::max(most, value);
    all.add(value);
    for (int d = 0; d < 3; ++d) sums[d].add(v[d]);
  }
  switch (reduce) {
    case Reduce::min: return least;
    case Reduce::max: return most;
    case Reduce::mean: return all.value() / static_cast<double>(values.size());
    case Reduce::sum: return component({sums[0].value(), sums[1].value(), sums[2].value()}, c);
  }
  return 0;
}

/// ω = R I⁻¹ Rᵀ L.
Vec3 angular_velocity_of(const Body& body, const Pose& pose, const Vec3& momentum) {
  return pose.rotation * (RigidMass(body.mass, body.inertia).inverse_inertia * (pose.rotation.conjugate() * momentum));
}

}  // namespace

/// What the observables of one state have in common, computed when first asked for.
struct Observables::Seen {
  const Model& model;
  const State& state;
  const Field& forces;
  const std::vector<Touch>& touches;
  const Motion* moving;
  std::vector<double> values = {};                    // so far
  std::optional<std::vector<BondField>> of_bonds = {};
  std::optional<std::vector<AngleField>> of_angles = {};
  std::optional<std::vector<StressResultants>> of_sheets = {};
  std::optional<Field> of_contacts = {};
  std::optional<std::vector<double>> rates = {};

  const std::vector<BondField>& bonds() { return of_bonds ? *of_bonds : of_bonds.emplace(bond_fields(model, state)); }
  const std::vector<AngleField>& angles() { return of_angles ? *of_angles : of_angles.emplace(angle_fields(model, state)); }
  const std::vector<StressResultants>& sheets() {
    return of_sheets ? *of_sheets : of_sheets.emplace(stress_resultants(model, state, bonds(), angles()));
  }
  const Field& contacts() { return of_contacts ? *of_contacts : of_contacts.emplace(contact_forces(model, touches)); }
};

Observables::Observables(const Problem& problem, const Model& model)
    : problem_(problem), model_(model), held_(decltype(held_)::Constant(3, model.particles() + 2 * static_cast<int>(model.bodies.size()), false)) {
  Mistakes mistakes(problem.file);
  std::set<std::size_t> parts;                        // of derivatives
  for (std::size_t k = 0; k < problem.observe.size(); ++k) {
    const ObserveTable& o = problem.observe[k];
    subjects_.push_back(subject_of(o, mistakes));
    if (o.quantity == Quantity::energy && !energy_) energy_ = std::make_unique<Energy>(model);
    if (o.quantity != Quantity::derivative) continue;
    for (const std::size_t part : made_of(problem.observe, k))
      if (part != k) parts.insert(part);
  }
  mistakes.raise();
  if (!parts.empty()) rates_ = std::make_unique<PathRates>(problem, model, std::vector(parts.begin(), parts.end()));
  hold_supports();
}

Observables::~Observables() = default;

Observables::Subject Observables::subject_of(const ObserveTable& o, Mistakes& mistakes) const {
  const auto wrong = [&](const char* key, const std::string& what) { mistakes.add(o.place, key, what); };
  Subject subject;
  if (of_observables(o.quantity)) return subject;
  const auto members = [&](const auto& of) {
    std::vector<int> entities;
    if (!of_bodies(o.quantity)) entities = of.particles;
    for (const int body : of.bodies) entities.push_back(model_.particles() + body);
    return entities;
  };
  const auto find = [&](const char* key, const std::string& name, std::vector<int>& entities) {
    if (const Group* group = find_named(model_.groups, name)) return entities = members(*group), true;
    if (const Wall* wall = find_named(model_.walls, name); wall && &entities == &subject.entities)
      return entities = members(*wall), subject.wall = static_cast<int>(wall - model_.walls.data()), true;
    std::string known;
    for (const Group& g : model_.groups) known += (known.empty() ? "" : ", ") + g.name;
    for (const Wall& w : model_.walls) known += ", " + w.name;
    wrong(key, "there is no group \"" + name + "\"; there are " + known);
    return false;
  };
  subject.known = find("group", o.group, subject.entities);
  if (!o.to.empty()) find("to", o.to, subject.to);
  if (!o.through.empty()) find("through", o.through, subject.through);
  if (!subject.known) return subject;
  if (subject.wall >= 0 && o.quantity != Quantity::reaction && o.quantity != Quantity::gap && o.quantity != Quantity::contacts) {
    wrong("quantity", "\"" + o.group + "\" is a wall; it has a reaction, gap and contacts only");
  } else if (subject.entities.empty() && subject.wall < 0) {
    wrong("group", of_bodies(o.quantity) ? "the group \"" + o.group + "\" has no body; particles have no rotation, torque and angular velocity"
                                                 : "the group \"" + o.group + "\" has no particle and no body; at least one is needed");
  }
  const auto has = [&](int i) { return std::binary_search(subject.entities.begin(), subject.entities.end(), i); };
  for (std::size_t b = 0; of_bonds(o.quantity) && b < model_.bonds.size(); ++b)
    if (has(model_.bonds[b].particles[0]) && has(model_.bonds[b].particles[1])) subject.inside.push_back(static_cast<int>(b));
  for (std::size_t a = 0; of_angles(o.quantity) && a < model_.angles.size(); ++a)
    if (has(model_.angles[a].particles[1])) subject.inside.push_back(static_cast<int>(a));
  if (o.about) subject.about = *o.about;
  else if (model_.plane_normal) subject.about = Vec3::Unit(*model_.plane_normal);
  if (const std::size_t least = least_row(o.quantity); least > 0) {
    const auto bodies = std::lower_bound(subject.entities.begin(), subject.entities.end(), model_.particles());
    subject.entities.erase(bodies, subject.entities.end());
    if (subject.entities.size() < least)
      wrong("group", "the group \"" + o.group + "\" has too few particles for a row; it must have " + std::to_string(least));
    else if (o.quantity == Quantity::area) {
      const Vec3 area = vector_area(model_.start, subject.entities);
      subject.about = area.normalized();
      if (!(length_of(area) > flat * std::pow(sides_of(model_.start).maxCoeff(), 2)))
        wrong("group", "the group \"" + o.group + "\" encloses no area at the start, along whose normal it could be counted");
    }
  }
  return subject;
}

void Observables::hold_supports() {
  const auto hold = [&](int site, const std::array<bool, 3>& held) {
    for (int c = 0; c < 3; ++c) held_(c, site) = held_(c, site) || held[c];
  };
  for (const Support& s : model_.supports) {
    for (const int i : s.particles) hold(i, s.held);
    for (const int b : s.bodies) hold(model_.particles() + 2 * b, s.held), hold(model_.particles() + 2 * b + 1, s.constrained_rotations);
  }
}

bool Observables::sufficient(const std::vector<Touch>& touches) const {
  for (std::size_t k = 0; k < subjects_.size(); ++k) {
    const ObserveTable& o = problem_.observe[k];
    if (o.quantity != Quantity::gap) continue;
    const std::vector<double> all = gaps(subjects_[k].wall, touches);
    const auto known = [&](int i) { return all[i] < infinity; };
    const std::vector<int>& of = subjects_[k].entities;
    if (o.reduce == Reduce::min ? std::none_of(of.begin(), of.end(), known) : !std::all_of(of.begin(), of.end(), known))
      return false;
  }
  return true;
}

std::vector<double> Observables::evaluate(const State& state, const Field& forces, const std::vector<Touch>& touches,
                                          const Motion* moving) const {
  Seen seen{model_, state, forces, touches, moving};
  for (std::size_t k = 0; k < subjects_.size(); ++k) {
    const ObserveTable& o = problem_.observe[k];
    const Subject& subject = subjects_[k];
    double value = 0;
    if (o.quantity == Quantity::difference) value = number(o.of[0], seen.values) - number(o.of[1], seen.values);
    else if (o.quantity == Quantity::derivative) value = derivative(o, seen);
    else if (elamin::of_shape(o.quantity)) value = of_shape(o, subject, state);
    else value = reduced(subject.wall >= 0 ? of_wall(o, subject, touches) : of_group(o, subject, seen),
                         is_number(o.quantity) ? Component::x : o.component, o.reduce);
    seen.values.push_back(value);
  }
  return seen.values;
}

/// The value of an observable further up.
double Observables::number(const std::string& name, const std::vector<double>& values) const {
  for (std::size_t k = 0; k < values.size(); ++k)
    if (problem_.observe[k].name == name) return values[k];
  return std::numeric_limits<double>::quiet_NaN();
}

double Observables::derivative(const ObserveTable& o, Seen& seen) const {
  if (!seen.rates) seen.rates = rates_->at(seen.state);
  const auto rate = [&](const std::string& name) {
    for (std::size_t k = 0; k < rates_->observed().size(); ++k)
      if (rates_->observed()[k].name == name) return (*seen.rates)[k + 1];
    return seen.rates->front();                       // of the load factor
  };
  return rate(o.of[0]) / rate(o.by);
}

double Observables::of_shape(const ObserveTable& o, const Subject& subject, const State& state) const {
  const std::vector<int>& of = subject.entities;
  switch (o.quantity) {
    case Quantity::distance: return length_of(way(state, of, subject.to));
    case Quantity::angle:
      if (subject.through.empty()) return angle(*o.axis, way(state, of, subject.to), subject.about);
      return opening(way(state, subject.through, of), way(state, subject.through, subject.to), subject.about);
    case Quantity::slope: return angle(*o.axis, end_bond(state, of, o.end == RowEnd::last), subject.about);
    case Quantity::extent: return extent(state, of, static_cast<int>(o.component));
    case Quantity::end_to_end: return length_of(way(state, {of.front()}, {of.back()}));
    case Quantity::area: return vector_area(state, of).dot(*subject.about);
    default: return 0;
  }
}

std::vector<Vec3> Observables::of_group(const ObserveTable& o, const Subject& subject, Seen& seen) const {
  std::vector<Vec3> values;
  if (of_bonds(o.quantity) || of_angles(o.quantity) || of_sheets(o.quantity)) return of_inside(o, subject, seen);
  const auto take = [&](const auto& of_all) {
    for (const int e : subject.entities) values.push_back(of_all(e));
    return values;
  };
  if (o.quantity == Quantity::contact_force) return take([&](int e) -> Vec3 { return seen.contacts().col(e); });
  if (o.quantity == Quantity::energy) {
    const Vector shares = energy_->shares(seen.state);
    return take([&](int e) { return as_vector(shares[e]); });
  }
  if (o.quantity == Quantity::gap) {
    const std::vector<double> all = gaps(-1, seen.touches);
    return take([&](int e) { return as_vector(all[e]); });
  }
  if (o.quantity == Quantity::contacts) {
    std::vector<int> all(entities(model_), 0);
    for (const Touch& t : seen.touches)
      if (closed(model_, t)) {
        ++all[t.particle];
        if (t.other >= 0) ++all[t.other];
      }
    return take([&](int e) { return as_vector(all[e]); });
  }
  return take([&](int e) {
    return is_body(model_, e) ? of_body(o.quantity, e - model_.particles(), seen) : of_particle(o.quantity, e, seen);
  });
}

std::vector<Vec3> Observables::of_inside(const ObserveTable& o, const Subject& subject, Seen& seen) const {
  std::vector<Vec3> values;
  for (const int k : subject.inside) {
    if (o.quantity == Quantity::tension) values.push_back(as_vector(seen.bonds()[k].tension));
    if (o.quantity == Quantity::strain) values.push_back(as_vector(seen.bonds()[k].strain));
    if (o.quantity == Quantity::moment) values.push_back(as_vector(seen.angles()[k].moment));
    if (o.quantity == Quantity::curvature) values.push_back(as_vector(seen.angles()[k].curvature));
  }
  if (!of_sheets(o.quantity) || seen.sheets().empty()) return values;
  for (const int e : subject.entities)
    if (const bool N = o.quantity == Quantity::membrane_force; !is_body(model_, e) && seen.sheets()[e].known)
      values.push_back(N ? seen.sheets()[e].N : seen.sheets()[e].M);
  return values;
}

Vec3 Observables::of_particle(Quantity q, int i, const Seen& seen) const {
  if (q == Quantity::position) return seen.state.position.col(i);
  if (q == Quantity::displacement) {
    const ExactVector d = seen.state.at(i) - model_.start.at(i);
    return d.hi + d.lo;
  }
  if (q == Quantity::reaction) return held_.col(i).select(-seen.forces.col(i), Vec3::Zero());
  const Field& velocity = seen.moving ? seen.moving->velocity : model_.velocity;
  return velocity.cols() > 0 ? Vec3(velocity.col(i)) : Vec3(Vec3::Zero());
}

Vec3 Observables::of_body(Quantity q, int b, const Seen& seen) const {
  const Pose &pose = seen.state.bodies[b], &start = model_.start.bodies[b];
  const int place = model_.particles() + 2 * b, turn = place + 1;
  const Field &velocity = seen.moving ? seen.moving->body_velocity : model_.body_velocity,
              &momentum = seen.moving ? seen.moving->angular_momentum : model_.angular_momentum;
  switch (q) {
    case Quantity::position: return pose.position.hi + pose.position.lo;
    case Quantity::displacement: {
      const ExactVector d = pose.position - start.position;
      return d.hi + d.lo;
    }
    case Quantity::rotation: return rotation_vector(pose.rotation * start.rotation.conjugate());
    case Quantity::reaction: return held_.col(place).select(-seen.forces.col(place), Vec3::Zero());
    case Quantity::torque:
      return held_.col(turn).select(-size_of(model_, model_.particles() + b) / 2 * seen.forces.col(turn), Vec3::Zero());
    case Quantity::velocity: return velocity.cols() > 0 ? Vec3(velocity.col(b)) : Vec3(Vec3::Zero());
    case Quantity::angular_velocity: return momentum.cols() > 0 ? angular_velocity_of(model_.bodies[b], pose, momentum.col(b)) : Vec3(Vec3::Zero());
    default: return Vec3::Zero();
  }
}

std::vector<Vec3> Observables::of_wall(const ObserveTable& o, const Subject& subject, const std::vector<Touch>& touches) const {
  std::vector<Vec3> values;
  if (o.quantity == Quantity::gap) {
    const std::vector<double> all = gaps(subject.wall, touches);
    for (const int e : subject.entities) values.push_back(as_vector(all[e]));
    return values;
  }
  const bool reaction = o.quantity == Quantity::reaction;
  std::map<int, Vec3> of_each;                        // it may touch several faces, at several places
  for (const Touch& t : touches)
    if (t.wall == subject.wall && (closed(model_, t) || (reaction && t.attracts)))
      of_each.emplace(t.particle, Vec3::Zero()).first->second += reaction ? t.force : as_vector(1);
  for (const auto& [e, value] : of_each) values.push_back(value);
  return values;
}

/// The smallest gap of every entity, to one wall or (−1) to anything; infinite where there is none.
std::vector<double> Observables::gaps(int wall, const std::vector<Touch>& touches) const {
  std::vector<double> all(entities(model_), infinity);
  for (const Touch& t : touches) {
    if (wall >= 0 && t.wall != wall) continue;
    all[t.particle] = std::min(all[t.particle], t.gap);
    if (t.other >= 0) all[t.other] = std::min(all[t.other], t.gap);
  }
  return all;
}

namespace {

Problem only(const Problem& problem, const std::vector<std::size_t>& numbers) {
  Problem some;
  some.file = problem.file;
  for (const std::size_t k : numbers) some.observe.push_back(problem.observe[k]);
  return some;
}

}  // namespace

std::vector<Touch> observed_touches(Energy& energy, const State& state, const Observables& observables) {
  constexpr double at_touch = 1e-9;                             // of the largest size: what an event has located
  const double largest = largest_size(energy.model());
  std::vector<Touch> touches = energy.touches(state, at_touch * largest);
  const double extent = sides_of(state).maxCoeff();
  for (double reach = largest / 4; !observables.sufficient(touches); reach *= 4) {
    const bool all = !(reach > 0 && reach < extent);
    touches = energy.touches(state, all ? infinity : reach);
    if (all) break;
  }
  return touches;
}

Probe::Probe(const Problem& problem, const Model& model, const std::vector<std::size_t>& numbers)
    : problem_(only(problem, numbers)), energy_(model), observables_(problem_, model) {}

std::vector<double> Probe::operator()(const State& state) {
  return observables_.evaluate(state, energy_.forces(state), observed_touches(energy_, state, observables_));
}

}  // namespace elamin
