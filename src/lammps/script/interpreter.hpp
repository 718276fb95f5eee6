#pragma once
// Goes through a script command by command, as LAMMPS does, and keeps what it builds.
#include "core/error.hpp"
#include "lammps/script/formula.hpp"

#include <map>
#include <optional>
#include <string>
#include <vector>

namespace elamin::script {

struct ReadingOptions {
  bool skip = false;                            // commands and styles that are not known are left out
  bool include_anywhere = false;                // `include` of files outside of the script's folder, too
  long long most_commands = 5000000;            // executed, so that a loop without an end ends
  std::vector<std::string> after;               // data files: where particles are behind the first run, the second, …
};

/// What has become of the commands of one name.
struct Told {
  enum class Fate { taken, ignored, not_understood } fate;
  std::string command, why;                     // `why` of what was ignored
  int count = 0;
  Where first;
};

struct Note { Where where; std::string text; };

/// One pass of a script: what it builds and runs until it deletes everything, or ends.
struct Pass {
  World world;
  std::map<std::string, std::string> loops;     // the loop variables as the pass ended
  std::optional<Where> stopped;                 // at a command that needs positions behind the last run
};

struct Reading {
  std::vector<std::string> files;               // by Where::file; the script first
  std::vector<std::string> data_files;          // that were read
  std::vector<Pass> passes;                     // those with a run; if there is none, the one that there is
  std::vector<Told> told;
  std::vector<Note> notes;
  long long commands = 0;
  /// As comments of a problem file have it: the file's name without its folder, and the line.
  std::string short_place(const Where& w) const;
  std::string place(const Where& w) const { return files[w.file] + ":" + std::to_string(w.line); }
};

/// Reads a script. Throws InputError with file, line and column of all mistakes (at most 20).
Reading read_script(const std::string& file, const ReadingOptions& options);

/// The state of the interpreter that commands work on.
struct Interpreter {
  World world;
  Names names;
  Reading reading;
  ReadingOptions options;
  std::size_t after = 0;                        // how many files of options.after have been taken
  // Of the command that is executed:
  Where where;
  std::vector<Word> words;
  std::string why_ignored;                      // set by it: it has no effect here
  // Where it goes on:
  std::optional<std::string> label;             // that is looked for
  bool jump_skip = false;                       // the next jump does not
  bool ended = false, failed = false;           // at its end; there was a mistake
  struct Frame { int file; std::size_t next; };
  std::vector<Frame> frames;
  int depth = 0;                                // of `if`

  std::size_t size() const { return words.size(); }
  std::string text() const;                     // the words, with single blanks
  const std::string& word(std::size_t i) const { return words[i].text; }
  /// Throws Wrong unless the command has at least so many words, itself among them, and at most so many.
  void wants(std::size_t least, const std::string& form, std::size_t most = static_cast<std::size_t>(-1)) const;
  double number(std::size_t i) const;
  double positive(std::size_t i) const;
  long long integer(std::size_t i, long long lo, long long hi) const;
  /// A number, or v_name of an equal-style variable.
  double value(std::size_t i, Dependence* on = nullptr) const;
  bool yes(std::size_t i) const;
  int axis(std::size_t i) const;
  /// What a length is in, as `units box` or `units lattice` from word i on say; by default the lattice's.
  double unit_of_length(std::size_t i) const;
  /// `n`, `*`, `n*`, `*n` or `m*n` within 1 … most.
  std::array<int, 2> range(std::size_t i, int most) const;
  void note(const std::string& text);
  void ignore(const std::string& why) { why_ignored = why; }
  /// The command matters in motion, which is refused with it.
  void not_in_motion() { world.not_in_motion.push_back({where, word(0), ""}); }

  Substitution substitution() const;
  void execute(const std::string& line_text, const Where& at);
  void run_command();
  /// The path of a file that the script names; throws Wrong if it lies where nothing may be read.
  std::string path_of(const std::string& name, std::size_t word) const;
  void begin_file(const std::string& name, std::size_t word, bool returns);
  void end_pass();
};

using Handler = void (*)(Interpreter&);
/// The handler of a command, or null.
Handler handler_of(const std::string& command);
/// Why a command is ignored by its name, or "".
std::string ignored_command(const std::string& command);
/// Why a command cannot be taken, with a remedy, or "".
std::string refused_command(const std::string& command);
/// All names that are known.
std::vector<std::string> known_commands();

/// Why something of a script has no effect here.
namespace because {
constexpr const char *output = "output: a run of elamin writes its own", *neighbours = "neighbour lists: elamin finds all pairs that touch",
                     *machine = "how LAMMPS uses the machine", *stepping = "how LAMMPS minimises or steps: [solver] says how elamin does",
                     *cold = "there is no temperature here";
}  // namespace because

// The commands, by what they are about.
namespace command {
// control.cpp
void include(Interpreter&), jump(Interpreter&), label(Interpreter&), next(Interpreter&), condition_of_if(Interpreter&),
    variable(Interpreter&), print(Interpreter&), quit(Interpreter&), clear(Interpreter&);
// settings.cpp
void units(Interpreter&), dimension(Interpreter&), boundary(Interpreter&), atom_style(Interpreter&), lattice(Interpreter&),
    region(Interpreter&), create_box(Interpreter&), change_box(Interpreter&), timestep(Interpreter&), reset_timestep(Interpreter&),
    special_bonds(Interpreter&), bond_style(Interpreter&), bond_coeff(Interpreter&), angle_style(Interpreter&), angle_coeff(Interpreter&),
    mass(Interpreter&), pair_style(Interpreter&), pair_coeff(Interpreter&), pair_modify(Interpreter&),
    neigh_modify(Interpreter&), neighbor(Interpreter&);
// building.cpp
void create_atoms(Interpreter&), create_bonds(Interpreter&), set(Interpreter&), group(Interpreter&), delete_atoms(Interpreter&),
    delete_bonds(Interpreter&), reset_atom_ids(Interpreter&), read_data(Interpreter&), velocity(Interpreter&), displace_atoms(Interpreter&),
    compute(Interpreter&), uncompute(Interpreter&);
// fixes.cpp
void fix(Interpreter&), unfix(Interpreter&);
// runs.cpp
void run(Interpreter&), minimize(Interpreter&);
}  // namespace command

/// A file of positions, as options.after has them, put in place behind a run.
void take_positions(Interpreter& in, const std::string& file);

}  // namespace elamin::script
