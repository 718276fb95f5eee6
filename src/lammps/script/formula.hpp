#pragma once
// LAMMPS's formulas: variables of style equal and atom, $(…), and the conditions of `if`.
#include "lammps/script/random.hpp"
#include "lammps/script/world.hpp"

#include <map>
#include <optional>
#include <string>
#include <vector>

namespace elamin::script {

/// A variable as the script has defined it.
struct Variable {
  enum class Style { index, loop, string, equal, atom, atomfile, format } style = Style::equal;
  std::vector<std::string> words;               // values of index, the string, the formula, variable and format
  long long first = 1, last = 1;                // of a loop
  bool pad = false;
  std::size_t which = 0;                        // of index and loop: the current one, from 0
  std::map<long long, double> of_id = {};       // of atomfile: a number by atom
  bool of_atoms() const { return style == Style::atom || style == Style::atomfile; }
};

/// compute reduce, or another one whose value is not known here.
struct Compute {
  std::string style, group, mode;               // of reduce: "min", "max", "sum", "ave", "sumsq", "avesq"
  std::vector<std::string> inputs;
};

struct Names {
  std::map<std::string, Variable> variables;
  std::map<std::string, Compute> computes;
  mutable std::optional<Marsaglia> random;      // one for all formulas, with the seed of that which draws first
  /// Whether v_NAME is of style atom or atomfile.
  bool of_atoms(const std::string& formula) const {
    const auto found = variables.find(formula.substr(2));
    return found != variables.end() && found->second.of_atoms();
  }
};

/// A number, or one for every particle of World::atoms.
struct Value {
  double number = 0;
  std::vector<double> each;                     // empty: the number
  double at(std::size_t i) const { return each.empty() ? number : each[i]; }
};

/// What the value of a formula depends on, besides numbers.
struct Dependence { bool time = false, places = false; };

constexpr int most_nested = 60;                 // formulas, brackets or signs in each other

/// What a formula says now. With LAMMPS's operators by rising precedence || |^, &&, == !=, < <= > >=, + −, * / %, ^ (from the left), and
/// before all of these − and ! of one operand. `each`: an atom-style formula, with x, y, z, id, type, … of every particle. `on`, if
/// given, tells what it depends on. In a formula v_NAME of style equal has 15 digits; v_NAME alone has all. Throws Wrong at `word`, or
/// NeedsPositions.
Value evaluate(const std::string& formula, const World& world, const Names& names, std::size_t word, bool each = false,
               Dependence* on = nullptr);

/// The same of a formula that is one number.
double number_of(const std::string& formula, const World& world, const Names& names, std::size_t word, Dependence* on = nullptr);

/// What ${name} stands for: numbers with 15 digits. Throws Wrong at word 0.
std::string text_of(const std::string& name, const World& world, const Names& names);

/// What $(formula) or $(formula:%g) stands for: numbers with 20 digits or in that format.
std::string immediate(const std::string& formula, const World& world, const Names& names);

/// The condition of `if`: numbers or words with == != < <= > >= && || |^ ! and brackets.
bool condition(const std::string& text, std::size_t word);

/// A number in a format of printf for one floating-point number; throws Wrong if it is none.
std::string formatted(const std::string& format, double value, std::size_t word);

}  // namespace elamin::script
