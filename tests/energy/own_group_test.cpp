// Groups that a program adds to an energy.
#include "catch.hpp"
#include "energy/energy.hpp"
#include "energy/law_group.hpp"
#include "laws/harmonic_bond.hpp"
#include "solve/newton.hpp"

using namespace elamin;

namespace {

Model three_in_a_row() {
  Model model;
  Field x = Field::Zero(3, 3);
  x.row(0) << 0, 1, 2.25;
  x.row(1) << 0, 0.5, 0;
  model.start = State(x);
  model.diameter.assign(3, 1.0), model.density.assign(3, 1.0);
  return model;
}

std::unique_ptr<ElementGroup> bonds() {
  return std::make_unique<LawGroup<HarmonicBond>>(std::vector{HarmonicBond{3, 1}}, std::vector{0, 0},
                                                  std::vector<std::array<int, 2>>{{0, 1}, {1, 2}});
}

// An element of that many sites, with no energy.
class Wide final : public ElementGroup {
 public:
  explicit Wide(int n) : sites_(n, 0) {}
  int elements() const override { return 1; }
  int sites() const override { return static_cast<int>(sites_.size()); }
  std::span<const int> stencils() const override { return sites_; }
  void values(const State&, double* value) const override { *value = 0; }
  void derivatives(const State&, const Tangent&, double* value, double* gradient, double* hessian) const override {
    *value = 0, std::fill_n(gradient, gradient_size(), 0.0);
    if (hessian) std::fill_n(hessian, hessian_size(), 0.0);
  }
  bool residual_energy(const State&, const State&, double*) const override { return false; }

 private:
  std::vector<int> sites_;
};

}  // namespace

TEST_CASE("bonds that a program adds are the model's own under another name") {
  const Model bare = three_in_a_row();
  Model bonded = bare;
  bonded.bond_types = {{3, 1}}, bonded.bonds = {{0, {0, 1}}, {0, {1, 2}}};
  Energy added(bare), built_in(bonded);
  added.add("own", bonds());
  added.evaluate(bare.start), built_in.evaluate(bare.start);
  REQUIRE(added.last_terms().own.size() == 1);
  CHECK(added.last_terms().own[0].first == "own");
  CHECK(added.last_terms().own[0].second == built_in.last_terms().bond);
  CHECK(added.last_terms().total() == built_in.last_terms().total());
  CHECK(added.gradient() == built_in.gradient());
  CHECK(added.hessian().toDense() == built_in.hessian().toDense());
  CHECK(added.unbonded_dofs().empty());
  State state = bare.start;
  const Report report = Newton(added).minimise(state);
  CHECK(report.converged());
  CHECK((state.at(1) - state.at(0)).hi.norm() == Approx(1).epsilon(1e-12));
}

TEST_CASE("what cannot be added is refused") {
  const Model model = three_in_a_row();
  Energy energy(model);
  energy.add("own", bonds());
  CHECK_THROWS_AS(energy.add("own", bonds()), std::invalid_argument);
  CHECK_THROWS_AS(energy.add("bond", bonds()), std::invalid_argument);
  CHECK_THROWS_AS(energy.add("far", std::make_unique<LawGroup<HarmonicBond>>(std::vector{HarmonicBond{3, 1}}, std::vector{0},
                                                                             std::vector<std::array<int, 2>>{{0, 3}})),
                  std::invalid_argument);
  energy.add("twelve", std::make_unique<Wide>(Assembler::most_sites));
  CHECK_THROWS_AS(energy.add("wide", std::make_unique<Wide>(Assembler::most_sites + 1)), std::invalid_argument);
  CHECK(energy.terms(model.start).own.size() == 2);
}
