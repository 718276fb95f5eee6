#include "results/stored_run.hpp"

#include "core/error.hpp"
#include "lammps/data.hpp"
#include "lammps/state.hpp"
#include "input/state_supplement.hpp"
#include "core/text.hpp"
#include "results/json.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <filesystem>
#include <set>

namespace elamin {
namespace {

namespace fs = std::filesystem;

const std::set<std::string> columns_of_words{"label", "parent", "stage", "status", "what", "zero_mode"};

/// The lines of a CSV file (RFC 4180) as fields; the last one only if it ends.
std::vector<std::vector<std::string>> fields(const std::string& text) {
  std::vector<std::vector<std::string>> lines;
  std::vector<std::string> line;
  std::string field;
  bool quoted = false;
  for (std::size_t i = 0; i < text.size(); ++i) {
    const char c = text[i];
    if (quoted) {
      if (c != '"') field += c;
      else if (i + 1 < text.size() && text[i + 1] == '"') field += c, ++i;
      else quoted = false;
    } else if (c == '"') {
      quoted = true;
    } else if (c == ',' || c == '\n') {
      line.push_back(std::move(field));
      field.clear();
      if (c == '\n') lines.push_back(std::move(line)), line.clear();
    } else if (c != '\r') {
      field += c;
    }
  }
  return lines;
}

Cell cell(const std::string& text) {
  int i = 0;
  double d = 0;
  if (text.empty()) return {};
  if (text == "true" || text == "false") return text == "true";
  if (text != "-0" && reads_as(text, i)) return i;
  if (reads_as(text, d)) return d;
  return text;
}

std::string in(const std::string& directory, const std::string& name) { return (fs::path(directory) / name).string(); }

Table table_if_there(const std::string& file) { return fs::exists(file) ? read_table(file) : Table{}; }

std::vector<std::pair<std::string, double>> numbers(const Json& object) {
  std::vector<std::pair<std::string, double>> all;
  for (const auto& [name, value] : object.items())
    if (value.is_number()) all.emplace_back(name, value.get<double>());
  return all;
}

void read_summary(const std::string& file, StoredRun& run) {
  if (!fs::exists(file)) return;
  try {
    const Json all = Json::parse(read_data(file, "summary"));
    Summary& s = run.summary.emplace();
    s.title = all.value("title", ""), s.status = all.value("status", ""), s.message = all.value("message", "");
    s.input = all.value("input", ""), s.input_sha256 = all.value("input_sha256", "");
    s.times = numbers(all.value("times", Json::object())), s.tolerances = numbers(all.value("tolerances", Json::object()));
    s.zero_modes = all.value("zero_modes", std::vector<std::string>{}), s.warnings = all.value("warnings", std::vector<std::string>{});
    run.version = all.value("version", "");
  } catch (const Json::exception& error) {
    throw InputError(fmt::format("{}: is no summary of a run: {}", file, error.what()));
  }
}

struct Columns {
  Table table;
  int at(const std::string& name) const { return table.column(name); }
  double number(std::size_t row, int column) const { return as_number(table.rows[row][column]).value_or(0); }
  Vec3 vector(std::size_t row, int first) const { return {number(row, first), number(row, first + 1), number(row, first + 2)}; }
};

void find_states(StoredRun& run) {
  const int label = run.path.column("label"), step = run.path.column("step");
  const int rows = static_cast<int>(run.path.rows.size());
  for (int k = 0; k < rows; ++k) {
    const Row& row = run.path.rows[k];
    const std::string* name = label >= 0 ? std::get_if<std::string>(&row[label]) : nullptr;
    const bool labelled = name && !name->empty();
    if (!labelled && step < 0) continue;
    const std::string stem = labelled ? "states/" + file_name_of(*name) : "frames/" + csv_text(row[step]);
    for (const char* end : {"-again.data", ".data", ".csv"})
      if (const std::string file = in(run.directory, stem + end); fs::exists(file)) {
        run.states.push_back({labelled ? *name : "", k, file});
        break;
      }
  }
  const Columns nodes{run.landscape};
  for (std::size_t k = 0; k < nodes.table.rows.size(); ++k) {
    const std::string node = csv_text(nodes.table.rows[k][nodes.at("label")]), load = csv_text(nodes.table.rows[k][nodes.at("lambda")]);
    for (int image = 1; image <= nodes.number(k, nodes.at("multiplicity")); ++image)
      for (const std::string& at : {std::string(), "@" + load}) {
        const std::string name = node + (image > 1 ? fmt::format("-image-{}", image) : "") + at;
        if (const std::string file = in(run.directory, "states/" + file_name_of(name) + ".data"); fs::exists(file)) run.states.push_back({name, -1, file});
      }
  }
}

void want(bool same, const std::string& file) {
  if (!same) throw InputError(file + ": does not hold the particles and bodies of the model in resolved.toml");
}

State read_frame(const std::string& file, const Model& model) {
  const Columns rows{read_table(file)};
  want(static_cast<int>(rows.table.rows.size()) == model.particles() && rows.at("z") >= 0, file);
  Field x(3, model.particles());
  for (int i = 0; i < model.particles(); ++i) x.col(i) = rows.vector(i, rows.at("x"));
  State state(x);
  if (model.bodies.empty()) return state;
  const std::string name = fs::path(file).replace_extension(".bodies.csv").string();
  const Columns bodies{read_table(name)};
  want(bodies.table.rows.size() == model.bodies.size() && bodies.at("qz") >= 0, name);
  for (std::size_t b = 0; b < model.bodies.size(); ++b) {
    const int q = bodies.at("qw");
    const Eigen::Quaterniond turn(bodies.number(b, q), bodies.number(b, q + 1), bodies.number(b, q + 2), bodies.number(b, q + 3));
    state.bodies.push_back({{bodies.vector(b, bodies.at("x")), Vec3::Zero()}, turn});
  }
  return state;
}

}  // namespace

Table read_table(const std::string& file) {
  Table table;
  for (std::vector<std::string>& line : fields(read_data(file, "table of results"))) {
    if (table.columns.empty()) {
      table.columns = std::move(line);
      continue;
    }
    if (line.size() != table.columns.size())
      throw InputError(fmt::format("{}:{}: {} entries for {} columns", file, table.rows.size() + 2, line.size(), table.columns.size()));
    Row row;
    for (std::size_t c = 0; c < line.size(); ++c)
      row.push_back(columns_of_words.count(table.columns[c]) ? Cell(std::move(line[c])) : cell(line[c]));
    table.rows.push_back(std::move(row));
  }
  return table;
}

StoredRun read_run(const std::string& directory) {
  if (!fs::exists(in(directory, "resolved.toml"))) throw InputError(directory + ": is not the directory of a run: it holds no resolved.toml");
  StoredRun run;
  run.directory = directory;
  run.in_time = fs::exists(in(directory, "trajectory.csv"));
  run.path = table_if_there(in(directory, run.in_time ? "trajectory.csv" : "path.csv"));
  run.events = table_if_there(in(directory, "events.csv"));
  run.curve = table_if_there(in(directory, "curve.csv"));
  run.landscape = table_if_there(in(directory, "landscape.csv"));
  run.contacts = table_if_there(in(directory, "contacts.csv"));
  run.modes = table_if_there(in(directory, "modes.csv"));
  read_summary(in(directory, "summary.json"), run);
  find_states(run);
  return run;
}

bool has_ended(const std::string& directory) {
  StoredRun run;
  read_summary(in(directory, "summary.json"), run);
  return run.summary && run.summary->status != "running" && run.summary->status != status_name(Status::interrupted);
}

std::vector<std::string> runs_in(const std::string& directory) {
  if (fs::exists(in(directory, "resolved.toml"))) return {directory};
  std::vector<std::string> runs;
  if (fs::exists(in(directory, "sweep.csv")))
    for (const auto& entry : fs::directory_iterator(directory))
      if (fs::exists(entry.path() / "resolved.toml")) runs.push_back(entry.path().string());
  if (runs.empty())
    throw InputError(directory + (fs::exists(directory) ? ": holds neither a run (resolved.toml) nor a sweep (sweep.csv)" : ": there is no such directory"));
  std::sort(runs.begin(), runs.end());
  return runs;
}

State read_state(const StoredState& stored, const Model& model) {
  if (stored.file.ends_with(".csv")) return read_frame(stored.file, model);
  LammpsData data = read_lammps_data(stored.file);
  if (!model.bodies.empty() && model.particles() > 0) {
    LammpsData bodies = read_lammps_data(bodies_file(stored.file));
    data.bodies = std::move(bodies.bodies), data.body_position = std::move(bodies.body_position);
  }
  const auto supplement = read_supplement(stored.file);
  want(data.id == model.id && data.bodies.size() == model.bodies.size() && (model.bodies.empty() || supplement), stored.file);
  State state(std::move(data.position));
  if (supplement) state.load_factor = supplement->load_factor;
  for (std::size_t b = 0; b < model.bodies.size(); ++b)
    state.bodies.push_back({{data.body_position.col(static_cast<Eigen::Index>(b)), Vec3::Zero()}, supplement->bodies[b].rotation});
  return state;
}

std::vector<Field> read_displacements(const std::string& file, const Model& model) {
  if (!fs::exists(file)) return {};
  const Columns rows{read_table(file)};
  const int n = model.particles(), m = static_cast<int>(model.bodies.size());
  const bool one = rows.at("ux") >= 0;                                     // of a mode; else ux1, uy1, uz1, ux2, …
  int count = one ? 1 : 0;
  while (!one && rows.at(fmt::format("ux{}", count + 1)) >= 0) ++count;
  const auto name = [&](const char* of, int k) { return one ? std::string(of) : fmt::format("{}{}", of, k + 1); };
  want(static_cast<int>(rows.table.rows.size()) == n, file);
  std::vector<Field> all(count, Field::Zero(3, n + 2 * m));
  for (int k = 0; k < count; ++k)
    for (int i = 0; i < n; ++i) all[k].col(i) = rows.vector(i, rows.at(name("ux", k)));
  if (m == 0) return all;
  std::string turns = file;
  turns.insert(turns.rfind(turns.ends_with(".modes.csv") ? ".modes.csv" : ".csv"), ".bodies");
  if (!fs::exists(turns)) return all;
  const Columns bodies{read_table(turns)};
  want(static_cast<int>(bodies.table.rows.size()) == m, turns);
  for (int k = 0; k < count; ++k)
    for (int b = 0; b < m; ++b) {
      all[k].col(n + 2 * b) = bodies.vector(b, bodies.at(name("ux", k)));
      all[k].col(n + 2 * b + 1) = bodies.vector(b, bodies.at(name("tx", k)));
    }
  return all;
}

std::string file_name_of(std::string label) {
  for (char& c : label)
    if (!std::isalnum(static_cast<unsigned char>(c)) && c != '-' && c != '_') c = '-';
  return label;
}

std::string null_vectors_file(const std::string& data_file) {
  return data_file.substr(0, data_file.rfind(".data")) + ".modes.csv";
}

}  // namespace elamin
