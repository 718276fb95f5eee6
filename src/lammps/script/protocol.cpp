#include "lammps/script/protocol.hpp"

#include "lammps/script/table_text.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace elamin::script {

namespace {

std::string observations(const Protocol& of) {
  std::string t;
  for (const auto& [group, axis] : of.observed)
    t += fmt::format("\n[[observe]]\nname = \"force_{}_{}\"\ngroup = \"{}\"\nquantity = \"reaction.{}\"\n", group, axis, group, axis);
  return t;
}

}  // namespace

std::string stage(int k) { return "run" + std::to_string(k + 1); }

std::string protocol_text(const Protocol& of, const Reading& reading, const World& world, const TranslationOptions& options) {
  const std::string jumping = std::string("when_unstable = \"jump\"\n") +
                              (of.touches ? "locate = []                      # snaps alone are reported; \"limit\", \"branch\", \"contact\" locate these events, too, which takes several times as long\n"
                                          : "locate = [\"limit\", \"branch\"]\n");
  std::string t;
  if (world.runs.empty()) return "\n[study]                          # the script runs nothing\ntype = \"energy\"\n";
  if (world.runs.front().still())
    return fmt::format("\n# {} {}\n[study]\ntype = \"energy\"\n", reading.short_place(world.runs.front().where), world.runs.front().text);
  if (options.dynamics) {
    const Run& run = world.runs.front();
    if (!of.start_from.empty()) t += fmt::format("\n[path]\nstart = \"{}\"\n", escaped(of.start_from));
    t += fmt::format("\n# {} {}\n[study]\ntype = \"dynamics\"\n\n[dynamics]\n", reading.short_place(run.where), run.text);
    if (run.minimize) return t + "relax = true\nsteps = 1000000\n" + observations(of);
    return t +
           fmt::format("timestep = {}\nsteps = {}\nevery = {}\nallow_unstable = true           # the script's timestep, whatever it is\n",
                       run.timestep, std::min(run.steps, 2000000000LL), std::max(1LL, run.steps / 100)) +
           observations(of);
  }
  if (world.run_number() <= 1) {
    const Run& run = world.runs.front();
    t += fmt::format("\n# {} {}\n", reading.short_place(run.where), run.text);
    if (of.driven.front())
      t += fmt::format("[path]                           # load factor 1: after {} of LAMMPS's time\nsteps = 100\n{}", run.time(), jumping);
    else t += "[study]\ntype = \"equilibrium\"\n";
    return t + observations(of);
  }
  t += fmt::format("\n[path]\nsteps = 100\n{}", jumping);
  for (int k = 0; k < world.run_number(); ++k) {
    const Run& run = world.runs[k];
    t += fmt::format("\n# {} {}\n[[stage]]\nname = \"{}\"\n", reading.short_place(run.where), run.text, stage(k));
    if (const auto off = of.off.find(k); off != of.off.end()) t += fmt::format("off = {}\n", list_of(off->second));
    if (!of.driven[k]) {
      t += "from = 0\nto = 1\nsteps = 1\n";
      continue;
    }
    const auto [from, to] = of.along[k];
    t += fmt::format("from = {}\nto = {}                            # 1: {} of LAMMPS's time\n", from, to, of.unit_time);
  }
  return t + observations(of);
}

}  // namespace elamin::script
