#include "study/prepare.hpp"

#include "input/check.hpp"
#include "input/read.hpp"
#include "input/stages.hpp"
#include "study/imperfection.hpp"
#include "study/refine.hpp"

#include <fmt/format.h>

#include <algorithm>
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
    mistakes.add(s.place, "range", fmt::format("leads from {} to {} by steps of {}, which never arrives; the step must point from first to last",
                                               first, last, step));
    return {};
  }
  if (!(count <= most_runs)) {
    mistakes.add(s.place, "range", fmt::format("has {:.0f} values; at most {:.0f} runs can be asked for", count, most_runs));
    return {};
  }
  const bool integers = first == std::trunc(first) && step == std::trunc(step) && std::abs(first) < 1e15 && std::abs(last) < 1e15;
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

/// What a file and the settings ask for.
class SweepReader {
 public:
  SweepReader(const Document& document, const std::vector<Setting>& settings)
      : document_(document), settings_(settings), mistakes_(document.file) {
    Mistakes ignored(document.file);              // those of the settings and the problem are told by read_problem
    for (const Setting& setting : settings) apply(setting, document_, ignored);
    tables_ = read_tables(document_, ignored);
    for (Sweep& s : tables_.sweeps)
      if (!s.place.broken) add(s);
    double count = 1;
    for (const Bundle& b : bundles_) count *= static_cast<double>(b.length);
    if (count > most_runs)
      mistakes_.add(fmt::format("the sweeps ask for {:.0f} runs; at most {:.0f} can be", count, most_runs));
    for (const Sweep& s : tables_.sweeps)
      if (bisects(s) && tables_.sweeps.size() > 1)
        mistakes_.add(s.place, "bisect", "a sweep that halves goes alone; leave the other sweeps out");
    if (refines() && !tables_.sweeps.empty()) mistakes_.add(tables_.problem.refine->place, "does not go with [[sweep]]; leave one of them out");
  }

  SweepReader(SweepReader&&) = default;              // bundles point into the tables: no copies

  const Mistakes& mistakes() const { return mistakes_; }
  const std::optional<Bisection>& bisection() const { return bisection_; }
  bool refines() const { return tables_.problem.refine.has_value(); }

  std::vector<std::vector<Setting>> runs() const {
    std::vector<std::vector<Setting>> runs(1);
    for (const Bundle& bundle : bundles_) {
      std::vector<std::vector<Setting>> longer;
      for (const auto& run : runs)
        for (std::size_t i = 0; i < bundle.length; ++i) {
          longer.push_back(run);
          for (const Sweep* s : bundle.sweeps)
            for (const std::string& key : s->keys) longer.back().push_back({key, s->values[i], place_of_values(*s)});
        }
      runs = std::move(longer);
    }
    for (std::vector<Setting>& run : runs) compute(run);
    return runs;
  }

 private:
  static Place place_of_values(const Sweep& s) {
    for (const char* key : {"values", "range", "between"})
      if (const auto found = s.place.keys.find(key); found != s.place.keys.end()) return found->second;
    return s.place;
  }

  /// Expressions among the values of a run become numbers: those of constants by the constants of the file, others by those of the run.
  void compute(std::vector<Setting>& run) const {
    const auto quoted = [](const Setting& s) { return s.value.find_first_of("\"'") == 0; };
    if (std::none_of(run.begin(), run.end(), quoted)) return;
    Document changed = document_;
    Mistakes ignored(document_.file);    // told where the run is read
    const Constants of_file = constants_of(document_);
    for (Setting& s : run) {
      if (s.key.compare(0, 10, "constants.") == 0) s.value = computed(s, document_, of_file);
      apply(s, changed, ignored);
    }
    const Constants of_run = constants_of(changed);
    for (Setting& s : run) s.value = computed(s, changed, of_run);
  }

  void add(Sweep& s) {
    if (!take_values(s) || s.values.empty() || !take_keys(s)) return;
    const auto [zip, is_new] = zips_.emplace(s.zip, bundles_.size());
    if (s.zip.empty() || is_new) {
      bundles_.push_back({{&s}, s.values.size()});
      return;
    }
    Bundle& bundle = bundles_[zip->second];
    if (s.values.size() != bundle.length)
      mistakes_.add(s.place, fmt::format("has {} values, {} of line {} has {}; sweeps with zip = \"{}\" go in step",
                                         s.values.size(), bundle.sweeps[0]->place.key, bundle.sweeps[0]->place.line,
                                         bundle.length, s.zip));
    bundle.sweeps.push_back(&s);
  }

  /// The values, from whichever key gives them; false after a mistake.
  bool take_values(Sweep& s) {
    const std::size_t before = mistakes_.list().size();
    const bool values = s.place.keys.count("values"), range = s.place.keys.count("range"), halves = bisects(s);
    if (values + range + halves != 1) {
      const char* what = values && range ? "has values as well as range; give one of them"
                         : halves        ? "has between and bisect as well as values or range; give one of them"
                                         : "values or range is missing; give values = [ … ] or range = [first, last, step], "
                                           "or between = [a, b] and bisect";
      mistakes_.add(s.place, what);
      return false;
    }
    if (range) s.values = values_of_range(s, mistakes_);
    if (halves) {
      for (std::string& value : s.between)
        if (!s.keys.empty()) value = computed({s.keys.front(), value}, document_, constants_of(document_));
      bisection_ = read_bisection(s, tables_.problem, mistakes_);
      s.values = s.between;
    } else {
      for (const char* key : {"at", "level", "tolerance"})
        if (s.place.keys.count(key)) mistakes_.add(s.place, key, "belongs to a sweep with between and bisect");
    }
    return mistakes_.list().size() == before;
  }

  /// Keys that are there, that nothing else sets, and whose first value fits; false after a mistake.
  bool take_keys(const Sweep& s) {
    const std::size_t before = mistakes_.list().size();
    if (s.keys.empty()) mistakes_.add(s.place, "key", "is an empty list; it must name a key or several");
    for (const std::string& given : s.keys) {
      Document changed = document_;
      Mistakes wrong(document_.file);
      apply({given, s.values[0], s.place.keys.at("key")}, changed, wrong);
      for (const Mistake& m : wrong.list()) mistakes_.add(s.place, "key", m.key + ": " + m.what);
      if (wrong.any()) continue;
      const std::string key = canonical_key(given, document_);
      if (const auto [first, is_new] = keys_.emplace(key, &s); !is_new)
        mistakes_.add(s.place, "key",
                      fmt::format("\"{}\" is swept by {} of line {} already", given, first->second->place.key,
                                  first->second->place.line));
      if (key.compare(0, 6, "sweep.") == 0) mistakes_.add(s.place, "key", "a sweep cannot change a sweep");
      for (const Setting& setting : settings_)
        if (canonical_key(setting.key, document_) == key)
          mistakes_.add(Place{}, setting.key,
                        fmt::format("is swept by line {} of the file; set {}.values instead", s.place.line, s.place.key));
    }
    return mistakes_.list().size() == before;
  }

  Document document_;
  const std::vector<Setting>& settings_;
  Mistakes mistakes_;
  ProblemFile tables_;
  std::vector<Bundle> bundles_;
  std::map<std::string, std::size_t> zips_;
  std::map<std::string, const Sweep*> keys_;
  std::optional<Bisection> bisection_;
};

/// The sweeps of a file, once nothing is wrong with them; else throws what is wrong with the problem beside it.
SweepReader whole_sweeps(const Document& document, const std::vector<Setting>& settings) {
  SweepReader reader(document, settings);
  if (!reader.mistakes().any()) return reader;
  Mistakes all = reader.mistakes();
  try {
    read_problem(document, settings);
  } catch (const InputError& e) {
    all.add(e.mistakes());
  }
  all.raise();
  return reader;
}

bool of_all(const ExpectTable& e) { return e.extrapolate || e.continuum || e.at == at_sweep; }

/// Expectations about all runs together leave the run's own, which stops where they look.
std::vector<ExpectTable> of_all_runs(Problem& problem) {
  std::vector<ExpectTable> together;
  std::vector<double> stops = problem.path.stops.value_or(std::vector<double>{});
  for (const ExpectTable& e : problem.expect)
    if (const auto lambda = load_factor_of(e.at); lambda && of_all(e)) stops.push_back(*lambda);
  if (!stops.empty()) problem.path.stops = stops;
  for (const ExpectTable& e : problem.expect)
    if (of_all(e)) together.push_back(e);
  std::erase_if(problem.expect, of_all);
  return together;
}

/// Expectations about all runs together need more than one.
void check_together(const std::vector<ExpectTable>& together, std::size_t runs, bool bisection, Mistakes& mistakes) {
  for (const ExpectTable& e : together) {
    if (e.at == at_sweep && !bisection)
      mistakes.add(e.place, "at", "\"sweep\" is for the threshold of a [[sweep]] with bisect; there is none");
    if (e.at == at_sweep && e.extrapolate)
      mistakes.add(e.place, "extrapolate", "does not go with at = \"sweep\"");
    else if (e.extrapolate && (runs < 2 || bisection))
      mistakes.add(e.place, "extrapolate", "needs a [[sweep]] of two runs or more");
  }
}

}  // namespace

PreparedRun prepare_run(const Document& document, const std::vector<Setting>& settings, const std::vector<Setting>& swept,
                        const std::vector<OwnLaw>& own) {
  std::vector<Setting> all = settings;
  all.insert(all.end(), swept.begin(), swept.end());
  PreparedRun run{swept, read_problem(document, all), {}, {}, {}};
  if (run.problem.curve) {
    const CurveTable& curve = *run.problem.curve;
    const Setting second{curve.second, "", curve.place.keys.at("second")};
    Mistakes mistakes(document.file);
    if (const std::string wrong = wrong_number(second.key, document); !wrong.empty()) mistakes.add(curve.place, "second", wrong);
    mistakes.raise();
    const auto at = [document, all, second](double value) {
      std::vector<Setting> changed = all;
      changed.push_back({second.key, to_toml(value), second.place});
      return read_problem(document, changed);
    };
    run.problem = at(curve.from);
    run.models = [at, own](double value) {
      const Problem problem = at(value);
      Model model = model_of(problem, own);
      std::string unclear;
      const Stage stage = Stages(problem).enter(unclear);
      return model_in(problem, stage, model, model.restart.value_or(model.start));
    };
  }
  run.together = of_all_runs(run.problem);
  run.model = model_of(run.problem, own);
  return run;
}

PreparedRuns prepare_runs(const std::string& file, const std::vector<Setting>& settings) {
  return prepare_runs(read_document(file), settings);
}

PreparedRuns prepare_runs(const Document& document, const std::vector<Setting>& settings, const std::vector<OwnLaw>& own) {
  const SweepReader reader = whole_sweeps(document, settings);
  const std::vector<std::vector<Setting>> runs = reader.refines() ? levels_of(document, settings, own) : reader.runs();
  PreparedRuns prepared{document, own, {}, reader.bisection()};
  // Mistakes of two runs are the same if place and key are, and they come in the same turn there.
  struct Told {
    Mistake mistake;
    std::size_t first_run, runs;
    bool alike;                          // the same sentence in all of them
  };
  std::map<std::string, Told> told;
  for (std::size_t r = 0; r < runs.size(); ++r) {
    try {
      prepared.runs.push_back(prepare_run(document, settings, runs[r], own));
      Mistakes of_together(document.file);
      check_together(prepared.runs.back().together, runs.size(), reader.bisection().has_value(), of_together);
      of_together.raise();
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
