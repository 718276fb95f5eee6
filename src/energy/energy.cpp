#include "energy/energy.hpp"

#include "core/find.hpp"
#include "core/sparse.hpp"
#include "energy/body_groups.hpp"
#include "energy/groups.hpp"
#include "energy/touches.hpp"
#include "model/entities.hpp"

#include <algorithm>
#include <cassert>
#include <stdexcept>

namespace elamin {

namespace {

// In the list of groups; each with glued particles, and then the same without.
enum Slot { bonds, angles = 2, contacts = 4, cohesion = 6, walls = 8, body_particles = 10, body_pairs = 12, body_walls, body_loads,
             pressures, sheet_pressures, hard_pairs, hard_walls, places };

// The term of each place.
constexpr double EnergyTerms::*term_at[places]{
    &EnergyTerms::bond,     &EnergyTerms::bond,     &EnergyTerms::angle, &EnergyTerms::angle, &EnergyTerms::contact, &EnergyTerms::contact,
    &EnergyTerms::cohesion, &EnergyTerms::cohesion, &EnergyTerms::wall,  &EnergyTerms::wall,  &EnergyTerms::body,    &EnergyTerms::body,
    &EnergyTerms::body,     &EnergyTerms::wall,     &EnergyTerms::external, &EnergyTerms::external, &EnergyTerms::external,
    &EnergyTerms::external, &EnergyTerms::external};

double distance(const Model& model, int i, int j) { return (model.start.at(j) - model.start.at(i)).hi.norm(); }

// The largest 2K r₀, B/r₀ and E_eff d²: the force of a stretch, rotation or overlap of order one.
double stiffest(const Model& model) {
  double most = 0;
  for (const Bond& b : model.bonds)
    most = std::max(most, 2 * model.bond_types[b.type].stiffness * distance(model, b.particles[0], b.particles[1]));
  for (const Angle& a : model.angles)
    if (const double l = distance(model, a.particles[0], a.particles[1]); l > 0)
      most = std::max(most, model.angle_types[a.type].stiffness / l);
  const auto contact = [&](double modulus, const std::vector<int>& particles) {
    for (const int p : particles) most = std::max(most, modulus * model.diameter[p] * model.diameter[p]);
  };
  for (const PairContact& c : model.contacts)
    for (const auto& side : c.particles) contact(c.hard ? 0.0 : c.effective_modulus, side);
  for (const Wall& w : model.walls) contact(w.hard ? 0.0 : w.effective_modulus, w.particles);
  const auto rounded = [&](const RoundedKernel& k, const std::vector<int>& bodies) {
    for (const int b : bodies) most = std::max(most, std::max(k.normal, k.attraction) * model.shapes[model.bodies[b].shape].bounding_radius());
  };
  for (const RoundedPair& r : model.rounded)
    for (const auto& side : r.bodies) rounded(r.kernel, side);
  for (const Wall& w : model.walls) rounded(w.kernel, w.bodies);
  for (const PairContact& c : model.contacts)
    if (c.law == PairContact::Law::lj) most = std::max(most, c.epsilon / c.sigma);
  return most;
}

// The largest force of bonds and angles at rest: 2K and B/r₀² times how exact rest lengths, rest angles and places may be.
double rounding_of_glue(const Model& model) {
  double most = 0;
  const auto place = [&](int i) { return model.start.at(i).hi.lpNorm<Eigen::Infinity>(); };
  const auto add = [&](double stiffness, int i, int j) { most = std::max(most, 4 * epsilon * stiffness * (distance(model, i, j) + place(i) + place(j))); };
  for (const Bond& b : model.bonds) add(2 * model.bond_types[b.type].stiffness, b.particles[0], b.particles[1]);
  for (const Angle& a : model.angles)
    if (const double l = distance(model, a.particles[0], a.particles[1]); l > 0) add(model.angle_types[a.type].stiffness / (l * l), a.particles[0], a.particles[1]);
  return most;
}

// Of a group the largest entry of an element's Hessian times its extent: the distance of its sites, or their size.
double stiffest(const ElementGroup& group, const Kinematics& kinematics, const State& state) {
  std::vector<double> value(group.elements()), gradient(std::size_t(group.elements()) * group.gradient_size()),
      hessian(std::size_t(group.elements()) * group.hessian_size());
  group.derivatives(state, {}, value.data(), gradient.data(), hessian.data());
  double most = 0;
  for (int e = 0; e < group.elements(); ++e) {
    double extent = 0, largest = 0;
    for (const int a : group.stencil(e)) {
      if (a >= 0) extent = std::max(extent, kinematics.size(a));
      for (const int b : group.stencil(e))
        if (a >= 0 && b >= 0 && std::max(a, b) < state.particles()) extent = std::max(extent, (state.at(b) - state.at(a)).hi.norm());
    }
    for (int k = 0; k < group.hessian_size(); ++k) largest = std::max(largest, std::abs(hessian[std::size_t(e) * group.hessian_size() + k]));
    if (std::isfinite(largest)) most = std::max(most, largest * extent);
  }
  return most;
}

// Below this forces on bodies are rounding, or parts of one element that cancel: what rounding of a vertex's place does, 4 ε k ℓ, or of the place of
// a particle that is carried, 8 ε K ℓ and 4 ε B/r² ℓ with its arm ℓ, is the usual tolerance 1e-10 of it; and the attraction k_na r_c.
double floor_of_bodies(const Model& model) {
  constexpr double rounding = 1e-5;
  double most = 0;
  const auto take = [&](const RoundedKernel& k, const std::vector<int>& bodies) {
    for (const int b : bodies) most = std::max({most, rounding * k.normal * model.shapes[model.bodies[b].shape].bounding_radius(), k.attraction * k.cutoff});
  };
  for (const RoundedPair& r : model.rounded)
    for (const auto& side : r.bodies) take(r.kernel, side);
  for (const Wall& w : model.walls) take(w.kernel, w.bodies);
  std::vector<double> arm(model.particles());
  for (const Glued& g : model.glued) arm[g.particle] = g.arm.norm();
  const auto carried = [&](double stiffness, const auto& particles) {
    for (const int p : particles) most = std::max(most, rounding * stiffness * arm[p]);
  };
  if (model.glued.empty()) return most;
  for (const Bond& b : model.bonds) carried(2 * model.bond_types[b.type].stiffness, b.particles);
  for (const Angle& a : model.angles)
    if (const double l = distance(model, a.particles[0], a.particles[1]); l > 0) carried(model.angle_types[a.type].stiffness / (l * l), a.particles);
  return most;
}

// The free dofs of bodies, and of particles that no bond and no angle holds.
std::vector<int> unbonded_dofs_of(const Model& model, const Kinematics& kinematics) {
  std::vector<bool> glued(kinematics.sites());
  for (const Bond& b : model.bonds)
    for (const int p : b.particles) glued[p] = true;
  for (const Angle& a : model.angles)
    for (const int p : a.particles) glued[p] = true;
  std::vector<int> loose;
  for (int d = 0; d < kinematics.dofs(); ++d)
    if (!glued[kinematics.site_of(d)]) loose.push_back(d);
  return loose;
}

bool same_pattern(const SparseMatrix& a, const SparseMatrix& b) {
  return a.cols() == b.cols() && a.nonZeros() == b.nonZeros() &&
         std::equal(a.outerIndexPtr(), a.outerIndexPtr() + a.cols() + 1, b.outerIndexPtr()) &&
         std::equal(a.innerIndexPtr(), a.innerIndexPtr() + a.nonZeros(), b.innerIndexPtr());
}

}  // namespace

Energy::Energy(const Model& model)
    : model_(model), kinematics_(model), neighbours_(model), body_neighbours_(model),
      constant_load_(Field::Zero(3, kinematics_.sites())), scaled_load_(Field::Zero(3, kinematics_.sites())) {
  const auto add = [&](int site, const Vec3& force, const Scaling& scaling) {
    constant_load_.col(site) += scaling.fixed * force, scaled_load_.col(site) += scaling.rate * force;
  };
  for (const Load& l : model.loads) {
    for (std::size_t k = 0; k < l.particles.size(); ++k) add(l.particles[k], l.on(k), l.scaling);
    for (const int b : l.bodies)
      if (l.point.isZero(0)) add(kinematics_.place_of(b), l.force, l.scaling);
  }
  for (const Gravity& g : model.gravity) {
    for (const int p : g.particles) add(p, model.mass(p) * g.acceleration, g.scaling);
    for (const int b : g.bodies) add(kinematics_.place_of(b), model.bodies[b].mass * g.acceleration, g.scaling);
  }
  for (const Pressure& p : model.pressures)
    for (std::size_t k = 0; p.rim.size() && k < p.particles.size(); ++k)
      add(p.particles[k], p.pressure * p.rim.col(static_cast<Eigen::Index>(k)), p.scaling);
  for (const Glued& g : model.glued) constant_load_.col(g.particle).setZero(), scaled_load_.col(g.particle).setZero();
  force_floor_ = std::max(epsilon * stiffest(model), floor_of_bodies(model));
  glue_rounding_ = rounding_of_glue(model);
  unbonded_dofs_ = unbonded_dofs_of(model, kinematics_);
  null_dofs_.reserve(unbonded_dofs_.size());
  groups_.resize(places);
  put(bonds, bond_group(model, kinematics_)), put(angles, angle_group(model, kinematics_)), put(walls, wall_group(model, kinematics_));
  groups_[body_walls] = body_wall_group(model, kinematics_), groups_[body_loads] = body_load_group(model, kinematics_);
  groups_[pressures] = pressure_group(model), groups_[sheet_pressures] = sheet_pressure_group(model);
  groups_[hard_walls] = hard_wall_group(model);
  const State& first = model.restart ? *model.restart : model.start;
  neighbours_.refresh(first), body_neighbours_.refresh(first);
  assemble_groups();
  for (const OwnLaw& law : model.own) this->add(law.term, law.group(*this));
}

void Energy::add(const std::string& term, std::unique_ptr<ElementGroup> group) {
  const auto taken = [&](const auto& known) { return known.first == term; };
  if (constexpr auto known = EnergyTerms::known(); std::any_of(known.begin(), known.end(), taken) || std::count(own_.begin(), own_.end(), term))
    throw std::invalid_argument("Energy::add: there is a term " + term + " already");
  if (group->sites() > Assembler::most_sites) throw std::invalid_argument("Energy::add: an element has too many sites");
  std::vector<bool> held(kinematics_.sites());
  for (int e = 0; e < group->elements(); ++e)
    for (const int site : group->stencil(e)) {
      if (site >= kinematics_.sites()) throw std::invalid_argument("Energy::add: an element has a site that is not in the model");
      if (site >= 0) held[site] = true;
    }
  std::erase_if(unbonded_dofs_, [&](int d) { return held[kinematics_.site_of(d)]; });
  force_floor_ = std::max(force_floor_, epsilon * stiffest(*group, kinematics_, model_.start));
  own_.push_back(term), groups_.push_back(std::move(group));
  assemble_groups();
}

void Energy::put(int place, Parts parts) {
  groups_[place] = std::move(parts.carried), groups_[place + 1] = std::move(parts.free);
}

// The groups of pairs and the assembler for the candidates of contact that there are now.
void Energy::assemble_groups() {
  const std::unique_ptr<Assembler> before = std::move(assembler_);
  put(contacts, contact_group(model_, kinematics_, neighbours_)), put(cohesion, cohesion_group(model_, kinematics_, neighbours_));
  put(body_particles, body_particle_groups(model_, kinematics_, body_neighbours_));
  groups_[body_pairs] = body_pair_group(model_, kinematics_, body_neighbours_);
  groups_[hard_pairs] = hard_pair_group(model_, neighbours_);
  assembler_ = std::make_unique<Assembler>(kinematics_, groups_);
  current_ = false;
  if (!before || !same_pattern(before->hessian(), assembler_->hessian())) ++pattern_version_;
}

void Energy::cover(const State& state) {
  assert(state.position.cols() == model_.particles() && state.bodies.size() == model_.bodies.size());
  const bool particles = !neighbours_.covers(state) && neighbours_.refresh(state);
  const bool bodies = !body_neighbours_.covers(state) && body_neighbours_.refresh(state);
  if (particles || bodies) assemble_groups();
}

EnergyTerms Energy::terms_of(const std::vector<double>& sums, const State& state) const {
  EnergyTerms terms;
  terms.external = external(state);
  for (int k = 0; k < places; ++k) terms.*term_at[k] += sums[k];
  for (std::size_t k = 0; k < own_.size(); ++k) terms.own.emplace_back(own_[k], sums[places + k]);
  return terms;
}

double Energy::external(const State& state) const {
  ExactSum sum;
  const auto add = [&](Eigen::Index site, const Vec3& x) {
    for (int c = 0; c < 3; ++c) sum.add(-(constant_load_(c, site) + state.load_factor * scaled_load_(c, site)) * x[c]);
  };
  for (Eigen::Index p = 0; p < state.particles(); ++p) add(p, state.position.col(p) + state.low.col(p));
  for (std::size_t b = 0; b < state.bodies.size(); ++b)
    add(kinematics_.place_of(static_cast<int>(b)), state.bodies[b].position.hi + state.bodies[b].position.lo);
  return sum.value();
}

EnergyTerms Energy::terms(const State& state) {
  cover(state);
  return terms_of(assembler_->values(state), state);
}

Vector Energy::shares(const State& state) {
  cover(state);
  Vector share = Vector::Zero(entities(model_));
  std::vector<double> value;
  std::vector<int> between;
  for (int place = bonds; place < body_loads; ++place) {
    const ElementGroup& group = *groups_[place];
    value.resize(group.elements());
    group.values(state, value.data());
    for (int e = 0; e < group.elements(); ++e) {
      between.clear();
      for (const int site : group.between(e)) {
        if (site < 0) continue;
        const int entity = site < model_.particles() ? site : model_.particles() + (site - model_.particles()) / 2;
        if (!contains(between, entity)) between.push_back(entity);
      }
      for (const int entity : between) share[entity] += value[e] / static_cast<double>(between.size());
    }
  }
  return share;
}

void Energy::evaluate(const State& state, bool with_hessian, const Tangent& tangent) {
  current_ = false;
  cover(state);
  terms_ = terms_of(assembler_->evaluate(state, with_hessian, tangent), state);
  finish_gradient(state);
  if (!with_hessian) return;
  assembler_->sum_hessian();
  evaluated_ = state, predicted_ = tangent.from || tangent.convex > 0;
  anchor_null_dofs();
  current_ = !predicted_;
}

void Energy::be_at(const State& state) {
  if (!current_ || !own_.empty() || !identical(state, evaluated_)) evaluate(state);
}

void Energy::anchor_null_dofs() {
  null_dofs_.clear();
  if (unbonded_dofs_.empty()) return;
  SparseMatrix& h = assembler_->hessian();
  Vector& stiffness = row_sums_;
  stiffness.setZero(dofs());
  add_absolute_row_sums(h, stiffness);
  const double largest = stiffness.size() ? stiffness.maxCoeff() : 0.0;
  for (const int d : unbonded_dofs_)
    if (stiffness[d] == 0) {
      const double fall = std::abs(gradient_[d]) / (2 * kinematics_.size(kinematics_.site_of(d)));
      h.valuePtr()[h.outerIndexPtr()[d]] = fall > 0 ? std::max(fall, 1e-12 * largest)
                                            : largest > 0 ? largest : force_scale_ > 0 ? force_scale_ / kinematics_.size(kinematics_.site_of(d)) : 1.0;
      null_dofs_.push_back(d);
    }
}

void Energy::finish_gradient(const State& state) {
  load_factor_ = state.load_factor;
  assembler_->gradient(site_gradient_);
  glue_force_ = assembler_->largest_element_force(bonds, contacts);
  other_force_ = assembler_->largest_element_force(contacts, groups_.size());
  for (Eigen::Index p = 0; p < site_gradient_.cols(); ++p) {
    const Vec3 load = constant_load_.col(p) + state.load_factor * scaled_load_.col(p);
    site_gradient_.col(p) -= load;
    other_force_ = std::max(other_force_, load.norm());
  }
  force_scale_ = std::max(glue_force_, other_force_);
  kinematics_.restrict(site_gradient_, gradient_);
}

Vector Energy::load_derivative() const {
  Vector d = -kinematics_.restrict(scaled_load_);
  assembler_->add_drive(evaluated_, d);
  return d;
}

Vector Energy::load_force() const {
  Vector pressed = Vector::Zero(dofs());
  for (const Slot given : {pressures, sheet_pressures, body_loads}) assembler_->add_load_derivative(*groups_[given], evaluated_, pressed);
  return kinematics_.restrict(scaled_load_) - pressed;
}

bool Energy::loads_scaled() const {
  const auto pushes = [](const Pressure& p) { return p.scaling.rate * p.pressure != 0; };
  return !scaled_load_.isZero(0) || groups_[body_loads]->load_dependent() || std::any_of(model_.pressures.begin(), model_.pressures.end(), pushes);
}

Vector Energy::multiply(const Vector& v, bool anchored) const {
  Field product;
  assembler_->multiply(kinematics_.extend(v), product);
  Vector hv = kinematics_.restrict(product);
  if (!anchored) return hv;
  const SparseMatrix& h = hessian();
  for (const int d : null_dofs_) hv[d] += h.valuePtr()[h.outerIndexPtr()[d]] * v[d];
  return hv;
}

BilinearForm Energy::form(const Vector& u, const Vector& v) const {
  assert(evaluated_.position.cols() == model_.particles());                 // with Hessian
  BilinearForm form = assembler_->form(kinematics_.extend(u), kinematics_.extend(v), predicted_ ? nullptr : &evaluated_);
  const SparseMatrix& h = hessian();
  for (const int d : null_dofs_) {
    const double part = h.valuePtr()[h.outerIndexPtr()[d]] * u[d] * v[d];
    form.value += part, form.size += std::abs(part);
  }
  return form;
}

BilinearForm Energy::slope(const Vector& v) const {
  const Field field = kinematics_.extend(v), by_loads = (constant_load_ + load_factor_ * scaled_load_).cwiseProduct(field);
  const BilinearForm inside = assembler_->slope(field);
  return {inside.value - by_loads.sum(), std::hypot(inside.size, by_loads.norm())};
}

double Energy::relative(const Vector& force) const {
  const double largest = force.size() ? force.cwiseAbs().maxCoeff() : 0.0;
  return largest == 0 ? 0.0 : largest / std::max(force_scale_, force_floor_);
}

std::vector<Touch> Energy::touches(const State& state, double within) {
  return find_touches(model_, neighbours_, body_neighbours_.rules(), state, within);
}

void Energy::look_around(const State& state) {
  const bool particles = neighbours_.refresh(state), bodies = body_neighbours_.refresh(state);
  if (particles || bodies) assemble_groups();
}

double Energy::collision_free_step(const State& from, const State& to) const {
  return std::min(collision_free_particle_step(model_, neighbours_, from, to), collision_free_body_step(model_, body_neighbours_.rules(), from, to));
}

std::vector<HardForce> Energy::hard_contacts(const State& state, double step_bound) {
  cover(state);
  std::vector<HardForce> found = hard_candidates(model_, neighbours_, state, step_bound);
  const auto held = [&](int p) { return p < 0 || (kinematics_.dof(p, 0) < 0 && kinematics_.dof(p, 1) < 0 && kinematics_.dof(p, 2) < 0); };
  std::erase_if(found, [&](const HardForce& h) { return held(h.particle) && held(h.other); });
  return found;
}

double Energy::gap(int particle, int other, int wall, const State& state) const {
  return wall < 0 ? pair_gap(model_, particle, other, state) : wall_gap(model_, particle, wall, state);
}

void Energy::carry(Archive& archive) {
  archive(neighbours_, body_neighbours_);
  if (archive.reads()) assemble_groups();
}

Field Energy::forces(const State& state) {
  evaluate(state, false);
  return -site_gradient_;
}

}  // namespace elamin
