#include "model/rigid_motion.hpp"

#include <Eigen/SVD>
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

// Null space of a matrix with six columns, in reduced echelon form, so that axes come out as axes.
std::vector<Twist> null_space(const Eigen::MatrixXd& constraints) {
  Eigen::MatrixXd padded = Eigen::MatrixXd::Zero(std::max<Eigen::Index>(constraints.rows(), 6), 6);
  padded.topRows(constraints.rows()) = constraints;
  const Eigen::JacobiSVD<Eigen::MatrixXd> svd(padded, Eigen::ComputeFullV);
  const double most = std::max(svd.singularValues()[0], 1e-300);
  int rank = 0;
  while (rank < 6 && svd.singularValues()[rank] > small * most) ++rank;
  Eigen::MatrixXd basis = svd.matrixV().rightCols(6 - rank).transpose();
  int row = 0;                                                 // rotations are eliminated first: pure translations remain
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

struct Part {
  std::vector<int> particles;
  std::string name;
};

using Pairs = std::vector<std::array<int, 2>>;

// A part is named after its structure if it is all of it, else after its first particle; `more`: it touches what is named.
std::vector<Part> parts_of(const Model& model, const Pairs& also) {
  const std::vector<int> of = connected_parts(model, also), glued = also.empty() ? of : connected_parts(model);
  std::vector<int> bare(model.particles());                    // particles of what is glued
  for (const int g : glued) ++bare[g];
  std::vector<Part> parts;
  std::size_t s = 0;
  for (int p = 0; p < model.particles(); ++p) {
    while (s < model.structures.size() && p >= model.structures[s].first + model.structures[s].count) ++s;
    if (of[p] == static_cast<int>(parts.size())) {
      parts.push_back({});
      std::string& name = parts.back().name;
      name = fmt::format("particle {}", model.id.empty() ? p + 1 : model.id[p]);
      if (s < model.structures.size() && p >= model.structures[s].first) {
        const Structure& structure = model.structures[s];
        if (bare[glued[p]] >= structure.count) name = "'" + structure.name + "'";
        else if (bare[glued[p]] > 1) name = fmt::format("the part of '{}' that has {}", structure.name, name);
      }
    }
    parts[of[p]].particles.push_back(p);
  }
  if (!also.empty())
    for (Part& part : parts)
      if (static_cast<int>(part.particles.size()) > bare[glued[part.particles.front()]]) part.name += " and what it touches";
  return parts;
}

}  // namespace

Field RigidMotion::velocity_field(int count) const {
  Field field = Field::Zero(3, count);
  for (Eigen::Index k = 0; k < part_velocity.cols(); ++k) field.col(particles[k]) = part_velocity.col(k);
  return field;
}

std::vector<int> connected_parts(const Model& model, const Pairs& also) {
  std::vector<int> root(model.particles());
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
  std::vector<int> part(model.particles()), number(model.particles(), -1);
  int parts = 0;
  for (int p = 0; p < model.particles(); ++p) {
    int& n = number[find(p)];
    if (n < 0) n = parts++;
    part[p] = n;
  }
  return part;
}

std::vector<RigidMotion> free_rigid_motions(const Model& model, const State& state, const Pairs& also) {
  Eigen::Matrix<bool, 3, Eigen::Dynamic> held = Eigen::Matrix<bool, 3, Eigen::Dynamic>::Constant(3, model.particles(), false);
  if (model.plane_normal) held.row(*model.plane_normal).setConstant(true);
  for (const Support& s : model.supports)
    for (const int p : s.particles)
      for (int c = 0; c < 3; ++c) held(c, p) = held(c, p) || s.held[c];

  std::vector<RigidMotion> motions;
  for (const Part& part : parts_of(model, also)) {
    if (part.particles.size() == 1) {                          // a free grain does not turn; there may be very many
      const int p = part.particles.front();
      for (int c = 0; c < 3; ++c)
        if (!held(c, p))
          motions.push_back({fmt::format("translation of {} along {}", part.name, "xyz"[c]), true, p, {p}, Vec3::Unit(c)});
      continue;
    }
    Vec3 mid = Vec3::Zero();
    for (const int p : part.particles) mid += state.position.col(p) / static_cast<double>(part.particles.size());
    double size = 0;
    for (const int p : part.particles) size = std::max(size, (state.position.col(p) - mid).norm());
    if (size == 0) size = 1;
    const auto velocity = [&](const Twist& t, int p) -> Vec3 {
      return t.head<3>() + t.tail<3>().cross(Vec3((state.position.col(p) - mid) / size));
    };
    // Normal equations of "no prescribed coordinate moves": 6 × 6 however many particles are held.
    Eigen::MatrixXd rows(0, 6);
    for (const int p : part.particles)
      for (int c = 0; c < 3; ++c) {
        if (!held(c, p)) continue;
        Eigen::RowVectorXd row(6);
        for (int k = 0; k < 6; ++k) row[k] = velocity(Twist::Unit(k), p)[c];
        rows.conservativeResize(rows.rows() + 1, 6);
        rows.row(rows.rows() - 1) = row;
        if (rows.rows() > 64) {                                // keep the triangle only
          const Eigen::HouseholderQR<Eigen::MatrixXd> qr(rows);
          rows = Eigen::MatrixXd(qr.matrixQR().topRows(6).triangularView<Eigen::Upper>());
        }
      }
    for (const Twist& t : null_space(rows)) {
      RigidMotion motion;
      motion.particle = part.particles.front();
      motion.particles = part.particles;
      Field& v = motion.part_velocity;
      v.resize(3, static_cast<Eigen::Index>(part.particles.size()));
      for (Eigen::Index k = 0; k < v.cols(); ++k) v.col(k) = velocity(t, part.particles[k]);
      if (v.cwiseAbs().maxCoeff() < 1e-6) continue;  // moves nothing: a row about its own line
      const Vec3 turn = t.tail<3>() / size, shift = t.head<3>();
      motion.translation = t.tail<3>().norm() < 1e-6;
      if (motion.translation) {
        motion.name = fmt::format("translation of {} along {}", part.name, direction_name(shift));
      } else {
        Vec3 through = mid + turn.cross(shift) / turn.squaredNorm();
        through -= turn * (turn.dot(through) / turn.squaredNorm());       // the axis' point closest to the origin
        for (int c = 0; c < 3; ++c) if (std::abs(through[c]) < small * size) through[c] = 0;
        motion.name = fmt::format("rotation of {} about {} through ({:.4g}, {:.4g}, {:.4g})", part.name,
                                  direction_name(turn), through[0], through[1], through[2]);
      }
      motions.push_back(std::move(motion));
    }
  }
  return motions;
}

}  // namespace elamin
