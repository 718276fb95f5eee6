#include "lammps/script/interpreter.hpp"

#include "core/suggest.hpp"
#include "core/text.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <memory>
#include <set>
#include <utility>

namespace elamin::script {
namespace {

constexpr std::size_t deepest_include = 16;     // as LAMMPS has it
constexpr std::size_t most_passes = 1000;

/// A script or what it includes, read once.
struct File {
  std::string path;
  std::vector<Line> lines;
  std::map<std::string, std::size_t> labels;    // the first line of each
};

/// How the mistake begins that follows where this command has made nothing of that name; "": it makes no names.
std::string missing(const std::string& command, const std::string& name) {
  if (command == "variable") return "there is no variable " + in_quotes(name);
  if (command == "pair_style") return "stands before pair_style";
  const bool makes = command == "region" || command == "group" || command == "compute" || command == "fix";
  return makes && !name.empty() ? in_quotes(name) + " is no " + command : "";
}

class Reader {
 public:
  Reader(const std::string& file, const ReadingOptions& options) {
    in_.options = options;
    in_.reading.files = {file};
    files_.push_back(read(file));
    in_.frames.push_back({0, 0});
  }

  Reading all() {
    while (!in_.frames.empty() && !in_.ended && !stopped_) step();
    if (in_.label && mistakes_.empty())
      mistakes_.push_back({in_.reading.files.front(), 1, 1, "jump", fmt::format("there is no label {}", in_quotes(*in_.label))});
    if (!mistakes_.empty()) throw InputError(std::move(mistakes_));
    in_.end_pass();
    return std::move(in_.reading);
  }

 private:
  static std::shared_ptr<File> read(const std::string& path) {
    auto file = std::make_shared<File>();
    file->path = path;
    file->lines = lines_of(std::string(without_mark(read_text(path))));
    for (std::size_t i = 0; i < file->lines.size(); ++i) {
      const std::string& text = file->lines[i].text;
      if (text.find("label") == std::string::npos) continue;
      try {
        const auto words = split(without_comment(text));
        if (words.size() == 2 && words[0].text == "label") file->labels.emplace(words[1].text, i);
      } catch (const Wrong&) {                   // told when the line is executed
      }
    }
    return file;
  }

  void step() {
    load_files();
    Interpreter::Frame& frame = in_.frames.back();
    const File& file = *files_[frame.file];
    if (in_.label) {
      const auto found = file.labels.find(*in_.label);
      if (found == file.labels.end()) {
        tell({file.path, file.lines.empty() ? 1 : file.lines.back().place(0).line, 1, "jump",
              fmt::format("there is no label {}", in_quotes(*in_.label))});
        in_.ended = true;
        return;
      }
      frame.next = found->second + 1;
      in_.label.reset();
    }
    if (frame.next >= file.lines.size()) {
      in_.frames.pop_back();
      return;
    }
    const Line& line = file.lines[frame.next++];
    const int number = frame.file;
    in_.where = {number, line.place(line.text.find_first_not_of(" \t\r\f\v\n")).line};
    if (++in_.reading.commands > in_.options.most_commands) {
      tell({file.path, in_.where.line, 1, "",
            fmt::format("more than {} commands have been gone through; a loop may have no end", in_.options.most_commands)});
      in_.ended = true;
      return;
    }
    in_.words.clear();
    try {
      const Substitution by{[&](const std::string& n) { return lookup(n); },
                            [&](const std::string& f) { return immediate(f, in_.world, in_.names); }};
      in_.words = words_of(line, by);
      if (in_.words.empty()) return;
      in_.run_command();
    } catch (const NeedsPositions& needs) {
      stop(needs, file);
    } catch (const Silent& silent) {
      leave_out(first_word(line.text), silent.what);
    } catch (const InputError& e) {              // of a file that the command reads
      for (const Mistake& m : e.mistakes())
        tell(m.line > 0 ? m : Mistake{file.path, in_.where.line, 1, in_.words[0].text, m.sentence()});
    } catch (const Wrong& wrong) {
      const std::size_t w = wrong.word < in_.words.size() ? wrong.word : 0;
      const Place at = line.place(in_.words.empty() ? line.text.find_first_not_of(" \t") : in_.words[w].offset);
      const std::string command = in_.words.empty() ? first_word(line.text) : in_.words[0].text;
      const std::string what = wrong.what();
      // What follows from a mistake that was told is not told again.
      const bool follows =
          std::any_of(broken_.begin(), broken_.end(), [&](const std::string& m) { return what == m || what.starts_with(m + ";"); });
      if (in_.words.size() > 1)
        if (const std::string name = missing(command, in_.words[1].text); !name.empty()) broken_.insert(name);
      if (follows || (wrong.unknown && in_.options.skip)) return leave_out(command, what);
      tell({file.path, at.line, at.column, command, what});
    }
  }

  /// A command that needs what was not made.
  struct Silent { std::string what; };

  void leave_out(const std::string& command, const std::string& why) {
    if (in_.options.skip) in_.reading.told.push_back({Told::Fate::not_understood, command, why, 1, in_.where});
  }

  static std::string first_word(const std::string& text) {
    const std::size_t begin = std::min(text.find_first_not_of(" \t\r\f\v\n"), text.size());
    return text.substr(begin, std::min(text.find_first_of(" \t\r\f\v\n", begin), text.size()) - begin);
  }

  std::string lookup(const std::string& name) const {
    const std::string what = missing("variable", name);
    if (broken_.count(what) && !in_.names.variables.count(name)) throw Silent{what};
    return text_of(name, in_.world, in_.names);
  }

  void tell(Mistake mistake) {
    in_.failed = true;
    for (const Mistake& m : mistakes_)
      if (m.file == mistake.file && m.line == mistake.line && m.column == mistake.column) return;
    mistakes_.push_back(std::move(mistake));
    if (mistakes_.size() < most_mistakes) return;
    const Mistake& last = mistakes_.back();
    mistakes_.push_back({last.file, last.line, last.column, {}, fmt::format("{} mistakes; there may be more", most_mistakes)});
    throw InputError(mistakes_);
  }

  /// At a command that needs positions behind a run: what was run so far is a problem by itself.
  void stop(const NeedsPositions& needs, const File& file) {
    stopped_ = true;
    const std::string command = in_.words.empty() ? "a formula" : in_.words[0].text;
    if (in_.world.runs.empty()) return tell({file.path, in_.where.line, 1, command, "needs positions behind a run that is not there"});
    in_.note(fmt::format(
        "{} {} the run of {}; the import ends here. Run the problem, then give its last state: "
        "--after DIR/states/final.data, or of several runs each one's: --after DIR/states/run1.data --after DIR/states/final.data",
        command, needs.why, in_.reading.place(needs.run)));
    in_.world.last_run = needs.run;
    in_.reading.passes.push_back({in_.world, {}, in_.where});
    in_.world = World();
  }

  /// Frames of files that the last command has opened, though something else of it was wrong.
  void load_files() {
    for (Interpreter::Frame& f : in_.frames) {
      if (f.file < static_cast<int>(files_.size())) continue;
      const std::string& path = in_.reading.files[f.file];
      try {
        files_.push_back(read(path));
      } catch (const InputError& e) {
        files_.push_back(std::make_shared<File>());
        files_.back()->path = path;
        Mistake m = e.mistakes().front();
        if (m.line == 0) m = {in_.reading.files[in_.where.file], in_.where.line, 1, in_.words[0].text, e.what()};
        tell(m);
      }
    }
  }

  Interpreter in_;
  std::vector<std::shared_ptr<File>> files_;
  std::vector<Mistake> mistakes_;
  std::set<std::string> broken_;
  bool stopped_ = false;
};

}  // namespace

std::string Reading::short_place(const Where& w) const {
  return std::filesystem::path(files[w.file]).filename().string() + ":" + std::to_string(w.line);
}

Reading read_script(const std::string& file, const ReadingOptions& options) { return Reader(file, options).all(); }

void Interpreter::wants(std::size_t least, const std::string& form, std::size_t most) const {
  if (size() < least) throw Wrong(0, fmt::format("has too few words; it is: {}", form));
  if (size() > most) throw Wrong(most, fmt::format("has too many words; it is: {}", form));
}

double Interpreter::number(std::size_t i) const {
  if (i >= size()) throw Wrong(size() - 1, "a number is missing behind this");
  double v = 0;
  if (!reads_as(unsigned_word(word(i)), v) || !std::isfinite(v)) throw Wrong(i, in_quotes(word(i)) + " is not a number");
  return v;
}

double Interpreter::positive(std::size_t i) const {
  const double v = number(i);
  if (!(v > 0)) throw Wrong(i, fmt::format("must be above 0, is {}", word(i)));
  return v;
}

long long Interpreter::integer(std::size_t i, long long lo, long long hi) const {
  if (i >= size()) throw Wrong(size() - 1, "an integer is missing behind this");
  const std::string& w = word(i);
  long long v = 0;
  if (reads_as(unsigned_word(w), v)) {
    if (v < lo || v > hi)
      throw Wrong(i, fmt::format("{} is out of range; {} is allowed", w, hi < lo ? "nothing" : fmt::format("{} to {}", lo, hi)));
    return v;
  }
  // LAMMPS's own formulas print large integers as numbers such as 1e+06.
  if (double d = 0; reads_as(w, d) && d == std::floor(d))
    throw Wrong(i, in_quotes(w) + " is a floating-point number where an integer is wanted; LAMMPS takes none either");
  throw Wrong(i, in_quotes(w) + " is not an integer");
}

double Interpreter::value(std::size_t i, Dependence* on) const {
  if (i < size() && word(i).starts_with("v_")) return number_of(word(i), world, names, i, on);
  return number(i);
}

int Interpreter::axis(std::size_t i) const {
  const std::string& w = word(std::min(i, size() - 1));
  if (w == "x" || w == "y" || w == "z") return w[0] - 'x';
  throw Wrong(std::min(i, size() - 1), in_quotes(w) + " is no axis; x, y and z are");
}

double Interpreter::unit_of_length(std::size_t i) const {
  for (; i + 1 < size(); ++i) {
    if (word(i) != "units") continue;
    if (word(i + 1) == "box") return 1;
    if (word(i + 1) != "lattice") throw Wrong(i + 1, in_quotes(word(i + 1)) + " are no units of length; box and lattice are");
  }
  return world.lattice;
}

bool Interpreter::yes(std::size_t i) const {
  if (i >= size()) throw Wrong(size() - 1, "yes or no is missing behind this");
  const std::string& w = word(i);
  if (w == "yes" || w == "on" || w == "true") return true;
  if (w == "no" || w == "off" || w == "false") return false;
  throw Wrong(i, in_quotes(w) + " is neither yes nor no");
}

std::array<int, 2> Interpreter::range(std::size_t i, int most) const {
  if (i >= size()) throw Wrong(size() - 1, "a number or a range such as 2*4 is missing behind this");
  const std::string& w = word(i);
  const std::size_t star = w.find('*');
  const auto part = [&](const std::string& text, int without) {
    if (text.empty()) return without;
    int v = 0;
    if (!reads_as(text, v)) throw Wrong(i, in_quotes(w) + " is no number and no range such as 2*4");
    if (v < 1 || v > most) throw Wrong(i, most == 0 ? fmt::format("{} is out of range; create_box or read_data announces none", v)
                                                    : fmt::format("{} is out of range; 1 to {} is allowed", v, most));
    return v;
  };
  if (star == std::string::npos) {
    const int v = part(w.empty() ? "x" : w, 0);
    return {v, v};
  }
  const std::array<int, 2> r{part(w.substr(0, star), 1), part(w.substr(star + 1), most)};
  if (r[0] > r[1]) throw Wrong(i, fmt::format("the range {} is empty", in_quotes(w)));
  return r;
}

std::string Interpreter::text() const {
  std::string all;
  for (const Word& w : words) (all += all.empty() ? "" : " ") += w.text;
  for (char& c : all)
    if (static_cast<unsigned char>(c) < 32) c = ' ';
  return all;
}

void Interpreter::note(const std::string& what) {
  for (const Note& n : reading.notes)
    if (n.where == where && n.text == what) return;
  if (reading.notes.size() < 200) reading.notes.push_back({where, what});
}

void Interpreter::run_command() {
  const std::string command = word(0);
  const auto tell = [&](Told::Fate fate, const std::string& why) {
    for (Told& t : reading.told)
      if (t.command == command && t.fate == fate && t.why == why) return void(++t.count);
    reading.told.push_back({fate, command, why, 1, where});
  };
  if (const Handler handler = handler_of(command)) {
    why_ignored.clear();
    handler(*this);
    if (why_ignored.empty()) tell(Told::Fate::taken, "");
    else tell(Told::Fate::ignored, why_ignored);
    return;
  }
  if (const std::string why = ignored_command(command); !why.empty()) return tell(Told::Fate::ignored, why);
  if (const std::string why = refused_command(command); !why.empty()) {
    if (size() == 2 && word(1) == "none") return tell(Told::Fate::ignored, why);       // dihedral_style none
    throw Wrong(0, why, true);
  }
  throw Wrong(0, in_quotes(command) + " is no command that is known here" + did_you_mean(command, known_commands()) + "; --skip leaves it out",
              true);
}

Substitution Interpreter::substitution() const {
  return {[this](const std::string& n) { return text_of(n, world, names); }, [this](const std::string& f) { return immediate(f, world, names); }};
}

void Interpreter::execute(const std::string& line_text, const Where& at) {
  if (depth > 20) throw Wrong(0, "holds commands in commands more than 20 deep");
  if (++reading.commands > options.most_commands) {
    ended = true;
    throw Wrong(0, fmt::format("more than {} commands have been gone through; a loop may have no end", options.most_commands));
  }
  const std::vector<Word> outer = std::exchange(words, {});
  struct Back {
    Interpreter& in;
    const std::vector<Word>& outer;
    ~Back() { in.words = outer, --in.depth; }
  } back{*this, outer};
  ++depth;
  where = at;
  try {
    words = split(substituted(without_comment(line_text), substitution()));
    if (!words.empty()) run_command();
  } catch (const Wrong& wrong) {
    throw Wrong(0, fmt::format("in {}: {}", in_quotes(line_text), wrong.what()), wrong.unknown);
  }
}

std::string Interpreter::path_of(const std::string& name, std::size_t w) const {
  namespace fs = std::filesystem;
  const fs::path root = fs::path(reading.files.front()).parent_path();
  const fs::path path = fs::path(name).is_absolute() ? fs::path(name) : root / name;
  if (name.empty() || name.find('\0') != std::string::npos) throw Wrong(w, "a file's name is missing");
  if (!options.include_anywhere) {
    std::error_code unknown;
    const fs::path whole = fs::weakly_canonical(fs::absolute(path), unknown);
    const fs::path base = unknown ? fs::path() : fs::weakly_canonical(root.empty() ? fs::path(".") : root, unknown);
    const fs::path inner = whole.lexically_relative(base);
    if (unknown || inner.empty() || *inner.begin() == "..")
      throw Wrong(w, in_quotes(name) + " lies outside of the script's folder; --include-anywhere allows that");
  }
  return path.string();
}

void Interpreter::begin_file(const std::string& name, std::size_t w, bool returns) {
  const std::string shown = path_of(name, w);
  if (frames.size() >= deepest_include) throw Wrong(w, fmt::format("files include each other more than {} deep", deepest_include));
  const auto found = std::find(reading.files.begin(), reading.files.end(), shown);
  const int number = static_cast<int>(found - reading.files.begin());
  if (found == reading.files.end()) reading.files.push_back(shown);
  if (!returns) frames.pop_back();
  frames.push_back({number, 0});
}

void Interpreter::end_pass() {
  const bool still = world.runs.empty() && world.still && world.is_of_now(*world.still);
  const bool ran = !world.runs.empty() || still;
  const bool anything = std::any_of(world.atoms.begin(), world.atoms.end(), World::there) || !world.body_file.empty();
  if (!ran && !(anything && reading.passes.empty())) return;
  if (reading.passes.size() >= most_passes) {
    ended = true;
    throw Wrong(0, fmt::format("more than {} problems follow from the script", most_passes));
  }
  std::map<std::string, std::string> loops;
  for (const auto& [name, v] : names.variables)
    if (v.style == Variable::Style::loop || v.style == Variable::Style::index) loops[name] = text_of(name, world, names);
  if (ran && !reading.passes.empty() && reading.passes.back().world.runs.empty()) reading.passes.pop_back();   // which ran nothing
  reading.passes.push_back({world, loops, std::nullopt});
  World& made = reading.passes.back().world;
  if (still) made.runs.push_back(*made.still), made.atoms = std::move(made.atoms_of_still);
  if (ran) return;
  for (Atom& a : made.atoms) a.start = a.x, a.start_v = a.v;
}

}  // namespace elamin::script
