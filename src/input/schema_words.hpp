#pragma once
// The words and ranges of a problem file.
#include "input/problem.hpp"

#include <limits>

namespace elamin {

/// What a number may be: lo ≤ x ≤ hi, or lo < x ≤ hi.
struct Range {
  double lo = -std::numeric_limits<double>::max(), hi = std::numeric_limits<double>::max();
  bool above = false;
};
inline constexpr int most_particles = 100'000'000, most_steps = 1'000'000, most_branches = 1000,
                     most_modes = 1000;
namespace range {
inline constexpr Range any{}, positive{0, any.hi, true}, not_negative{0}, count{1, most_particles};
inline constexpr Range id{1, std::numeric_limits<int>::max()};
inline constexpr Range poissons_ratio{-1, 0.5, true}, degrees{0, 180};
}  // namespace range

/// A word of the file and what it stands for.
template <class T> struct Word {
  const char* text;
  T value;
};
inline constexpr Word<Section> section_words[]{{"cylinder", Section::cylinder}, {"square", Section::square}};
inline constexpr Word<Profile> profile_words[]{{"circle", Profile::circle}, {"sine", Profile::sine}};
inline constexpr Word<ClampedEnds> clamped_words[]{
    {"from", ClampedEnds::from}, {"to", ClampedEnds::to}, {"both", ClampedEnds::both}};
inline constexpr Word<SheetShape> sheet_words[]{
    {"rectangle", SheetShape::rectangle}, {"circle", SheetShape::circle}, {"cylinder", SheetShape::cylinder}};
inline constexpr Word<BodyShape> body_words[]{{"sphere", BodyShape::sphere},
                                              {"rod", BodyShape::rod},
                                              {"tetrahedron", BodyShape::tetrahedron},
                                              {"cube", BodyShape::cube},
                                              {"box", BodyShape::box},
                                              {"mesh", BodyShape::mesh},
                                              {"molecule", BodyShape::molecule}};
inline constexpr Word<RemoveTable::What> remove_words[]{
    {"particles", RemoveTable::What::particles}, {"bonds", RemoveTable::What::bonds}, {"angles", RemoveTable::What::angles}};
inline constexpr Word<const char*> plane_words[]{{"xy", "xy"}, {"xz", "xz"}, {"yz", "yz"}};
inline constexpr Word<Shape> shape_words[]{{"plane", Shape::plane},
                                           {"block", Shape::block},
                                           {"cylinder", Shape::cylinder},
                                           {"sphere", Shape::sphere},
                                           {"cone", Shape::cone}};
inline constexpr Word<int> axis_words[]{{"x", 0}, {"y", 1}, {"z", 2}};
inline constexpr Word<const char*> block_faces[]{{"xlo", "xlo"}, {"xhi", "xhi"}, {"ylo", "ylo"},
                                                 {"yhi", "yhi"}, {"zlo", "zlo"}, {"zhi", "zhi"}};
inline constexpr Word<const char*> round_faces[]{{"lo", "lo"}, {"hi", "hi"}, {"side", "side"}};   // cylinder, cone
inline constexpr Word<bool> side_words[]{{"inside", true}, {"outside", false}};
inline constexpr Word<bool> effective_radius_words[]{{"particle", false}, {"curved", true}};
inline constexpr Word<const char*> law_words[]{{"hertz", "hertz"}, {"lj", "lj"}, {"rounded", "rounded"}};
inline constexpr Word<CutoffStyle> cutoff_style_words[]{{"cut", CutoffStyle::cut}, {"shifted", CutoffStyle::shifted}, {"smooth", CutoffStyle::smooth}};
inline constexpr Word<RoundedFormulation> formulation_words[]{{"multi", RoundedFormulation::multi},
                                                              {"closest", RoundedFormulation::closest},
                                                              {"lammps", RoundedFormulation::lammps}};
inline constexpr Word<bool> wall_formulation_words[]{{"potential", false}, {"lammps", true}};
inline constexpr Word<RoundedKernel::Form> kernel_words[]{{"lammps", RoundedKernel::Form::coded},
                                                          {"printed", RoundedKernel::Form::printed}};
inline constexpr Word<bool> rounded_damping_words[]{{"coded", false}, {"printed", true}};
inline constexpr Word<StudyType> study_words[]{{"energy", StudyType::energy},
                                               {"equilibrium", StudyType::equilibrium},
                                               {"path", StudyType::path},
                                               {"modes", StudyType::modes},
                                               {"dynamics", StudyType::dynamics}};
inline constexpr Word<PathMethod> path_method_words[]{{"load_steps", PathMethod::load_steps},
                                                      {"arc_length", PathMethod::arc_length}};
inline constexpr Word<WhenUnstable> when_unstable_words[]{
    {"jump", WhenUnstable::jump}, {"follow", WhenUnstable::follow}, {"stop", WhenUnstable::stop}};
inline constexpr Word<const char*> event_words[]{{"limit", "limit"}, {"branch", "branch"}, {"contact", "contact"}};
inline constexpr Word<const char*> solver_words[]{
    {"auto", "auto"},
    {"newton", "newton"},
    {"ipopt", "ipopt"},
    {"fire", "fire"},
    {"nlopt:LD_LBFGS", "nlopt:LD_LBFGS"},
    {"nlopt:LD_TNEWTON", "nlopt:LD_TNEWTON"},
    {"nlopt:LD_TNEWTON_RESTART", "nlopt:LD_TNEWTON_RESTART"},
    {"nlopt:LD_TNEWTON_PRECOND", "nlopt:LD_TNEWTON_PRECOND"},
    {"nlopt:LD_TNEWTON_PRECOND_RESTART", "nlopt:LD_TNEWTON_PRECOND_RESTART"},
    {"nlopt:LD_VAR1", "nlopt:LD_VAR1"},
    {"nlopt:LD_VAR2", "nlopt:LD_VAR2"},
    {"nlopt:LD_SLSQP", "nlopt:LD_SLSQP"},
    {"nlopt:LD_MMA", "nlopt:LD_MMA"},
    {"nlopt:LD_CCSAQ", "nlopt:LD_CCSAQ"},
    {"nlopt:LN_COBYLA", "nlopt:LN_COBYLA"},
    {"nlopt:LN_BOBYQA", "nlopt:LN_BOBYQA"},
    {"nlopt:LN_NEWUOA", "nlopt:LN_NEWUOA"},
    {"nlopt:LN_PRAXIS", "nlopt:LN_PRAXIS"},
    {"nlopt:LN_NELDERMEAD", "nlopt:LN_NELDERMEAD"},
    {"nlopt:LN_SBPLX", "nlopt:LN_SBPLX"},
    {"nlopt:G_MLSL", "nlopt:G_MLSL"},
    {"nlopt:G_MLSL_LDS", "nlopt:G_MLSL_LDS"},
    {"nlopt:GN_DIRECT", "nlopt:GN_DIRECT"},
    {"nlopt:GN_DIRECT_L", "nlopt:GN_DIRECT_L"},
    {"nlopt:GN_CRS2_LM", "nlopt:GN_CRS2_LM"},
    {"nlopt:GN_ISRES", "nlopt:GN_ISRES"},
    {"nlopt:GN_ESCH", "nlopt:GN_ESCH"}};
inline constexpr Word<ContactDamping::Model> damping_words[]{{"none", ContactDamping::Model::none},
                                                             {"velocity", ContactDamping::Model::velocity},
                                                             {"mass_velocity", ContactDamping::Model::mass_velocity},
                                                             {"viscoelastic", ContactDamping::Model::viscoelastic},
                                                             {"tsuji", ContactDamping::Model::tsuji}};
inline constexpr Word<Reduce> reduce_words[]{
    {"mean", Reduce::mean}, {"sum", Reduce::sum}, {"min", Reduce::min}, {"max", Reduce::max}};

/// What is observed: quantity and component in one word; a gap and contacts have no components.
struct Observed {
  Quantity quantity;
  Component component;
  bool operator==(const Observed&) const = default;
};
inline constexpr Word<Observed> observed_words[]{
    {"position.x", {Quantity::position, Component::x}},
    {"position.y", {Quantity::position, Component::y}},
    {"position.z", {Quantity::position, Component::z}},
    {"position.norm", {Quantity::position, Component::norm}},
    {"displacement.x", {Quantity::displacement, Component::x}},
    {"displacement.y", {Quantity::displacement, Component::y}},
    {"displacement.z", {Quantity::displacement, Component::z}},
    {"displacement.norm", {Quantity::displacement, Component::norm}},
    {"rotation.x", {Quantity::rotation, Component::x}},
    {"rotation.y", {Quantity::rotation, Component::y}},
    {"rotation.z", {Quantity::rotation, Component::z}},
    {"rotation.norm", {Quantity::rotation, Component::norm}},
    {"reaction.x", {Quantity::reaction, Component::x}},
    {"reaction.y", {Quantity::reaction, Component::y}},
    {"reaction.z", {Quantity::reaction, Component::z}},
    {"reaction.norm", {Quantity::reaction, Component::norm}},
    {"torque.x", {Quantity::torque, Component::x}},
    {"torque.y", {Quantity::torque, Component::y}},
    {"torque.z", {Quantity::torque, Component::z}},
    {"torque.norm", {Quantity::torque, Component::norm}},
    {"velocity.x", {Quantity::velocity, Component::x}},
    {"velocity.y", {Quantity::velocity, Component::y}},
    {"velocity.z", {Quantity::velocity, Component::z}},
    {"velocity.norm", {Quantity::velocity, Component::norm}},
    {"spin.x", {Quantity::spin, Component::x}},
    {"spin.y", {Quantity::spin, Component::y}},
    {"spin.z", {Quantity::spin, Component::z}},
    {"spin.norm", {Quantity::spin, Component::norm}},
    {"gap", {Quantity::gap, Component::x}},
    {"contacts", {Quantity::contacts, Component::x}}};

/// How the values of a group's particles become one where the file does not say it.
constexpr Reduce default_reduce(Quantity q) {
  if (q == Quantity::gap) return Reduce::min;
  return q == Quantity::reaction || q == Quantity::torque || q == Quantity::contacts ? Reduce::sum : Reduce::mean;
}

}  // namespace elamin
