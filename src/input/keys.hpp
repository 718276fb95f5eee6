#pragma once
// How a table says its keys, once: `void describe(Keys&, Table&)` names each with what it means and may be, and what goes
// together. Four things go through that: the Reader (TOML → structs, every mistake), the Writer (structs → resolved.toml),
// the KeyTree (--set, key reference, JSON schema).
#include "core/error.hpp"
#include "core/types.hpp"

#include <algorithm>
#include <array>
#include <cstddef>
#include <functional>
#include <initializer_list>
#include <limits>
#include <map>
#include <optional>
#include <string>
#include <type_traits>
#include <utility>
#include <variant>
#include <vector>

namespace elamin {

// What every table of a problem file has, and what its keys may hold.

class Groups;
class Mistakes;
class Names;
struct Problem;

/// Where a table and its keys stand, for messages that come after reading. It is not part of what the file says:
/// two tables that say the same are equal wherever they stand.
struct TablePlace : Place {
  std::string key;                              // what `--set` calls the table: "beam.column", "support.2", "path"
  std::map<std::string, Place> keys;            // of those that are written
  bool broken = false;                          // a mistake was found in it
  bool written(const char* name) const { return keys.count(name) > 0; }
  bool operator==(const TablePlace&) const { return true; }
};

/// What a number may be: lo ≤ x ≤ hi, or lo < x ≤ hi.
struct Range {
  double lo = -std::numeric_limits<double>::max(), hi = std::numeric_limits<double>::max();
  bool above = false;
};
inline constexpr int most_particles = 100'000'000, most_steps = 1'000'000, most_branches = 1000, most_modes = 1000;
namespace range {
inline constexpr Range any{}, positive{0, any.hi, true}, not_negative{0}, count{1, most_particles};
inline constexpr Range id{1, std::numeric_limits<int>::max()};
inline constexpr Range poissons_ratio{-1, 0.5, true}, degrees{0, 180};
}  // namespace range

/// A word of the file and what it stands for.
template <class T> struct Word {
  const char* text;
  T value;
};

/// Films of a run's states, by the ends of their names.
inline constexpr std::array film_words{"lammpstrj", "pvd", "xyz"};

/// The rest angle of a structure's angles: "straight", "as_built", or degrees.
struct Rest {
  bool as_built = false;
  double degrees = 180;
  bool operator==(const Rest&) const = default;
};

/// Numbers with names of the file's own.
using NamedNumbers = std::vector<std::pair<std::string, double>>;

struct Key {
  enum class Kind { plain, name, file, one_or_more, one_or_two, values, words, center };
  const char *name, *means;
  bool needed = false;
  Range range = {};
  Kind kind = Kind::plain;
  std::vector<std::string> words = {};          // that may stand there
  int axis = 0;                                 // of a centre: the coordinate that may be left out
};

/// Where the value of a key goes to or comes from.
using KeyValue = std::variant<bool*, int*, double*, std::string*, Vec3*, Rest*, std::array<double, 2>*, std::array<std::string, 2>*, std::vector<int>*,
                              std::vector<double>*, std::vector<Vec3>*, std::vector<std::vector<int>>*,
                              std::vector<std::vector<double>>*, std::vector<std::string>*>;

class Keys {
 public:
  using Kind = Key::Kind;
  using Names = std::vector<const char*>;
  virtual ~Keys() = default;

  /// What the table is, in a sentence or two.
  virtual void about(const char*) {}

  /// A key that must be there, and one that may: then the value stays as it is where the key is absent.
  template <class T> void must(const char* name, T& value, const char* means, Range range = {}) { take({name, means, true, range}, value); }
  template <class T> void may(const char* name, T& value, const char* means, Range range = {}) { take({name, means, false, range}, value); }
  /// A name of something new; an existing file, sought from the folder of the problem file.
  void name(const char* key, std::string& value, const char* means) { take({key, means, true, {}, Kind::name}, value); }
  void may_name(const char* key, std::string& value, const char* means) { this->value({key, means, false, {}, Kind::name}, &value, !value.empty()); }
  void file(const char* key, std::string& value, const char* means) { take({key, means, true, {}, Kind::file}, value); }
  void may_file(const char* key, std::string& value, const char* means) { this->value({key, means, false, {}, Kind::file}, &value, !value.empty()); }
  /// A string or a list of them.
  template <class T> void one_or_more(const char* key, T& list, const char* means) { take({key, means, false, {}, Kind::one_or_more}, list); }
  void must_one_or_more(const char* key, std::vector<std::string>& list, const char* means) { take({key, means, true, {}, Kind::one_or_more}, list); }
  /// A number, or a list of two for unlike materials.
  void one_or_two(const char* key, std::vector<double>& list, const char* means, Range range) {
    value({key, means, false, range, Kind::one_or_two}, &list, !list.empty());
  }
  /// A list of any values, kept as TOML.
  void values(const char* key, std::vector<std::string>& list, const char* means) { value({key, means, false, {}, Kind::values}, &list, false); }
  /// A point, with or without its coordinate along the axis, which is not read.
  void center(const char* key, Vec3& x, int axis, const char* means) { value({key, means, true, {}, Kind::center, {}, axis}, &x, true); }

  /// One of some words. False: it was none of them, or is missing, and that was told.
  template <class T, class W, std::size_t n> bool word(const char* key, T& value, const Word<W> (&known)[n], const char* means, bool needed = false) {
    int at = -1;
    for (std::size_t i = 0; i < n; ++i)
      if (value == known[i].value) at = static_cast<int>(i);
    if (!choose({key, means, needed, {}, Kind::plain, texts(known)}, at)) return false;
    if (at >= 0) value = known[at].value;
    return true;
  }
  template <class T, class W, std::size_t n> bool must_word(const char* key, T& value, const Word<W> (&known)[n], const char* means) {
    return word(key, value, known, means, true);
  }
  /// The same of words that stand for themselves.
  template <std::size_t n> bool word(const char* key, std::string& value, const std::array<const char*, n>& known, const char* means) {
    const auto now = std::find(known.begin(), known.end(), value);
    int at = now == known.end() ? -1 : static_cast<int>(now - known.begin());
    if (!choose({key, means, false, {}, Kind::plain, {known.begin(), known.end()}}, at)) return false;
    if (at >= 0) value = known[at];
    return true;
  }
  /// Some of them, each once.
  template <std::size_t n> void words(const char* key, std::vector<std::string>& list, const std::array<const char*, n>& known, const char* means) {
    value({key, means, false, {}, Kind::words, {known.begin(), known.end()}}, &list, true);
  }
  template <std::size_t n> void words(const char* key, std::optional<std::vector<std::string>>& list, const std::array<const char*, n>& known, const char* means) {
    std::vector<std::string> held = list.value_or(std::vector<std::string>{});
    if (value({key, means, false, {}, Kind::words, {known.begin(), known.end()}}, &held, list.has_value())) list = std::move(held);
  }

  /// Any names that the file likes, each with a number.
  virtual void numbers(NamedNumbers& list) = 0;

  /// [key], may be absent; [[key]], any number.
  template <class T> void table(const char* key, T& t) {
    below(key, {false, 1, [] {}, [&](std::size_t, Keys& keys) -> TablePlace& { return describe(keys, t), t.place; }});
  }
  template <class T> void table(const char* key, std::optional<T>& t) {
    below(key, {false, t.has_value(), [&] { t.emplace(); }, [&](std::size_t, Keys& keys) -> TablePlace& { return describe(keys, *t), t->place; }});
  }
  template <class T> void tables(const char* key, std::vector<T>& list) {
    below(key, {true, list.size(), [&] { list.emplace_back(); },
                [&](std::size_t i, Keys& keys) -> TablePlace& { return describe(keys, list[i]), list[i].place; }});
  }

  /// Keys that there are only with some words of the key `by`. Those of the other choices are refused, as not belonging to `what`.
  struct Choice {
    Names words;
    const char* what;                           // "a circle"
    bool chosen;
    std::function<void()> keys;
  };
  virtual void either(const char* by, const std::vector<Choice>& choices) = 0;
  /// The word that the other keys depend on could not be read: what else is there is not looked at.
  virtual void skip_the_rest() {}

  /// Of these keys one at most.
  virtual void at_most_one(const Names&) {}
  /// Of these keys one at least; `wanted`: what to give.
  virtual void one_at_least(const Names&, const char* /*wanted*/) {}
  /// Keys that are of no use without one of the `needed`, which are `what`.
  virtual void with(const Names& /*keys*/, const Names& /*needed*/, const char* /*what*/) {}

 protected:
  /// Tables below a key: how many there are, how one is added, and what describes the i-th and tells where it stands.
  struct Below {
    bool many;
    std::size_t count;
    std::function<void()> add;
    std::function<TablePlace&(std::size_t, Keys&)> each;
  };
  /// there: whether there is a value yet. True if one was put there.
  virtual bool value(const Key& key, KeyValue value, bool there) = 0;
  /// at: index of the word that stands there, −1 for none.
  virtual bool choose(const Key& key, int& at) = 0;
  virtual void below(const char* key, const Below& tables) = 0;

 private:
  template <class T> void take(const Key& key, T& v) { value(key, &v, true); }
  template <class T> void take(const Key& key, std::optional<T>& v) {
    T held = blank(std::type_identity<T>());
    if (v) held = *v;
    if (value(key, &held, v.has_value())) v = std::move(held);
  }
  template <class T> static T blank(std::type_identity<T>) { return T{}; }
  static Vec3 blank(std::type_identity<Vec3>) { return Vec3::Zero(); }
  template <class W, std::size_t n> static std::vector<std::string> texts(const Word<W> (&known)[n]) {
    std::vector<std::string> all;
    for (const auto& w : known) all.push_back(w.text);
    return all;
  }
};

// Collects what is wrong with a problem file, so that everything is told in one go.

class Mistakes {
 public:
  explicit Mistakes(std::string file) : file_(std::move(file)) {}

  const std::string& file() const { return file_; }
  bool any() const { return !list_.empty(); }
  const std::vector<Mistake>& list() const { return list_; }

  /// A mistake at a place of the file; line 0: of the command line.
  void add(Place at, const std::string& key, const std::string& what) {
    keep({at.line > 0 ? file_ : "--set", at.line, at.column, key, what});
  }
  /// A mistake of a key of a table: at its value if it is written, else at the table.
  void add(const TablePlace& table, const std::string& key, const std::string& what) {
    const auto found = table.keys.find(key);
    add(found == table.keys.end() ? Place{table} : found->second, table.key + "." + key, what);
  }
  /// A mistake of a table as a whole.
  void add(const TablePlace& table, const std::string& what) { add(Place{table}, table.key, what); }
  /// The same, and marks the table as broken.
  void add(TablePlace& table, const std::string& key, const std::string& what) {
    table.broken = true;
    add(static_cast<const TablePlace&>(table), key, what);
  }
  void add(TablePlace& table, const std::string& what) {
    table.broken = true;
    add(static_cast<const TablePlace&>(table), what);
  }
  /// A mistake of the file as a whole.
  void add(const std::string& what) { keep({file_, 0, 0, {}, what}); }
  void add(const std::vector<Mistake>& others) {
    for (const Mistake& m : others) keep(m);
  }
  /// What `read` gives; nothing where it throws InputError, whose mistakes are added.
  template <class Read> auto unless_wrong(const Read& read) -> std::optional<decltype(read())> {
    try {
      return read();
    } catch (const InputError& error) {
      return add(error.mistakes()), std::nullopt;
    }
  }

  /// Throws InputError, which has the order of the file, if there is any.
  void raise() const {
    if (!any()) return;
    std::vector<Mistake> all = list_;
    if (left_out_ > 0)
      all.push_back({file_, 0, 0, {}, "has " + std::to_string(left_out_) + " more mistakes than are told here"});
    throw InputError(std::move(all));
  }

 private:
  static constexpr std::size_t most = 200;   // further ones are counted, not kept
  void keep(Mistake m) {
    if (list_.size() >= most)
      ++left_out_;
    else
      list_.push_back(std::move(m));
  }
  std::string file_;
  std::vector<Mistake> list_;
  std::size_t left_out_ = 0;
};

}  // namespace elamin
