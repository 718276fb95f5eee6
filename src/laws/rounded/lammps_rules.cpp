#include "laws/rounded/lammps_rules.hpp"

#include "laws/rounded/lammps_hits.hpp"

#include <cmath>

namespace elamin {

namespace {

constexpr std::size_t most_stored = 32;        // of LAMMPS

/// A touching contact that waits for the area factor.
struct Stored {
  LammpsHit hit;
  Vec3 force;                                  // of the kernel, on the owner of the point
};

/// Adds up what the hits of one pair do.
class Sum {
 public:
  Sum(const LammpsRules& rules, const LammpsPlaced& i, const LammpsPlaced& j, const BodyMotion& vi, const BodyMotion& vj,
      const Vec3& origin,
      std::vector<LammpsContact>* contacts)
      : rules_(rules), body_{&i, &j}, motion_{&vi, &vj}, origin_(origin), contacts_(contacts),
        radii_(i.shape->radius + j.shape->radius), sphere_(i.sphere() || j.sphere()) {}

  void add(const LammpsHit& hit) {
    const double gap = hit.distance - radii_;
    const double force = -rules_.kernel.slope(gap);
    const Vec3 apart = hit.point - hit.foot, n = apart.normalized();   // 0 where they meet: LAMMPS divides by zero
    // Of parallel edges the distance is that of another point, and this is no unit vector.
    const Vec3 along = hit.distance > 0 ? Vec3(apart / hit.distance) : Vec3::Zero(), f = force * along;
    pair_.energy += rules_.kernel.reported(gap);
    pair_.through |= hit.through;
    pair_.parallel |= hit.parallel && gap <= rules_.kernel.cutoff;
    if (gap > 0 || sphere_) apply(hit, f);
    if (gap <= 0) {
      damp(hit, n);
      if (!sphere_) {
        apply(hit, rules_.friction * f);
        if (!hit.through) stored_.push_back({hit, force * n});
      }
    }
    if (gap > rules_.kernel.cutoff) return;
    const LammpsHow how = hit.through ? LammpsHow::through : gap > 0 || sphere_ ? LammpsHow::direct : LammpsHow::scaled;
    if (contacts_ && how == LammpsHow::scaled) listed_.push_back(contacts_->size());
    if (!contacts_) return;
    contacts_->push_back({hit.first_of, hit.first, hit.second, gap, how, origin_ + hit.point, origin_ + hit.foot, n});
  }

  LammpsPair finish() {
    pair_.overflow = stored_.size() > most_stored;
    std::vector<bool> kept(stored_.size(), true);
    if (stored_.size() >= 3) scale(kept);
    for (std::size_t k = 0; k < stored_.size(); ++k) {
      if (kept[k]) apply(stored_[k].hit, pair_.area_factor * stored_[k].force);
      else if (contacts_) (*contacts_)[listed_[k]].how = LammpsHow::dropped;
    }
    return pair_;
  }

 private:
  void apply(const LammpsHit& hit, const Vec3& f) {
    const int a = hit.first_of, b = 1 - a;
    pair_.on[a].add(f, arm(a, hit.point));
    pair_.on[b].add(-f, arm(b, hit.foot));
  }

  void damp(const LammpsHit& hit, const Vec3& n) {
    const int a = hit.first_of, b = 1 - a;
    const Vec3 arm_a = arm(a, hit.point), arm_b = arm(b, hit.foot);
    const Vec3 v = motion_[a]->at(arm_a) - motion_[b]->at(arm_b), vn = v.dot(n) * n;
    const Vec3 f = -rules_.normal_damping * vn - rules_.tangential_damping * (v - vn);
    apply(hit, f);
    pair_.damping[a].add(f, arm_a), pair_.damping[b].add(-f, arm_b);
  }

  /// A sphere is pushed and moved at its centre.
  Vec3 arm(int k, const Vec3& point) const {
    return body_[k]->sphere() ? Vec3::Zero() : Vec3(point - body_[k]->center);
  }

  void scale(std::vector<bool>& kept) {
    const auto middle = [this](std::size_t k) -> Vec3 { return (stored_[k].hit.point + stored_[k].hit.foot) / 2; };
    Vec3 mean = Vec3::Zero();
    double count = 0, spread = 0;
    for (std::size_t k = 0; k < stored_.size(); ++k) {
      for (std::size_t m = 0; m < k; ++m)
        kept[k] = kept[k] && !(kept[m] && (middle(k) - middle(m)).squaredNorm() < lammps_epsilon);
      pair_.dropped |= !kept[k];
      if (kept[k]) mean += place(k), count += 1;
    }
    mean /= count;
    for (std::size_t k = 0; k < stored_.size(); ++k)
      if (kept[k]) spread += (place(k) - mean).squaredNorm();
    const double unit = rules_.unit_area < 0 ? 1 : rules_.unit_area;
    pair_.area_factor = std::max(1.0, pi * spread / count / (count * unit));
  }

  /// On the owner of the face, or of two edges on i.
  Vec3 place(std::size_t k) const {
    const LammpsHit& hit = stored_[k].hit;
    return hit.second.kind == FeatureKind::face || hit.first_of != 0 ? hit.foot : hit.point;
  }

  const LammpsRules& rules_;
  std::array<const LammpsPlaced*, 2> body_;
  std::array<const BodyMotion*, 2> motion_;
  Vec3 origin_;
  std::vector<LammpsContact>* contacts_;
  double radii_;
  bool sphere_;
  LammpsPair pair_;
  std::vector<Stored> stored_;
  std::vector<std::size_t> listed_;            // place in *contacts_ of each stored one
};

}  // namespace

LammpsPair LammpsRules::pair(const RoundedBody& i, const RoundedBody& j, const BodyMotion& vi, const BodyMotion& vj,
                             std::vector<LammpsContact>* contacts) const {
  const Vec3 apart = (j.pose.position - i.pose.position).hi;
  const auto size = [](const RoundedShape& s) { return s.vertices.size() == 1 ? s.radius : s.extent; };
  if (!(apart.norm() <= size(*i.shape) + size(*j.shape) + kernel.cutoff)) return {};
  const LammpsPlaced a(i, Vec3::Zero()), b(j, apart);                  // origin: the position of i
  Sum sum(*this, a, b, vi, vj, i.pose.position.hi, contacts);
  lammps_hits(a, b, kernel.cutoff, [&sum](const LammpsHit& hit) { sum.add(hit); });
  return sum.finish();
}

Wrench LammpsWall::on(const RoundedBody& body, const BodyMotion& motion, Wrench* damping) const {
  Wrench w;
  const Vec3 x = body.pose.position.hi;
  const double plane = x[axis] - lo < hi - x[axis] ? lo : hi, rho = body.shape->radius;
  if (!std::isfinite(plane) || std::abs(x[axis] - plane) > body.shape->bounding_radius()) return w;
  for (const Vec3& r : body.shape->vertices) {
    const Vec3 arm = body.pose.rotation * r;
    const double height = x[axis] + arm[axis] - plane, s = std::abs(height);
    if (s > rho) continue;
    Vec3 n = Vec3::Zero();
    n[axis] = height < 0 ? -1 : 1;
    const Vec3 v = motion.at(arm), vn = v.dot(n) * n;
    const Vec3 resistance = -normal_damping * vn - tangential_damping * (v - vn);
    w.add(stiffness * (rho - s) * n + resistance, arm);
    if (damping) damping->add(resistance, arm);
  }
  return w;
}

}  // namespace elamin
