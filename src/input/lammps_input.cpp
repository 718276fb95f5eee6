#include "input/lammps_input.hpp"

#include "core/error.hpp"
#include "core/suggest.hpp"
#include "lammps/script/report.hpp"
#include "lammps/script/translation.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <iterator>

namespace elamin {
namespace {

namespace fs = std::filesystem;

/// Everything of the script stands where the file names it.
void put_at(Node& node, Place place) {
  node.place = place;
  if (auto* list = std::get_if<List>(&node.value))
    for (Node& n : *list) put_at(n, place);
  if (auto* entries = std::get_if<Entries>(&node.value))
    for (Entry& e : *entries) e.place = place, put_at(e.node, place);
}

void merge(Entries& own, Entries&& script) {
  for (Entry& e : script) {
    Node* const there = find(own, e.key);
    if (!there) {
      own.push_back(std::move(e));
    } else if (is_tables(*there) && is_tables(e.node)) {
      List& mine = std::get<List>(there->value);
      List& first = std::get<List>(e.node.value);
      mine.insert(mine.begin(), std::make_move_iterator(first.begin()), std::make_move_iterator(first.end()));
    } else if (std::holds_alternative<Entries>(there->value) && std::holds_alternative<Entries>(e.node.value)) {
      merge(std::get<Entries>(there->value), std::move(std::get<Entries>(e.node.value)));
    }
  }
}

}  // namespace

void take_lammps_input(Document& document) {
  Node* const table = find(document.root, "lammps");
  if (document.script || !table || !std::holds_alternative<Entries>(table->value)) return;
  Entries& lammps = std::get<Entries>(table->value);
  const Node* const input = find(lammps, "input");
  if (!input || !std::holds_alternative<std::string>(input->value)) return;
  const Place place = input->place;
  const std::string name = std::get<std::string>(input->value);
  const auto wrong = [&](const std::string& what) { throw InputError({Mistake{document.file, place.line, place.column, "lammps.input", what}}); };
  if (name.empty()) wrong("is empty; the name of a LAMMPS input script is wanted");
  Node* const only = find(lammps, "particles_only");
  const bool tables = !only || !std::holds_alternative<bool>(only->value) || !std::get<bool>(only->value);
  for (const char* key : {"data", "bodies"})
    if (find(lammps, key) && (tables || key[0] == 'd'))
      wrong(fmt::format("and {} are both given; the script says where its particles are from", in_quotes(key)));
  const script::Reading reading = script::read_script((fs::path(document.file).parent_path() / name).string(), {});
  if (reading.passes.size() != 1)
    wrong(reading.passes.empty() ? "makes no particle that is there at its end"
                                 : fmt::format("begins anew and gives {} problems; `elamin import` writes them all", reading.passes.size()));
  if (reading.passes[0].stopped)
    wrong(fmt::format("needs positions behind a run at {}; `elamin import` writes what comes before, and with --after what follows",
                      reading.place(*reading.passes[0].stopped)));
  script::Translated made = script::translated(reading, reading.passes[0], {}, "");
  document.script = {std::move(made.data), {}, script::notes_of(reading, made.notes)};
  for (const auto& files : {reading.files, reading.data_files})
    for (const std::string& f : files) document.script->files.push_back(fs::absolute(f).lexically_normal().string());
  Entries entries = parse_entries(made.toml, reading.files.front());
  for (Entry& e : entries) e.place = place, put_at(e.node, place);
  std::erase_if(std::get<Entries>(find(entries, "lammps")->value), [](const Entry& e) { return e.key == "data"; });
  if (!tables) std::erase_if(entries, [](const Entry& e) { return e.key != "lammps"; });
  else if (only) only->value = true;
  else lammps.push_back({"particles_only", place, {place, true}});
  merge(document.root, std::move(entries));
}

}  // namespace elamin
