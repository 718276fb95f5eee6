#include "lammps/script/formula.hpp"

#include "core/suggest.hpp"
#include "core/text.hpp"
#include "laws/section.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <charconv>
#include <cmath>
#include <cstdlib>
#include <cstring>

namespace elamin::script {
namespace {

constexpr int most_operands = 1000000;          // of one formula with all that it goes through

bool is_name(char c) { return std::isalnum(static_cast<unsigned char>(c)) || c == '_'; }

[[noreturn]] void needs_forces(std::size_t word, const std::string& what) {
  throw Wrong(word, in_quotes(what) + " is known only where LAMMPS runs; the import follows what a script builds, not how it moves", true);
}

class Formula {
 public:
  Formula(const std::string& text, const World& world, const Names& names, std::size_t word, bool each, Dependence* on, int& operands,
          int depth = 0)
      : text_(text), world_(world), names_(names), word_(word), each_(each), on_(on), operands_(operands), depth_(depth) {
    if (depth > most_nested) wrong("goes through too many variables or brackets");
  }

  Value whole() {
    Value v = operation(1);
    if (!end()) wrong(fmt::format("{} is left over", in_quotes(text_.substr(i_))));
    return v;
  }

 private:
  [[noreturn]] void wrong(const std::string& what) const { throw Wrong(word_, "the formula " + in_quotes(text_) + ": " + what); }

  void blanks() {
    while (i_ < text_.size() && std::isspace(static_cast<unsigned char>(text_[i_]))) ++i_;
  }
  bool end() {
    blanks();
    return i_ >= text_.size();
  }

  struct Operator { const char* sign; int precedence; };
  /// The operator that stands here, or none.
  const Operator* operator_here() {
    static constexpr Operator all[]{{"||", 1}, {"|^", 1}, {"&&", 2}, {"==", 3}, {"!=", 3}, {"<=", 4}, {">=", 4}, {"<", 4},
                                    {">", 4},  {"+", 5},  {"-", 5},  {"*", 6},  {"/", 6},  {"%", 6},  {"^", 7}};
    if (end()) return nullptr;
    for (const Operator& o : all)
      if (text_.compare(i_, std::strlen(o.sign), o.sign) == 0) return &o;
    return nullptr;
  }

  Value operation(int least) {
    Value left = operand();
    for (const Operator* o = operator_here(); o && o->precedence >= least; o = operator_here()) {
      i_ += std::strlen(o->sign);
      const Value right = operation(o->precedence + 1);
      left = combined(o->sign, left, right);
    }
    return left;
  }

  double apply(std::string_view sign, double a, double b, bool one) const {
    if (sign == "+") return a + b;
    if (sign == "-") return a - b;
    if (sign == "*") return a * b;
    if (sign == "^") return std::pow(a, b);
    if (sign == "||") return a != 0 || b != 0;
    if (sign == "|^") return (a != 0) != (b != 0);
    if (sign == "&&") return a != 0 && b != 0;
    if (sign == "==") return a == b;
    if (sign == "!=") return a != b;
    if (sign == "<=") return a <= b;
    if (sign == ">=") return a >= b;
    if (sign == "<") return a < b;
    if (sign == ">") return a > b;
    if (b == 0 && one) wrong("divides by 0");
    return sign == "/" ? a / b : std::fmod(a, b);
  }

  Value combined(std::string_view sign, const Value& a, const Value& b) const {
    Value r;
    if (a.each.empty() && b.each.empty()) {
      r.number = apply(sign, a.number, b.number, true);
      return r;
    }
    r.each.resize(world_.atoms.size());
    for (std::size_t k = 0; k < r.each.size(); ++k) r.each[k] = apply(sign, a.at(k), b.at(k), false);
    return r;
  }

  template <class Call> Value mapped(Value v, const Call& call) const {
    if (v.each.empty()) v.number = call(v.number);
    for (double& x : v.each) x = call(x);
    return v;
  }

  Value operand() {
    if (end()) wrong("ends where a number is wanted");
    if (++nested_ > most_nested) wrong("has too many brackets or signs in each other");
    if (++operands_ > most_operands) wrong("goes through more than " + std::to_string(most_operands) + " numbers");
    struct Leave { int& n; ~Leave() { --n; } } leave{nested_};
    const char c = text_[i_];
    if (c == '-' || c == '!') {
      ++i_;
      return mapped(operand(), [c](double x) { return c == '-' ? -x : static_cast<double>(x == 0); });
    }
    if (c == '(') {
      ++i_;
      Value v = operation(1);
      close(')');
      return v;
    }
    if (std::isdigit(static_cast<unsigned char>(c)) || c == '.') return number();
    if (std::isalpha(static_cast<unsigned char>(c))) return word();
    wrong(fmt::format("{} stands where a number is wanted", in_quotes(std::string(1, c))));
  }

  void close(char bracket) {
    if (end() || text_[i_] != bracket) wrong(fmt::format("'{}' is missing", bracket));
    ++i_;
  }

  Value number() {
    Value v;
    const auto [last, error] = std::from_chars(text_.data() + i_, text_.data() + text_.size(), v.number);
    if (error != std::errc{}) wrong("holds a number that cannot be read");
    i_ = static_cast<std::size_t>(last - text_.data());
    return v;
  }

  std::string name() {
    const std::size_t begin = i_;
    while (i_ < text_.size() && is_name(text_[i_])) ++i_;
    return text_.substr(begin, i_ - begin);
  }

  /// What stands in the brackets behind a function, cut at its commas.
  std::vector<std::string> arguments(char open, char shut) {
    const std::size_t begin = ++i_;
    std::vector<std::string> all{""};
    for (int depth = 1; i_ < text_.size(); ++i_) {
      const char c = text_[i_];
      if (c == open) ++depth;
      if (c == shut && --depth == 0) {
        ++i_;
        return all;
      }
      if (c == ',' && depth == 1) all.emplace_back();
      else all.back() += c;
    }
    wrong(fmt::format("'{}' is not closed: {}", open, in_quotes(text_.substr(begin - 1))));
  }

  Value sub(const std::string& formula) { return Formula(formula, world_, names_, word_, each_, on_, operands_, depth_ + 1).whole(); }
  double sub_number(const std::string& formula) {
    const Value v = sub(formula);
    if (!v.each.empty()) wrong(in_quotes(formula) + " is a number for every atom where one number is wanted");
    return v.number;
  }

  Value word() {
    const std::string w = name();
    if (w.starts_with("v_")) return variable(w.substr(2));
    if (w.starts_with("c_")) return compute(w.substr(2), w);
    if (w.starts_with("f_")) needs_forces(word_, w);
    if (i_ < text_.size() && text_[i_] == '(') return function(w, arguments('(', ')'));
    if (i_ < text_.size() && text_[i_] == '[') return of_atom(w, arguments('[', ']'));
    Value v;
    if (vector(w, v) || constant(w, v.number) || keyword(w, v.number)) return v;
    wrong(in_quotes(w) + " is no function, atom vector, constant or thermo keyword that is known here");
  }

  Value variable(const std::string& n) {
    const auto found = names_.variables.find(n);
    if (found == names_.variables.end()) wrong(in_quotes("v_" + n) + " is no variable");
    const Variable& v = found->second;
    Value value;
    if (i_ < text_.size() && text_[i_] == '[') {
      if (!v.of_atoms()) wrong(in_quotes("v_" + n) + " is not of style atom");
      const int i = atom(sub_number(arguments('[', ']').front()));
      value.number = v.style == Variable::Style::atomfile ? from_file(v, world_.atoms[i])
                                                          : Formula(v.words.front(), world_, names_, word_, true, on_, operands_, depth_ + 1).whole().at(i);
      return value;
    }
    if (v.of_atoms() && !each_) wrong(in_quotes("v_" + n) + " is of style atom");
    if (v.style == Variable::Style::atomfile) {
      for (const Atom& a : world_.atoms) value.each.push_back(from_file(v, a));
      return value;
    }
    if (v.style == Variable::Style::equal || v.style == Variable::Style::atom) {
      value = sub(v.words.front());
      // LAMMPS reads what it has printed; what changes in time is held against a line, and keeps its digits.
      if (v.style == Variable::Style::equal && !on_) value.number = std::strtod(fmt::format("{:.15g}", value.number).c_str(), nullptr);
      return value;
    }
    const std::string text = text_of(n, world_, names_);
    if (!reads_as(unsigned_word(text), value.number)) wrong(fmt::format("{} is {}, no number", in_quotes("v_" + n), in_quotes(text)));
    return value;
  }

  int atom(double id) const {
    if (!(std::abs(id) < 2e9)) wrong("an atom's id is out of range");
    return world_.with_id(std::llround(id), word_);
  }

  Value compute(const std::string& n, const std::string& w) {
    const auto found = names_.computes.find(n);
    if (found == names_.computes.end()) wrong(in_quotes(w) + " is no compute");
    const Compute& c = found->second;
    if (c.style != "reduce") needs_forces(word_, w);
    std::size_t which = 0;
    if (i_ < text_.size() && text_[i_] == '[')
      which = static_cast<std::size_t>(std::clamp(sub_number(arguments('[', ']').front()), 1.0, 1e6)) - 1;
    if (which >= c.inputs.size()) wrong(in_quotes(w) + " has not so many values");
    std::string input = c.inputs[which];
    const Value v = Formula(input, world_, names_, word_, true, on_, operands_, depth_ + 1).whole();
    const int group = world_.group(c.group, word_);
    double sum = 0, least = 1e20, most = -1e20, count = 0;
    for (std::size_t k = 0; k < world_.atoms.size(); ++k) {
      if (!World::there(world_.atoms[k]) || !world_.in(world_.atoms[k], group)) continue;
      if (v.each.empty()) wrong(in_quotes(input) + " is no number for every atom");
      const double x = v.each[k];
      sum += c.mode.ends_with("sq") ? x * x : x, least = std::min(least, x), most = std::max(most, x), ++count;
    }
    Value r;
    r.number = c.mode == "min" ? least : c.mode == "max" ? most : c.mode.starts_with("ave") ? (count > 0 ? sum / count : 0) : sum;
    return r;
  }

  static double from_file(const Variable& v, const Atom& a) {
    const auto at = v.of_id.find(a.id);
    return at == v.of_id.end() ? 0 : at->second;
  }

  void placed() const {
    if (on_) on_->places = true;
  }

  static constexpr const char* vectors[]{"id", "mass", "type", "mol", "x", "y", "z", "vx", "vy", "vz", "radius", "diameter"};
  /// An atom's entry in a vector; false: there is no such vector.
  bool entry(const std::string& w, const Atom& a, double& out) const {
    if (w == "id") out = a.id;
    else if (w == "mass") out = world_.mass_of(a);
    else if (w == "type") out = a.type;
    else if (w == "mol") out = a.molecule;
    else if (w == "x" || w == "y" || w == "z") out = world_.at(a)[w[0] - 'x'], placed();
    else if (w == "vx" || w == "vy" || w == "vz") {
      if (a.drifts) throw NeedsPositions{world_.last_run};
      out = a.v[w[1] - 'x'], placed();
    }
    else return false;
    return true;
  }

  bool vector(const std::string& w, Value& v) const {
    double one = 0;
    if (w == "fx" || w == "fy" || w == "fz" || w == "q") needs_forces(word_, w);
    if (!entry(w, Atom{}, one)) return false;
    if (!each_) wrong(in_quotes(w) + " is of every atom; an equal-style formula takes " + w + "[id]");
    v.each.resize(world_.atoms.size());
    for (std::size_t k = 0; k < v.each.size(); ++k)
      if (World::there(world_.atoms[k])) entry(w, world_.atoms[k], v.each[k]);
    return true;
  }

  Value of_atom(const std::string& w, const std::vector<std::string>& args) {
    Value v;
    if (w == "fx" || w == "fy" || w == "fz" || w == "q") needs_forces(word_, w);
    if (!entry(w, world_.atoms.at(atom(sub_number(args.front()))), v.number))
      wrong(in_quotes(w) + " is no atom vector");
    return v;
  }

  static bool constant(const std::string& w, double& out) {
    if (w == "PI") out = pi;
    else if (w == "version") out = 20210929;
    else if (w == "yes" || w == "on" || w == "true") out = 1;
    else if (w == "no" || w == "off" || w == "false") out = 0;
    else return false;
    return true;
  }

  double side(int c, int end) const {
    if (const char kind = world_.kind_of_side(c, end); kind == 's' || kind == 'm') placed();
    return world_.side(c, end);
  }
  double length(int c) const { return side(c, 1) - side(c, 0); }

  bool keyword(const std::string& w, double& out) const {
    const World::Moment& m = world_.moment;
    if (w == "step") out = static_cast<double>(world_.step + m.steps);
    else if (w == "time") out = world_.time + static_cast<double>(m.steps) * world_.timestep;
    else if (w == "elapsed" || w == "elaplong") out = static_cast<double>(m.steps + (w == "elaplong" ? m.before : 0));
    else if (w == "dt") out = world_.timestep;
    else if (w == "atoms") out = static_cast<double>(std::count_if(world_.atoms.begin(), world_.atoms.end(), World::there));
    else if (w == "xlo" || w == "ylo" || w == "zlo") out = side(w[0] - 'x', 0);
    else if (w == "xhi" || w == "yhi" || w == "zhi") out = side(w[0] - 'x', 1);
    else if (w == "lx" || w == "ly" || w == "lz") out = length(w[1] - 'x');
    else if (w == "vol") out = length(0) * length(1) * length(2);
    else {
      static constexpr const char* unknown[]{"temp",  "press", "pe",     "ke",   "etotal", "evdwl", "ecoul",
                                             "epair", "ebond", "eangle", "fmax", "fnorm",  "cpu"};
      for (const char* u : unknown)
        if (w == u) needs_forces(word_, w);
      return false;
    }
    if (on_ && (w == "step" || w == "time" || w.starts_with("elap"))) on_->time = true;
    return true;
  }

  Value function(const std::string& w, const std::vector<std::string>& args) {
    const std::size_t n = args.size();
    const auto wants = [&](std::size_t least, std::size_t most) {
      if (n < least || n > most)
        wrong(fmt::format("{}() has {} arguments, {} wanted", w, n, least == most ? std::to_string(least) : fmt::format("{} to {}", least, most)));
    };
    struct One { const char* name; double (*call)(double); };
    static constexpr One ones[]{{"sqrt", std::sqrt}, {"exp", std::exp},   {"ln", std::log},     {"log", std::log10}, {"abs", std::abs},
                                {"sin", std::sin},   {"cos", std::cos},   {"tan", std::tan},    {"asin", std::asin}, {"acos", std::acos},
                                {"atan", std::atan}, {"ceil", std::ceil}, {"floor", std::floor},
                                {"round", [](double x) { return x - std::floor(x) >= 0.5 ? std::ceil(x) : std::floor(x); }}};
    for (const One& o : ones) {
      if (w != o.name) continue;
      wants(1, 1);
      const Value v = sub(args[0]);
      if (v.each.empty() && !std::isfinite(o.call(v.number))) wrong(fmt::format("{}({}) is not a number", w, v.number));
      return mapped(v, o.call);
    }
    if (w == "atan2") {
      wants(2, 2);
      const Value y = sub(args[0]), x = sub(args[1]);
      Value r;
      if (y.each.empty() && x.each.empty()) r.number = std::atan2(y.number, x.number);
      else
        for (std::size_t k = 0; k < world_.atoms.size(); ++k) r.each.push_back(std::atan2(y.at(k), x.at(k)));
      return r;
    }
    if (w == "random" || w == "normal") return drawn(w, args);
    if (w == "ramp" || w == "vdisplace" || w == "swiggle" || w == "cwiggle") return in_time(w, args);
    if (w == "gmask" || w == "rmask" || w == "grmask") return mask(w, args);
    Value v;
    if (group_function(w, args, v.number)) return v;
    if (w == "is_defined") return defined(args);
    if (w == "is_active" || w == "is_available" || w == "is_file") throw Wrong(word_, w + "() is not known here", true);
    wrong(in_quotes(w + "()") + " is no function that is known here");
  }

  Value drawn(const std::string& w, const std::vector<std::string>& args) {
    if (args.size() != 3) wrong(fmt::format("{}() has {} arguments, 3 wanted", w, args.size()));
    if (each_ || on_)
      throw Wrong(word_, w + "() of every atom, or in a run, draws as LAMMPS has sorted its atoms; that is not followed; write the numbers it gave", true);
    const double a = sub_number(args[0]), b = sub_number(args[1]), seed = sub_number(args[2]);
    if (!(seed >= 1 && seed <= 900000000)) wrong(fmt::format("{}() has the seed {}; 1 to 900000000 is allowed", w, seed));
    if (!names_.random) names_.random.emplace(static_cast<int>(seed));
    Value v;
    v.number = w == "random" ? names_.random->next() * (b - a) + a : a + b * names_.random->normal();
    return v;
  }

  Value defined(const std::vector<std::string>& args) const {
    if (args.size() != 2) wrong(fmt::format("is_defined() has {} arguments, 2 wanted", args.size()));
    const std::string &what = args[0], &name = args[1];
    Value v;
    if (what == "compute") v.number = names_.computes.count(name) > 0;
    else if (what == "fix") v.number = std::any_of(world_.fixes.begin(), world_.fixes.end(), [&](const Fix& f) { return f.id == name; });
    else if (what == "group") v.number = world_.find_group(name).has_value();
    else if (what == "region") v.number = world_.regions.count(name) > 0;
    else if (what == "variable") v.number = names_.variables.count(name) > 0;
    else throw Wrong(word_, in_quotes(what) + " is nothing that is_defined() knows of here; compute, fix, group, region and variable are", true);
    return v;
  }

  Value in_time(const std::string& w, const std::vector<std::string>& args) {
    if (on_) on_->time = true;
    Value v;
    const auto argument = [&](std::size_t k) {
      if (k >= args.size()) wrong(w + "() has too few arguments");
      return sub_number(args[k]);
    };
    const World::Moment& m = world_.moment;
    const auto gone = static_cast<double>(m.before + m.steps);
    const double a = argument(0), b = argument(1), elapsed = gone * world_.timestep;
    if (w == "ramp") v.number = m.total > 0 ? a + gone / static_cast<double>(m.total) * (b - a) : a;
    else if (w == "vdisplace") v.number = a + b * elapsed;
    else {
      const double period = argument(2), phase = 2 * pi * elapsed / period;
      if (period == 0) wrong(w + "() has a period of 0");
      v.number = a + b * (w == "swiggle" ? std::sin(phase) : 1 - std::cos(phase));
    }
    return v;
  }

  Value mask(const std::string& w, const std::vector<std::string>& args) {
    if (!each_) wrong(w + "() is of every atom");
    if (args.size() != (w == "grmask" ? 2u : 1u)) wrong(w + "() has not as many arguments as it wants");
    if (w != "gmask") placed();
    Value v;
    for (const Atom& a : world_.atoms) {
      if (!World::there(a)) {
        v.each.push_back(0);
        continue;
      }
      bool on = true;
      if (w != "rmask") on = world_.in(a, world_.group(args[0], word_));
      if (w != "gmask") on = on && world_.matches(args.back(), world_.at(a), word_);
      v.each.push_back(on);
    }
    return v;
  }

  bool group_function(const std::string& w, const std::vector<std::string>& args, double& out) const {
    static constexpr std::pair<const char*, int> known[]{{"count", 1}, {"mass", 1}, {"xcm", 2}, {"bound", 2}};
    static constexpr const char* unknown[]{"charge", "vcm", "fcm", "gyration", "ke", "angmom", "torque", "inertia", "omega"};
    for (const char* u : unknown)
      if (w == u) needs_forces(word_, w + "()");
    const auto* found = std::find_if(std::begin(known), std::end(known), [&](const auto& k) { return w == k.first; });
    if (found == std::end(known)) return false;
    const auto least = static_cast<std::size_t>(found->second);
    if (args.size() < least || args.size() > least + 1) wrong(fmt::format("{}() has {} arguments, {} wanted", w, args.size(), least));
    const int group = world_.group(args[0], word_);
    const std::string region = args.size() > least ? args.back() : "", what = args.size() > 1 ? args[1] : "";
    int axis = -1;
    if (w == "xcm" && (what == "x" || what == "y" || what == "z")) axis = what[0] - 'x';
    if (w == "bound" && what.size() == 4 && what[0] >= 'x' && what[0] <= 'z' && (what.ends_with("min") || what.ends_with("max")))
      axis = what[0] - 'x';
    if (axis < 0 && (w == "xcm" || w == "bound"))
      wrong(fmt::format("{} is no {}", in_quotes(what), w == "xcm" ? "direction; x, y and z are" : "end; xmin, xmax, ymin, … are"));
    if (axis >= 0 || !region.empty()) placed();
    double count = 0, mass = 0, moment = 0, least_x = 1e20, most_x = -1e20;
    for (const Atom& a : world_.atoms) {
      if (!World::there(a) || !world_.in(a, group) || (!region.empty() && !world_.matches(region, world_.at(a), word_))) continue;
      const double m = world_.mass_of(a);
      ++count, mass += m;
      if (axis < 0) continue;
      const double x = world_.at(a)[axis];
      moment += m * x, least_x = std::min(least_x, x), most_x = std::max(most_x, x);
    }
    out = w == "count"            ? count
          : w == "mass"           ? mass
          : w == "xcm"            ? (mass > 0 ? moment / mass : 0)
          : what.ends_with("min") ? least_x
                                  : most_x;
    return true;
  }

  const std::string& text_;
  const World& world_;
  const Names& names_;
  std::size_t word_, i_ = 0;
  bool each_;
  Dependence* on_;
  int& operands_;
  int depth_, nested_ = 0;
};

double finite(double v, const std::string& formula, std::size_t word) {
  if (!std::isfinite(v)) throw Wrong(word, "the formula " + in_quotes(formula) + " is not finite");
  return v;
}

}  // namespace

Value evaluate(const std::string& formula, const World& world, const Names& names, std::size_t word, bool each, Dependence* on) {
  int operands = 0;
  if (formula.starts_with("v_"))
    if (const auto v = names.variables.find(formula.substr(2)); v != names.variables.end() && v->second.style == Variable::Style::equal)
      return Formula(v->second.words.front(), world, names, word, each, on, operands, 1).whole();
  return Formula(formula, world, names, word, each, on, operands).whole();
}

double number_of(const std::string& formula, const World& world, const Names& names, std::size_t word, Dependence* on) {
  return finite(evaluate(formula, world, names, word, false, on).number, formula, word);
}

std::string formatted(const std::string& format, double value, std::size_t word) {
  const auto refuse = [&] { throw Wrong(word, in_quotes(format) + " is no format of one floating-point number, such as %.6f"); };
  const std::size_t percent = format.find('%');
  if (percent == std::string::npos) refuse();
  std::size_t k = percent + 1;
  while (k < format.size() && std::strchr("-+ #0", format[k])) ++k;
  std::size_t digits = 0;
  while (k < format.size() && (std::isdigit(static_cast<unsigned char>(format[k])) || format[k] == '.')) ++k, ++digits;
  if (k >= format.size() || !std::strchr("fFgGeE", format[k]) || digits > 6 || format.find('%', k) != std::string::npos ||
      format.size() > 200)
    refuse();
  char buffer[2000];
  const int n = std::snprintf(buffer, sizeof buffer, format.c_str(), value);
  if (n < 0 || n >= static_cast<int>(sizeof buffer)) refuse();
  return buffer;
}

std::string text_of(const std::string& name, const World& world, const Names& names) {
  const auto found = names.variables.find(name);
  if (found == names.variables.end()) {
    std::vector<std::string> known;
    for (const auto& [n, v] : names.variables) known.push_back(n);
    throw Wrong(0, "there is no variable " + in_quotes(name) + did_you_mean(name, known));
  }
  const Variable& v = found->second;
  switch (v.style) {
    case Variable::Style::index: return v.words[v.which];
    case Variable::Style::string: return v.words.front();
    case Variable::Style::loop: {
      const std::string text = std::to_string(v.first + static_cast<long long>(v.which)), last = std::to_string(v.last);
      return v.pad && text.size() < last.size() ? std::string(last.size() - text.size(), '0') + text : text;
    }
    case Variable::Style::equal: return formatted("%.15g", number_of(v.words.front(), world, names, 0), 0);
    case Variable::Style::format:
      if (const auto of = names.variables.find(v.words.front()); of == names.variables.end() || of->second.style != Variable::Style::equal)
        throw Wrong(0, in_quotes(name) + " is the format of " + in_quotes(v.words.front()) + ", which is no variable of style equal");
      return formatted(v.words[1], number_of("v_" + v.words.front(), world, names, 0), 0);
    case Variable::Style::atom:
    case Variable::Style::atomfile: break;
  }
  throw Wrong(0, in_quotes(name) + " is of style atom: one number for every atom, which cannot be put into a line");
}

std::string immediate(const std::string& formula, const World& world, const Names& names) {
  const std::size_t colon = formula.rfind(":%");
  const std::string format = colon == std::string::npos ? "%.20g" : formula.substr(colon + 1);
  const std::string itself = formula.substr(0, colon);
  int operands = 0;
  return formatted(format, finite(Formula(itself, world, names, 0, false, nullptr, operands).whole().number, itself, 0), 0);
}

}  // namespace elamin::script
