// Scripts that are damaged in every way, with what they include: each becomes a model, or is refused with a sentence; none crashes, hangs, fills the memory
// or reads a file outside of its folder.
#include "catch.hpp"
#include "lammps/script_reading.hpp"
#include "processor_time.hpp"

#include <sys/resource.h>

#include <cstdlib>
#include <map>
#include <random>
#include <sstream>

using namespace elamin;

namespace {

/// A problem file without the lines that say where its tables come from.
std::string without_remarks(const std::string& toml) {
  std::string text;
  for (std::size_t begin = 0; begin < toml.size();) {
    const std::size_t end = std::min(toml.find('\n', begin), toml.size());
    if (toml[begin] != '#') text += toml.substr(begin, end - begin) + "\n";
    begin = end + 1;
  }
  return text;
}

/// A script and what lies beside it, by name.
struct Files {
  std::string main;
  std::map<std::string, std::string> parts;

  std::string text() const {
    std::string all = main;
    for (const auto& [name, part] : parts) all += "# " + name + "\n" + part;
    return all;
  }
};

/// Reads one script after another; what is read becomes a problem, and that a model.
struct ScriptAttempts {
  int read = 0, refused = 0, refused_problems = 0, of_several_files = 0;
  bool models = false;                          // are built
  double slowest = 0;                           // [s] of one
  std::size_t particles = 0;                    // of the last one
  ScratchDirectory scratch;

  ScriptAttempts() {
    for (const char* folder : {"folder/inner", "outside"}) std::filesystem::create_directories(scratch / folder);
    scratch.file("folder/strip.data", text_of(lammps_scripts + "strip.data"));
    scratch.file("outside/secret.lmp", "kept_outside\n");
    std::filesystem::create_symlink(scratch / "outside/secret.lmp", scratch / "folder/link.lmp");
  }

  void operator()(const Files& files) {
    const std::string text = files.text(), file = scratch.file("folder/in.lmp", files.main);   // where it lies after a crash
    for (const auto& [name, part] : files.parts) scratch.file("folder/" + name, part);
    const std::clock_t begin = std::clock();
    particles = 0;
    try {
      attempt(file);
      ++read;
    } catch (const InputError& e) {
      REQUIRE_FALSE(e.mistakes().empty());
      REQUIRE(e.mistakes().size() <= 21);
      for (const Mistake& m : e.mistakes()) {
        REQUIRE_FALSE(m.what.empty());
        REQUIRE(m.what.find("kept_outside") == std::string::npos);
        REQUIRE((m.file.empty() || is_inside(m.file)));
      }
      ++refused;
    } catch (const std::exception& e) {
      FAIL(e.what() << "\n" << text);
    }
    for (const auto& [name, part] : files.parts) std::filesystem::remove(scratch / ("folder/" + name));
    const double seconds = processor_seconds(begin);
    slowest = std::max(slowest, seconds);
    INFO(text);
    REQUIRE(seconds < 5 + 2e-5 * static_cast<double>(particles));    // a million particles may be asked for
  }

 private:
  /// Whether a file that was read lies in the scripts' folder.
  bool is_inside(const std::string& name) const {
    return std::filesystem::weakly_canonical(name).string().starts_with(std::filesystem::canonical(scratch / "folder").string() + "/");
  }

  void attempt(const std::string& file) {
    script::ReadingOptions options;
    options.skip = (read + refused) % 2;
    options.most_commands = 5000;
    const script::Reading r = script::read_script(file, options);
    const std::string told = script::report(r, {});
    REQUIRE_FALSE(told.empty());
    REQUIRE(told.find("kept_outside") == std::string::npos);
    for (const auto* read_files : {&r.files, &r.data_files})
      for (const std::string& name : *read_files) REQUIRE(is_inside(name));
    of_several_files += r.files.size() > 1;
    for (const script::Pass& p : r.passes) {
      particles += p.world.atoms.size();
      const script::Translated t = script::translated(r, p, {}, "p.data");
      REQUIRE(t.toml.starts_with("# Written by elamin import"));
      for (const char* number : {"= nan", "= -nan", "= inf", "= -inf", "[nan", "[-nan", "[inf", "[-inf", ", nan", ", -nan", ", inf", ", -inf"}) {
        INFO(t.toml);
        REQUIRE(without_remarks(t.toml).find(number) == std::string::npos);
      }
      REQUIRE(t.data.find(" nan") == std::string::npos);
      if (!models) continue;
      scratch.file("folder/p.data", t.data);
      const std::string problem = scratch.file("folder/p.toml", t.toml);
      try {
        build_model(read_problem(problem));
      } catch (const InputError& e) {
        REQUIRE_FALSE(e.mistakes().empty());
        if (++refused_problems; std::getenv("ELAMIN_FUZZ")) std::fprintf(stderr, "%s\n", e.mistakes().front().sentence().c_str());
      }
    }
  }
};

using Words = std::vector<std::string>;
using Lines = std::vector<Words>;

const Words odd_words{
    "", "0", "-1", "1e999", "nan", "99999999999999999999", "*", "2*", "*0", "all", "$x", "${d}", "$(1/0)", "v_x", "\"", "'", "\"\"\"",
    "&\n", "#", "\n", "NULL", "INF", "EDGE", "SELF", "delete", "\t", "\xff", "1e-320", "loop", "region", "label", "run 5", "units",
    "1e20", "clear", "group all id 1", "fix 1 all nve", "$(xcm(all,x))", "$(x[1])", "$(v_n)", "${n}", "1000000", "2147483647",
    "-2147483648", "../a", "/etc/passwd", "strip.data", "in.lmp", "add", "append", "none"};

/// Names of files that a script may ask for: some are there, some are none, some lie outside.
const Words odd_files{"in.lmp",        "part_1.lmp",  "part_2.lmp",     "link.lmp",  "../outside/secret.lmp",          "inner/../../outside/secret.lmp",
                      "inner",         ".",           "..",             "",          "inner/../part_1.lmp",            "../folder/part_1.lmp",
                      "nothing.lmp",   "strip.data",  "/dev/stdin",     "/dev/zero", "link.lmp/../../outside/secret.lmp", "${n}.lmp"};

Lines lines_of_text(const std::string& text) {
  Lines lines;
  std::istringstream in(text);
  for (std::string line; std::getline(in, line);) {
    Words words;
    std::istringstream row(line);
    for (std::string word; row >> word;) words.push_back(word);
    if (!words.empty()) lines.push_back(std::move(words));
  }
  return lines;
}

std::string text_of_lines(const Lines& lines) {
  std::string text;
  for (const Words& line : lines) {
    for (const std::string& word : line) text += word + " ";
    text += "\n";
  }
  return text;
}

/// Changes scripts at their words, numbers, lines and bytes, and puts parts of them into files that they include.
class Damage {
 public:
  explicit Damage(unsigned seed) : random_(seed) {
    for (const char* name : {"column", "grains", "glued", "stages", "formulas", "read", "shifted", "hertz", "material", "hybrid"}) {
      texts_.push_back(text_of(lammps_scripts + name + ".lmp"));
      scripts_.push_back(lines_of_text(texts_.back()));
      for (const Words& line : scripts_.back()) like_[line[0]].push_back(line);
    }
  }

  Files next() {
    Lines lines = some(scripts_);
    for (std::size_t changes = 1 + pick(4); changes > 0; --changes) change(lines);
    Files files;
    if (pick(3) == 0) take_out(lines, 1, files);
    files.main = spoilt(text_of_lines(lines));
    return files;
  }

 private:
  std::size_t pick(std::size_t n) { return static_cast<std::size_t>(random_() % n); }
  template <class T> const T& some(const std::vector<T>& list) { return list[pick(list.size())]; }

  std::string spoilt(std::string text) {
    if (pick(4) == 0 && !text.empty()) text[pick(text.size())] = static_cast<char>(random_());
    if (pick(16) == 0) text.resize(pick(text.size() + 1));
    return text.empty() ? "\n" : text;
  }

  /// Some lines become a file, and of these some another one; instead of each the script has `include` and, mostly, its name.
  void take_out(Lines& lines, int number, Files& files) {
    if (lines.empty()) return;
    const std::string name = "part_" + std::to_string(number) + ".lmp";
    const std::size_t from = pick(lines.size()), count = pick(lines.size() - from) + 1;
    const auto begin = lines.begin() + static_cast<std::ptrdiff_t>(from), end = begin + static_cast<std::ptrdiff_t>(count);
    Lines part(begin, end);
    lines.insert(lines.erase(begin, end), Words{pick(8) == 0 ? "jump" : "include", pick(4) == 0 ? some(odd_files) : name});
    if (number < 3 && pick(2) == 0) take_out(part, number + 1, files);
    files.parts[name] = spoilt(text_of_lines(part));
  }

  /// One that a number is near, or far from.
  std::string number(const std::string& old) {
    char* end = nullptr;
    const double v = std::strtod(old.c_str(), &end);
    if (end == old.c_str()) return some(odd_words);
    const double factors[]{0, -1, 0.5, 2, 10, 1e3, 1e6, 1e-6, 1e150, 1e-150, 1 + 1e-15};
    const double w = pick(3) == 0 ? v + static_cast<double>(pick(5)) - 2 : v * factors[pick(std::size(factors))];
    std::ostringstream out;
    if (w == std::trunc(w) && std::abs(w) < 1e15) out << static_cast<long long>(w);
    else out << w;
    return out.str();
  }

  void change(Lines& lines) {
    if (lines.empty()) lines.push_back(some(some(scripts_)));
    const auto at = [&] { return lines.begin() + static_cast<std::ptrdiff_t>(pick(lines.size())); };
    Words& line = *at();
    const std::size_t w = pick(line.size());
    switch (pick(12)) {
      case 0: line[w] = some(odd_words); break;
      case 1:
      case 2: line[w] = number(line[w]); break;
      case 3:                                     // a word that stands there elsewhere
        if (const auto found = like_.find(line[0]); found != like_.end())
          if (const Words& other = some(found->second); w < other.size()) line[w] = other[w];
        break;
      case 4: line.erase(line.begin() + static_cast<std::ptrdiff_t>(w)); break;
      case 5: line.insert(line.begin() + static_cast<std::ptrdiff_t>(w), pick(2) ? some(odd_words) : some(some(some(scripts_)))); break;
      case 6: lines.erase(at()); break;
      case 7: lines.insert(at(), Words(*at())); break;
      case 8: std::swap(*at(), *at()); break;
      case 9: lines.insert(at(), some(some(scripts_))); break;
      case 10: {                                  // again and again
        const auto begin = at();
        const std::size_t from = static_cast<std::size_t>(begin - lines.begin()), to = from + pick(lines.size() - from) + 1;
        lines.insert(lines.begin() + static_cast<std::ptrdiff_t>(to), {{"next", "again"}, {"jump", "SELF", "again"}});
        lines.insert(lines.begin() + static_cast<std::ptrdiff_t>(from),
                     {{"variable", "again", "loop", std::to_string(1 + pick(30))}, {"label", "again"}});
        break;
      }
      default: {                                  // another script behind
        const Lines& other = some(scripts_);
        const std::size_t from = pick(other.size());
        lines.insert(lines.end(), other.begin() + static_cast<std::ptrdiff_t>(from), other.end());
      }
    }
    std::erase_if(lines, [](const Words& l) { return l.empty(); });
  }

  std::mt19937 random_;
  std::vector<std::string> texts_;
  std::vector<Lines> scripts_;
  std::map<std::string, Lines> like_;             // lines by command
};

unsigned setting(const char* name, unsigned otherwise) {
  const char* value = std::getenv(name);
  return value ? static_cast<unsigned>(std::strtoul(value, nullptr, 10)) : otherwise;
}

/// No more memory than this from here on [bytes].
class MemoryLimit {
 public:
  explicit MemoryLimit(rlim_t bytes) {
    getrlimit(RLIMIT_AS, &before_);
    rlimit now = before_;
    now.rlim_cur = bytes;
    setrlimit(RLIMIT_AS, &now);
  }
  ~MemoryLimit() { setrlimit(RLIMIT_AS, &before_); }

 private:
  rlimit before_;
};

}  // namespace

TEST_CASE("damaged scripts are read or refused", "[script][fuzz]") {
  ScriptAttempts attempt;
  Damage damage(20261);
  for (int k = 0; k < 4000; ++k) {
    attempt.models = k % 4 == 0;
    attempt(damage.next());
  }
  CHECK(attempt.read > 400);                      // both ends are reached
  CHECK(attempt.refused > 400);
  CHECK(attempt.of_several_files > 30);
}

// ELAMIN_FUZZ=100000 ELAMIN_SEED=1 elamin_tests "damaged scripts, as many as asked for"
TEST_CASE("damaged scripts, as many as asked for", "[.]") {
#ifndef __SANITIZE_ADDRESS__                      // which maps far more than it uses
  const MemoryLimit limit(4000000000);
#endif
  ScriptAttempts attempt;
  attempt.models = true;
  Damage damage(setting("ELAMIN_SEED", 1));
  for (unsigned k = 0; k < setting("ELAMIN_FUZZ", 1000); ++k) attempt(damage.next());
  WARN(attempt.read << " read, of these " << attempt.of_several_files << " of several files, " << attempt.refused << " refused, "
                    << attempt.refused_problems << " refused as problems, the slowest in " << attempt.slowest << " s");
}
