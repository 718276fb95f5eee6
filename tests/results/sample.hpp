#pragma once
// A small chain and points on a made-up path of it.
#include "energy/touch.hpp"
#include "model/model.hpp"
#include "path/point.hpp"
#include "input/problem.hpp"

/// Five particles along z with bonds and angles; the first is held in full, the last along x and z.
inline elamin::Model sample_model() {
  using namespace elamin;
  Model m;
  Field x(3, 5);
  for (int i = 0; i < 5; ++i) {
    x.col(i) = Vec3(0.1 * i, 0, i / 3.0);
    m.id.push_back(i + 1), m.type.push_back(1 + i % 2), m.molecule.push_back(1), m.diameter.push_back(0.3),
        m.density.push_back(800);
  }
  m.start = State(x);
  m.bond_types = {{100.0 / 3, 1.0 / 3}, {7, 0}};
  m.angle_types = {{1e-7 / 3}};
  for (int i = 0; i < 4; ++i) m.bonds.push_back({i == 3 ? 1 : 0, {i, i + 1}});
  for (int i = 0; i < 3; ++i) m.angles.push_back({0, {i, i + 1, i + 2}});
  m.groups = {{"all", {0, 1, 2, 3, 4}}, {"ends", {0, 4}}, {"two", {1, 2}}, {"none", {}}};
  Support first, last;
  first.group = "first", first.particles = {0};
  last.group = "last", last.particles = {4}, last.held = {true, false, true};
  m.supports = {first, last};
  Wall floor, side;
  floor.name = "floor", floor.group = "all", floor.particles = {0, 1, 2, 3, 4};
  side.name = "side", side.group = "two", side.particles = {1, 2};
  m.walls = {floor, side};
  return m;
}

inline elamin::PathPoint sample_point(const elamin::Model& m, int step, double lambda, const std::string& label = "") {
  elamin::PathPoint p;
  p.step = step, p.label = label, p.state = m.start, p.state.load_factor = lambda;
  p.state.position(0, 2) += lambda;
  p.energy.bond = 0.1 * step, p.energy.angle = 1.0 / 3, p.energy.external = -1e-3 * lambda;
  p.energy.contact = 0.5 * step, p.energy.wall = 0.25 * lambda, p.energy.cohesion = -0.125 * step;
  p.report.status = elamin::Status::converged, p.report.residual = 3e-14, p.report.iterations = 4;
  p.report.history = {{1.5, 1e-3, 1e-4, 0}, {1.25, 3e-14, 1e-9, 0}};
  p.stability.stable = true;
  return p;
}

/// Made-up contacts: 1–3 closed, 1–4 open, 2–4 closed, particle 0 on one and 1 on two faces of the floor, 2 near the side.
inline std::vector<elamin::Touch> sample_touches() {
  using elamin::Vec3;
  return {{1, 3, -1, -0.25, Vec3(0, 0, -8), Vec3(1, 2, 3)},   {1, 4, -1, 0.5, Vec3::Zero(), Vec3::Zero()},
          {2, 4, -1, -0.125, Vec3(3, 4, 0), Vec3::Zero()},    {0, -1, 0, -0.5, Vec3(0, 0, 16), Vec3::Zero()},
          {1, -1, 0, -0.75, Vec3(0, 0, 32), Vec3::Zero()},    {1, -1, 0, -0.0625, Vec3(-3, 0, 0), Vec3::Zero()},
          {2, -1, 1, 0.375, Vec3::Zero(), Vec3::Zero()}};
}

inline elamin::ObserveTable observe(const std::string& name, const std::string& group, elamin::Quantity q,
                                    elamin::Component c, elamin::Reduce r) {
  elamin::ObserveTable o;
  o.name = name, o.group = group, o.quantity = q, o.component = c, o.reduce = r;
  return o;
}
