#include "results/shot.hpp"

#include "core/text_file.hpp"
#include "energy/wall_group.hpp"
#include "model/entities.hpp"
#include "results/mode.hpp"
#include "results/surfaces.hpp"

#include <fmt/format.h>
#include <zlib.h>

#include <bit>
#include <cmath>
#include <new>

namespace elamin {
namespace {

static_assert(std::endian::native == std::endian::little);   // as the file says

// An array with one or three components, for every point or every cell.
struct Column {
  Column(std::string name_, int components_) : name(std::move(name_)), components(components_) {}
  void put(double v) { values.push_back(std::isfinite(v) ? v : 0); }
  void put(const Vec3& v) { for (const double x : v) put(x); }
  std::string name;
  int components;
  std::vector<double> values;
};

// The XML in front, the bytes that it points to behind.
class VtkFile {
 public:
  template <class Number> void array(const char* type, const std::string& name, const std::vector<Number>& numbers, const std::string& more = "") {
    xml_ += fmt::format("<DataArray type=\"{}\" Name=\"{}\"{} format=\"appended\" offset=\"{}\"/>\n", type, name, more, bytes_.size());
    const std::string packed = compressed(numbers.data(), numbers.size() * sizeof(Number));
    const std::uint64_t blocks = numbers.empty() ? 0 : 1;                 // as long as all of it, none shorter at the end
    std::vector<std::uint64_t> head{blocks, numbers.size() * sizeof(Number), 0};
    if (blocks) head.push_back(packed.size());
    bytes_.append(reinterpret_cast<const char*>(head.data()), head.size() * sizeof(std::uint64_t));
    if (blocks) bytes_ += packed;
  }
  void array(const Column& c) {
    array("Float64", c.name, c.values, c.components > 1 ? fmt::format(" NumberOfComponents=\"{}\"", c.components) : "");
  }
  void tag(const std::string& text) { xml_ += "<" + text + ">\n"; }
  void text(const std::string& name, const std::string& value) {
    std::string codes;
    for (const char c : value) codes += fmt::format("{} ", static_cast<unsigned char>(c));
    xml_ += fmt::format("<Array type=\"String\" Name=\"{}\" NumberOfTuples=\"1\" format=\"ascii\">{}0</Array>\n", name, codes);
  }
  std::string whole() const {
    return "<?xml version=\"1.0\"?>\n<VTKFile type=\"UnstructuredGrid\" version=\"1.0\" byte_order=\"LittleEndian\" header_type=\"UInt64\" "
           "compressor=\"vtkZLibDataCompressor\">\n" + xml_ +
           "<AppendedData encoding=\"raw\">\n_" + bytes_ + "\n</AppendedData>\n</VTKFile>\n";
  }

 private:
  static std::string compressed(const void* from, std::size_t bytes) {
    uLongf size = compressBound(static_cast<uLong>(bytes));
    std::string packed(size, '\0');
    if (compress2(reinterpret_cast<Bytef*>(packed.data()), &size, static_cast<const Bytef*>(from), static_cast<uLong>(bytes), Z_BEST_SPEED) != Z_OK)
      throw std::bad_alloc();                                            // the only way in which it can fail
    packed.resize(size);
    return packed;
  }
  std::string xml_, bytes_;
};

// Points and cells as they are added, the columns of each filled alongside.
class Grid {
 public:
  explicit Grid(const Shot& shot) : shot_(shot), model_(shot.model) {
    for (EntityColumn& c : columns_of(shot)) known_.push_back(std::move(c));
    for (const EntityColumn& c : known_) at_points_.emplace_back(c.name, static_cast<int>(c.components.size()));
    for (std::size_t k = 1; k <= shot.modes.size(); ++k) at_points_.emplace_back(fmt::format("mode_{}", k), 3);
  }

  void particles() {
    for (int i = 0; i < model_.particles(); ++i) {
      point(shot_.state.position.col(i), i, model_.diameter[i] / 2);
      for (std::size_t k = 0; k < shot_.modes.size(); ++k) at_points_[known_.size() + k].put(Vec3(shot_.modes[k].col(i)));
      cell(particle, vertex, {i}, id_of(model_, i), 0);
    }
  }

  void bonds() {
    for (std::size_t b = 0; b < shot_.fields.bonds.size(); ++b) {
      const auto& [i, j] = model_.bonds[b].particles;
      const BondField& f = shot_.fields.bonds[b];
      cell(bond, line, {i, j}, id_of(model_, i), id_of(model_, j));
      tension_.values.back() = finite(f.tension), strain_.values.back() = finite(f.strain);
    }
  }

  void angles() {
    for (std::size_t a = 0; a < shot_.fields.angles.size(); ++a) {
      const auto& [i, j, k] = model_.angles[a].particles;
      const AngleField& f = shot_.fields.angles[a];
      cell(angle, poly_line, {i, j, k}, id_of(model_, i), id_of(model_, k));
      curvature_.values.back() = finite(f.curvature), moment_.values.back() = finite(f.moment);
      set(moment_vector_, f.moment_vector);
    }
  }

  void contacts() {
    for (const Touch& t : closed_contacts(shot_.touches, model_, shot_.label)) {
      const int at = point(t.point);
      cell(contact, vertex, {at}, id_of(model_, t.particle), t.other >= 0 ? id_of(model_, t.other) : -1 - t.wall);
      gap_.values.back() = finite(t.gap);
      set(force_, t.force);
    }
  }

  void walls() {
    const Eigen::AlignedBox3d box = box_of(model_, shot_.state);
    for (std::size_t w = 0; w < model_.walls.size() && !box.isEmpty(); ++w) {
      const Surface s = surface_of(wall_at(model_.walls[w], shot_.state.load_factor).region.rounded(), box);
      const int first = static_cast<int>(points_.size() / 3);
      for (const Vec3& x : s.points) point(x);
      polygons(wall, s, first, -1 - static_cast<int>(w));
    }
  }

  void bodies() {
    std::vector<Surface> surfaces;
    for (const RoundedShape& s : model_.shapes) surfaces.push_back(surface_of(s));
    for (int b = 0; b < static_cast<int>(model_.bodies.size()); ++b) {
      const Surface& s = surfaces[model_.bodies[b].shape];
      const Pose& pose = shot_.state.bodies[b];
      const int first = static_cast<int>(points_.size() / 3);
      for (const Vec3& r : s.points) {
        const Vec3 arm = pose.rotation * r;
        point(pose.position.hi + arm, model_.particles() + b);
        for (std::size_t k = 0; k < shot_.modes.size(); ++k) {
          const Eigen::Matrix<double, 6, 1> v = body_motion(model_, shot_.modes[k], b);
          at_points_[known_.size() + k].put(Vec3(v.head<3>() + Vec3(v.tail<3>()).cross(arm)));
        }
      }
      polygons(body, s, first, model_.bodies[b].id);
    }
  }

  std::string text() const {
    VtkFile d;
    d.tag("UnstructuredGrid"), d.tag("FieldData");
    const std::string one = " NumberOfTuples=\"1\"";
    d.array("Int64", "step", std::vector<std::int64_t>{shot_.step}, one);
    d.array("Float64", shot_.motion ? "time" : "load_factor", std::vector<double>{shot_.parameter}, one);
    d.text("label", shot_.label);
    d.tag("/FieldData");
    d.tag(fmt::format("Piece NumberOfPoints=\"{}\" NumberOfCells=\"{}\"", points_.size() / 3, kinds_.size()));
    d.tag("PointData");
    d.array("Int32", "id", ids_);
    d.array(radius_);
    for (const Column& c : at_points_) d.array(c);
    d.tag("/PointData"), d.tag("CellData");
    d.array("Int32", "kind", kinds_), d.array("Int32", "first", first_), d.array("Int32", "second", second_);
    for (const Column* c : {&tension_, &strain_, &curvature_, &moment_, &moment_vector_, &gap_, &force_}) d.array(*c);
    d.tag("/CellData"), d.tag("Points");
    d.array("Float64", "Points", points_, " NumberOfComponents=\"3\"");
    d.tag("/Points"), d.tag("Cells");
    d.array("Int64", "connectivity", connectivity_), d.array("Int64", "offsets", offsets_), d.array("UInt8", "types", types_);
    d.tag("/Cells"), d.tag("/Piece"), d.tag("/UnstructuredGrid");
    return d.whole();
  }

 private:
  enum Kind { particle, bond, angle, contact, wall, body };
  static constexpr std::uint8_t vertex = 1, line = 3, poly_line = 4, polygon = 7;      // VTK's numbers

  static double finite(double v) { return std::isfinite(v) ? v : 0; }
  static void set(Column& c, const Vec3& v) {
    for (int k = 0; k < 3; ++k) c.values[c.values.size() - 3 + static_cast<std::size_t>(k)] = finite(v[k]);
  }

  // Of an entity, or of none; its modes are put by who knows them.
  int point(const Vec3& x, int entity = -1, double radius = 0) {
    points_.insert(points_.end(), x.begin(), x.end());
    ids_.push_back(entity < 0 ? 0 : id_of(model_, entity));
    radius_.put(radius);
    for (std::size_t c = 0; c < known_.size(); ++c)
      for (int k = 0; k < at_points_[c].components; ++k) at_points_[c].put(entity < 0 ? 0 : known_[c].values(k, entity));
    for (std::size_t c = known_.size(); c < at_points_.size() && entity < 0; ++c) at_points_[c].put(Vec3(Vec3::Zero()));
    return static_cast<int>(points_.size() / 3) - 1;
  }

  void cell(Kind kind, std::uint8_t type, const std::vector<int>& points, int first, int second) {
    kinds_.push_back(kind), first_.push_back(first), second_.push_back(second), types_.push_back(type);
    connectivity_.insert(connectivity_.end(), points.begin(), points.end());
    offsets_.push_back(static_cast<std::int64_t>(connectivity_.size()));
    for (Column* c : {&tension_, &strain_, &curvature_, &moment_, &gap_}) c->put(0);
    for (Column* c : {&moment_vector_, &force_}) c->put(Vec3(Vec3::Zero()));
  }

  void polygons(Kind kind, const Surface& s, int first_point, int who) {
    for (std::vector<int> p : s.polygons) {
      for (int& k : p) k += first_point;
      cell(kind, polygon, p, who, 0);
    }
  }

  const Shot& shot_;
  const Model& model_;
  EntityColumns known_;
  std::vector<double> points_;
  std::vector<std::int32_t> ids_, kinds_, first_, second_;
  std::vector<std::int64_t> connectivity_, offsets_;
  std::vector<std::uint8_t> types_;
  Column radius_{"radius", 1}, tension_{"tension", 1}, strain_{"strain", 1}, curvature_{"curvature", 1}, moment_{"moment", 1},
      moment_vector_{"moment_vector", 3}, gap_{"gap", 1}, force_{"force", 3};
  std::vector<Column> at_points_;      // those known, then the modes
};

}  // namespace

void write_vtu(const std::string& file, const Shot& shot) {
  Grid grid(shot);
  grid.particles(), grid.bonds(), grid.angles(), grid.contacts(), grid.walls(), grid.bodies();
  write_text(file, grid.text());
}

}  // namespace elamin
