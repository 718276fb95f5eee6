#include "input/lammps_input.hpp"

#include "core/error.hpp"
#include "core/suggest.hpp"
#include "core/text.hpp"
#include "core/text_file.hpp"
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

/// Written anew where something differs, and only over a file of this kind.
void keep_data(const std::string& file, const std::string& data) {
  if (fs::exists(file)) {
    const std::string old = read_data(file, "LAMMPS data file");
    if (old == data) return;
    if (old.substr(0, old.find('\n')).find("by elamin import") == std::string::npos)
      throw InputError(file + ": is in the way: the particles of the script beside it go there; give that file another name");
  }
  write_text(file, data);
}

}  // namespace

void take_lammps_input(Document& document) {
  Node* const table = find(document.root, "lammps");
  if (!table || !std::holds_alternative<Entries>(table->value)) return;
  Entries& lammps = std::get<Entries>(table->value);
  const auto input = std::find_if(lammps.begin(), lammps.end(), [](const Entry& e) { return e.key == "input"; });
  if (input == lammps.end() || !std::holds_alternative<std::string>(input->node.value)) return;
  const Place place = input->node.place;
  const std::string name = std::get<std::string>(input->node.value);
  const auto wrong = [&](const std::string& what) { throw InputError({Mistake{document.file, place.line, place.column, "lammps.input", what}}); };
  if (name.empty()) wrong("is empty; the name of a LAMMPS input script is wanted");
  for (const char* key : {"data", "bodies"})
    if (find(lammps, key)) wrong(fmt::format("and {} are both given; the script says where its particles are from", in_quotes(key)));
  const std::string script = fs::path(name).is_absolute() ? name : (fs::path(document.file).parent_path() / name).string();
  const script::Reading reading = script::read_script(script, {});
  if (reading.passes.size() != 1)
    wrong(reading.passes.empty() ? "makes no particle that is there at its end" : fmt::format("begins anew and gives {} problems; `elamin import` writes them all", reading.passes.size()));
  if (reading.passes[0].stopped)
    wrong(fmt::format("needs positions behind a run at {}; `elamin import` writes what comes before, and with --after what follows", reading.place(*reading.passes[0].stopped)));
  const script::Translated made = script::translated(reading, reading.passes[0], {}, name + ".data");
  if (!made.data.empty()) keep_data(script + ".data", made.data);
  Entries entries = parse_entries(made.toml, script);
  for (Entry& e : entries) e.place = place, put_at(e.node, place);
  lammps.erase(input);
  merge(document.root, std::move(entries));
}

}  // namespace elamin
