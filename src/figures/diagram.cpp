#include "figures/diagram.hpp"

#include "core/error.hpp"
#include "core/suggest.hpp"
#include "core/text.hpp"
#include "results/columns.hpp"
#include "results/json.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>

namespace elamin {

namespace {

constexpr double small_type = 6.5, large_type = 7.5;

std::string power_of_ten(int exponent) {
  static const std::array<const char*, 10> raised{"⁰", "¹", "²", "³", "⁴", "⁵", "⁶", "⁷", "⁸", "⁹"};
  std::string power = exponent < 0 ? "⁻" : "";
  for (const char digit : fmt::format("{}", std::abs(exponent))) power += raised[digit - '0'];
  return "10" + power;
}

// "name (10⁻³)", or the name alone.
std::string with_factor(const std::string& name, int exponent) { return exponent == 0 ? name : fmt::format("{} ({})", name, power_of_ten(exponent)); }

}  // namespace

void Extent::add(double v) {
  if (empty()) lo = hi = v;
  lo = std::min(lo, v), hi = std::max(hi, v);
}

Extent with_room(const Extent& range) {
  if (range.empty()) return {0, 1};
  const double size = std::max(std::abs(range.lo), std::abs(range.hi));
  double room = 0.04 * (range.hi - range.lo);
  if (!(range.hi - range.lo > 1e-9 * size)) room = size > 0 ? 0.1 * size : 1;
  return {range.lo - room, range.hi + room};
}

Ticks ticks_of(const Extent& range, bool whole) {
  constexpr int about = 5;
  const double rough = (range.hi - range.lo) / about, power = std::pow(10.0, std::floor(std::log10(rough)));
  double step = 10 * power;
  for (const double m : {1.0, 2.0, 5.0})
    if (m * power >= 0.8 * rough) {
      step = m * power;
      break;
    }
  if (whole) step = std::max(1.0, std::round(step));
  Ticks ticks;
  const double size = std::max(std::abs(range.lo), std::abs(range.hi));
  const int order = static_cast<int>(std::floor(std::log10(size) + 1e-9));
  if (order < -2 || order > 3) ticks.exponent = order;
  const double unit = std::pow(10.0, ticks.exponent);
  const int decimals = std::max(0, static_cast<int>(std::ceil(-std::log10(step / unit) - 1e-9)));
  for (double k = std::ceil(range.lo / step - 1e-9); k * step <= range.hi + 1e-9 * step; ++k) {
    ticks.values.push_back(k * step);
    std::string label = fmt::format("{:.{}f}", std::abs(k * step / unit), decimals);
    ticks.labels.push_back(k < 0 ? "−" + label : label);
  }
  return ticks;
}

Ticks decades_of(const Extent& range) {
  Ticks ticks;
  const int step = std::max(1, static_cast<int>(std::ceil((range.hi - range.lo) / 6)));
  for (int k = static_cast<int>(std::ceil(range.lo)); k <= range.hi; k += step) ticks.values.push_back(k), ticks.labels.push_back(power_of_ten(k));
  return ticks;
}

void draw_axes(Drawing& drawing, const PlotArea& f, const std::string& x, const std::string& y) {
  constexpr double tick = 2.5;
  const Ticks across = ticks_of(f.x, f.whole_x), up = f.up();
  std::vector<Polyline> marks;
  double widest = 0;
  for (std::size_t i = 0; i < across.values.size(); ++i) {
    const Vec2 at = f.at(across.values[i], f.y.lo);
    marks.push_back({at, at - Vec2(0, tick)});
    drawing.words(at + Vec2(0, 8.5), across.labels[i], Anchor::middle, small_type);
  }
  for (std::size_t i = 0; i < up.values.size(); ++i) {
    const Vec2 at = f.at(f.x.lo, up.values[i]);
    marks.push_back({at, at + Vec2(tick, 0)});
    drawing.words(at + Vec2(-2.5, 2.3), up.labels[i], Anchor::end, small_type);
    widest = std::max(widest, 1.2 * width_of(up.labels[i], small_type));
  }
  drawing.lines(marks, {});
  drawing.area({f.lo, {f.hi.x(), f.lo.y()}, f.hi, {f.lo.x(), f.hi.y()}}, "", {});
  drawing.words({(f.lo.x() + f.hi.x()) / 2, f.lo.y() + 18.5}, with_factor(x, across.exponent), Anchor::middle, large_type);
  drawing.words({f.lo.x() - 6.5 - widest, (f.lo.y() + f.hi.y()) / 2}, with_factor(y, up.exponent), Anchor::middle, large_type, true);
}

namespace {

std::string text_in(const Row& row, int column) {
  if (column < 0) return "";
  const std::string* text = std::get_if<std::string>(&row[column]);
  return text ? *text : "";
}

std::optional<double> number_in(const Row& row, int column) {
  return column < 0 ? std::nullopt : as_number(row[column]);
}

int needed(const Table& table, const std::string& name, const std::string& file) {
  const int column = table.column(name);
  if (column < 0)
    throw InputError(fmt::format("{}: has no column {}; there are: {}{}", file, in_quotes(name), listed(table.columns), did_you_mean(name, table.columns)));
  return column;
}

// Whether a column has at least two numbers that differ by more than rounding.
bool changes(const Table& table, int column) {
  Extent range;
  for (const Row& row : table.rows)
    if (const auto v = number_in(row, column)) range.add(*v);
  return !range.empty() && range.hi - range.lo > 1e-9 * std::max(std::abs(range.lo), std::abs(range.hi));
}

// The first of the columns from `first` up to `last` (left out) that changes.
std::string first_changing(const Table& table, const std::string& first, const std::string& last) {
  const int end = table.column(last), begin = table.column(first);
  for (int c = begin + 1; begin >= 0 && c < end; ++c)
    if (changes(table, c)) return table.columns[c];
  return "";
}

std::string first_of(std::initializer_list<std::string> names) {
  for (const std::string& name : names)
    if (!name.empty()) return name;
  return "";
}

std::string axis_name(const std::string& column) { return column == "lambda" ? "load factor λ" : column; }

// The columns of the two axes.
struct CurveColumns {
  int x, y;
  std::optional<Vec2> at(const Row& row) const {
    const auto u = number_in(row, x), v = number_in(row, y);
    return u && v ? std::optional(Vec2(*u, *v)) : std::nullopt;
  }
};

Diagram begun(const Table& table, const Axes& axes, const std::string& file, CurveColumns& columns) {
  columns = {needed(table, axes.x, file), needed(table, axes.y, file)};
  return {axis_name(axes.x), axis_name(axes.y), {}, {}};
}

}  // namespace

bool Diagram::empty() const {
  std::size_t points = 0;
  for (const Curve& c : curves) points += c.points.size();
  return points < 2;
}

Diagram path_diagram(const Table& path, const Axes& asked, const std::string& file) {
  const auto column = [&](const char* name) { return path.column(name); };
  const auto if_changing = [&](const char* name) { return changes(path, column(name)) ? name : ""; };
  const Axes axes{asked.x.empty() ? "lambda" : asked.x,
                  first_of({asked.y, first_changing(path, "stable", "parent"), if_changing("negative"), "energy"})};
  CurveColumns at{};
  Diagram d = begun(path, axes, file, at);
  const int label = column("label"), branch = column("branch"), stable = column("stable"), parent = column("parent"), stage = column("stage");
  std::map<std::string, Vec2> events;
  std::map<std::string, int> stages;
  const Row* before = nullptr;
  int branches = 0;                                        // that no snap leads to
  for (const Row& row : path.rows) {
    const auto here = at.at(row);
    if (!here) {
      before = nullptr;
      continue;
    }
    const std::string name = text_in(row, label), of_stage = text_in(row, stage);
    const bool event = is_event(name), snap = name.starts_with("jump:");
    if (event) d.marks.push_back({name.substr(0, name.find(':')), *here}), events.insert_or_assign(name, *here);
    if (!of_stage.empty() && stages.try_emplace(of_stage, static_cast<int>(stages.size())).second) d.names.push_back(of_stage);
    const bool new_branch = before && number_in(*before, branch) != number_in(row, branch) && !snap;
    if (new_branch) ++branches;
    const bool new_stage = before && text_in(*before, stage) != of_stage;
    const auto known_stable = [&](const Row& r) { return number_in(r, stable).value_or(0) != 0; };
    std::optional<Vec2> from = before ? at.at(*before) : std::nullopt;
    bool is_stable = known_stable(row);
    if (before && !new_branch && event) is_stable = is_event(text_in(*before, label)) ? is_stable && known_stable(*before) : known_stable(*before);
    if (new_branch) {
      const auto origin = events.find(text_in(row, parent));
      from = origin == events.end() ? std::nullopt : std::optional(origin->second);
    }
    if (new_stage && axes.x == "lambda") from.reset();
    const auto kind = snap ? Curve::Kind::snap : is_stable ? Curve::Kind::stable : Curve::Kind::unstable;
    const int its_colour = of_stage.empty() ? branches : stages[of_stage];
    Curve* last = d.curves.empty() ? nullptr : &d.curves.back();
    const bool goes_on = last && from && !new_branch && last->kind == kind && last->colour == its_colour && last->points.back() == *from;
    if (goes_on) last->points.push_back(*here);
    else d.curves.push_back({from ? Polyline{*from, *here} : Polyline{*here}, kind, its_colour});
    before = &row;
  }
  if (stages.empty() && branches > 0)
    for (int b = 0; b <= branches; ++b) d.names.push_back(b == 0 ? "first branch" : fmt::format("branch {}", b + 1));
  if (d.names.size() < 2) d.names.clear();
  return d;
}

Diagram curve_diagram(const Table& table, const Axes& asked, const std::string& file) {
  CurveColumns at{};
  Diagram d = begun(table, {first_of({asked.x, "second"}), first_of({asked.y, "lambda"})}, file, at);
  const int label = table.column("label");
  d.curves.emplace_back();
  for (const Row& row : table.rows) {
    const auto here = at.at(row);
    if (!here) continue;
    d.curves.front().points.push_back(*here);
    if (const std::string name = text_in(row, label); is_event(name)) d.marks.push_back({name.substr(0, name.find(':')), *here});
  }
  return d;
}

Diagram landscape_diagram(const Table& table, const Axes& asked, const std::string& file) {
  CurveColumns at{};
  Diagram d = begun(table, {first_of({asked.x, "lambda"}), first_of({asked.y, "energy"})}, file, at);
  const int label = table.column("label");
  for (const Row& row : table.rows) {
    const std::string name = text_in(row, label);
    const auto here = at.at(row);
    if (!here || !is_event(name)) continue;
    const auto known = std::find(d.names.begin(), d.names.end(), name);
    const auto colour = static_cast<std::size_t>(known - d.names.begin());
    const Curve::Kind kind = name.starts_with("minimum:") ? Curve::Kind::stable : Curve::Kind::unstable;
    if (known == d.names.end()) d.names.push_back(name), d.curves.push_back({{}, kind, static_cast<int>(colour)});
    d.curves[colour].points.push_back(*here);
  }
  if (d.names.size() < 2) d.names.clear();
  return d;
}

Diagram tree_diagram(const std::string& file) {
  Diagram d{"minima", "energy", {}, {}};
  d.whole_x = true;
  const Json json = Json::parse(read_text(file), nullptr, false);
  if (json.is_discarded() || !json.contains("landscapes") || json["landscapes"].empty()) throw InputError(file + ": is no landscape.json of elamin");
  const Json& tree = json["landscapes"].back()["tree"];
  for (const Json& line : tree["lines"]) {
    d.curves.emplace_back();
    for (const Json& point : line) d.curves.back().points.emplace_back(point[0].get<double>(), point[1].get<double>());
  }
  for (const Json& leaf : tree["leaves"]) d.curves.push_back({{{leaf["x"].get<double>(), leaf["energy"].get<double>()}}, Curve::Kind::points, 0});
  return d;
}

Diagram motion_diagram(const Table& trajectory, const Axes& asked, const std::string& file) {
  const int balance = trajectory.column("balance");
  std::string observed;
  for (std::size_t c = static_cast<std::size_t>(balance + 1); balance >= 0 && c < trajectory.columns.size() && observed.empty(); ++c)
    if (changes(trajectory, static_cast<int>(c))) observed = trajectory.columns[c];
  CurveColumns at{};
  Diagram d = begun(trajectory, {first_of({asked.x, "time"}), first_of({asked.y, observed, "kinetic"})}, file, at);
  Curve curve;
  for (const Row& row : trajectory.rows)
    if (const auto here = at.at(row)) curve.points.push_back(*here);
  d.curves = {curve};
  return d;
}

Diagram modes_diagram(const Table& modes, const Axes& asked, const std::string& file) {
  CurveColumns at{};
  Diagram d = begun(modes, {first_of({asked.x, "mode"}), first_of({asked.y, "eigenvalue"})}, file, at);
  d.whole_x = d.x == "mode";
  for (const Row& row : modes.rows)
    if (const auto here = at.at(row)) d.curves.push_back({{*here}, Curve::Kind::points, 0});
  return d;
}

Diagram sweep_diagram(const Table& sweep, const Axes& asked, const std::string& file) {
  const int status = needed(sweep, "status", file);
  std::vector<int> keys;                                   // swept, but not what is expected
  for (int c = 0; c < status; ++c)
    if (!sweep.columns[c].starts_with("expect.") && changes(sweep, c)) keys.push_back(c);
  Axes axes = asked;
  if (axes.x.empty()) axes.x = keys.empty() ? sweep.columns.front() : sweep.columns[keys.front()];
  const bool in_time = sweep.column("balance") >= 0;
  if (axes.y.empty())
    axes.y = first_of({first_changing(sweep, "status", "step"), first_changing(sweep, "stable", "parent"), in_time ? "kinetic" : "energy"});
  CurveColumns at{};
  Diagram d = begun(sweep, axes, file, at);
  if (d.x == sweep.columns[at.x] && d.x.find('.') != std::string::npos) d.x = d.x.substr(d.x.find('.') + 1);
  if (is_event(d.y)) d.y = "load factor λ of " + d.y;
  // One series, unless a value comes twice.
  std::map<double, int> times;
  bool twice = false;
  for (const Row& row : sweep.rows)
    if (const auto here = at.at(row)) twice = ++times[here->x()] > 1 || twice;
  std::map<std::string, Curve> series;
  for (const Row& row : sweep.rows) {
    const auto here = at.at(row);
    if (!here) continue;
    std::string name;
    for (const int k : keys)
      if (twice && k != at.x) {
        const std::string& key = sweep.columns[k];
        const std::string value = fmt::format("{:.6g}", number_in(row, k).value_or(0));
        name += (name.empty() ? "" : ", ") + key.substr(key.rfind('.') + 1) + " = " + value;
      }
    const auto [it, is_new] = series.try_emplace(name, Curve{{}, Curve::Kind::points, static_cast<int>(series.size())});
    if (is_new && twice) d.names.push_back(name);
    it->second.points.push_back(*here);
  }
  for (auto& [name, curve] : series) {
    std::sort(curve.points.begin(), curve.points.end(), [](const Vec2& a, const Vec2& b) { return a.x() < b.x(); });
    d.curves.push_back(curve);
  }
  return d;
}

Diagram refinement_diagram(const Table& refine, const std::string& file) {
  constexpr std::size_t most = 6;
  const int at = needed(refine, "at", file), quantity = needed(refine, "quantity", file), value = needed(refine, "value", file),
            order = needed(refine, "order", file), first = needed(refine, "level_1", file);
  Diagram d{"level", "distance from the value without particles, relative", {}, {}};
  d.whole_x = d.decades = true;
  for (const Row& row : refine.rows) {
    const auto limit = number_in(row, value), observed = number_in(row, order);
    if (!limit || !observed || *limit == 0 || d.curves.size() == most) continue;
    Curve curve{{}, Curve::Kind::points, static_cast<int>(d.curves.size())};
    for (int c = first; c < static_cast<int>(refine.columns.size()); ++c)
      if (const auto level = number_in(row, c); level && *level != *limit) curve.points.emplace_back(c - first + 1, std::log10(std::abs((*level - *limit) / *limit)));
    d.names.push_back(fmt::format("{} at {}, order {:.2f}", text_in(row, quantity), text_in(row, at), *observed));
    d.curves.push_back(std::move(curve));
  }
  return d;
}

}  // namespace elamin
