#include "lammps/body.hpp"

#include "core/dense.hpp"

#include <fmt/format.h>

#include <cmath>
#include <cstdint>

namespace elamin {
namespace {

/// Takes the numbers one by one; the caller has counted them.
class Numbers {
 public:
  Numbers(const std::vector<double>& numbers, int vertices, std::vector<std::string>& wrong)
      : numbers_(numbers), vertices_(vertices), wrong_(wrong) {}

  double next() { return numbers_[at_++]; }
  Vec3 vector() {
    const double x = next(), y = next();
    return {x, y, next()};
  }
  /// A vertex, or −1 where that is allowed and stands there. What is neither is told, and −2.
  int vertex(const char* kind, int number, bool may_be_absent) {
    const double value = next();
    if (may_be_absent && value == -1) return -1;
    if (value >= 0 && value < vertices_ && value == std::floor(value)) return static_cast<int>(value);
    wrong_.push_back(fmt::format("{} {} names vertex {}; allowed: 0 to {}{}", kind, number, value, vertices_ - 1,
                                 may_be_absent ? ", or -1 as the fourth of a triangle" : ""));
    return -2;
  }

 private:
  const std::vector<double>& numbers_;
  int vertices_;
  std::vector<std::string>& wrong_;
  std::size_t at_ = 0;
};

/// How many numbers there are to be; of spheres and rods lists may be left out. −1: none of these.
int announced_in(const std::array<int, 3>& counts, std::size_t numbers) {
  const auto [n, e, f] = std::array<std::int64_t, 3>{counts[0], counts[1], counts[2]};
  const std::int64_t least = 7 + 3 * n, given = static_cast<std::int64_t>(numbers);
  if (given == least + 2 * e + 4 * f) return 2;                  // edges and faces
  if (n > 2) return -1;
  return given == least + 2 * e ? 1 : given == least ? 0 : -1;
}

void take_mesh(Numbers& numbers, const std::array<int, 3>& counts, int lists, CoreMesh& core) {
  for (int k = 0; k < counts[0]; ++k) core.vertices.push_back(numbers.vector());
  for (int k = 0; lists >= 1 && k < counts[1]; ++k) {
    const int a = numbers.vertex("edge", k, false);
    core.edges.push_back({a, numbers.vertex("edge", k, false)});
  }
  for (int k = 0; lists == 2 && k < counts[2]; ++k) {
    std::vector<int> face;
    for (int i = 0; i < 4; ++i)
      if (const int v = numbers.vertex("face", k, i == 3 || counts[0] <= 2); v != -1) face.push_back(v);
    core.faces.push_back(face);
  }
  if (counts[0] <= 2) core.edges.clear(), core.faces.clear();    // of a sphere or rod they say nothing
}

}  // namespace

std::string wrong_inertia(const Mat3& inertia) {
  const Vec3 moments = symmetric_eigen(inertia).values;   // ascending
  const double allowed = 1e-6 * moments.cwiseAbs().maxCoeff();
  if (moments[0] < -allowed)
    return fmt::format("the inertia has the principal moment {:.6g}; none may be negative", moments[0]);
  if (moments[2] > moments[0] + moments[1] + allowed)
    return fmt::format("the inertia has the principal moments {:.6g}, {:.6g} and {:.6g}; none may exceed the sum of the others",
                       moments[0], moments[1], moments[2]);
  return "";
}

std::optional<BodyForm> body_form(const std::array<int, 3>& counts, const std::vector<double>& numbers,
                                  std::vector<std::string>& wrong) {
  const std::size_t before = wrong.size();
  const auto [n, e, f] = std::array<std::int64_t, 3>{counts[0], counts[1], counts[2]};
  const int lists = announced_in(counts, numbers.size());
  if (lists < 0) {
    wrong.push_back(fmt::format("{} numbers are announced, but {} vertices, {} edges and {} faces take {}{}", numbers.size(), n, e, f,
                                7 + 3 * n + 2 * e + 4 * f,
                                n <= 2 ? fmt::format(", or {} without edges and faces", 7 + 3 * n) : ""));
    return std::nullopt;
  }
  Numbers rest(numbers, counts[0], wrong);
  BodyForm form;
  const Vec3 diagonal = rest.vector(), off = rest.vector();
  form.inertia << diagonal[0], off[0], off[1], off[0], diagonal[1], off[2], off[1], off[2], diagonal[2];
  take_mesh(rest, counts, lists, form.core);
  form.diameter = rest.next();
  if (!(form.diameter > 0)) wrong.push_back(fmt::format("the rounding diameter is {}; it must be positive", form.diameter));
  if (wrong.size() == before)                                    // else what stands for the wrong numbers is wrong besides
    for (std::string& sentence : mistakes(form.core, form.diameter / 2)) wrong.push_back(std::move(sentence));
  if (std::string sentence = wrong_inertia(form.inertia); !sentence.empty()) wrong.push_back(std::move(sentence));
  return wrong.size() == before ? std::optional(std::move(form)) : std::nullopt;
}

}  // namespace elamin
