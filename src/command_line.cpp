#include "command_line.hpp"

#include "core/error.hpp"
#include "core/memory.hpp"
#include "core/say.hpp"
#include "core/suggest.hpp"
#include "figures/figure.hpp"
#include "input/key_tree.hpp"
#include "report/report.hpp"
#include "results/terminal.hpp"
#include "results/summary.hpp"
#include "solve/ranks.hpp"
#include "study/commands.hpp"
#include "study/compare.hpp"
#include "study/resume.hpp"
#include "study/run.hpp"
#include "study/sweep.hpp"

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <cstring>
#include <exception>
#include <filesystem>

namespace elamin {

namespace {

const char* const description =
    "elamin: static equilibria of elastic structures made of glued particles.\n"
    "\n"
    "  elamin problem.toml        runs the study; results go to a directory named like the file\n"
    "  elamin SUBCOMMAND …        does one of what stands below; elamin SUBCOMMAND --help tells what it takes\n";
const char* const footer =
    "\nExit status: 0 done; 1 wrong input; 2 not converged, or no room for the results (what was\n"
    "reached is written); 3 an expectation is not met;\n"
    "130 interrupted (Ctrl-C; a second one ends at once; elamin resume DIR goes on).\n"
    "A first study to read: problems/column_cylindrical.toml. Keys of a problem file: docs/keys.md, and problems/.\n";

// What is wrong with words that no option, command or file has taken, of which the problem file may have become the first; "": nothing.
std::string not_understood(const CLI::App& app, const std::string& file) {
  std::vector<std::string> words = app.remaining(true), commands, options;
  const bool runs = app.get_subcommands().empty();
  const CLI::App* active = runs ? &app : app.get_subcommands().front();
  for (const CLI::App* command : app.get_subcommands([](const CLI::App*) { return true; })) commands.push_back(command->get_name());
  for (const CLI::Option* option : active->get_options())
    for (const std::string& name : option->get_lnames()) options.push_back("--" + name);
  for (const std::string& word : words)
    if (word.starts_with('-')) return word + ": is no option; there are: " + listed(options) + did_you_mean(word, options);
  const bool too_many = !words.empty();
  if (runs && !too_many && !std::filesystem::is_regular_file(file) && std::filesystem::is_regular_file(file + ".toml"))
    return file + ": is no problem file; did you mean \"" + file + ".toml\"?";
  if (runs && !file.empty() && !std::filesystem::exists(file)) words.insert(words.begin(), file);
  for (const std::string& word : words) {
    if (std::filesystem::exists(word)) continue;
    if (word.find('=') != std::string::npos) return word + ": every KEY=VALUE needs a --set of its own: --set " + word;
    if (const std::string meant = did_you_mean(word, commands); runs && &word == &words.front() && !meant.empty())
      return word + ": is no command and no file" + meant;
  }
  if (!too_many) return "";
  return words.back() + ": is one word too many; " + (runs ? "a run has one problem file" : "--help tells what the command takes");
}

// What to do with results, in words that a shell understands.
std::string next_steps(const std::string& directory, bool has_report, bool stopped) {
  const auto plain = [](unsigned char c) { return std::isalnum(c) || std::strchr("_-./,+=", c); };
  const std::string name = std::all_of(directory.begin(), directory.end(), plain) ? directory : "'" + directory + "'";
  const std::string report = has_report ? "" : "elamin report " + name + " (a page to look at), ";
  if (stopped) return "elamin resume " + name + " goes on\n";
  return "next: " + report + "elamin plot " + name + " (a figure)\n";
}

// Of an option that needs a number that is allowed; `what`: of which kind.
CLI::Validator number_of(const std::string& what, bool (*allowed)(double)) {
  return {[=](std::string& text) {
            double value = 0;
            return CLI::detail::lexical_cast(text, value) && allowed(value) ? "" : "must be a " + what + ", is " + text;
          }, ""};
}
CLI::Validator positive(const std::string& what) {
  return number_of("positive " + what, [](double value) { return value > 0; });
}

}  // namespace

int command_line(int argc, char** argv) {
  CLI::App app{description};
  app.allow_extras();                            // they are told in sentences of our own
  app.footer(footer);
  app.set_version_flag("--version", "elamin " + version());
  std::string file;
  std::vector<std::string> set, files;
  RunOptions options;
  EnergyOptions energy;
  const auto common = [&](CLI::App* command) {
    command->add_option("--set", set, "KEY=VALUE: change a key of the file, as beam.column.particles=40; may be repeated")->allow_extra_args(false);
  };
  const auto checkpointed = [&](CLI::App* command) {
    command->add_option("--checkpoint", options.checkpoint, "seconds between two checkpoints, from which elamin resume goes on (default: 1; 0: one at every row)")
        ->check(number_of("number of seconds from 0 to 1e9", [](double value) { return value >= 0 && value <= 1e9; }));
  };
  const auto running = [&](CLI::App* command) {
    common(command);
    command->add_option("-o,--output", options.directory, "directory of the results (default: the file's name without .toml)");
    command->add_option("--threads", options.threads, "threads to use (default: OMP_NUM_THREADS, or all cores)")->check(positive("integer"));
    command->add_flag("--force", options.force, "write to a directory that holds something else than results, too");
    command->add_flag("--quiet", options.quiet, "print nothing but errors");
    checkpointed(command);
  };
  app.add_option("problem", file, "the problem file")->type_name("FILE");
  running(&app);
  std::string part;
  app.add_option("--part", part, "K/N: of a sweep the runs K, K + N, K + 2N, …, on a machine of its own; elamin collect DIR puts all parts together")->type_name("K/N");
  bool and_report = false, and_plot = false;
  app.add_flag("--report", and_report, "then write report.html, a page to look at in a browser, into the directory of the results");
  app.add_flag("--plot", and_plot, "then draw a small diagram in the terminal");
  CLI::App* energy_app = app.add_subcommand("energy", "energies and forces of the file's starting state, nothing solved");
  energy_app->add_option("problem", file, "the problem file")->type_name("FILE")->required();
  energy_app->add_flag("--json", energy.json, "print JSON");
  energy_app->add_option("--forces", energy.forces_file, "write id,fx,fy,fz of all particles to this CSV file");
  energy_app->add_option("--lambda", energy.load_factor, "load factor (default: where the study starts; 1 without a path)")
      ->check(number_of("finite number", [](double value) { return std::isfinite(value); }));
  common(energy_app);
  CLI::App* check_app = app.add_subcommand("check", "every mistake in a problem file, or what was understood of it");
  check_app->add_option("problem", file, "the problem file")->type_name("FILE")->required();
  common(check_app);
  CLI::App* verify_app = app.add_subcommand("verify", "run, and hold the results against [[expect]]");
  verify_app->add_option("problems", files, "problem files")->type_name("FILE")->required();
  running(verify_app);
  CompareOptions comparison;
  CLI::App* compare_app = app.add_subcommand("compare", "run the problem by every method that can, side by side; nothing is written");
  compare_app->add_option("problem", file, "the problem file")->type_name("FILE")->required();
  compare_app->add_option("--methods", comparison.methods, "methods as solver.method has them, with commas between (default: those that fit)")->delimiter(',');
  compare_app->add_option("--limit", comparison.limit, "seconds that a method may take (default: 60)")->check(positive("number"));
  compare_app->add_option("--threads", comparison.threads, "threads to use (default: OMP_NUM_THREADS, or all cores)")->check(positive("integer"));
  compare_app->add_flag("--json", comparison.json, "print JSON");
  common(compare_app);
  ExportOptions exported;
  CLI::App* export_app = app.add_subcommand("export", "the model and its stages as a LAMMPS script and data file");
  export_app->add_option("problem", file, "the problem file")->type_name("FILE")->required();
  export_app->add_option("-o,--output", exported.script, "the script, with its data file beside it (default: the file's name with .lmp)")->type_name("FILE");
  export_app->add_flag("--skip", exported.skip, "leave out what LAMMPS cannot have, instead of refusing");
  export_app->add_flag("--force", exported.force, "write over files that elamin export has not written, too");
  export_app->add_option("--steps", exported.steps, "steps of each stage's run towards equilibrium (default: about 20 periods of the slowest bending)")->check(positive("integer"));
  common(export_app);
  ReportOptions report;
  CLI::App* report_app = app.add_subcommand("report", "one self-contained HTML page of the results of runs and sweeps, to look at in a browser; also --report after a run");
  report_app->add_option("directories", report.directories, "directories of results")->type_name("DIR")->required();
  report_app->add_option("-o,--output", report.file, "the page (default: report.html in the directory; of several directories, here)")->type_name("FILE");
  report_app->add_flag("--quiet", report.quiet, "print nothing but errors");
  ResumeOptions stopped;
  CLI::App* resume_app = app.add_subcommand("resume", "a run or sweep that was stopped goes on where it was, with the same bits");
  resume_app->add_option("directory", stopped.directory, "the directory of its results")->type_name("DIR")->required();
  resume_app->add_option("--threads", stopped.threads, "threads to use (default: OMP_NUM_THREADS, or all cores)")->check(positive("integer"));
  resume_app->add_flag("--quiet", stopped.quiet, "print nothing but errors");
  resume_app->add_flag("--report", and_report, "then write report.html into the directory");
  checkpointed(resume_app);
  CollectOptions parts;
  CLI::App* collect_app = app.add_subcommand("collect", "sweep.csv of a sweep that was run in parts (--part K/N), each on a machine of its own");
  collect_app->add_option("directory", parts.directory, "the directory of its results")->type_name("DIR")->required();
  collect_app->add_flag("--quiet", parts.quiet, "print nothing but errors");
  FigureOptions figure;
  CLI::App* plot_app = app.add_subcommand("plot", "a figure of a run's results: the diagram, and states below it");
  plot_app->add_option("directory", figure.directory, "the directory of the results")->type_name("DIR")->required();
  plot_app->add_option("--x", figure.x, "column for the horizontal axis (default: the load factor, what is swept, or time)");
  plot_app->add_option("--y", figure.y, "column for the vertical axis (default: the first one observed that changes)");
  plot_app->add_option("--shapes", figure.shapes, "labels of states to draw below, with commas between: initial, final, branch:1, branch:1+mode, mode:2, step=40")->delimiter(',');
  plot_app->add_flag("!--no-diagram", figure.diagram, "the states alone");
  plot_app->add_option("--out", figure.file, "file of the figure, FIG.svg or FIG.pdf (default: DIR/figure.svg)");
  ImportOptions import;
  CLI::App* import_app = app.add_subcommand("import", "a LAMMPS input script as a problem file, with a data file beside it; what was taken, ignored, not understood");
  import_app->add_option("script", import.script, "the script")->type_name("FILE")->required();
  import_app->add_option("-o,--output", import.output, "the problem file (default: the script's name with .toml)")->type_name("FILE.toml");
  import_app->add_flag("--dynamics", import.dynamics, "motion in time, step for step as LAMMPS makes it, instead of equilibria");
  import_app->add_option("--compat", import.compat, "lwp: keep the bending stiffness of LAMMPSStructures's sheets as it is")->type_name("lwp");
  import_app->add_flag("--correct", import.correct, "give these sheets the bending stiffness of their derivation, 3 sqrt(3) times as much");
  import_app->add_flag("--skip", import.skip, "leave out commands and styles that are not known");
  import_app->add_option("--after", import.after, "a state that the script's first run has ended in (DIR/states/final.data), the second …, for what follows them")->type_name("FILE");
  import_app->add_flag("--include-anywhere", import.include_anywhere, "include files that lie outside of the script's folder, too");
  import_app->add_flag("--force", import.force, "write over files that elamin import has not written, too");
  import_app->add_flag("--quiet", import.quiet, "print nothing but errors");
  ProveOptions proof;
  CLI::App* prove_app = app.add_subcommand("prove", "that near a state there is exactly one equilibrium, and whether it is a minimum, as a theorem");
  prove_app->add_option("directory", proof.directory, "the directory of the results")->type_name("DIR")->required();
  prove_app->add_option("--at", proof.at, "label of the state: initial, final (default), jump:1, step=40")->type_name("LABEL");
  prove_app->add_option("--out", proof.file, "file of what proves it (default: DIR/proof.json)")->type_name("FILE");
  CLI::App* schema_app = app.add_subcommand("schema", "print the JSON schema of problem files, for editors");
  bool markdown = false;
  schema_app->add_flag("--markdown", markdown, "print the key reference instead, docs/keys.md");
  app.require_subcommand(0, 1);

  try {
    app.parse(argc, argv);
    if (const std::string wrong = not_understood(app, file); !wrong.empty()) throw InputError(wrong);
    const bool serves = ranks() && ranks()->rank() > 0;
    if (serves) options.quiet = true;
    std::vector<Setting> settings;
    for (const std::string& s : set) settings.push_back(parse_setting(s));
    options.settings = energy.settings = comparison.settings = exported.settings = settings;
    options.file = energy.file = comparison.file = exported.file = file;
    if (*energy_app) return energy_command(energy);
    if (*schema_app) return say("{}", markdown ? key_reference() : json_schema()), exit_done;
    if (*check_app) return check_command(file, settings), exit_done;
    if (*export_app) return export_command(exported), exit_done;
    if (*compare_app) return compare_command(comparison);
    if (*verify_app) return verify_command(files, options);
    if (*import_app) return import_command(import), exit_done;
    if (*report_app) return report_command(report), exit_done;
    if (*plot_app) return say("written: {}\n", write_figure(figure)), exit_done;
    if (*prove_app) return prove_command(proof);
    if (*collect_app) return collect(parts).exit_status;
    if (*resume_app) {
      stopped.checkpoint = options.checkpoint;
      const RunResult result = resume(stopped);
      if (and_report) report_command({{result.directory}, "", stopped.quiet});
      if (!stopped.quiet && result.exit_status == exit_interrupted) say("{}", next_steps(result.directory, true, true));
      return result.exit_status;
    }
    if (file.empty()) return say("{}", app.help()), exit_wrong_input;
    options.report = and_report, options.by_ranks = true;
    if (!part.empty()) options.part = parse_part(part);
    const RunResult result = run(options);
    if (serves) return result.exit_status;
    figure.directory = result.directory;
    if (options.part) {
      if (!options.quiet) say("next: elamin collect {}, when all parts have ended\n", result.directory);
      return result.exit_status;
    }
    if (and_plot) say("{}", terminal_figure(figure, terminal_width(stdout)));
    if (and_report) report_command({{result.directory}, "", options.quiet});
    if (!options.quiet) say("{}", next_steps(result.directory, and_report, result.exit_status == exit_interrupted));
    return result.exit_status;
  } catch (const CLI::ParseError& error) {
    return app.exit(error) == 0 ? exit_done : exit_wrong_input;
  } catch (const InputError& error) {
    complain("{}\n", told(error));
    return memory_was_short() ? exit_not_converged : exit_wrong_input;
  } catch (const OutputError& error) {
    complain("{}\n", told(error));
    return exit_not_converged;
  } catch (const std::exception& error) {
    complain("elamin: {}\n", told(error));
    return exit_not_converged;
  }
}

}  // namespace elamin
