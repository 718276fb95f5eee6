#include "study/commands.hpp"

#include "core/error.hpp"
#include "core/say.hpp"
#include "core/suggest.hpp"
#include "core/text.hpp"
#include "core/text_file.hpp"
#include "lammps/script/report.hpp"
#include "lammps/script/translation.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>

namespace elamin {
namespace {

namespace fs = std::filesystem;

std::string output_of(const ImportOptions& o) {
  if (!o.output.empty()) return o.output;
  const fs::path name = fs::path(o.script).filename();
  const std::string end = name.extension().string();
  const bool replaced = end == ".lmp" || end == ".lammps" || end == ".in" || end == ".txt";
  return (replaced ? name.stem().string() : name.string()) + ".toml";
}

/// What the script is made of is not written over, whatever was asked.
void must_not_be_read(const std::string& file, const std::vector<std::string>& read) {
  const bool there = fs::exists(file) && std::any_of(read.begin(), read.end(), [&](const std::string& r) { return fs::exists(r) && fs::equivalent(file, r); });
  if (there) throw InputError(file + ": is read by the script, and would be written over; choose another name with -o");
}

}  // namespace

void import_command(const ImportOptions& o) {
  if (!o.compat.empty() && o.compat != "lwp") throw InputError("--compat: " + in_quotes(o.compat) + " is not known; lwp is");
  if (!o.compat.empty() && o.correct) throw InputError("--compat and --correct say different things of the same sheets; give one of them");
  const std::string output = output_of(o);
  if (!output.ends_with(".toml")) throw InputError("-o: " + in_quotes(output) + " must end with .toml");
  const script::Reading reading = script::read_script(o.script, {.skip = o.skip, .include_anywhere = o.include_anywhere, .after = o.after});
  if (reading.passes.empty())
    throw InputError(o.script + ": makes no particle that is there at its end, and runs nothing; there is no problem in it");
  const fs::path base = fs::path(output).replace_extension();
  struct File { std::string name, text; };
  std::vector<File> files;
  std::vector<script::Note> notes;
  const auto keep = [&](const script::Translated& t, const fs::path& stem) {
    files.push_back({stem.string() + ".toml", t.toml});
    if (!t.data.empty()) files.push_back({stem.string() + ".data", t.data});
    notes.insert(notes.end(), t.notes.begin(), t.notes.end());
  };
  const script::TranslationOptions how{o.dynamics, o.correct, o.compat == "lwp"};
  for (std::size_t p = 0; p < reading.passes.size(); ++p) {
    const script::Pass& pass = reading.passes[p];
    const fs::path stem = reading.passes.size() == 1 ? base : fs::path(fmt::format("{}-{}", base.string(), p + 1));
    const std::size_t runs = o.dynamics ? std::max<std::size_t>(1, pass.world.runs.size()) : 1;
    std::vector<fs::path> stems(runs, stem);
    std::vector<std::string> data, folders;
    for (std::size_t k = 0; k < runs; ++k) {
      if (runs > 1) stems[k] = fmt::format("{}-run{}", stem.string(), k + 1);
      data.push_back(stems[k].filename().string() + ".data"), folders.push_back(stems[k].filename().string());
    }
    if (o.dynamics) {
      const auto all = script::in_time(reading, pass, how, data, folders);
      for (std::size_t k = 0; k < all.size(); ++k) keep(all[k], stems[k]);
    } else keep(script::translated(reading, pass, how, data.front()), stem);
  }
  for (const auto* read : {&reading.files, &reading.data_files, &o.after})
    for (const File& f : files) must_not_be_read(f.name, *read);
  for (const File& f : files) must_be_own(f.name, "import", o.force);
  for (const File& f : files) write_text(f.name, f.text);
  if (o.quiet) return;
  say("{}", script::report(reading, notes));
  std::string names;
  for (std::size_t k = 0; k < files.size(); ++k)
    if (files.size() <= 8 || k < 4 || k + 2 >= files.size()) names += (names.empty() ? "" : ", ") + files[k].name;
    else if (k == 4) names += ", ...";
  say("written: {}\nnext: elamin check {}\n", names, files.front().name);
}

}  // namespace elamin
