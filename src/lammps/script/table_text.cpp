#include "lammps/script/table_text.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace elamin::script {

std::string vec(const Vec3& v) { return fmt::format("[{}, {}, {}]", v[0] + 0.0, v[1] + 0.0, v[2] + 0.0); }
std::string quoted(const std::string& s) { return '"' + s + '"'; }

std::string list_of(const std::vector<std::string>& items) {
  std::string text = "[";
  std::size_t line = 7;
  for (std::size_t k = 0; k < items.size(); ++k) {
    if (line + items[k].size() > 130) text += "\n  ", line = 2;
    text += items[k] + (k + 1 < items.size() ? ", " : "");
    line += items[k].size() + 2;
  }
  return text + "]";
}

std::string escaped(const std::string& s) {
  std::string r;
  for (const char c : s) {
    if (c == '"' || c == '\\') r += '\\';
    r += static_cast<unsigned char>(c) < 32 ? ' ' : c;
  }
  return r;
}

std::string ordinal(int k) { return std::to_string(k) + (k == 1 ? "st" : k == 2 ? "nd" : k == 3 ? "rd" : "th"); }

std::string region_text(const Region& r, bool inside) {
  std::string t = fmt::format("shape = \"{}\"\n", name_of(r.shape));
  if (!inside) t += "side = \"outside\"\n";
  std::vector<std::string> open;
  for (const std::string& face : r.open_faces()) open.push_back(quoted(face));
  switch (r.shape) {
    case Shape::plane: t += fmt::format("point = {}\nnormal = {}\n", vec(r.center), vec(r.normal)); break;
    case Shape::block: t += fmt::format("lo = {}\nhi = {}\n", vec(r.lo), vec(r.hi)); break;
    case Shape::sphere: t += fmt::format("center = {}\nradius = {}\n", vec(r.center), r.radius); break;
    case Shape::cylinder:
    case Shape::cone:
      t += fmt::format("axis = \"{}\"\ncenter = {}\n", "xyz"[r.axis], vec(r.center));
      t += r.shape == Shape::cylinder ? fmt::format("radius = {}\n", r.radius)
                                      : fmt::format("radius_lo = {}\nradius_hi = {}\n", r.radius_lo, r.radius_hi);
      if (r.axial_lo > -1e20) t += fmt::format("lo = {}\n", r.axial_lo);
      if (r.axial_hi < 1e20) t += fmt::format("hi = {}\n", r.axial_hi);
      break;
  }
  if (!open.empty()) t += fmt::format("open = {}\n", list_of(open));
  return t;
}

}  // namespace elamin::script
