#include "problem/sweep.hpp"

#include "problem/build.hpp"
#include "problem/read.hpp"
#include "problem/tables.hpp"

#include <fmt/format.h>

#include <cmath>
#include <map>

namespace elamin {
namespace {

constexpr double most_runs = 100'000;

/// first, first + step, … up to last (included if a step ends there to rounding); integers stay integers.
std::vector<std::string> values_of_range(const Sweep& s, Mistakes& mistakes) {
  if (s.range.size() != 3)
    return mistakes.add(s.place, "range", "must be a list of three numbers [first, last, step]"),
           std::vector<std::string>{};
  const double first = s.range[0], last = s.range[1], step = s.range[2];
  const double count = std::floor((last - first) / step + 1e-9) + 1;
  if (step == 0 || !(count >= 1)) {
    mistakes.add(
        s.place, "range",
        fmt::format("leads from {} to {} by steps of {}, which never arrives; the step must point from first to last",
                    first, last, step));
    return {};
  }
  if (!(count <= most_runs)) {
    mistakes.add(s.place, "range",
                 fmt::format("has {:.0f} values; at most {:.0f} runs can be asked for", count, most_runs));
    return {};
  }
  const bool integers =
      first == std::trunc(first) && step == std::trunc(step) && std::abs(first) < 1e15 && std::abs(last) < 1e15;
  std::vector<std::string> values;
  for (int i = 0; i < count; ++i) {
    const double x = first + i * step;
    // 15 digits drop the rounding of the sum: 0.3, not 0.30000000000000004.
    const double shorter = i == 0 ? x : std::stod(fmt::format("{:.15g}", x));
    values.push_back(integers ? fmt::format("{:.0f}", x) : to_toml(shorter));
  }
  return values;
}

/// Sweeps that go in step, with their values.
struct Bundle {
  std::vector<const Sweep*> sweeps;
  std::size_t length = 0;
};

std::vector<Bundle> bundled(std::vector<Sweep>& sweeps, const Document& document, const std::vector<Setting>& settings,
                            Mistakes& mistakes) {
  std::vector<Bundle> bundles;
  std::map<std::string, std::size_t> zips;
  std::map<std::string, const Sweep*> keys;
  for (Sweep& s : sweeps) {
    if (s.place.broken) continue;
    const bool values = s.place.keys.count("values"), range = s.place.keys.count("range");
    if (values == range) {
      mistakes.add(s.place, values ? "has values as well as range; give one of them"
                                   : "values or range is missing; give values = [ … ] or range = [first, last, step]");
      continue;
    }
    if (range) s.values = values_of_range(s, mistakes);
    if (s.values.empty()) continue;

    Document changed = document;
    const std::size_t before = mistakes.list().size();
    const auto key_place = s.place.keys.find("key");
    apply({s.key, s.values[0], key_place->second}, changed, mistakes);
    if (mistakes.list().size() > before) continue;
    const std::string key = canonical_key(s.key, document);
    if (const auto [first, is_new] = keys.emplace(key, &s); !is_new)
      mistakes.add(s.place, "key",
                   fmt::format("\"{}\" is swept by {} of line {} already", s.key, first->second->place.key,
                               first->second->place.line));
    if (key.compare(0, 6, "sweep.") == 0) mistakes.add(s.place, "key", "a sweep cannot change a sweep");
    for (const Setting& setting : settings)
      if (canonical_key(setting.key, document) == key)
        mistakes.add(Place{}, setting.key,
                     fmt::format("is swept by line {} of the file; set {}.values instead", s.place.line, s.place.key));

    const auto [zip, is_new] = zips.emplace(s.zip, bundles.size());
    if (s.zip.empty() || is_new) {
      bundles.push_back({{&s}, s.values.size()});
      continue;
    }
    Bundle& bundle = bundles[zip->second];
    if (s.values.size() != bundle.length)
      mistakes.add(s.place, fmt::format("has {} values, {} of line {} has {}; sweeps with zip = \"{}\" go in step",
                                        s.values.size(), bundle.sweeps[0]->place.key, bundle.sweeps[0]->place.line,
                                        bundle.length, s.zip));
    bundle.sweeps.push_back(&s);
  }
  return bundles;
}

}  // namespace

std::vector<std::vector<Setting>> read_sweep(const std::string& file, const std::vector<Setting>& settings) {
  Document document = read_document(file);
  Mistakes ignored(file), of_sweeps(file);   // those of the settings and the problem are told by read_problem
  for (const Setting& setting : settings) apply(setting, document, ignored);
  std::vector<Sweep> sweeps = read_tables(document, ignored).sweeps;
  const std::vector<Bundle> bundles = bundled(sweeps, document, settings, of_sweeps);

  double count = 1;
  for (const Bundle& b : bundles) count *= static_cast<double>(b.length);
  if (count > most_runs)
    of_sweeps.add(fmt::format("the sweeps ask for {:.0f} runs; at most {:.0f} can be", count, most_runs));
  if (of_sweeps.any()) {
    try {
      read_problem(file, settings);
    } catch (const InputError& e) {
      of_sweeps.add(e.mistakes());
    }
    of_sweeps.raise();
  }

  std::vector<std::vector<Setting>> runs(1);
  for (const Bundle& bundle : bundles) {
    std::vector<std::vector<Setting>> longer;
    for (const auto& run : runs)
      for (std::size_t i = 0; i < bundle.length; ++i) {
        longer.push_back(run);
        for (const Sweep* s : bundle.sweeps) {
          const auto values = s->place.keys.find("values"), range = s->place.keys.find("range");
          longer.back().push_back(
              {s->key, s->values[i], values != s->place.keys.end() ? values->second : range->second});
        }
      }
    runs = std::move(longer);
  }
  return runs;
}

std::vector<PreparedRun> prepare_runs(const std::string& file, const std::vector<Setting>& settings) {
  const std::vector<std::vector<Setting>> runs = read_sweep(file, settings);
  std::vector<PreparedRun> prepared;
  // Mistakes of two runs are the same if place and key are, and they come in the same turn there.
  struct Told {
    Mistake mistake;
    std::size_t first_run, runs;
    bool alike;                          // the same sentence in all of them
  };
  std::map<std::string, Told> told;
  for (std::size_t r = 0; r < runs.size(); ++r) {
    std::vector<Setting> all = settings;
    all.insert(all.end(), runs[r].begin(), runs[r].end());
    try {
      Problem problem = read_problem(file, all);
      Model model = build_model(problem);
      prepared.push_back({runs[r], std::move(problem), std::move(model)});
    } catch (const InputError& e) {
      std::map<std::string, int> turn;
      for (const Mistake& m : e.mistakes()) {
        const std::string place = fmt::format("{}:{:9}:{:9}:{}", m.file, m.line, m.column, m.key);
        const auto [found, is_new] = told.emplace(fmt::format("{}#{:9}", place, turn[place]++), Told{m, r, 0, true});
        ++found->second.runs;
        found->second.alike = found->second.alike && found->second.mistake.what == m.what;
      }
    }
  }
  std::vector<Mistake> mistakes;         // in the order of the file, as the map is
  for (auto& [place, t] : told) {
    if (t.runs < runs.size() || !t.alike) {
      std::string run;
      for (const Setting& s : runs[t.first_run]) run += (run.empty() ? "" : ", ") + s.key + " = " + s.value;
      t.mistake.what += " (in the run with " + run + (t.runs > 1 ? fmt::format("; in {} runs)", t.runs) : ")");
    }
    mistakes.push_back(std::move(t.mistake));
  }
  if (!mistakes.empty()) throw InputError(mistakes);
  return prepared;
}

}  // namespace elamin
