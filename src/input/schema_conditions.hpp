#pragma once
// Keys of what acts on particles: groups, supports, loads, contacts, walls.
#include "input/schema_words.hpp"

#include <algorithm>
#include <cmath>
#include <optional>
#include <string>
#include <vector>

namespace elamin {

/// The faces of a region that are open, by name.
template <class IO, std::size_t n> void describe_open(IO& io, Region& r, const Word<const char*> (&faces)[n]) {
  std::vector<std::string> open;
  for (std::size_t i = 0; i < n; ++i)
    if (r.open[i]) open.push_back(faces[i].text);
  io.words("open", open, faces);
  for (std::size_t i = 0; i < n; ++i) r.open[i] = std::find(open.begin(), open.end(), faces[i].text) != open.end();
}

/// A region's keys stand among those of its table, after them: each shape has its own.
template <class IO> void describe_region(IO& io, Region& r) {
  if (!io.must_word("shape", r.shape, shape_words)) return io.skip_the_rest();   // other keys belong to other shapes
  std::vector<const char*> others{"point", "normal", "center",    "axis",      "radius",
                                  "lo",    "hi",     "radius_lo", "radius_hi", "open"};
  const auto has = [&](std::initializer_list<const char*> keys, const std::string& what) {
    for (const std::string key : keys) std::erase_if(others, [&](const char* other) { return key == other; });
    for (const char* other : others) io.foreign(other, what);
  };
  switch (r.shape) {
    case Shape::plane:
      io.must("point", r.center);
      io.must("normal", r.normal);
      return has({"point", "normal"}, "a plane, which has point and normal");
    case Shape::block:
      io.must("lo", r.lo);
      io.must("hi", r.hi);
      describe_open(io, r, block_faces);
      return has({"lo", "hi", "open"}, "a block, which has lo, hi and open");
    case Shape::sphere:
      io.must("center", r.center);
      io.must("radius", r.radius, range::positive);
      return has({"center", "radius"}, "a sphere, which has center and radius");
    case Shape::cylinder: {
      io.must_word("axis", r.axis, axis_words);
      io.center("center", r.center, r.axis);
      io.must("radius", r.radius, range::positive);
      std::optional<double> lo, hi;
      if (std::isfinite(r.axial_lo)) lo = r.axial_lo;
      if (std::isfinite(r.axial_hi)) hi = r.axial_hi;
      io.may("lo", lo);
      io.may("hi", hi);
      if (lo) r.axial_lo = *lo;
      if (hi) r.axial_hi = *hi;
      describe_open(io, r, round_faces);
      return has({"center", "axis", "radius", "lo", "hi", "open"},
                 "a cylinder, which has center, axis, radius, lo, hi and open");
    }
    case Shape::cone:
      io.must_word("axis", r.axis, axis_words);
      io.center("center", r.center, r.axis);
      io.must("radius_lo", r.radius_lo, range::not_negative);
      io.must("radius_hi", r.radius_hi, range::not_negative);
      io.must("lo", r.axial_lo);
      io.must("hi", r.axial_hi);
      describe_open(io, r, round_faces);
      return has({"center", "axis", "radius_lo", "radius_hi", "lo", "hi", "open"},
                 "a cone, which has center, axis, radius_lo, radius_hi, lo, hi and open");
  }
}

template <class IO> void describe(IO& io, GroupTable::Inside& t) { describe_region(io, t.region); }

template <class IO> void describe(IO& io, GroupTable& t) {
  io.name("name", t.name);
  io.one_or_more("of", t.of);
  io.one_or_more("except", t.except);
  io.may("first", t.first, range::count);
  io.may("last", t.last, range::count);
  io.may("middle", t.middle, range::count);
  io.may("ids", t.ids, range::id);
  io.table("inside", t.inside);
  io.table("outside", t.outside);
}

template <class IO> void describe(IO& io, SupportTable& t) {
  io.may_name("name", t.name);
  io.must("group", t.group);
  io.may("directions", t.directions);
  io.may("turns", t.turns);
  io.may("displacement", t.displacement);
  io.may("velocity", t.velocity);
  io.may("constant", t.constant);
  io.may("from_stage", t.from_stage);
  io.table("rotation", t.rotation);
}

template <class IO> void describe(IO& io, LoadTable& t) {
  io.may_name("name", t.name);
  io.must("group", t.group);
  io.may("force", t.force);
  io.may("total_force", t.total_force);
  io.may("radial", t.radial);
  io.may("center", t.center);
  io.may("axis", t.axis);
  io.may("point", t.point);
  io.may("torque", t.torque);
  io.may("constant", t.constant);
  io.may("from_stage", t.from_stage);
}

template <class IO> void describe(IO& io, GravityTable& t) {
  io.may_name("name", t.name);
  io.may("group", t.group);
  io.must("acceleration", t.acceleration);
  io.may("constant", t.constant);
  io.may("from_stage", t.from_stage);
}

template <class IO> void describe(IO& io, PressureTable& t) {
  io.may_name("name", t.name);
  io.must("loop", t.loop);
  io.must("pressure", t.pressure);
  io.may("constant", t.constant);
  io.may("from_stage", t.from_stage);
}

template <class IO> void describe(IO& io, ChangeTable& t) {
  io.may_name("name", t.name);
  io.must("group", t.group);
  io.may("rest_length", t.rest_length);
  io.may("bond_stiffness", t.bond_stiffness);
  io.may("angle_stiffness", t.angle_stiffness);
  io.may("constant", t.constant);
  io.may("from_stage", t.from_stage);
}

/// Damping and friction stand among the keys of a contact's table.
template <class IO> void describe_damping(IO& io, DampingKeys& d) {
  io.word("damping", d.model, damping_words);
  io.may("damping_coefficient", d.coefficient, range::not_negative);
  io.may("restitution", d.restitution, Range{0, 1});
  io.may("friction", d.friction, range::not_negative);
  io.may("friction_damping", d.friction_damping, range::not_negative);
}

/// The keys of rounded bodies; those that only LAMMPS's rules or only the potentials have belong to these.
template <class IO> void describe_rounded(IO& io, ContactTable& t) {
  RoundedKeys& r = t.rounded;
  io.must("k_n", r.k_n, range::not_negative);
  io.may("k_na", r.k_na, range::not_negative);
  io.may("cutoff", t.cutoff, range::not_negative);
  io.word("formulation", r.formulation, formulation_words);
  io.may("mu", r.mu, range::not_negative);
  io.may("c_n", r.c_n, range::not_negative);
  io.may("c_t", r.c_t, range::not_negative);
  if (r.formulation == RoundedFormulation::lammps) {
    for (const char* key : {"kernel", "slip", "damping"}) io.foreign(key, "formulation \"lammps\", whose rules are LAMMPS's own");
    io.may("delta_ua", r.delta_ua, range::positive);
    return;
  }
  io.word("kernel", r.kernel, kernel_words);
  io.may("slip", r.slip, range::not_negative);
  io.word("damping", r.apart, rounded_damping_words);
  io.foreign("delta_ua", "the potentials; it is for formulation \"lammps\"");
}

template <class IO> void describe(IO& io, ContactTable& t) {
  io.must("between", t.between);
  io.may("from_stage", t.from_stage);
  if (!io.word("law", t.law, law_words)) return io.skip_the_rest();   // other keys belong to other laws
  const auto foreign = [&](std::initializer_list<const char*> keys, const std::string& what) {
    for (const char* key : keys) io.foreign(key, what);
  };
  const auto hertz = {"youngs_modulus", "poissons_ratio", "effective_modulus", "hard", "damping_coefficient", "restitution", "friction",
                      "friction_damping"};
  const auto rounded = {"k_n", "k_na", "formulation", "kernel", "delta_ua", "mu", "c_n", "c_t", "slip"};
  if (t.law == "rounded") {
    const std::string has = "law \"rounded\", which has k_n, k_na, cutoff, formulation, kernel, delta_ua, mu, c_n, c_t, slip and damping";
    foreign(hertz, has), foreign({"epsilon", "sigma", "cutoff_style", "inner_cutoff", "exclude_bonds"}, has);
    return describe_rounded(io, t);
  }
  if (t.law == "hertz") {
    io.one_or_two("youngs_modulus", t.youngs_modulus, range::positive);
    io.one_or_two("poissons_ratio", t.poissons_ratio, range::poissons_ratio);
    io.may("effective_modulus", t.effective_modulus, range::not_negative);
    const std::string has = "law \"hertz\", which has youngs_modulus, poissons_ratio, effective_modulus, hard, damping and exclude_bonds";
    foreign({"epsilon", "sigma", "cutoff", "cutoff_style", "inner_cutoff"}, has), foreign(rounded, has);
    io.may("hard", t.hard);
    describe_damping(io, t.damping);
  } else {
    io.must("epsilon", t.epsilon, range::not_negative);
    io.must("sigma", t.sigma, range::positive);
    io.must("cutoff", t.cutoff, range::positive);
    io.word("cutoff_style", t.cutoff_style, cutoff_style_words);
    if (t.cutoff_style == CutoffStyle::smooth) io.must("inner_cutoff", t.inner_cutoff, range::positive);
    else io.foreign("inner_cutoff", "this cutoff_style; it is for \"smooth\", whose force goes to zero from there on");
    const std::string has = "law \"lj\", which has epsilon, sigma, cutoff, cutoff_style, inner_cutoff and exclude_bonds";
    foreign(hertz, has), foreign({"damping"}, has), foreign(rounded, has);
  }
  io.may("exclude_bonds", t.exclude_bonds, Range{0, 1000});
}

template <class IO> void describe(IO& io, WallTable& t) {
  io.name("name", t.name);
  io.may("group", t.group);
  io.word("side", t.inside, side_words);
  io.may("youngs_modulus", t.youngs_modulus, range::positive);
  io.may("poissons_ratio", t.poissons_ratio, range::poissons_ratio);
  io.may("effective_modulus", t.effective_modulus, range::not_negative);
  io.word("effective_radius", t.curved, effective_radius_words);
  io.may("displacement", t.displacement);
  io.may("radius_change", t.radius_change);
  io.may("hard", t.hard);
  describe_damping(io, t.damping);
  io.may("k_n", t.k_n, range::not_negative);
  io.may("k_na", t.k_na, range::not_negative);
  io.may("cutoff", t.cutoff, range::not_negative);
  io.may("c_n", t.c_n, range::not_negative);
  io.may("c_t", t.c_t, range::not_negative);
  io.word("formulation", t.lammps, wall_formulation_words);
  io.may("from_stage", t.from_stage);
  describe_region(io, t.region);
}

template <class IO> void describe(IO& io, ViscosityTable& t) {
  io.may("group", t.group);
  io.must("coefficient", t.coefficient, range::not_negative);
}

template <class IO> void describe(IO& io, VelocityTable& t) {
  io.may("group", t.group);
  io.may("velocity", t.velocity);
  io.may("spin", t.spin);
}

}  // namespace elamin
