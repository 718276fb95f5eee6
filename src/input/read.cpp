#include "input/read.hpp"

#include "dynamics/relax.hpp"
#include "input/build.hpp"
#include "input/check.hpp"
#include "input/lammps.hpp"
#include "input/document.hpp"
#include "input/reader.hpp"
#include "input/state_supplement.hpp"

#include <algorithm>
#include <filesystem>

namespace elamin {
namespace {

/// Defaults that are the values of other keys.
void complete(Problem& p) {
  if (!p.study_place.written("type"))
    p.study = !p.dynamics.place.key.empty()                           ? StudyType::dynamics
              : p.landscape                                            ? StudyType::landscape
              : !p.path.place.key.empty() || !p.stages.empty() ? StudyType::path
              : !p.modes.place.key.empty()                             ? StudyType::modes
                                                                       : StudyType::equilibrium;
  if (!p.solver.max_iterations) p.solver.max_iterations = standard_iterations(p.solver);
  if (p.dynamics.relax && !p.dynamics.place.written("steps")) p.dynamics.steps = static_cast<int>(RelaxOptions{}.max_steps);
  for (ObserveTable& o : p.observe)
    if (!o.place.written("reduce")) o.reduce = default_reduce(o.quantity);
  const bool arc_length = p.path.method == PathMethod::arc_length;
  if (!p.path.when_unstable) p.path.when_unstable = arc_length ? WhenUnstable::follow : WhenUnstable::jump;
  // A stage may have steps of its own, and with them its own default.
  if ((arc_length || p.path.branches > 0) && !p.path.points && p.stages.empty()) p.path.points = 20 * p.path.steps;
  for (BeamTable& b : p.beams) {
    if (!b.thickness) b.thickness = b.diameter;
    if (b.center && !b.spacing) b.spacing = b.diameter;
  }
  for (LoopTable& l : p.loops)
    if (!l.thickness) l.thickness = l.diameter;
  for (SheetTable& s : p.sheets) {
    if (!s.thickness) s.thickness = s.spacing;
    if (!s.diameter) s.diameter = s.spacing;
  }
  for (SupportTable& s : p.supports)
    if (!s.directions && !s.rotations && !s.rotation && p.bodies.empty() && !p.lammps) s.directions = "xyz";
  if (p.study == StudyType::landscape && !p.landscape) p.landscape.emplace();
  for (WallTable& w : p.walls)
    if (w.k_n && !w.c_t) w.c_t = w.c_n / 2;
  if (!p.path.start.empty() && !p.path.start_lambda) {
    p.path.start_lambda = p.follows_path() ? p.path.from : 1.0;
    try {
      if (const auto stored = read_supplement(p.path.start)) p.path.start_lambda = stored->load_factor;
    } catch (const InputError&) {
      // told where the state is read
    }
  }
}

/// Names inside tables that the schema does not know.
std::vector<std::string> names_in_unknown_tables(const Document& document) {
  std::vector<std::string> names;
  for (const Entry& e : document.root) {
    if (!is_tables(e.node) || has_table(e.key)) continue;
    for (const Node& element : std::get<List>(e.node.value))
      if (const Node* name = find(std::get<Entries>(element.value), "name"))
        if (const auto* text = std::get_if<std::string>(&name->value)) names.push_back(*text);
  }
  return names;
}

/// Whether there is a table that is meant to be a structure and was refused.
bool structure_refused(const Document& document) {
  const Problem none;
  return std::any_of(document.root.begin(), document.root.end(), [&](const Entry& e) {
    const bool is_table = std::holds_alternative<Entries>(e.node.value) || is_tables(e.node);
    bool structure = false;
    for_structures(none, [&](std::string_view kind, const auto&) { structure = structure || e.key == kind; });
    return (structure && !is_tables(e.node)) || (is_table && !has_table(e.key));
  });
}

}  // namespace

ProblemFile read_tables(const Document& document, Mistakes& mistakes) {
  ProblemFile file;
  const std::string folder = std::filesystem::path(document.file).parent_path().string();
  Constants constants;
  Reader reader(document.root, {}, "", "", folder, constants, mistakes);
  describe(reader, file);
  reader.finish();
  file.problem.file = document.file;
  file.problem.sha256 = document.sha256;
  if (file.problem.lammps) file.problem.lammps->script = document.script;
  complete(file.problem);
  bool empty = !file.problem.lammps;
  for_structures(file.problem, [&](const char*, const auto& tables) { empty = empty && tables.empty(); });
  if (empty && !structure_refused(document))
    mistakes.add("holds no structure; add a [[beam]], [[loop]], [[sheet]], [[grains]], [[body]] or a [lammps] data file");
  check_problem(file.problem, names_in_unknown_tables(document), mistakes);
  return file;
}

Constants constants_of(const Document& document) {
  Constants constants;
  Mistakes ignored(document.file);
  const Node* node = find(document.root, "constants");
  if (const auto* entries = node ? std::get_if<Entries>(&node->value) : nullptr) {
    NamedNumbers numbers;
    Reader(*entries, node->place, "constants", "constants", "", constants, ignored).numbers(numbers);
  }
  return constants;
}

Problem read_problem(const std::string& file, const std::vector<Setting>& settings) { return read_problem(read_document(file), settings); }

Problem read_problem_text(const std::string& text, const std::string& file, const std::vector<Setting>& settings) {
  return read_problem(parse_document(text, file), settings);
}

Problem read_problem(Document document, const std::vector<Setting>& settings) {
  Mistakes mistakes(document.file);
  take_lammps_input(document);
  for (const Setting& setting : settings) apply(setting, document, mistakes);
  std::vector<std::string> notes = take_old_names(document);
  if (document.script) notes.insert(notes.end(), document.script->notes.begin(), document.script->notes.end());
  Problem problem = read_tables(document, mistakes).problem;
  problem.notes = std::move(notes);
  if (mistakes.any()) {
    // What is whole may hold more mistakes, and all are told at once.
    check_model(problem, !structure_refused(document), mistakes);
    mistakes.raise();
  }
  return problem;
}

}  // namespace elamin
