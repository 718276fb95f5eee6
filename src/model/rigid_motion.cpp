#include "model/rigid_motion.hpp"

#include "core/dense.hpp"
#include "model/entities.hpp"

#include <fmt/format.h>

#include <numeric>

namespace elamin {

namespace {

using Twist = Eigen::Matrix<double, 6, 1>;                     // translation, then rotation times the part's size
constexpr double small = 1e-9;                                 // beside 1: of directions of order one

std::string direction_name(Vec3 d) {
  d.normalize();
  for (int c = 0; c < 3; ++c)
    if (std::abs(d[c]) > 1 - small) return std::string(1, "xyz"[c]);
  for (int c = 0; c < 3; ++c) if (std::abs(d[c]) < small) d[c] = 0;
  return fmt::format("({:.4g}, {:.4g}, {:.4g})", d[0], d[1], d[2]);
}

// Rows that span the same, in reduced echelon form, so that axes come out as axes; rotations are eliminated first: pure
// translations remain.
std::vector<Twist> echelon(Eigen::MatrixXd basis) {
  int row = 0;
  for (const int c : {3, 4, 5, 0, 1, 2}) {
    if (row == basis.rows()) break;
    Eigen::Index best;
    if (basis.col(c).tail(basis.rows() - row).cwiseAbs().maxCoeff(&best) < 1e-6) continue;
    basis.row(row).swap(basis.row(row + best));
    basis.row(row) /= basis(row, c);
    for (int r = 0; r < basis.rows(); ++r)
      if (r != row) basis.row(r) -= basis(r, c) * basis.row(row);
    ++row;
  }
  std::vector<Twist> twists;
  for (int r = 0; r < basis.rows(); ++r) twists.push_back(basis.row(r).transpose());
  return twists;
}

// Null space of a matrix with six columns.
std::vector<Twist> null_space(const Eigen::MatrixXd& constraints) {
  Eigen::MatrixXd padded = Eigen::MatrixXd::Zero(std::max<Eigen::Index>(constraints.rows(), 6), 6);
  padded.topRows(constraints.rows()) = constraints;
  const Singular svd = singular_values(padded);
  const double most = std::max(svd.values[0], 1e-300);
  int rank = 0;
  while (rank < 6 && svd.values[rank] > small * most) ++rank;
  return echelon(svd.v.rightCols(6 - rank).transpose());
}

// A rotation is told by its axis and the axis' point closest to the origin.
std::string name_of(const std::string& part, const Twist& t, const Vec3& mid, double size) {
  const Vec3 turn = t.tail<3>() / size, shift = t.head<3>();
  if (t.tail<3>().norm() < 1e-6) return fmt::format("translation of {} along {}", part, direction_name(shift));
  Vec3 through = mid + turn.cross(shift) / turn.squaredNorm();
  through -= turn * (turn.dot(through) / turn.squaredNorm());
  for (int c = 0; c < 3; ++c) if (std::abs(through[c]) < small * size) through[c] = 0;
  return fmt::format("rotation of {} about {} through ({:.4g}, {:.4g}, {:.4g})", part, direction_name(turn), through[0], through[1], through[2]);
}

struct Part {
  std::vector<int> entities;
  std::string name;
};

using Pairs = std::vector<std::array<int, 2>>;

// A part is named after its structure if it is all of it, else after its first member; `more`: it touches what is named.
std::vector<Part> parts_of(const Model& model, const Pairs& also) {
  const std::vector<int> of = connected_parts(model, also), glued = also.empty() ? of : connected_parts(model), structures = structure_of(model);
  std::vector<int> bare(entities(model));                      // members of what is glued
  for (const int g : glued) ++bare[g];
  std::vector<Part> parts;
  for (int e = 0; e < entities(model); ++e) {
    if (of[e] == static_cast<int>(parts.size())) {
      parts.push_back({});
      std::string& name = parts.back().name;
      name = called(model, e);
      if (structures[e] >= 0) {
        const Structure& structure = model.structures[structures[e]];
        if (bare[glued[e]] >= structure.count + structure.bodies) name = "'" + structure.name + "'";
        else if (bare[glued[e]] > 1) name = fmt::format("the part of '{}' that has {}", structure.name, name);
      }
    }
    parts[of[e]].entities.push_back(e);
  }
  if (!also.empty())
    for (Part& part : parts)
      if (static_cast<int>(part.entities.size()) > bare[glued[part.entities.front()]]) part.name += " and what it touches";
  return parts;
}

// What a part is made of, as the dofs see it: places of particles and bodies, turns of bodies in units of length.
struct Member {
  int site;
  Vec3 place;
  double length;                                                // 0: a place
};

std::vector<Member> members(const Model& model, const State& state, const Part& part) {
  std::vector<Member> all;
  for (const int e : part.entities) {
    if (!is_body(model, e)) {
      all.push_back({e, state.position.col(e), 0});
      continue;
    }
    const int b = e - model.particles(), site = model.particles() + 2 * b;
    all.push_back({site, state.bodies[b].position.hi, 0});
    all.push_back({site + 1, state.bodies[b].position.hi, size_of(model, e) / 2});
  }
  return all;
}

using Held = Eigen::Matrix<bool, 3, Eigen::Dynamic>;           // 3 × sites

Held held_sites(const Model& model) {
  const int n = model.particles();
  Held held = Held::Constant(3, n + 2 * static_cast<int>(model.bodies.size()), false);
  if (model.plane_normal)
    for (Eigen::Index s = 0; s < held.cols(); ++s)
      for (int c = 0; c < 3; ++c) held(c, s) = (c == *model.plane_normal) != (s >= n && (s - n) % 2 == 1);
  for (const Support& s : model.supports)
    for (int c = 0; c < 3; ++c) {
      for (const int p : s.particles) held(c, p) = held(c, p) || s.held[c];
      for (const int b : s.bodies) {
        held(c, n + 2 * b) = held(c, n + 2 * b) || s.held[c];
        held(c, n + 2 * b + 1) = held(c, n + 2 * b + 1) || s.constrained_rotations[c];
      }
    }
  return held;
}

}  // namespace

Field RigidMotion::velocity_field(int count) const {
  Field field = Field::Zero(3, count);
  for (Eigen::Index k = 0; k < part_velocity.cols(); ++k) field.col(sites[k]) = part_velocity.col(k);
  return field;
}

std::vector<RigidMotion> combined(const std::vector<RigidMotion>& motions, const Eigen::MatrixXd& combinations) {
  const RigidMotion& first = motions.front();
  Eigen::MatrixXd twists(combinations.cols(), 6), of(6, static_cast<Eigen::Index>(motions.size()));
  for (std::size_t k = 0; k < motions.size(); ++k) of.col(static_cast<Eigen::Index>(k)) = motions[k].twist;
  std::vector<RigidMotion> found;
  for (const Twist& t : echelon((of * combinations).transpose())) {
    RigidMotion motion = first;
    motion.twist = t, motion.translation = t.tail<3>().norm() < 1e-6;
    motion.name = name_of(first.part, t, first.mid, first.size);
    const Vector c = least_squares(of, t);
    motion.part_velocity.setZero();
    for (std::size_t k = 0; k < motions.size(); ++k) motion.part_velocity += c[static_cast<Eigen::Index>(k)] * motions[k].part_velocity;
    found.push_back(std::move(motion));
  }
  return found;
}

std::vector<int> connected_parts(const Model& model, const Pairs& also) {
  std::vector<int> root(entities(model));
  std::iota(root.begin(), root.end(), 0);
  const auto find = [&](int p) {
    while (root[p] != p) p = root[p] = root[root[p]];
    return p;
  };
  const auto join = [&](int p, int q) {
    p = find(p), q = find(q);
    root[std::max(p, q)] = std::min(p, q);
  };
  for (const Bond& b : model.bonds) join(b.particles[0], b.particles[1]);
  for (const auto& [p, q] : also) join(p, q);
  for (const Angle& a : model.angles) join(a.particles[0], a.particles[1]), join(a.particles[1], a.particles[2]);
  for (const Glued& g : model.glued) join(g.particle, model.particles() + g.body);
  for (const OwnLaw& law : model.own)
    for (const std::vector<int>& element : law.elements)
      for (std::size_t k = 1; k < element.size(); ++k) join(element[k - 1], element[k]);
  std::vector<int> part(root.size()), number(root.size(), -1);
  int parts = 0;
  for (int p = 0; p < static_cast<int>(root.size()); ++p) {
    int& n = number[find(p)];
    if (n < 0) n = parts++;
    part[p] = n;
  }
  return part;
}

std::vector<RigidMotion> free_rigid_motions(const Model& model, const State& state, const Pairs& also) {
  const Held held = held_sites(model);
  std::vector<RigidMotion> motions;
  for (const Part& part : parts_of(model, also)) {
    const int first = part.entities.front();
    if (part.entities.size() == 1 && !is_body(model, first)) { // a free grain does not turn; there may be very many
      for (int c = 0; c < 3; ++c)
        if (!held(c, first))
          motions.push_back({fmt::format("translation of {} along {}", part.name, "xyz"[c]), true, first, {first}, Vec3::Unit(c)});
      continue;
    }
    const std::vector<Member> all = members(model, state, part);
    Vec3 mid = Vec3::Zero();
    for (const Member& m : all) mid += m.place / static_cast<double>(all.size());
    double size = 0;
    for (const Member& m : all) size = std::max({size, (m.place - mid).norm(), m.length});
    if (size == 0) size = 1;
    const auto velocity = [&](const Twist& t, const Member& m) -> Vec3 {
      if (m.length > 0) return t.tail<3>() * (m.length / size);
      return t.head<3>() + t.tail<3>().cross(Vec3((m.place - mid) / size));
    };
    // Normal equations of "no prescribed coordinate moves": 6 × 6 however many sites are held.
    Eigen::MatrixXd rows(0, 6);
    for (const Member& m : all)
      for (int c = 0; c < 3; ++c) {
        if (!held(c, m.site)) continue;
        Eigen::RowVectorXd row(6);
        for (int k = 0; k < 6; ++k) row[k] = velocity(Twist::Unit(k), m)[c];
        rows.conservativeResize(rows.rows() + 1, 6);
        rows.row(rows.rows() - 1) = row;
        if (rows.rows() > 64) rows = triangle(rows);
      }
    for (const Twist& t : null_space(rows)) {
      RigidMotion motion;
      motion.particle = first;
      Field& v = motion.part_velocity;
      v.resize(3, static_cast<Eigen::Index>(all.size()));
      for (std::size_t k = 0; k < all.size(); ++k) motion.sites.push_back(all[k].site), v.col(static_cast<Eigen::Index>(k)) = velocity(t, all[k]);
      if (v.cwiseAbs().maxCoeff() < 1e-6) continue;  // moves nothing: a row about its own line
      motion.translation = t.tail<3>().norm() < 1e-6;
      motion.name = name_of(part.name, t, mid, size);
      motion.part = part.name, motion.mid = mid, motion.size = size, motion.twist = t;
      motions.push_back(std::move(motion));
    }
  }
  return motions;
}

}  // namespace elamin
