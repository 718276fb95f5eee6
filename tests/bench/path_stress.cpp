// Random path problems whose right outcome is known: by theory, by symmetry, or because the same problem with other steps and
// the other method must come to the same.
//
//     bench path_stress [--seed S] [--count M] [--family NAME] [--only SEED] [--keep DIR] [--jobs J] [--seconds T] [--least N]
//
// Problem number k has the seed S + k (default S = 1, M = 100); its family is the next one in turn, or NAME. Prints how many
// ended right, in all and by family, and a line for each that did not. --only: this one problem alone; --keep: its files are
// left in DIR, to be run by hand. Each problem runs in a process of its own, which may crash; after T seconds of the processor
// (default 60) it counts as one without end. Fails if one did not end right, or with --least if fewer than N of them did.
#include "core/exact.hpp"
#include "core/memory.hpp"
#include "core/parallel.hpp"
#include "energy/energy.hpp"
#include "input/build.hpp"
#include "input/read.hpp"
#include "study/trace.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <csignal>
#include <cstdint>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <functional>
#include <map>
#include <sys/time.h>
#include <sys/wait.h>
#include <unistd.h>

using namespace elamin;

namespace path_stress {

// ---- Random numbers: splitmix64, the same on every machine.

class Random {
 public:
  explicit Random(std::uint64_t seed) : state_(seed * 0x9e3779b97f4a7c15u + 0x2545f4914f6cdd1du) { bits(), bits(); }
  double unit() { return static_cast<double>(bits() >> 11) * 0x1p-53; }
  double between(double a, double b) { return a + (b - a) * unit(); }
  /// Evenly in the logarithm, rounded to six digits so that no library's pow matters.
  double decades(double a, double b) { return std::stod(fmt::format("{:.5e}", a * std::pow(b / a, unit()))); }
  int whole(int a, int b) { return a + static_cast<int>(bits() % static_cast<std::uint64_t>(b - a + 1)); }
  int whole_decades(int a, int b) { return std::clamp(static_cast<int>(std::lround(decades(a, b))), a, b); }
  bool chance(double p) { return unit() < p; }
  double sign() { return chance(0.5) ? 1 : -1; }
  Vec3 direction() {
    const double z = between(-1, 1), angle = between(0, 2 * pi), r = std::sqrt(1 - z * z);
    return {r * std::cos(angle), r * std::sin(angle), z};
  }
  int other_steps(int than) {
    for (;;)
      if (const int s = whole_decades(3, 200); s != than) return s;
  }

 private:
  std::uint64_t bits() {
    std::uint64_t z = state_ += 0x9e3779b97f4a7c15u;
    z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9u, z = (z ^ (z >> 27)) * 0x94d049bb133111ebu;
    return z ^ (z >> 31);
  }
  std::uint64_t state_;
};

// ---- Problem files.

std::string toml(double x) { return fmt::format("{:.17g}", x); }
std::string toml(int x) { return std::to_string(x); }
std::string toml(bool x) { return x ? "true" : "false"; }
std::string toml(const char* x) { return fmt::format("\"{}\"", x); }
std::string toml(const std::string& x) { return toml(x.c_str()); }
std::string toml(const Vec3& x) { return fmt::format("[{:.17g}, {:.17g}, {:.17g}]", x[0], x[1], x[2]); }
std::string toml(const std::vector<Vec3>& x) {
  std::string all;
  for (const Vec3& v : x) all += (all.empty() ? "" : ", ") + toml(v);
  return "[" + all + "]";
}

class File {
 public:
  File& list(const std::string& name) { return text_ += "\n[[" + name + "]]\n", *this; }
  File& table(const std::string& name) { return text_ += "\n[" + name + "]\n", *this; }
  template <class T>
  File& key(const std::string& name, const T& value) { return text_ += name + " = " + toml(value) + "\n", *this; }
  File& raw(const std::string& line) { return text_ += line + "\n", *this; }
  File& group(const std::string& name, const std::string& of, const std::string& line) {
    return list("group").key("name", name).key("of", of).raw(line);
  }
  const std::string& text() const { return text_; }

 private:
  std::string text_;
};

struct Way {
  PathMethod method = PathMethod::load_steps;
  int steps = 100;
  double to = 1;
  const char* when_unstable = "jump";
  int branches = 0;
  double from = 0;
  bool arcs() const { return method == PathMethod::arc_length; }
  std::string toml() const {
    std::string text = fmt::format("\n[path]\nmethod = \"{}\"\nsteps = {}\nto = {:.17g}\nwhen_unstable = \"{}\"\n",
                                   arcs() ? "arc_length" : "load_steps", steps, to, when_unstable);
    if (from != 0) text += fmt::format("from = {:.17g}\n", from);
    if (branches > 0) text += fmt::format("branches = {}\n", branches);
    if (arcs()) text += fmt::format("points = 20000\nlowest = {:.17g}\n", from - 1000 * std::abs(to - from));
    return text;
  }
};

/// A place in space, or in a plane, for a structure that is described in coordinates (s, t, u) of its own, u across the plane:
/// turned anyhow, or along the axes where supports must know directions.
struct Place3 {
  Vec3 origin = Vec3::Zero();
  Mat3 axes = Mat3::Identity();                 // columns: s, t, u
  std::string plane;                            // or ""
  Vec3 along(double s, double t, double u = 0) const { return axes * Vec3(s, t, u); }
  Vec3 at(double s, double t, double u = 0) const { return origin + along(s, t, u); }
  /// The letter of an axis, of a place along the axes.
  std::string letter(int k) const {
    Eigen::Index row = 0;
    axes.col(k).cwiseAbs().maxCoeff(&row);
    return std::string(1, "xyz"[row]);
  }
  File begin(const std::string& title) const {
    File file;
    file.key("title", title);
    if (!plane.empty()) file.key("plane", plane);
    return file;
  }
};

Place3 anywhere(Random& random, bool planar, double size, bool along_axes) {
  Place3 p;
  p.origin = random.chance(0.3) ? Vec3(Vec3::Zero()) : Vec3(random.between(0, 3) * size * random.direction());
  const int first = random.whole(0, 2);
  const bool odd = random.chance(0.5);
  Mat3 axes = Mat3::Zero();
  axes(first, 0) = random.sign(), axes((first + (odd ? 2 : 1)) % 3, 1) = random.sign(), axes((first + (odd ? 1 : 2)) % 3, 2) = 1;
  if (axes.determinant() < 0) axes.col(2) *= -1;
  const double angle = random.between(0, 2 * pi);
  if (planar) {
    std::string letters;
    for (int c = 0; c < 3; ++c)
      if (axes(c, 2) == 0) letters += "xyz"[c];
    p.plane = letters;
    if (!along_axes) {
      const Vec3 s = std::cos(angle) * axes.col(0) + std::sin(angle) * axes.col(1), t = std::cos(angle) * axes.col(1) - std::sin(angle) * axes.col(0);
      axes.col(0) = s, axes.col(1) = t;
    }
    for (int c = 0; c < 3; ++c)
      if (axes(c, 2) != 0) p.origin[c] = 0;
  } else if (!along_axes) {
    const Vec3 s = random.direction(), t = s.cross(random.direction()).normalized();
    axes.col(0) = s, axes.col(1) = t, axes.col(2) = s.cross(t);
  }
  p.axes = axes;
  return p;
}

// ---- What came of a problem.

struct Row {
  PathPoint point;
  int stage = 0;
  std::string kind() const {
    const std::size_t colon = point.label.find(':');
    return colon == std::string::npos ? "" : point.label.substr(0, colon);
  }
  double lambda() const { return point.state.load_factor; }
  double energy() const { return point.energy.total(); }
};

struct Traced {
  Model model;                                  // of the first stage
  std::vector<Row> rows;
  Outcome outcome;
  std::string name;
  bool done() const { return outcome.status == Status::converged && !rows.empty(); }
  const Row& last() const { return rows.back(); }
  std::vector<Row> events() const {
    std::vector<Row> found;
    for (const Row& r : rows)
      if (!r.kind().empty()) found.push_back(r);
    return found;
  }
  std::vector<Row> of(const std::string& kind) const {
    std::vector<Row> found;
    for (const Row& r : rows)
      if (r.kind() == kind) found.push_back(r);
    return found;
  }
  std::vector<Row> on_branch(int k) const {
    std::vector<Row> found;
    for (const Row& r : rows)
      if (r.point.branch == k) found.push_back(r);
    return found;
  }
  /// Such as "branch 0.5, jump 0.51".
  std::string told() const {
    std::string all;
    for (const Row& r : events()) all += fmt::format("{}{} {:.10g}", all.empty() ? "" : ", ", r.kind(), r.lambda());
    return all.empty() ? "none" : all;
  }
};

constexpr double of_events = 1e-9;              // load factors: known ones of their own size, those of two runs of the path's range
constexpr double of_states = 1e-8;              // positions, of the structure's size
constexpr double of_energies = 1e-9;            // relative
constexpr double of_round = 1e-6;               // a ring's radii at its branch point, where the residual moves it most
constexpr double of_gaps = 1e-9;                // at a contact, of the size of what touches

/// One problem at work: runs what a family writes, and keeps what is wrong.
class Case {
 public:
  Case(std::string family, std::uint64_t seed, std::string directory) : random(seed), family_(std::move(family)), seed_(seed), directory_(std::move(directory)) {}

  Traced trace(const std::string& text, const std::string& name) {
    const std::string file = fmt::format("{}/{}-{}-{}.toml", directory_, family_, seed_, name);
    std::ofstream(file) << text;
    const Problem problem = read_problem(file);
    const Model model = build_model(problem);
    Traced t;
    t.name = name;
    int stage = -1;
    const Sink sink{.stage = [&](const Stage&, Energy& energy) { if (++stage == 0) t.model = energy.model(); },
                    .point = [&](const PathPoint& point, bool) { t.rows.push_back({point, stage}); },
                    .modes = [](const PathPoint&, const std::vector<Mode>&) {},
                    .note = [](const std::string&) {}};
    t.outcome = elamin::trace(problem, model, {}, sink);
    return t;
  }
  Traced trace(const File& file, const Way& way, const std::string& name) { return trace(file.text() + way.toml(), name); }

  void wrong(std::string sentence) { wrong_.push_back(std::move(sentence)); }
  bool expect(bool fulfilled, const std::function<std::string()>& sentence) {
    if (!fulfilled) wrong(sentence());
    return fulfilled;
  }
  const std::vector<std::string>& mistakes() const { return wrong_; }

  /// Status 0, the last point at `to` exactly, nothing that is no number, no point of the path beyond its range.
  bool reaches(const Traced& t, double to) {
    if (!ends(t)) return false;
    return expect(t.last().lambda() == to, [&] { return fmt::format("{}: ends at {:.17g}, not at {:.17g}: {}", t.name, t.last().lambda(), to, t.outcome.why); });
  }
  bool ends(const Traced& t) {
    if (!expect(t.done(), [&] { return fmt::format("{}: not converged: {} (events: {})", t.name, t.outcome.why, t.told()); })) return false;
    for (const Row& r : t.rows)
      if (!std::isfinite(r.energy()) || !std::isfinite(r.lambda())) return wrong(fmt::format("{}: not a number at step {}", t.name, r.point.step)), false;
    return falls(t);
  }

  /// Every fall has its event before it and ends in a minimum.
  bool falls(const Traced& t) {
    bool right = true;
    for (std::size_t k = 0; k < t.rows.size(); ++k) {
      const Row& r = t.rows[k];
      if (r.kind() != "jump") continue;
      right &= expect(k > 0 && !t.rows[k - 1].kind().empty() && r.point.parent == t.rows[k - 1].point.label,
                      [&] { return fmt::format("{}: {} at {:.10g} has no event before it", t.name, r.point.label, r.lambda()); });
      right &= expect(r.point.stability.negative == 0, [&] { return fmt::format("{}: {} does not end in a minimum", t.name, r.point.label); });
      double from = 0, to = 0;
      if (std::sscanf(r.point.what.c_str(), "from energy %lf to %lf", &from, &to) == 2)
        right &= expect(to <= from + 1e-9 * std::abs(from), [&] { return fmt::format("{}: {} gains energy: {}", t.name, r.point.label, r.point.what); });
    }
    return right;
  }

  /// The list of events is this one: kinds and load factors, in their order.
  /// `of`: what load factors are measured by, besides their own size.
  bool has_events(const Traced& t, const std::vector<std::pair<std::string, double>>& expected, double tolerance = of_events, bool without_jumps = true, double of = 0) {
    std::vector<Row> found = t.events();
    if (without_jumps) std::erase_if(found, [](const Row& r) { return r.kind() == "jump"; });
    const auto told = [&] {
      std::string all;
      for (const auto& [kind, lambda] : expected) all += fmt::format("{}{} {:.10g}", all.empty() ? "" : ", ", kind, lambda);
      return fmt::format("{}: events {}; expected {}", t.name, t.told(), all.empty() ? "none" : all);
    };
    if (!expect(found.size() == expected.size(), told)) return false;
    double range = 0;
    for (const Row& r : t.rows) range = std::max(range, std::abs(r.lambda()));
    bool right = true;
    for (std::size_t k = 0; k < found.size() && right; ++k) {
      const auto& [kind, lambda] = expected[k];
      right = expect(found[k].kind() == kind, told);
      const double off = std::abs(found[k].lambda() - lambda) / std::max({std::abs(lambda), 1e-3 * range, of});
      right = right && expect(off <= tolerance, [&] { return fmt::format("{}: {} at {:.17g}, expected {:.17g}: off by {:.2g}", t.name, found[k].point.label, found[k].lambda(), lambda, off); });
    }
    return right;
  }

  /// Two runs of one problem: the same events (before a first fall, whose landing may depend on where it was made) and the
  /// same end.
  bool agree(const Traced& a, const Traced& b, bool end_too = true) {
    const auto sorted = [](const Traced& t, bool& whole) {
      std::vector<Row> e = t.events();
      const auto fall = std::find_if(e.begin(), e.end(), [](const Row& r) { return r.kind() == "jump"; });
      whole = fall == e.end();
      e.erase(fall, e.end());
      return e;
    };
    bool whole_a = true, whole_b = true;
    const std::vector<Row> x = sorted(a, whole_a), y = sorted(b, whole_b);
    const bool both_whole = whole_a && whole_b;
    const auto told = [&] { return fmt::format("{}: events {}; {}: {}", a.name, a.told(), b.name, b.told()); };
    if (both_whole ? !expect(x.size() == y.size(), told) : !expect(whole_a ? x.size() >= y.size() : whole_b ? y.size() >= x.size() : x.size() == y.size(), told)) return false;
    double range = 0;
    for (const Row& r : a.rows) range = std::max(range, std::abs(r.lambda()));
    for (std::size_t k = 0; k < std::min(x.size(), y.size()); ++k) {
      const double off = std::abs(x[k].lambda() - y[k].lambda()) / range;
      if (!expect(x[k].kind() == y[k].kind() && off <= of_events && x[k].point.multiplicity == y[k].point.multiplicity,
                  [&] { return fmt::format("{}, off by {:.2g}", told(), off); })) return false;
    }
    return !(both_whole && end_too) || same_state(a, a.last(), b, b.last());
  }

  bool same_state(const Traced& a, const Row& x, const Traced& b, const Row& y, double tolerance = of_states) {
    const double size = extent(a.model), moved = displacement(x.point.state, y.point.state).cwiseAbs().maxCoeff();
    return expect(moved <= tolerance * size, [&] {
      return fmt::format("{} and {} end in other states: {:.2g} of the size apart, energies {:.12g} and {:.12g}", a.name, b.name, moved / size, x.energy(), y.energy());
    });
  }
  bool same_energy(const std::string& what, double x, double y) {
    return expect(std::abs(x - y) <= of_energies * std::max(std::abs(x), std::abs(y)), [&] { return fmt::format("{}: energy {:.12g}, expected {:.12g}", what, x, y); });
  }
  bool index_is(const Traced& t, int negative) {
    for (const Row& r : t.rows)
      if (r.point.stability.negative != negative)
        return wrong(fmt::format("{}: Morse index {} at {:.10g}, expected {}", t.name, r.point.stability.negative, r.lambda(), negative)), false;
    return true;
  }

  /// At every contact event something has no gap, and it is said what.
  bool touches(const Traced& t) {
    Energy energy(t.model);
    bool right = true;
    for (const Row& r : t.of("contact")) {
      double least = std::numeric_limits<double>::infinity(), size = 0;
      for (const double d : t.model.diameter) size = std::max(size, d);
      for (const Wall& w : t.model.walls)
        if (!t.model.bodies.empty()) size = std::max(size, (w.region.center - t.model.walls[0].region.center).norm());
      for (const Touch& touch : energy.touches(r.point.state, 1e-6 * size)) least = std::min(least, std::abs(touch.gap));
      right &= expect(least <= of_gaps * size, [&] { return fmt::format("{}: {} at {:.10g} has a gap of {:.2g} of the size", t.name, r.point.label, r.lambda(), least / size); });
      right &= expect(!r.point.what.empty(), [&] { return fmt::format("{}: {} at {:.10g} does not say what touches", t.name, r.point.label, r.lambda()); });
    }
    return right;
  }

  static double extent(const Model& model) {
    double size = 0;
    if (model.particles() > 0) size = (model.start.position.rowwise().maxCoeff() - model.start.position.rowwise().minCoeff()).maxCoeff();
    for (const double d : model.diameter) size = std::max(size, d);
    for (std::size_t a = 0; a < model.start.bodies.size(); ++a)
      for (std::size_t b = 0; b <= a; ++b) size = std::max(size, (model.start.bodies[a].position.hi - model.start.bodies[b].position.hi).norm());
    return size;
  }

  Random random;

 private:
  std::string family_;
  std::uint64_t seed_;
  std::string directory_;
  std::vector<std::string> wrong_;
};

// ---- Columns.

enum class Ends { clamped, hinged, cantilever };

/// A straight chain, compressed by shortening or by a dead load. Exact: P a = 4B sin²(k/2) for the force P and length a of its
/// bonds, with the mode sin² or sin: k/2 = π/(N + 2) clamped (N free particles), π/(2n) hinged (n links), π/(2(2N + 1)) cantilever.
struct Column {
  Ends ends = Ends::clamped;
  bool dead = false, planar = true;
  int particles = 0, first = 0, last = 0;       // of the compressed part; first and last are its ends
  double EA = 0, EI = 1, length = 1, slenderness = 0, diameter = 0;   // slenderness: EA L²/EI
  double euler = 0;                             // the continuum's critical force, to size things
  Place3 place;
  double drive = 0;                             // at load factor 1: shortening, or force
  double sine = 0;                              // sin(k/2)
  int rooted() const { return ends == Ends::hinged ? 1 : 2; }
  int headed() const { return ends == Ends::cantilever ? 0 : rooted(); }
  Vec3 at(double s) const { return place.at(s * length, 0); }
};

Column random_column(Random& random, Ends ends, bool dead, bool planar, double least = 1e3, double most = 1e9) {
  Column c;
  c.ends = ends, c.dead = dead, c.planar = planar;
  c.particles = random.whole_decades(8, 400);
  c.length = random.decades(1e-6, 1e3);
  c.slenderness = random.decades(least, most);
  const double force = random.decades(1e-9, 1e9);                  // EI/L²
  c.EI = force * c.length * c.length, c.EA = c.slenderness * force;
  c.place = anywhere(random, planar, c.length, dead && ends != Ends::cantilever);
  if (ends == Ends::clamped && dead) c.particles = std::max(c.particles, 20);      // a polygon of few links has a limit point soon
  const int free = c.particles - c.rooted() - c.headed();
  c.first = c.rooted() - 1, c.last = ends == Ends::cantilever ? c.particles - 1 : c.particles - c.headed();
  c.sine = std::sin(ends == Ends::clamped ? pi / (free + 2) : ends == Ends::hinged ? pi / (2.0 * (c.particles - 1)) : pi / (2.0 * (2 * free + 1)));
  const double spacing = c.length / (c.particles - 1);
  c.euler = 4 * c.EI / (spacing * spacing) * c.sine * c.sine;
  c.diameter = spacing * (random.chance(0.5) ? 1 : random.between(0.05, 1));
  const double strain = c.euler / c.EA, critical = random.between(0.2, 0.9);
  const double unit = random.chance(0.5) ? 1 : random.decades(1e-3, 1e3);
  c.drive = (dead ? c.euler : strain * (c.last - c.first) * spacing) / critical / unit;
  return c;
}

File written(const Column& c, const std::string& title) {
  File f = c.place.begin(title);
  f.list("beam").key("name", "column").key("particles", c.particles).key("from", c.at(0)).key("to", c.at(1)).key("diameter", c.diameter)
      .key("axial_stiffness", c.EA).key("bending_stiffness", c.EI);
  f.group("foot", "column", fmt::format("first = {}", c.rooted())).list("support").key("group", "foot");
  const Vec3 down = -c.drive * c.place.along(1, 0);
  if (c.headed() > 0) {
    f.group("head", "column", fmt::format("last = {}", c.headed())).list("support").key("name", "press").key("group", "head");
    if (!c.dead) f.key("displacement", down);
    else f.key("directions", c.planar ? c.place.letter(1) : c.place.letter(1) + c.place.letter(2));
  }
  if (c.dead) f.group("tip", "column", "last = 1").list("load").key("name", "press").key("group", "tip").key("force", down);
  return f;
}

/// The critical load factor of the column as it was built: its numbers are those of the model.
double critical_load(const Column& c, const Model& m) {
  const double K = m.bond_types[0].stiffness, q0 = m.bond_types[0].rest_length, B = m.angle_types[0].stiffness;
  const double mu = 4 * B * c.sine * c.sine;
  const double a = q0 * (1 + std::sqrt(1 - 2 * mu / (K * q0 * q0))) / 2;
  if (c.dead) return mu / a / c.drive;
  const ExactVector d = m.start.at(c.last) - m.start.at(c.first);
  const Exact square = dot(d, d);
  const double s = std::sqrt(square.hi);
  const Exact rest = square - two_product(s, s);                  // |d| = s + rest/(2s)
  const int n = c.last - c.first;
  const Exact slack = Exact{s, 0} + rest.value() / (2 * s) - two_product(n, q0);
  return (n * (mu / (2 * K * a)) + slack.value()) / c.drive;
}

/// Displacements across the axis at one state.
Vec3 sideways(const Column& c, const Traced& t, const Row& r, int particle) {
  const Vec3 d = r.point.state.position.col(particle) - t.model.start.position.col(particle);
  const Vec3 s = c.place.along(1, 0);
  return d - d.dot(s) * s;
}

int random_middle(Random& random, const Column& c) {
  return std::clamp(static_cast<int>(std::lround(random.between(0.25, c.ends == Ends::cantilever ? 1.0 : 0.75) * (c.particles - 1))),
                    c.rooted(), c.particles - 1 - c.headed());
}

Ends random_ends(Random& random) { return std::vector{Ends::clamped, Ends::hinged, Ends::cantilever}[random.whole(0, 2)]; }

/// Between this and the next critical load, and where a column under a dead load is not bent too far.
/// (In space a clamped column that is bent by 70 degrees turns out of its plane, at 1.22 of its critical load.)
double beyond_critical(Random& random, const Column& c) {
  return random.between(1.02, !c.dead ? 1.8 : c.planar ? 1.3 : 1.1);
}

Column some_column(Random& random) {
  const Ends ends = random_ends(random);
  return random_column(random, ends, ends == Ends::cantilever || random.chance(0.4), random.chance(0.6));
}

/// The first run tells the critical load factor; then `to` is known. (A run of one step that is stopped at once.)
double built_critical(Case& test, const Column& c, const File& f) {
  const std::string file = f.text() + Way{.steps = 1, .to = 1}.toml();
  return critical_load(c, test.trace(f.text() + "\n[study]\ntype = \"energy\"\n", "built").model);
}

void column_straight(Case& test) {
  Random& random = test.random;
  const Column c = some_column(random);
  const File f = written(c, "A perfect column, on its straight path");
  const double critical = built_critical(test, c, f);
  const bool stop = random.chance(0.4);
  Way way{.method = random.chance(0.5) ? PathMethod::arc_length : PathMethod::load_steps, .steps = random.whole_decades(3, 200),
          .to = beyond_critical(random, c) * critical, .when_unstable = stop ? "stop" : "follow"};
  const Traced t = test.trace(f, way, "path");
  if (stop ? !test.ends(t) : !test.reaches(t, way.to)) return;
  if (!test.has_events(t, {{"branch", critical}})) return;
  const Row event = t.of("branch")[0];
  const int each = c.planar ? 1 : 2;
  test.expect(event.point.multiplicity == each, [&] { return fmt::format("multiplicity {}, expected {}", event.point.multiplicity, each); });
  for (const Row& r : t.rows)
    if (r.kind().empty())
      if (!test.expect(r.point.stability.negative == (r.lambda() > critical ? each : 0), [&] { return fmt::format("Morse index {} at {:.10g}", r.point.stability.negative, r.lambda()); })) return;
}

void column_falls(Case& test) {
  Random& random = test.random;
  const Column c = some_column(random);
  const File f = written(c, "A perfect column falls");
  const double critical = built_critical(test, c, f);
  Way way{.method = random.chance(0.3) ? PathMethod::arc_length : PathMethod::load_steps, .steps = random.whole_decades(3, 200), .to = beyond_critical(random, c) * critical};
  const Traced t = test.trace(f, way, "path");
  if (!test.reaches(t, way.to) || !test.has_events(t, {{"branch", critical}})) return;
  if (!test.expect(t.of("jump").size() == 1, [&] { return "events " + t.told() + "; expected one fall"; })) return;
  test.expect(t.last().point.stability.negative == 0, [&] { return "the end is not stable"; });
  way.steps = random.other_steps(way.steps), way.method = PathMethod::load_steps;
  const Traced other = test.trace(f, way, "other");
  if (test.reaches(other, way.to) && test.has_events(other, {{"branch", critical}})) test.same_energy("the end of both runs", t.last().energy(), other.last().energy());
}

void column_branches(Case& test) {
  Random& random = test.random;
  const Column c = some_column(random);
  const File f = written(c, "A perfect column, along its side branches");
  const double critical = built_critical(test, c, f);
  Way way{.method = PathMethod::arc_length, .steps = random.whole_decades(3, 200), .to = beyond_critical(random, c) * critical, .when_unstable = "follow", .branches = 1};
  const Traced t = test.trace(f, way, "path");
  if (!test.reaches(t, way.to) || !test.has_events(t, {{"branch", critical}})) return;
  const int branches = t.last().point.branch;
  if (!test.expect(c.planar ? branches == 2 : branches >= 1, [&] { return fmt::format("{} side branches", branches); })) return;
  const Way down{.steps = random.other_steps(way.steps), .to = way.to};
  const Traced fall = test.trace(f, down, "fall");
  const bool fallen = fall.done() && fall.last().lambda() == way.to;      // another family is about that
  const double straight = t.on_branch(0).back().energy();
  Vec3 sum = Vec3::Zero();
  double most = 0;
  for (int k = 1; k <= branches; ++k) {
    const std::vector<Row> rows = t.on_branch(k);
    const Row& end = rows.back();
    if (!test.expect(end.lambda() == way.to, [&] { return fmt::format("side branch {} ends at {:.17g}", k, end.lambda()); })) return;
    for (const Row& r : rows) {
      if (!test.expect(r.lambda() <= way.to && r.lambda() >= critical * (1 - 1e-9), [&] { return fmt::format("side branch {} is at {:.17g}", k, r.lambda()); })) return;
      if (!test.expect(r.point.stability.negative == 0, [&] { return fmt::format("side branch {} has Morse index {} at {:.10g}", k, r.point.stability.negative, r.lambda()); })) return;
    }
    test.expect(end.energy() < straight, [&] { return fmt::format("side branch {} ends higher than the straight column", k); });
    test.same_energy(fmt::format("the ends of side branches 1 and {}", k), end.energy(), t.on_branch(1).back().energy());
    if (fallen) test.same_energy("the end of a side branch and of the fall", end.energy(), fall.last().energy());
    const Vec3 w = sideways(c, t, end, c.particles / 2);
    sum += w, most = std::max(most, w.norm());
  }
  if (c.planar) test.expect(sum.norm() <= 1e-7 * most, [&] { return fmt::format("the side branches do not mirror each other: {:.2g}", sum.norm() / most); });
}

void column_pushed(Case& test) {
  Random& random = test.random;
  Column c = some_column(random);
  const double push = random.decades(1e-9, 1e-3);
  File f = written(c, "A column that is pushed sideways");
  const int particle = random_middle(random, c);
  const double angle = c.planar ? (random.chance(0.5) ? 0 : pi) : random.between(0, 2 * pi);
  const Vec3 side = c.place.along(0, std::cos(angle), c.planar ? 0 : std::sin(angle));
  f.group("pushed", "column", fmt::format("ids = [{}]", particle + 1));
  f.list("load").key("name", "push").key("group", "pushed").key("force", Vec3(push * c.euler * side)).key("constant", true);
  const double critical = built_critical(test, c, f);
  Way way{.method = random.chance(0.5) ? PathMethod::arc_length : PathMethod::load_steps, .steps = random.whole_decades(3, 200),
          .to = (c.dead ? beyond_critical(random, c) + 0.02 : random.between(1.1, 3)) * critical, .when_unstable = random.chance(0.5) ? "follow" : "jump"};
  if (!way.arcs()) way.when_unstable = "jump";
  const Traced t = test.trace(f, way, "path");
  if (!test.reaches(t, way.to)) return;
  test.has_events(t, {}, of_events, false);
  test.index_is(t, 0);
  test.expect(sideways(c, t, t.last(), particle).dot(side) > 0, [] { return "it went to the other side than it was pushed to"; });
  // The same end along another way: pushed much more first, then shortened, then let go.
  File g = f;
  g.list("load").key("name", "hand").key("group", "pushed").key("force", Vec3(0.03 * c.euler * side));
  g.raw("\n[path]\nsteps = 30");
  g.list("stage").key("name", "push").raw("vary = [\"load.hand\"]\nto = 1");
  g.list("stage").key("name", "shorten").raw(c.dead ? "vary = [\"load.press\"]" : "vary = [\"support.press\"]").key("to", way.to);
  g.list("stage").key("name", "let_go").raw("vary = [\"load.hand\"]\nto = 0");
  const Traced reference = test.trace(g.text(), "reference");
  if (!test.ends(reference)) return;
  test.same_energy("the end and that of the reference", t.last().energy(), reference.last().energy());
  if (c.planar) return (void)test.same_state(t, t.last(), reference, reference.last());
  // In space the push alone says which way: the residual, 1e-10 of the largest force (between neighbours in bending up to as many times the
  // load as there are particles), turns it by that much of the push.
  const Vec3 w = sideways(c, t, t.last(), particle), v = sideways(c, reference, reference.last(), particle);
  test.expect(std::abs(w.norm() - v.norm()) <= 1e-7 * v.norm() && (w - v).norm() <= (1e-7 + 1e-10 * c.particles / push) * v.norm(),
              [&] { return fmt::format("ends in another state than the reference, by {:.2g} and {:.2g} of the deflection", w.norm() / v.norm() - 1, (w - v).norm() / v.norm()); });
}

// ---- Arches.

void arch_sine(Case& test) {
  Random& random = test.random;
  const int links = 2 * random.whole_decades(4, 40);
  const double length = random.decades(1e-6, 1e3), EI = random.decades(1e-6, 1e6), slender = random.decades(1e7, 1e9);   // EA L²/EI
  const double rho = length / std::sqrt(slender), ratio = 4 * std::pow(std::cos(pi / (2 * links)), 2);
  double height;                                                  // Fung and Kaplan's λ
  do height = random.between(1.2, 2.85);
  while (std::abs(height * height - ratio) < 0.2 || std::abs(height * height - (3 * ratio - 1) / 2) < 0.25);
  const double rise = 2 * rho * height, k2 = 4 * std::pow(std::sin(pi / (2 * links)) * links / length, 2);
  const Place3 p = anywhere(random, true, length, false);
  File f = p.begin("A shallow sine arch under a sine load");
  f.list("beam").key("name", "arch").key("particles", links + 1).key("from", p.at(0, 0)).key("to", p.at(length, 0)).key("toward", p.along(0, 1))
      .key("rise", rise).key("profile", "sine").key("rest", "as_built").key("diameter", length / links / 2)
      .key("axial_stiffness", slender * EI / (length * length)).key("bending_stiffness", EI);
  f.group("feet", "arch", fmt::format("ids = [1, {}]", links + 1)).list("support").key("group", "feet");
  for (int i = 1; i < links; ++i) {
    f.group(fmt::format("p{}", i), "arch", fmt::format("ids = [{}]", i + 1));
    f.list("load").key("group", fmt::format("p{}", i)).key("force", p.along(0, -2 * rho * EI * k2 * k2 * length / links * std::sin(pi * i / links)));
  }
  const double square = height * height, fold = std::sqrt(4 * std::pow(square - 1, 3) / 27);
  std::vector<std::pair<std::string, double>> expected{{"limit", height + fold}, {"limit", height - fold}};
  if (square > ratio) {
    const double sway = (ratio - 1) * std::sqrt(square - ratio);
    const bool before = square - ratio > (square - 1) / 3;        // the sway's amplitude against the fold's
    expected = before ? std::vector<std::pair<std::string, double>>{{"branch", height + sway}, {"limit", height + fold}, {"limit", height - fold}, {"branch", height - sway}}
                      : std::vector<std::pair<std::string, double>>{{"limit", height + fold}, {"branch", height + sway}, {"branch", height - sway}, {"limit", height - fold}};
  }
  Way way{.method = PathMethod::arc_length, .steps = random.whole_decades(3, 200), .to = random.between(1.1, 2.5) * (height + fold), .when_unstable = "follow"};
  const Traced t = test.trace(f, way, "path");
  const double shallow = 100 * std::pow(rise / length, 2) + 1e-7;
  if (!test.reaches(t, way.to) || !test.has_events(t, expected, shallow, true, height + fold)) return;
  way.steps = random.other_steps(way.steps);
  const Traced other = test.trace(f, way, "other");
  if (test.reaches(other, way.to)) test.agree(t, other);
}

void arch_round(Case& test) {
  Random& random = test.random;
  const double length = random.decades(1e-6, 1e3), EI = random.decades(1e-6, 1e6), slender = random.decades(1e3, 1e8);
  const double degrees = random.between(25, 120);
  const bool clamped = random.chance(0.5);
  int particles = 2 * random.whole_decades(5, 60) + 1;
  const double radius = length / (2 * std::sin(degrees * pi / 360));
  const Place3 p = anywhere(random, true, length, false);
  File f = p.begin("An arch under a load");
  if (clamped) particles += 2;
  f.list("beam").key("name", "arch").key("particles", particles).key("from", p.at(0, 0)).key("to", p.at(length, 0)).key("toward", p.along(0, 1))
      .key("angle", degrees).key("rest", "as_built").key("diameter", length / particles / 2)
      .key("axial_stiffness", slender * EI / (length * length)).key("bending_stiffness", EI);
  if (clamped) f.key("clamped", "both");
  f.group("foot", "arch", clamped ? "first = 2" : "first = 1").group("head", "arch", clamped ? "last = 2" : "last = 1");
  f.list("support").key("group", "foot").list("support").key("group", "head");
  const int crown = particles / 2 + (random.chance(0.5) ? 0 : random.whole(1, particles / 8 + 1) * static_cast<int>(random.sign()));
  f.group("loaded", "arch", fmt::format("ids = [{}]", crown + 1)).list("load").key("group", "loaded").key("force", p.along(0, -10 * EI / (radius * radius)));
  Way way{.method = PathMethod::arc_length, .steps = random.whole_decades(3, 200), .to = random.between(0.5, 5), .when_unstable = "follow"};
  const Traced t = test.trace(f, way, "path");
  if (!test.reaches(t, way.to)) return;
  way.steps = random.other_steps(way.steps);
  const Traced other = test.trace(f, way, "other");
  if (test.reaches(other, way.to)) test.agree(t, other);
}

// ---- Trusses.

/// Pins at (∓b, 0), the apex at (0, y): two springs K (r − r₀)². P = 4K y (r₀/r − 1); limit points at r³ = r₀ b²; it sways
/// where r³ − r₀ r² + r₀ b² = 0, which has roots for r₀ > 2.598 b.
struct Truss {
  double b = 1, height = 1, rest = 0, K = 1;
  double load(double y) const { return 4 * K * y * (rest / std::hypot(b, y) - 1); }
  double limit() const {
    const double r = std::cbrt(rest * b * b);
    return std::sqrt(r * r - b * b);
  }
  std::vector<double> sways() const {
    const auto f = [&](double r) { return (r - rest) * r * r + rest * b * b; };
    std::vector<double> ys;
    const double turn = 2 * rest / 3;
    if (f(turn) >= 0) return ys;
    for (auto [low, high] : {std::pair{b, turn}, std::pair{turn, rest}}) {
      const bool rising = f(high) > f(low);
      for (int k = 0; k < 200; ++k) {
        const double middle = (low + high) / 2;
        ((f(middle) < 0) == rising ? low : high) = middle;
      }
      if (low > b) ys.push_back(std::sqrt(low * low - b * b));
    }
    return ys;
  }
};

struct PlacedTruss {
  Truss truss;
  Place3 place;
  double force = 1;                             // at load factor 1
  File file;
};

PlacedTruss random_truss(Random& random, bool tall, bool along_axes = false) {
  PlacedTruss t;
  const double size = random.decades(1e-6, 1e3);
  t.truss.b = size;
  t.truss.height = size * (tall ? random.between(2.6, 6) : random.chance(0.5) ? random.between(0.05, 1) : random.between(1, 2.2));
  t.truss.K = random.decades(1e-6, 1e6);
  const bool planar = tall || random.chance(0.6);
  t.place = anywhere(random, planar, size, along_axes || !planar);
  t.file = t.place.begin(tall ? "A tall truss" : "A low truss");
  const Vec3 left = t.place.at(-size, 0), apex = t.place.at(0, t.truss.height), right = t.place.at(size, 0);
  t.truss.rest = ((apex - left).norm() + (apex - right).norm()) / 2;
  t.truss.rest = std::stod(fmt::format("{:.17g}", t.truss.rest));
  t.file.list("grains").key("name", "truss").key("positions", std::vector<Vec3>{left, apex, right}).key("diameter", 0.05 * size);
  t.file.group("feet", "truss", "ids = [1, 3]").group("apex", "truss", "ids = [2]");
  t.file.list("connect").raw("between = [\"feet\", \"apex\"]").key("within", 1.1 * t.truss.rest).key("bond_stiffness", t.truss.K).key("rest_length", t.truss.rest);
  t.file.list("support").key("group", "feet");
  if (!planar) t.file.list("support").key("group", "apex").key("directions", t.place.letter(2));
  const double unit = random.chance(0.5) ? 1 : random.decades(1e-3, 1e3);
  t.force = t.truss.load(t.truss.limit()) / unit;
  t.file.list("load").key("name", "weight").key("group", "apex").key("force", t.place.along(0, -t.force));
  return t;
}

double height_of(const PlacedTruss& t, const Row& r) { return (r.point.state.position.col(1) - t.place.origin).dot(t.place.along(0, 1)); }

void truss_arcs(Case& test) {
  Random& random = test.random;
  const bool tall = random.chance(0.5);
  const PlacedTruss t = random_truss(random, tall);
  const double top = t.truss.load(t.truss.limit()) / t.force;
  std::vector<std::pair<double, std::string>> by_height{{t.truss.limit(), "limit"}, {-t.truss.limit(), "limit"}};
  if (t.place.plane.empty() || tall || t.truss.rest > 2.598076 * t.truss.b)
    for (const double y : t.truss.sways()) by_height.push_back({y, "branch"}), by_height.push_back({-y, "branch"});
  std::sort(by_height.rbegin(), by_height.rend());
  std::vector<std::pair<std::string, double>> expected;
  for (const auto& [y, kind] : by_height) expected.push_back({kind, t.truss.load(y) / t.force});
  Way way{.method = PathMethod::arc_length, .steps = random.whole_decades(3, 200), .to = random.between(1.05, 3) * top, .when_unstable = "follow"};
  const Traced run = test.trace(t.file, way, "path");
  if (!test.reaches(run, way.to) || !test.has_events(run, expected)) return;
  for (const Row& r : run.events()) test.expect(r.point.multiplicity == 1, [&] { return fmt::format("{} has multiplicity {}", r.point.label, r.point.multiplicity); });
}

/// Loaded until it snaps, unloaded until it snaps back: hysteresis.
void truss_snaps(Case& test) {
  Random& random = test.random;
  PlacedTruss t = random_truss(random, false);
  while (t.truss.rest > 2.55 * t.truss.b) t = random_truss(random, false);       // it would sway first
  const double top = t.truss.load(t.truss.limit()) / t.force, up = random.between(1.05, 2) * top, down = -random.between(1.05, 2) * top;
  const int steps = random.whole_decades(3, 200);
  File f = t.file;
  f.raw(fmt::format("\n[path]\nsteps = {}\nmethod = \"{}\"\nwhen_unstable = \"jump\"", steps, random.chance(0.3) ? "arc_length" : "load_steps"));
  f.list("stage").key("name", "load").key("to", up).list("stage").key("name", "unload").key("to", down);
  const Traced run = test.trace(f.text(), "path");
  if (!test.reaches(run, down) || !test.has_events(run, {{"limit", top}, {"limit", -top}})) return;
  test.expect(run.of("jump").size() == 2, [&] { return "events " + run.told() + "; expected two falls"; });
  const double y = height_of(t, run.last());
  test.expect(y > t.truss.height && std::abs(t.truss.load(y) / t.force / down - 1) < 1e-8, [&] { return fmt::format("ends at height {:.10g}", y); });
}

/// Where the apex passes certain heights: each once, those in pairs both.
void events_truss(Case& test) {
  Random& random = test.random;
  PlacedTruss t = random_truss(random, random.chance(0.3));
  const double top = t.truss.load(t.truss.limit()) / t.force;
  Way way{.method = PathMethod::arc_length, .steps = random.whole_decades(3, 200), .to = random.between(1.05, 3) * top, .when_unstable = "follow"};
  const Place3& p = t.place;
  // A coordinate of the apex on which its height depends well.
  Eigen::Index row = 0;
  p.along(0, 1).cwiseAbs().maxCoeff(&row);
  const double slope = p.along(0, 1)[row], at = p.at(0, 0)[row], start = p.at(0, t.truss.height)[row];
  const std::string letter(1, "xyz"[row]);
  t.file.list("observe").key("name", "place").key("group", "apex").key("quantity", "position." + letter);
  t.file.list("observe").key("name", "way").key("group", "apex").key("quantity", "displacement." + letter);
  std::vector<std::pair<double, std::string>> by_height;
  const int places = random.whole(1, 4);
  for (int k = 0; k < places; ++k) {
    const double y = random.between(-1.02, 0.98) * t.truss.height;
    const int how = random.whole(0, 3);                           // alone, twins by one observable, by two, near each other
    const auto add = [&](const std::string& name, bool moved, double where) {
      const double value = moved ? at + slope * where - start : at + slope * where;
      t.file.list("event").key("name", name).key("observable", moved ? "way" : "place").key("value", value);
      by_height.push_back({where, name});
    };
    const std::string name = fmt::format("e{}", k);
    add(name, random.chance(0.5), y);
    if (how == 1 || how == 2) add(name + "t", how == 2, y);
    if (how == 3) add(name + "n", random.chance(0.5), y * (1 + random.decades(1e-6, 1e-1)));
  }
  const Traced run = test.trace(t.file, way, "path");
  if (!test.reaches(run, way.to)) return;
  for (const auto& [y, name] : by_height) {
    const double lambda = t.truss.load(y) / t.force;
    if (y >= t.truss.height || (y < 0 && t.truss.load(y) > t.force * way.to)) continue;  // not reached
    const std::vector<Row> found = run.of(name);
    if (!test.expect(found.size() == 1, [&] { return fmt::format("event {} at height {:.10g} comes {} times ({})", name, y / t.truss.height, found.size(), run.told()); })) continue;
    test.expect(std::abs(found[0].lambda() - lambda) <= of_events * std::max(std::abs(lambda), top) &&
                    std::abs(height_of(t, found[0]) - y) <= of_events * t.truss.height,
                [&] { return fmt::format("event {} at {:.17g}, expected {:.17g}", name, found[0].lambda(), lambda); });
  }
}

/// A tall truss sways: on the side branches the apex passes certain places across, whose load factors follow from balance.
void events_side(Case& test) {
  Random& random = test.random;
  PlacedTruss t = random_truss(random, true, true);
  const Truss& truss = t.truss;
  const std::vector<double> sways = truss.sways();
  if (sways.size() != 2) return test.wrong("the truss does not sway");
  const double sway = std::max(sways[0], sways[1]);
  const double critical = truss.load(sway) / t.force;
  const Place3& p = t.place;
  Eigen::Index row = 0;
  p.along(1, 0).cwiseAbs().maxCoeff(&row);
  const std::string letter(1, "xyz"[row]);
  t.file.list("observe").key("name", "place").key("group", "apex").key("quantity", "displacement." + letter);
  Way way{.method = PathMethod::arc_length, .steps = random.whole_decades(3, 200), .to = random.between(1.02, 1.5) * critical, .when_unstable = "follow", .branches = 1};
  std::vector<std::string> names;
  const int places = random.whole(1, 4);
  for (int k = 0; k < places; ++k) {
    const double value = random.decades(1e-4, 0.2) * truss.b * random.sign();
    names.push_back(fmt::format("e{}", k));
    t.file.list("event").key("name", names.back()).key("observable", "place").key("value", value);
  }
  // Across by x: the apex is displaced by (x, v) with no force across, and the letter's coordinate is what it is. Both side branches are the
  // same but mirrored, so each place is passed at least once; and twice the steps pass it as often.
  const Traced run = test.trace(t.file, way, "path");
  if (!test.ends(run)) return;
  for (const std::string& name : names)
    test.expect(!run.of(name).empty(), [&] { return fmt::format("event {} does not come ({})", name, run.told()); });
  way.steps = random.other_steps(way.steps);
  const Traced other = test.trace(t.file, way, "other");
  if (!test.ends(other)) return;
  for (const std::string& name : names) {
    std::vector<double> a, b;
    for (const Row& r : run.of(name)) a.push_back(r.lambda());
    for (const Row& r : other.of(name)) b.push_back(r.lambda());
    std::sort(a.begin(), a.end()), std::sort(b.begin(), b.end());
    bool same = a.size() == b.size();
    for (std::size_t k = 0; same && k < a.size(); ++k) same = std::abs(a[k] - b[k]) <= of_events * critical;
    test.expect(same, [&] { return fmt::format("event {} comes at {:.12g} or at {:.12g}", name, fmt::join(a, ", "), fmt::join(b, ", ")); });
  }
}

// ---- Rings under pressure.

/// Of a regular polygon of n bonds, radial U cos mα and tangential W sin mα: with ε = (the bond's change)/(the bond) = ρ cos mγ + i ω sin mγ
/// (γ the bond's middle, h = π/n)
///   ρ = (U cos mh + W cot h sin mh)/R,   ω = (U cot h sin mh + W cos mh)/R
/// and per n/2 the energy  K a² ρ² + (K(a − q₀)a + 2f″ sin² mh) ω² + p/2 (sin 2h cos 2mh (U² + W²) + 2 cos 2h sin 2mh UW),  f″ that of an angle,
/// a = 2R sin h,  p = 2K(q₀ − a)/(R cos h). The pressure at which the smaller of the two stiffnesses vanishes.
double ring_critical(const Model& model, int m) {
  const int n = model.particles();
  const double K = model.bond_types[0].stiffness, q0 = model.bond_types[0].rest_length, B = model.angle_types[0].stiffness, h = pi / n;
  const double curvature = B * std::cos(pi - 2 * h - model.angle_types[0].rest);
  const double c = std::cos(m * h), s = std::sin(m * h), cot = 1 / std::tan(h), D = c * c - cot * cot * s * s;
  const auto pressure = [&](double d) { return 4 * K * d * std::tan(h) / (q0 - d); };     // d = q₀ − a, 1/(R cos h) = 2 tan h/a
  const auto soft = [&](double d) {
    const double a = q0 - d, R = a / (2 * std::sin(h)), p = pressure(d);
    const double uu = R * c / D, uw = -R * cot * s / D;          // U = uu ρ + uw ω, W = uw ρ + uu ω
    const double same = p / 2 * std::sin(2 * h) * std::cos(2 * m * h), mixed = p * std::cos(2 * h) * std::sin(2 * m * h);
    const double rr = K * a * a + same * (uu * uu + uw * uw) + mixed * uu * uw;
    const double ww = -K * d * a + 2 * curvature * s * s + same * (uu * uu + uw * uw) + mixed * uu * uw;
    const double rw = same * 2 * uu * uw + mixed * (uu * uu + uw * uw) / 2;
    return ww - rw * rw / rr;
  };
  double low = 0, high = 1e-12 * q0;
  while (soft(high) > 0 && high < q0 / 2) high *= 1.5;
  for (int k = 0; k < 200; ++k) ((soft((low + high) / 2) > 0) ? low : high) = (low + high) / 2;
  return pressure(low);
}

struct RingCase {
  File file;
  double unit = 1;                              // the pressure at load factor 1
};

RingCase random_ring(Random& random, int coarsest = 12) {
  const double radius = random.decades(1e-6, 1e3), EI = random.decades(1e-6, 1e6), slender = random.decades(1e3, 1e8);   // EA R²/EI
  const int n = random.whole_decades(coarsest, 200);
  Place3 p = anywhere(random, true, radius, true);
  File f = p.begin("A ring under pressure, held by the least supports");
  f.list("loop").key("name", "ring").key("particles", n).key("center", p.origin).key("normal", Vec3(p.axes.col(2).cwiseAbs())).key("radius", radius)
      .key("diameter", radius / n).key("axial_stiffness", slender * EI / (radius * radius)).key("bending_stiffness", EI);
  if (random.chance(0.5)) f.key("rest", "as_built");
  // One particle is held, and one about opposite across the line to it: no rigid motion is left, and no force is needed.
  const int one = random.whole(1, n), far = (one - 1 + n / 2) % n + 1;
  const double angle = 2 * pi * (one - 1) / n;
  // The loop's first particle lies along e1 of its frame, the second after it towards e2; for normals along axes these are axes.
  const Vec3 normal = p.axes.col(2).cwiseAbs();
  const Vec3 e1 = normal[0] == 1 ? Vec3(0, 0, -1) : Vec3(1, 0, 0), e2 = normal[1] == 1 ? Vec3(0, 0, -1) : Vec3(0, 1, 0);
  const Vec3 line = std::cos(angle) * e1 + std::sin(angle) * e2, across = normal.cross(line);
  Eigen::Index best = 0;
  across.cwiseAbs().maxCoeff(&best);
  f.group("one", "ring", fmt::format("ids = [{}]", one)).group("far", "ring", fmt::format("ids = [{}]", far));
  f.list("support").key("group", "one").list("support").key("group", "far").key("directions", std::string(1, "xyz"[best]));
  RingCase r{f, random.between(0.5, 2) * 3 * EI / (radius * radius * radius)};
  r.file.list("pressure").key("loop", "ring").key("pressure", r.unit);
  return r;
}

void ring_pressure(Case& test) {
  Random& random = test.random;
  const RingCase ring = random_ring(random);
  const Model model = test.trace(ring.file.text() + "\n[study]\ntype = \"energy\"\n", "built").model;
  const double critical = ring_critical(model, 2) / ring.unit;
  const bool stop = random.chance(0.3);
  Way way{.method = random.chance(0.6) ? PathMethod::arc_length : PathMethod::load_steps, .steps = random.whole_decades(3, 200),
          .to = std::min(random.between(1.05, 2) * critical, 0.95 * ring_critical(model, 3) / ring.unit), .when_unstable = stop ? "stop" : "follow"};
  const Traced t = test.trace(ring.file, way, "path");
  if (stop ? !test.ends(t) : !test.reaches(t, way.to)) return;
  if (!test.has_events(t, {{"branch", critical}})) return;
  const Row event = t.of("branch")[0];
  test.expect(event.point.multiplicity == 2, [&] { return fmt::format("multiplicity {}, expected 2", event.point.multiplicity); });
  const Field x = event.point.state.position.colwise() - event.point.state.position.rowwise().mean().eval();
  const double most = x.colwise().norm().maxCoeff(), least = x.colwise().norm().minCoeff();
  test.expect(most - least <= of_round * most, [&] { return fmt::format("the ring is not round at the branch point, by {:.2g}", (most - least) / most); });
}

void ring_side(Case& test) {
  Random& random = test.random;
  const RingCase ring = random_ring(random, 40);                  // the oval of a coarse one has limit points of its own
  const Model model = test.trace(ring.file.text() + "\n[study]\ntype = \"energy\"\n", "built").model;
  const double critical = ring_critical(model, 2) / ring.unit;
  Way way{.method = PathMethod::arc_length, .steps = random.whole_decades(3, 200), .to = random.between(1.05, 1.5) * critical, .when_unstable = "follow", .branches = 1};
  const Traced t = test.trace(ring.file, way, "path");
  if (!test.reaches(t, way.to)) return;
  const std::vector<Row> found = t.of("branch");
  if (!test.expect(!found.empty() && std::abs(found[0].lambda() / critical - 1) <= of_events, [&] { return fmt::format("events {}; expected branch {:.12g}", t.told(), critical); })) return;
  const int branches = t.last().point.branch;
  if (!test.expect(branches >= 1 && branches <= 4, [&] { return fmt::format("{} side branches", branches); })) return;
  for (int k = 1; k <= branches; ++k) {
    const Row end = t.on_branch(k).back();
    if (!test.expect(end.lambda() == way.to, [&] { return fmt::format("side branch {} ends at {:.17g}", k, end.lambda()); })) return;
    // The ovals towards particles and towards bonds differ a little, and one of them is a saddle.
    test.expect(end.point.stability.negative <= 1, [&] { return fmt::format("the oval has Morse index {}", end.point.stability.negative); });
  }
}

// ---- Contacts.

/// A row of grains on a floor, a lid comes down on them.
void grain_lid(Case& test) {
  Random& random = test.random;
  const int grains = random.chance(0.5) ? 1 : random.whole(2, 8);
  const double r = random.decades(1e-6, 1e3), weight = random.decades(1e-9, 1e9);
  const double E_wall = random.decades(1e2, 1e10) * weight / (r * r), E_grain = random.decades(1e2, 1e10) * weight / (r * r);
  const bool planar = random.chance(0.3);
  const Place3 p = anywhere(random, planar, r, true);
  const auto overlap = [&](double force, double E, double radius) { return std::pow(0.75 * force / (E * std::sqrt(radius)), 2.0 / 3.0); };
  // All overlaps and the place of the topmost grain's top above the floor at a force on the lid.
  const auto height = [&](double lid) {
    double z = 2 * r * grains - overlap(lid + grains * weight, E_wall, r) - overlap(lid, E_wall, r);
    for (int k = 1; k < grains; ++k) z -= overlap(lid + (grains - k) * weight, E_grain, r / 2);
    return z;
  };
  const double gap = random.between(0.005, 0.3) * r, way_down = gap + random.between(0.02, 0.05) * r, start = 2 * r * grains + gap;
  File f = p.begin("A lid comes down on grains");
  std::vector<Vec3> centers;
  for (int k = 0; k < grains; ++k) centers.push_back(p.at((2 * k + 1) * r, 0));
  f.list("grains").key("name", "grains").key("positions", centers).key("diameter", 2 * r).key("density", 1.0);
  f.list("support").key("group", "grains").key("directions", planar ? p.letter(1) : p.letter(1) + p.letter(2));
  f.list("load").key("group", "grains").key("force", p.along(-weight, 0)).key("constant", true);
  if (grains > 1) f.list("contact").raw("between = [\"grains\", \"grains\"]").key("effective_modulus", E_grain);
  f.list("wall").key("name", "floor").key("shape", "plane").key("point", p.at(0, 0)).key("normal", p.along(1, 0)).key("effective_modulus", E_wall);
  f.list("wall").key("name", "lid").key("shape", "plane").key("point", p.at(start, 0)).key("normal", p.along(-1, 0)).key("effective_modulus", E_wall)
      .key("displacement", p.along(-way_down, 0));
  const double critical = (start - height(0)) / way_down;
  Way way{.method = random.chance(0.5) ? PathMethod::arc_length : PathMethod::load_steps, .steps = random.whole_decades(3, 200), .to = 1,
          .when_unstable = random.chance(0.5) ? "follow" : "jump"};
  if (!way.arcs()) way.when_unstable = "jump";
  if (critical > 0.999) return;                                   // soft: the lid hardly comes to touch
  if (random.chance(0.25)) {                                      // down and up again
    f.raw(fmt::format("\n[path]\nmethod = \"{}\"\nsteps = {}", way.arcs() ? "arc_length" : "load_steps", way.steps));
    f.list("stage").key("name", "down").key("to", 1.0).list("stage").key("name", "up").key("to", 0.0);
    const Traced t = test.trace(f.text(), "path");
    if (test.reaches(t, 0) && test.has_events(t, {{"contact", critical}, {"contact", critical}})) test.touches(t), test.same_state(t, t.last(), t, t.rows.front());
    return;
  }
  const Traced t = test.trace(f, way, "path");
  if (!test.reaches(t, 1) || !test.has_events(t, {{"contact", critical}})) return;
  test.touches(t), test.index_is(t, 0);
  double low = 0, high = 1e-6 * weight;
  while (height(high) > start - way_down) high *= 2;
  for (int k = 0; k < 200; ++k) (height((low + high) / 2) > start - way_down ? low : high) = (low + high) / 2;
  const double top = start - way_down - r + overlap(low, E_wall, r);
  const double found = (t.last().point.state.position.col(grains - 1) - p.origin).dot(p.along(1, 0));
  test.expect(std::abs(found - top) <= of_states * r, [&] { return fmt::format("the topmost grain ends {:.2g} radii beside its place", (found - top) / r); });
}

// Grains in a row that nothing holds along it: a wall pushes them together, one after the other and without a force, until the last one meets
// the other wall. Then they are Hertz's springs in series.
void grain_floats(Case& test) {
  Random& random = test.random;
  const int grains = random.chance(0.3) ? 1 : random.whole(2, 6);
  const double r = random.decades(1e-6, 1e3), E = random.decades(1e-3, 1e11);
  const Place3 p = anywhere(random, random.chance(0.3), r, true);
  std::vector<double> gaps;
  for (int k = 0; k <= grains; ++k) gaps.push_back(random.between(0.02, 0.5) * r);
  std::vector<Vec3> centers;
  double place = 0;
  for (int k = 0; k < grains; ++k) place += gaps[k] + r, centers.push_back(p.at(place, 0)), place += r;
  place += gaps[grains];
  double apart = 0;
  for (const double gap : gaps) apart += gap;
  const double squeeze = random.between(0.001, 0.02) * r, way_down = apart + squeeze;
  std::vector<std::pair<std::string, double>> wanted;
  double closed = 0;
  for (const double gap : gaps) wanted.push_back({"contact", (closed += gap) / way_down});
  File f = p.begin("Grains are pushed together");
  f.list("grains").key("name", "grains").key("positions", centers).key("diameter", 2 * r).key("density", 1.0);
  f.list("support").key("group", "grains").key("directions", p.letter(1) + p.letter(2));
  if (grains > 1) f.list("contact").raw("between = [\"grains\", \"grains\"]").key("effective_modulus", E);
  f.list("wall").key("name", "piston").key("shape", "plane").key("point", p.at(0, 0)).key("normal", p.along(1, 0)).key("effective_modulus", E)
      .key("displacement", p.along(way_down, 0));
  f.list("wall").key("name", "end").key("shape", "plane").key("point", p.at(place, 0)).key("normal", p.along(-1, 0)).key("effective_modulus", E);
  const Way way{.method = random.chance(0.5) ? PathMethod::arc_length : PathMethod::load_steps, .steps = random.whole_decades(3, 200), .to = 1,
                .when_unstable = "jump"};
  const Traced t = test.trace(f, way, "path");
  if (!test.reaches(t, 1) || !test.has_events(t, wanted)) return;
  test.index_is(t, 0);
  const double springs = 2 / std::pow(r, 1.0 / 3) + (grains - 1) / std::pow(r / 2, 1.0 / 3);       // overlap = (3F/4E)^(2/3) R^(−1/3), in series
  const double at_wall = squeeze / springs / std::pow(r, 1.0 / 3), last = place - r + at_wall;
  const double found = (t.last().point.state.position.col(grains - 1) - p.origin).dot(p.along(1, 0));
  test.expect(std::abs(found - last) <= of_states * r, [&] { return fmt::format("the last grain ends {:.2g} radii beside its place", (found - last) / r); });
}

/// A stack of boxes on a floor, a lid comes down flat: four corners at once.
void box_lid(Case& test) {
  Random& random = test.random;
  const int boxes = random.whole(1, 3);
  const double size = random.decades(1e-6, 1e3), weight = random.decades(1e-6, 1e6);
  const auto stiff = [&] { return random.decades(30, 1e7) * weight * boxes / size; };
  const double floor = stiff(), lid = stiff(), pair = stiff(), rounding = random.between(0.05, 0.3) * size;
  const Place3 p = anywhere(random, false, size, true);
  File f = p.begin("A lid comes down on boxes");
  double z = 0, wide = 3 * size;
  std::vector<double> heights;
  for (int k = 0; k < boxes; ++k) {
    const double core = random.between(0.5, 1.5) * size;
    Vec3 sides;
    for (int c = 0; c < 3; ++c) sides[c] = std::abs(p.axes(c, 0)) == 1 ? core : wide;
    f.list("body").key("name", fmt::format("box{}", k + 1)).key("shape", "box").key("size", sides).key("rounding_diameter", rounding)
        .key("position", p.at(z + (core + rounding) / 2, 0)).raw(fmt::format("rotation = {{ axis = {}, angle = {:.17g} }}", toml(p.along(1, 0)), random.chance(0.3) ? 0.0 : random.between(0, 40)))
        .key("mass", weight);
    z += core + rounding, wide *= 0.6;
  }
  if (boxes > 1) f.list("contact").raw("between = [\"all\", \"all\"]\nlaw = \"rounded\"").key("k_n", pair);
  double sunk = 0, give = 1 / (4 * floor) + 1 / (4 * lid);
  for (int k = 0; k < boxes; ++k) {
    sunk += weight * (boxes - k) / (4 * (k == 0 ? floor : pair));
    if (k > 0) give += 1 / (4 * pair);
  }
  const double gap = random.between(0, 0.3) * size, way_down = gap + sunk + random.between(0.02, 0.1) * rounding;
  f.list("wall").key("name", "floor").key("shape", "plane").key("point", p.at(0, 0)).key("normal", p.along(1, 0)).key("k_n", floor);
  f.list("wall").key("name", "lid").key("shape", "plane").key("point", p.at(z + gap, 0)).key("normal", p.along(-1, 0)).key("k_n", lid).key("displacement", p.along(-way_down, 0));
  f.list("gravity").key("acceleration", p.along(-1, 0));
  f.list("support").key("group", "all").key("directions", p.letter(1) + p.letter(2));
  const double critical = (gap + sunk) / way_down;
  Way way{.method = random.chance(0.5) ? PathMethod::arc_length : PathMethod::load_steps, .steps = random.whole_decades(3, 200), .to = 1};
  const Traced t = test.trace(f, way, "path");
  if (!test.reaches(t, 1) || !test.has_events(t, {{"contact", critical}})) return;
  test.touches(t), test.index_is(t, 0);
  const double force = (way_down - gap - sunk) / give, top = z + gap - way_down + force / (4 * lid);
  const Row& last = t.last();
  const double found = (last.point.state.bodies.back().position.hi - t.model.start.bodies.back().position.hi).dot(p.along(1, 0)) + z;
  test.expect(std::abs(found - top) <= of_states * size, [&] { return fmt::format("the topmost box ends {:.2g} sizes beside its place", (found - top) / size); });
}

/// A clamped or hinged column, pushed sideways, bends against a stop.
void column_stop(Case& test) {
  Random& random = test.random;
  Column c = random_column(random, random.chance(0.5) ? Ends::clamped : Ends::hinged, false, random.chance(0.7), 1e4, 1e8);
  while (c.particles > 150) c = random_column(random, c.ends, false, c.planar, 1e4, 1e8);
  const double spacing = c.length / (c.particles - 1);
  File f = written(c, "A column bends against a stop");
  const int particle = random_middle(random, c);
  const Vec3 side = c.place.along(0, 1);
  f.group("pushed", "column", fmt::format("ids = [{}]", particle + 1));
  f.list("load").key("group", "pushed").key("force", Vec3(random.decades(1e-5, 1e-2) * c.euler * side)).key("constant", true);
  const double to = (1 + random.decades(0.3, 20)) * c.euler * (c.last - c.first) * spacing / c.EA / c.drive;
  const double bend = std::sqrt(to * c.drive * c.length) * 0.6;   // about the deflection at the end, without the stop
  const double gap = bend * random.between(0.4, 0.9);
  const double E = random.decades(1e2, 1e10) * c.euler / (c.diameter * c.diameter);
  f.list("wall").key("name", "stop").key("shape", "plane").key("point", c.place.at(0, gap + c.diameter / 2)).key("normal", c.place.along(0, -1)).key("effective_modulus", E);
  const bool jump = random.chance(0.4);
  Way way{.method = PathMethod::arc_length, .steps = random.whole_decades(3, 200), .to = to, .when_unstable = "follow"};
  if (jump) way = {.method = PathMethod::load_steps, .steps = way.steps, .to = to, .when_unstable = "jump"};
  const Traced t = test.trace(f, way, "path");
  if (!test.ends(t)) return;
  if (!jump && t.last().lambda() != to) return test.wrong(fmt::format("ends at {:.10g}: {}", t.last().lambda(), t.outcome.why));
  test.touches(t);
  way.steps = random.other_steps(way.steps);
  if (random.chance(0.3)) way.method = jump ? PathMethod::arc_length : PathMethod::arc_length;
  const Traced other = test.trace(f, way, "other");
  if (!test.ends(other)) return;
  test.touches(other);
  test.agree(t, other);
}

/// A column in space beside a wall, or between two, which it may come to: it ends as without, in a direction in which nothing is in the way.
void column_slides(Case& test) {
  Random& random = test.random;
  const Ends ends = random_ends(random);
  const bool dead = ends == Ends::cantilever || random.chance(0.4);
  Column c = random_column(random, ends, dead, false);
  while (c.particles > 150) c = random_column(random, ends, dead, false);
  File f = written(c, "A column in space beside a wall");
  Way way{.method = random.chance(0.5) ? PathMethod::arc_length : PathMethod::load_steps, .steps = random.whole_decades(3, 200),
          .to = beyond_critical(random, c) * built_critical(test, c, f)};
  const Traced alone = test.trace(f, way, "alone");
  if (!test.reaches(alone, way.to)) return;
  Vec3 bent = Vec3::Zero();
  for (int k = 0; k < c.particles; ++k)
    if (const Vec3 w = sideways(c, alone, alone.last(), k); w.norm() > bent.norm()) bent = w;
  const double angle = random.between(-1, 1);
  const Vec3 normal = Eigen::AngleAxisd(angle, c.place.along(1, 0)) * bent.normalized();
  const double gap = random.between(0.2, 0.95) * bent.norm() * std::cos(angle);
  const double E = random.decades(1e2, 1e8) * c.euler / (c.diameter * c.diameter);
  for (const double side : random.chance(0.5) ? std::vector{1.0} : std::vector{1.0, -1.0})
    f.list("wall").key("name", side > 0 ? "wall" : "other").key("shape", "plane").key("point", Vec3(c.place.at(0, 0) + side * (gap + c.diameter / 2) * normal))
        .key("normal", Vec3(-side * normal)).key("effective_modulus", E);
  for (const char* name : {"path", "other"}) {
    const Traced t = test.trace(f, way, name);
    if (!test.reaches(t, way.to)) return;
    test.same_energy("the end with and without walls", t.last().energy(), alone.last().energy());
    test.expect(t.last().point.stability.negative == 0, [&] { return "the end is not stable"; });
    way.steps = random.other_steps(way.steps);
    if (random.chance(0.5)) way.method = way.method == PathMethod::arc_length ? PathMethod::load_steps : PathMethod::arc_length;
  }
}

// ---- More of them: load and unload, events, sheets, grains, boxes.

/// The same column is loaded and unloaded: it comes back to where it began, and nothing has happened.
void column_back(Case& test) {
  Random& random = test.random;
  const Column c = some_column(random);
  File f = written(c, "A column is pushed, bent and let go");
  const double push = random.decades(1e-8, 1e-2);
  const int particle = random_middle(random, c);
  const Vec3 side = c.place.along(0, random.sign());
  f.group("pushed", "column", fmt::format("ids = [{}]", particle + 1));
  f.list("load").key("name", "push").key("group", "pushed").key("force", Vec3(push * c.euler * side)).key("constant", true);
  const double critical = built_critical(test, c, f), to = beyond_critical(random, c) * critical;
  f.raw(fmt::format("\n[path]\nmethod = \"{}\"\nsteps = {}", random.chance(0.5) ? "arc_length" : "load_steps", random.whole_decades(3, 200)));
  f.list("stage").key("name", "there").key("to", to).list("stage").key("name", "back").key("to", 0.0);
  if (random.chance(0.5)) f.key("steps", random.whole_decades(3, 200));
  const Traced t = test.trace(f.text(), "path");
  if (!test.reaches(t, 0)) return;
  test.has_events(t, {}, of_events, false), test.index_is(t, 0);
  test.same_state(t, t.last(), t, t.rows.front());
}

/// Where a bending column passes certain deflections: each once, twins both, whatever the steps and the method.
void events_column(Case& test) {
  Random& random = test.random;
  const Column c = random_column(random, random.chance(0.5) ? Ends::clamped : Ends::hinged, false, random.chance(0.7));
  File f = written(c, "A column that bends, with events");
  const double push = random.decades(1e-7, 1e-2);
  const int particle = random_middle(random, c);
  const Vec3 side = c.place.along(0, random.sign());
  f.group("pushed", "column", fmt::format("ids = [{}]", particle + 1));
  f.list("load").key("name", "push").key("group", "pushed").key("force", Vec3(push * c.euler * side)).key("constant", true);
  const double critical = built_critical(test, c, f), beyond = random.between(1.1, 3);
  const double amplitude = 2 / pi * std::sqrt((beyond - 1) * critical * c.drive * c.length);       // about
  Eigen::Index row = 0;
  side.cwiseAbs().maxCoeff(&row);
  const std::string letter(1, "xyz"[row]);
  f.list("observe").key("name", "w").key("group", "pushed").key("quantity", "displacement." + letter);
  std::vector<std::pair<std::string, double>> wanted;
  const int places = random.whole(1, 4);
  for (int k = 0; k < places; ++k) {
    const double value = random.decades(1e-2, 0.9) * amplitude * side[row];
    const int how = random.whole(0, 2);                           // alone, twins, near each other
    wanted.push_back({fmt::format("e{}", k), value});
    if (how > 0) wanted.push_back({fmt::format("e{}t", k), how == 1 ? value : value * (1 + random.decades(1e-6, 1e-1))});
  }
  for (const auto& [name, value] : wanted) f.list("event").key("name", name).key("observable", "w").key("value", value);
  Way way{.method = random.chance(0.5) ? PathMethod::arc_length : PathMethod::load_steps, .steps = random.whole_decades(3, 200), .to = beyond * critical,
          .when_unstable = "follow"};
  if (!way.arcs()) way.when_unstable = "jump";
  const Traced t = test.trace(f, way, "path");
  if (!test.reaches(t, way.to)) return;
  const auto bent = [&](const Row& r) { return (r.point.state.position(row, particle) - t.model.start.position(row, particle)) / side[row]; };
  const double begin = bent(t.rows.front()), end = bent(t.last());
  std::vector<std::pair<double, double>> found;                   // deflection, load factor
  for (const auto& [name, value] : wanted) {
    const std::vector<Row> rows = t.of(name);
    const bool passed = value / side[row] > begin && value / side[row] < end;
    if (test.expect(rows.size() == (passed ? 1 : 0), [&] { return fmt::format("event {} comes {} times, expected {} ({})", name, rows.size(), passed ? 1 : 0, t.told()); }) && passed)
      found.push_back({value / side[row], rows[0].lambda()});
  }
  if (test.expect(t.events().size() == found.size(), [&] { return "other events: " + t.told(); }) == false) return;
  way.steps = random.other_steps(way.steps), way.method = way.arcs() ? PathMethod::load_steps : PathMethod::arc_length;
  way.when_unstable = way.arcs() ? "follow" : "jump";
  const Traced other = test.trace(f, way, "other");
  if (!test.reaches(other, way.to)) return;
  for (const auto& [name, value] : wanted) {
    const std::vector<Row> a = t.of(name), b = other.of(name);
    test.expect(a.size() == b.size() && (a.empty() || std::abs(a[0].lambda() - b[0].lambda()) <= of_events * way.to),
                [&] { return fmt::format("event {} comes otherwise: {}; {}", name, t.told(), other.told()); });
  }
}

/// A hinged column under a dead load until its ends have passed each other. Where they meet it may spin.
void column_passes(Case& test) {
  Random& random = test.random;
  Column c = random_column(random, Ends::hinged, true, true, 1e4, 1e8);
  // Of a few links the angles become so large that their moment B sin φ yields: the load has a limit on the way.
  while (c.particles > 120 || c.particles < 24) c = random_column(random, Ends::hinged, true, true, 1e4, 1e8);
  const File f = written(c, "The ends of a column pass each other");
  const double critical = built_critical(test, c, f);
  Way way{.method = PathMethod::arc_length, .steps = random.whole_decades(5, 200), .to = random.between(2.3, 3) * critical, .when_unstable = "follow", .branches = 1};
  const Traced t = test.trace(f, way, "path");
  if (!test.reaches(t, way.to)) return;
  const int branches = t.last().point.branch;
  for (int k = 1; k <= branches; ++k) {
    const Row end = t.on_branch(k).back();
    if (!test.expect(end.lambda() == way.to, [&] { return fmt::format("side branch {} ends at {:.17g}", k, end.lambda()); })) return;
  }
  test.expect(branches == 2, [&] { return fmt::format("{} side branches", branches); });
  test.same_energy("the ends of the side branches", t.on_branch(1).back().energy(), t.on_branch(2).back().energy());
}

/// Two clamped columns side by side are shortened and pushed against each other.
void two_beams(Case& test) {
  Random& random = test.random;
  const int particles = random.whole_decades(16, 48);
  const double length = random.decades(1e-6, 1e3), spacing = length / (particles - 1), EI = random.decades(1e-6, 1e6), ratio = random.between(0.6, 6);
  const double slender = random.decades(1e4, 1e7), free = length * (particles - 2.0) / (particles - 1), euler = 4 * pi * pi * EI / (free * free);
  const Place3 p = anywhere(random, true, length, false);
  const double shortening = random.between(1.2, 3) * euler / (slender * EI / (length * length)) * free;
  const double amplitude = 2 / pi * std::sqrt(shortening * length), gap = amplitude * random.between(0.1, 1.2), diameter = spacing * random.between(0.3, 1);
  File f = p.begin("Two beams are pushed against each other");
  const std::array<std::string, 2> names{"thin", "thick"};
  for (int k = 0; k < 2; ++k) {
    const double t = k == 0 ? 0 : diameter + gap, stiff = k == 0 ? 1 : ratio;
    f.list("beam").key("name", names[k]).key("particles", particles).key("from", p.at(0, t)).key("to", p.at(length, t)).key("diameter", diameter)
        .key("axial_stiffness", slender * EI * std::sqrt(stiff) / (length * length)).key("bending_stiffness", EI * stiff);
    f.group(names[k] + "_foot", names[k], "first = 2").group(names[k] + "_head", names[k], "last = 2").group(names[k] + "_middle", names[k], "middle = 1");
    f.list("support").key("group", names[k] + "_foot").list("support").key("group", names[k] + "_head").key("displacement", p.along(-shortening, 0));
    f.list("load").key("group", names[k] + "_middle").key("force", p.along(0, (k == 0 ? 1 : -1) * random.decades(1e-9, 1e-3) * euler * stiff)).key("constant", true);
  }
  f.list("contact").raw("between = [\"thin\", \"thick\"]").key("effective_modulus", random.decades(1e3, 1e11) * euler / (diameter * diameter));
  const bool jump = random.chance(0.4);
  Way way{.method = jump ? PathMethod::load_steps : PathMethod::arc_length, .steps = random.whole_decades(3, 200), .to = 1, .when_unstable = jump ? "jump" : "follow"};
  const Traced t = test.trace(f, way, "path");
  if (!test.reaches(t, 1)) return;
  test.touches(t);
  for (const Row& r : t.rows) {
    if (r.kind() == "contact") break;                             // until they touch each beam bends to the side it is pushed to
    if (!test.expect(r.kind().empty() && r.point.stability.negative == 0, [&] { return fmt::format("before the beams touch: {} at {:.10g}, Morse index {}", r.point.label, r.lambda(), r.point.stability.negative); })) return;
    for (int k = 0; k < 2; ++k) {
      const int middle = k * particles + particles / 2;
      const double moved = (r.point.state.position.col(middle) - t.model.start.position.col(middle)).dot(p.along(0, k == 0 ? 1 : -1));
      if (!test.expect(moved >= -1e-13 * length, [&] { return fmt::format("the {} beam goes to the other side than it is pushed to, at {:.10g}", names[k], r.lambda()); })) return;
    }
  }
  way.steps = random.other_steps(way.steps);
  const Traced other = test.trace(f, way, "other");
  if (test.reaches(other, 1)) test.touches(other), test.agree(t, other);
}

/// A strip of the lattice, clamped at two ends, is compressed until it buckles out of its plane.
void sheet_strip(Case& test) {
  Random& random = test.random;
  const int wide = random.whole(2, 5), rows = random.whole(8, 18);
  const double spacing = random.decades(1e-6, 1e3), thick = random.between(0.1, 0.8) * spacing, E = random.decades(1, 1e9);
  const double length = (rows - 1) * spacing * std::sqrt(3) / 2, clamped = length - spacing * std::sqrt(3) / 2;
  Place3 p = anywhere(random, false, length, false);
  Vec3 n = p.axes.col(2);
  if (n[2] < 0) n = -n;
  // The sheet's frame for this normal: see frame_of.
  const Vec3 e2(-n[0] * n[1] / (1 + n[2]), 1 - n[1] * n[1] / (1 + n[2]), -n[1]);
  File f = p.begin("A strip is compressed");
  f.list("sheet").key("name", "strip").key("shape", "rectangle").raw(fmt::format("size = [{:.17g}, {:.17g}]", wide * spacing, length * (1 + 1e-10)))
      .key("center", p.origin).key("normal", n).key("spacing", spacing).key("thickness", thick).key("youngs_modulus", E);
  f.group("foot", "strip", fmt::format("first = {}", 2 * wide + 1)).group("head", "strip", fmt::format("last = {}", 2 * wide + 1));
  const double estimate = 4 * pi * pi * thick * thick / (12 * 8.0 / 9) / (clamped * clamped) * clamped;
  f.list("support").key("group", "foot").list("support").key("group", "head").key("displacement", Vec3(-estimate * e2));
  const bool fall = random.chance(0.5);
  Way way{.method = PathMethod::arc_length, .steps = random.whole_decades(3, 100), .to = random.between(1.3, 1.7), .when_unstable = "follow", .branches = 1};
  if (fall) way = {.method = PathMethod::load_steps, .steps = way.steps, .to = way.to};
  const Traced t = test.trace(f, way, "path");
  if (!test.reaches(t, way.to)) return;
  test.expect(t.of("branch").size() >= 1 && t.of("branch")[0].point.multiplicity == 1, [&] { return "events " + t.told() + "; expected one branch point first"; });
  if (!fall) {
    const int branches = t.last().point.branch;
    if (!test.expect(branches == 2, [&] { return fmt::format("{} side branches", branches); })) return;
    const Row one = t.on_branch(1).back(), two = t.on_branch(2).back();
    if (!test.expect(one.lambda() == way.to && two.lambda() == way.to, [&] { return fmt::format("the side branches end at {:.17g} and {:.17g}", one.lambda(), two.lambda()); })) return;
    test.same_energy("the ends of the side branches", one.energy(), two.energy());
    const Field sum = (one.point.state.position - t.model.start.position) + (two.point.state.position - t.model.start.position);
    const Vector across = sum.transpose() * n, w = (one.point.state.position - t.model.start.position).transpose() * n;
    test.expect(across.cwiseAbs().maxCoeff() <= 1e-7 * w.cwiseAbs().maxCoeff(), [] { return "the side branches do not mirror each other"; });
  }
  way.steps = random.other_steps(way.steps);
  const Traced other = test.trace(f, way, "other");
  if (!test.reaches(other, way.to)) return;
  if (fall) test.agree(t, other), test.same_energy("the ends of two falls", t.last().energy(), other.last().energy());
  else test.same_energy("the ends of side branches", t.on_branch(1).back().energy(), other.on_branch(1).back().energy());
}

/// A hard lid on a row of grains that springs join: touches at a load factor that may lie on a step, and compresses them.
void hard_lid(Case& test) {
  Random& random = test.random;
  const int grains = random.whole(2, 8);
  const double size = random.decades(1e-6, 1e3), K = random.decades(1e-6, 1e6), r = random.between(0.1, 0.45) * size;
  const bool planar = random.chance(0.5);
  const Place3 p = anywhere(random, planar, size, true);
  Way way{.steps = random.whole_decades(3, 200), .to = 1};
  const double critical = random.chance(0.5) ? random.whole(1, way.steps - 1) / static_cast<double>(way.steps) : random.between(0.1, 0.9);
  const double way_down = random.between(0.05, 0.5) * size;
  std::vector<Vec3> centers;
  for (int k = 0; k < grains; ++k) centers.push_back(p.at(k * size, 0));
  File f = p.begin("A hard lid on a row of springs");
  f.list("grains").key("name", "row").key("positions", centers).key("diameter", 2 * r);
  f.list("connect").raw("between = [\"row\", \"row\"]").key("within", 1.1 * size).key("bond_stiffness", K).key("rest_length", size);
  f.group("foot", "row", "first = 1").group("top", "row", fmt::format("last = {}", grains - 1));
  f.list("support").key("group", "foot").list("support").key("group", "top").key("directions", planar ? p.letter(1) : p.letter(1) + p.letter(2));
  f.list("wall").key("name", "lid").key("shape", "plane").key("group", "top").key("point", p.at((grains - 1) * size + r + critical * way_down, 0)).key("normal", p.along(-1, 0))
      .key("hard", true).key("displacement", p.along(-way_down, 0));
  f.table("solver").key("method", "ipopt");
  const Traced t = test.trace(f, way, "path");
  if (!test.reaches(t, 1) || !test.has_events(t, {{"contact", critical}})) return;
  const double top = (t.last().point.state.position.col(grains - 1) - p.origin).dot(p.along(1, 0)), expected = (grains - 1) * size - (1 - critical) * way_down;
  test.expect(std::abs(top - expected) <= of_states * size, [&] { return fmt::format("the topmost grain ends {:.2g} sizes beside its place", (top - expected) / size); });
  const double force = 2 * K * (1 - critical) * way_down / (grains - 1), energy = force * force / (4 * K) * (grains - 1);
  test.same_energy("the springs", t.last().energy(), energy);
}

/// A ring between two plates, as the grains of a suspension: the plates press it flat.
void ring_plates(Case& test) {
  Random& random = test.random;
  const double radius = random.decades(1e-6, 1e3), EI = random.decades(1e-6, 1e6), slender = random.decades(1e4, 1e8);
  const int n = 4 * random.whole_decades(4, 20);
  const Place3 p = anywhere(random, true, radius, true);
  const Vec3 normal = p.axes.col(2).cwiseAbs();
  const Vec3 e2 = normal[1] == 1 ? Vec3(0, 0, -1) : Vec3(0, 1, 0);
  const std::string across = normal[0] == 1 ? "z" : "x";
  const double diameter = random.between(0.005, 0.05) * radius, gap = random.between(0.02, 0.2) * radius, down = random.between(0.2, 0.6) * radius;
  File f = p.begin("A ring between plates");
  f.list("loop").key("name", "ring").key("particles", n).key("center", p.origin).key("normal", normal).key("radius", radius).key("diameter", diameter)
      .key("axial_stiffness", slender * EI / (radius * radius)).key("bending_stiffness", EI).key("rest", "as_built");
  f.group("top", "ring", fmt::format("ids = [{}]", n / 4 + 1)).group("bottom", "ring", fmt::format("ids = [{}]", 3 * n / 4 + 1));
  f.list("support").key("group", "top").key("directions", across).list("support").key("group", "bottom");
  f.list("wall").key("name", "plate").key("shape", "plane").key("point", Vec3(p.origin + (radius + diameter / 2 + gap) * e2)).key("normal", Vec3(-e2))
      .key("effective_modulus", random.decades(1e2, 1e10) * EI / std::pow(radius * diameter, 2)).key("displacement", Vec3(-(gap + down) * e2));
  Way way{.method = random.chance(0.5) ? PathMethod::arc_length : PathMethod::load_steps, .steps = random.whole_decades(3, 100), .to = 1, .when_unstable = "follow"};
  if (!way.arcs()) way.when_unstable = "jump";
  const Traced t = test.trace(f, way, "path");
  if (!test.reaches(t, 1)) return;
  const std::vector<Row> contacts = t.of("contact");
  const double first = gap / (gap + down);
  test.expect(!contacts.empty() && std::abs(contacts[0].lambda() - first) <= of_events, [&] { return fmt::format("events {}; expected contact {:.12g} first", t.told(), first); });
  test.touches(t);
  way.steps = random.other_steps(way.steps), way.method = way.arcs() ? PathMethod::load_steps : PathMethod::arc_length, way.when_unstable = way.arcs() ? "follow" : "jump";
  const Traced other = test.trace(f, way, "other");
  if (test.reaches(other, 1)) test.touches(other), test.agree(t, other);
}

/// A small heap of grains between walls in a plane, a lid comes down on it. Where the lid meets one grain of a layer first and the walls yield, the
/// heap may tilt at a limit point and fall until the others touch the lid, too.
void grain_heap(Case& test) {
  Random& random = test.random;
  const int below = random.whole(2, 4);
  const double r = random.decades(1e-6, 1e3), weight = random.decades(1e-9, 1e9);
  const auto stiff = [&] { return random.decades(1e3, 1e9) * weight / (r * r); };
  const double E_wall = stiff(), E_grain = stiff();
  const Place3 p = anywhere(random, true, r, false);
  File f = p.begin("A heap of grains under a lid");
  std::vector<Vec3> centers;
  for (int k = 0; k < below; ++k) centers.push_back(p.at(r, (2 * k - below + 1) * r));
  for (int k = 0; k + 1 < below; ++k) centers.push_back(p.at(r + std::sqrt(3) * r, (2 * k - below + 2) * r));
  f.list("grains").key("name", "grains").key("positions", centers).key("diameter", 2 * r);
  f.list("load").key("group", "grains").key("force", p.along(-weight, 0)).key("constant", true);
  f.list("contact").raw("between = [\"grains\", \"grains\"]").key("effective_modulus", E_grain);
  const auto wall = [&](const char* name, const Vec3& point, const Vec3& normal) -> File& {
    return f.list("wall").key("name", name).key("shape", "plane").key("point", point).key("normal", normal).key("effective_modulus", E_wall);
  };
  const double gap = random.between(0.01, 0.3) * r, down = gap + random.between(0.01, 0.08) * r;
  wall("floor", p.at(0, 0), p.along(1, 0)), wall("left", p.at(0, -below * r), p.along(0, 1)), wall("right", p.at(0, below * r), p.along(0, -1));
  wall("lid", p.at((2 + std::sqrt(3)) * r + gap, 0), p.along(-1, 0)).key("displacement", p.along(-down, 0));
  Way way{.method = random.chance(0.5) ? PathMethod::arc_length : PathMethod::load_steps, .steps = random.whole_decades(3, 200), .to = 1, .when_unstable = "jump"};
  const Traced t = test.trace(f, way, "path");
  if (!test.reaches(t, 1)) return;
  test.touches(t);
  way.steps = random.other_steps(way.steps), way.method = way.arcs() ? PathMethod::load_steps : PathMethod::arc_length;
  const Traced other = test.trace(f, way, "other");
  if (test.reaches(other, 1)) test.touches(other), test.agree(t, other), test.same_state(t, t.last(), other, other.last());
}

/// A box on a soft floor is pushed at the height a above its middle until it tips: F a = 4k b² sin θ − W c tan θ as long as all corners
/// touch, sin θ < W/(4kb), then W(b − c tan θ), down to F = 0.
void box_tips(Case& test) {
  Random& random = test.random;
  const double size = random.decades(1e-6, 1e3), W = random.decades(1e-6, 1e6), b = random.between(0.3, 0.8) * size, c = random.between(0.3, 1) * size;
  const double stiff = random.decades(10, 1e6) * W / b * std::max(1.0, c / b), a = random.between(0.2, 1) * c, rounding = random.between(0.05, 0.3) * size;
  const double k = std::max(stiff, 1.5 * W / rounding);           // on two corners the overlap W/2k is less than the rounding's radius
  const Place3 p = anywhere(random, false, size, true);           // s up, t the way of the push
  File f = p.begin("A box tips over");
  Vec3 sides;
  for (int axis = 0; axis < 3; ++axis) sides[axis] = std::abs(p.axes(axis, 0)) == 1 ? 2 * c : std::abs(p.axes(axis, 1)) == 1 ? 2 * b : 0.6 * size;
  const double sine = W / (4 * k * b), top = (4 * k * b * b * sine - W * c * sine / std::sqrt(1 - sine * sine)) / a, unit = random.between(0.5, 2);
  f.list("body").key("name", "box").key("shape", "box").key("size", sides).key("rounding_diameter", rounding).key("position", p.at(c + rounding / 2, 0)).key("mass", W);
  f.list("wall").key("name", "floor").key("group", "box").key("shape", "plane").key("point", p.at(0, 0)).key("normal", p.along(1, 0)).key("k_n", k);
  f.list("gravity").key("acceleration", p.along(-1, 0));
  f.list("support").key("group", "box").key("directions", p.letter(1) + p.letter(2)).key("turns", p.letter(0) + p.letter(1));
  f.list("load").key("group", "box").key("force", p.along(0, unit * top)).key("point", p.along(a, 0));
  Way way{.method = PathMethod::arc_length, .steps = random.whole_decades(3, 200), .to = random.between(1.05, 3) / unit, .when_unstable = "follow"};
  const Traced t = test.trace(f.text() + fmt::format("\n[path]\nmethod = \"arc_length\"\nsteps = {}\nto = {:.17g}\nlowest = 0.0\npoints = 20000\n", way.steps, way.to), "path");
  if (test.reaches(t, 0)) test.has_events(t, {{"limit", 1 / unit}});
}

// ---- All of them.

struct Family {
  const char* name;
  void (*run)(Case&);
};
const std::vector<Family> families{
    {"column_straight", column_straight}, {"column_falls", column_falls}, {"column_branches", column_branches}, {"column_pushed", column_pushed},
    {"arch_sine", arch_sine}, {"arch_round", arch_round}, {"truss_arcs", truss_arcs}, {"truss_snaps", truss_snaps},
    {"events_truss", events_truss}, {"events_side", events_side}, {"ring_pressure", ring_pressure}, {"ring_side", ring_side},
    {"grain_lid", grain_lid}, {"grain_floats", grain_floats}, {"box_lid", box_lid}, {"column_stop", column_stop}, {"column_back", column_back},
    {"events_column", events_column}, {"column_passes", column_passes}, {"two_beams", two_beams}, {"sheet_strip", sheet_strip},
    {"hard_lid", hard_lid}, {"ring_plates", ring_plates}, {"grain_heap", grain_heap}, {"box_tips", box_tips},
    {"column_slides", column_slides},
};

/// What is wrong with one problem, one sentence after the other; "": it ended right.
std::string judge(const Family& family, std::uint64_t seed, const std::string& directory) {
  Case test(family.name, seed, directory);
  try {
    family.run(test);
  } catch (const std::exception& e) {
    test.wrong(std::string("refused: ") + e.what());
  }
  return fmt::format("{}", fmt::join(test.mistakes(), "; "));
}

struct Running {
  std::uint64_t seed;
  const Family* family;
  int answer;                                   // the end of the pipe to read from
  double since;
};

double now() {
  timespec t;
  clock_gettime(CLOCK_MONOTONIC, &t);
  return static_cast<double>(t.tv_sec) + 1e-9 * static_cast<double>(t.tv_nsec);
}

int main(int argc, char** argv) {
  keep_freed_memory();
  std::uint64_t seed = 1;
  int count = 100, jobs = 1, seconds = 60, least = -1;
  std::string name, keep;
  bool only = false;
  for (int k = 1; k < argc; ++k) {
    const std::string option = argv[k], value = k + 1 < argc ? argv[++k] : "";
    if (option == "--seed") seed = std::stoull(value);
    else if (option == "--count") count = std::stoi(value);
    else if (option == "--family") name = value;
    else if (option == "--only") seed = std::stoull(value), count = 1, only = true;
    else if (option == "--keep") keep = value;
    else if (option == "--jobs") jobs = std::max(1, std::stoi(value));
    else if (option == "--seconds") seconds = std::stoi(value);
    else if (option == "--least") least = std::stoi(value);
    else return std::fprintf(stderr, "unknown option %s; see the head of tests/bench/path_stress.cpp\n", option.c_str()), EXIT_FAILURE;
  }
  const auto named = std::find_if(families.begin(), families.end(), [&](const Family& f) { return f.name == name; });
  if (!name.empty() && named == families.end()) {
    std::fprintf(stderr, "unknown family %s; there are", name.c_str());
    for (const Family& f : families) std::fprintf(stderr, " %s", f.name);
    return std::fprintf(stderr, "\n"), EXIT_FAILURE;
  }
  set_threads(1);
  const std::string directory = keep.empty() ? (std::filesystem::temp_directory_path() / fmt::format("path_stress-{}", getpid())).string() : keep;
  std::filesystem::create_directories(directory);

  std::map<pid_t, Running> running;
  std::map<std::string, std::array<int, 2>> by_family;            // right, all
  std::vector<std::pair<std::uint64_t, std::string>> lines;
  int right = 0, done = 0;
  const double begun = now();
  double slowest = 0;
  std::string slowest_name;
  for (int next = 0; next < count || !running.empty();) {
    if (next < count && static_cast<int>(running.size()) < jobs) {
      const std::uint64_t s = seed + static_cast<std::uint64_t>(next++);
      const Family& family = named != families.end() ? *named : families[s % families.size()];
      int ends[2];
      if (pipe(ends) != 0) return std::perror("pipe"), EXIT_FAILURE;
      std::fflush(stdout);
      const pid_t child = fork();
      if (child < 0) return std::perror("fork"), EXIT_FAILURE;
      if (child == 0) {
        close(ends[0]);
        const itimerval most{{0, 0}, {seconds, 0}};
        setitimer(ITIMER_PROF, &most, nullptr);
        const std::string answer = judge(family, s, directory).substr(0, 4000);
        _exit(write(ends[1], answer.data(), answer.size()) == static_cast<ssize_t>(answer.size()) ? 0 : 1);
      }
      close(ends[1]);
      running[child] = {s, &family, ends[0], now()};
      continue;
    }
    int status = 0;
    const pid_t child = wait(&status);
    if (child < 0) return std::perror("wait"), EXIT_FAILURE;
    const auto found = running.find(child);
    if (found == running.end()) continue;
    const Running r = found->second;
    running.erase(found);
    std::string answer(8192, '\0');
    const ssize_t size = read(r.answer, answer.data(), answer.size());
    answer.resize(size > 0 ? static_cast<std::size_t>(size) : 0);
    close(r.answer);
    if (WIFSIGNALED(status)) answer = WTERMSIG(status) == SIGPROF ? fmt::format("no end after {} seconds", seconds) : fmt::format("killed by signal {}", WTERMSIG(status));
    ++done, right += answer.empty();
    if (const double took = now() - r.since; took > slowest) slowest = took, slowest_name = fmt::format("--family {} --only {}", r.family->name, r.seed);
    by_family[r.family->name][0] += answer.empty(), ++by_family[r.family->name][1];
    if (!answer.empty()) lines.push_back({r.seed, fmt::format("--family {} --only {}: {}", r.family->name, r.seed, answer)});
  }
  if (keep.empty()) std::filesystem::remove_all(directory);

  std::sort(lines.begin(), lines.end());
  for (const auto& [s, line] : lines) std::printf("%s\n", line.c_str());
  if (only && lines.empty()) std::printf("ended right\n");
  for (const auto& [family, n] : by_family) std::printf("%-16s ended right: %d of %d\n", family.c_str(), n[0], n[1]);
  std::printf("ended right: %d of %d (%.1f s, the longest %.1f s: %s)\n", right, done, now() - begun, slowest, slowest_name.c_str());
  return right >= (least < 0 ? done : least) ? EXIT_SUCCESS : EXIT_FAILURE;
}

}  // namespace path_stress
