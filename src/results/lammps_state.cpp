#include "results/lammps_state.hpp"

#include "laws/section.hpp"
#include "results/text_file.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>

namespace elamin {
namespace {

/// LAMMPS reads lines of at most 255 bytes; there must be room for a remark behind it.
std::string one_line(std::string title) {
  if (title.size() > 180) {
    std::size_t end = 180;
    while (end > 0 && (static_cast<unsigned char>(title[end]) & 0xC0) == 0x80) --end;   // not within a UTF-8 character
    title.resize(end);
  }
  for (char& c : title)
    if (static_cast<unsigned char>(c) < 32 || c == 127) c = ' ';
  return title;
}

struct Box { Vec3 lo, hi; };

/// All particles with room: a tenth of the largest extent, at least the largest diameter, and not lost in rounding.
Box box_around(const Field& x, const std::vector<double>& diameter) {
  Box box{x.col(0), x.col(0)};
  for (Eigen::Index i = 1; i < x.cols(); ++i)
    for (int c = 0; c < 3; ++c) box.lo[c] = std::min(box.lo[c], x(c, i)), box.hi[c] = std::max(box.hi[c], x(c, i));
  double room = *std::max_element(diameter.begin(), diameter.end());
  for (int c = 0; c < 3; ++c)
    room = std::max({room, 0.1 * (box.hi[c] - box.lo[c]), 1e-6 * std::abs(box.lo[c]), 1e-6 * std::abs(box.hi[c])});
  if (room == 0) room = 1;
  for (int c = 0; c < 3; ++c) box.lo[c] -= room, box.hi[c] += room;
  return box;
}

bool all_straight(const Model& model) {
  return std::all_of(model.angle_types.begin(), model.angle_types.end(), [](const AngleType& a) { return a.rest == pi; });
}

/// In degrees, exactly 180 for π, and so that degrees · (π/180) gives the same angle back where one of the doubles does.
double degrees(double angle) {
  if (angle == pi) return 180;
  const double near = angle * (180 / pi);
  for (const double d : {near, std::nextafter(near, 0.0), std::nextafter(near, 360.0)})
    if (d * (pi / 180) == angle) return d;
  return near;
}

int largest(const std::vector<int>& values) { return *std::max_element(values.begin(), values.end()); }

}  // namespace

void write_state(const std::string& file, const Model& model, const State& state, const std::string& title) {
  const int n = model.particles();
  const Field& x = state.position;
  const bool some_density = std::all_of(model.density.begin(), model.density.end(), [](double d) { return d > 0; });
  fmt::memory_buffer text;
  const auto put = [&](fmt::string_view format, const auto&... values) {
    fmt::vformat_to(std::back_inserter(text), format, fmt::make_format_args(values...));
  };
  put("{}{}\n\n", one_line(title), some_density ? "" : "; a density that is not given is written as 1");
  put("{} atoms\n{} bonds\n{} angles\n", n, model.bonds.size(), model.angles.size());
  put("{} atom types\n{} bond types\n{} angle types\n\n", largest(model.type), model.bond_types.size(),
      model.angle_types.size());
  const Box box = box_around(x, model.diameter);
  for (int c = 0; c < 3; ++c) put("{:.17g} {:.17g} {}lo {}hi\n", box.lo[c], box.hi[c], "xyz"[c], "xyz"[c]);
  if (!model.bond_types.empty()) {
    put("\nBond Coeffs # harmonic\n\n");
    for (std::size_t k = 0; k < model.bond_types.size(); ++k)
      put("{} {:.17g} {:.17g}\n", k + 1, model.bond_types[k].stiffness, model.bond_types[k].rest_length);
  }
  if (!model.angle_types.empty()) {
    const bool straight = all_straight(model);
    put("\nAngle Coeffs # {}\n\n", straight ? "cosine" : "cosine/shift");
    for (std::size_t k = 0; k < model.angle_types.size(); ++k) {
      const AngleType& a = model.angle_types[k];
      if (straight) put("{} {:.17g}\n", k + 1, a.stiffness);
      else put("{} {:.17g} {:.17g}\n", k + 1, 2 * a.stiffness, degrees(a.rest));   // U_min = 2B, θ₀
    }
  }
  put("\nAtoms # hybrid sphere angle\n\n");
  for (int i = 0; i < n; ++i)
    put("{} {} {:.17g} {:.17g} {:.17g} {:.17g} {:.17g} {}\n", model.id[i], model.type[i], x(0, i), x(1, i), x(2, i),
        model.diameter[i], model.density[i] > 0 ? model.density[i] : 1.0, model.molecule[i]);
  if (model.velocity.cols() > 0) {
    put("\nVelocities # hybrid sphere angle\n\n");
    const Field spin = model.spin.cols() > 0 ? model.spin : Field(Field::Zero(3, n));
    for (int i = 0; i < n; ++i)
      put("{} {:.17g} {:.17g} {:.17g} {:.17g} {:.17g} {:.17g}\n", model.id[i], model.velocity(0, i), model.velocity(1, i),
          model.velocity(2, i), spin(0, i), spin(1, i), spin(2, i));
  }
  if (!model.bonds.empty()) put("\nBonds\n\n");
  for (std::size_t k = 0; k < model.bonds.size(); ++k) {
    const Bond& b = model.bonds[k];
    put("{} {} {} {}\n", k + 1, b.type + 1, model.id[b.particles[0]], model.id[b.particles[1]]);
  }
  if (!model.angles.empty()) put("\nAngles\n\n");
  for (std::size_t k = 0; k < model.angles.size(); ++k) {
    const Angle& a = model.angles[k];
    put("{} {} {} {} {}\n", k + 1, a.type + 1, model.id[a.particles[0]], model.id[a.particles[1]],
        model.id[a.particles[2]]);
  }
  write_text(file, {text.data(), text.size()});
}

}  // namespace elamin
