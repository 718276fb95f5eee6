// Scripts that are damaged in every way: each is read, or refused with a sentence; none crashes or hangs.
#include "catch.hpp"
#include "lammps/script_reading.hpp"

#include <random>

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

/// Reads one text after another; what is read becomes a problem.
struct ScriptAttempts {
  int read = 0, refused = 0;
  ScratchDirectory scratch;

  void operator()(const std::string& text) {
    const std::string file = scratch.file(std::to_string(read + refused) + ".lmp", text);
    script::ReadingOptions options;
    options.skip = (read + refused) % 2;
    options.most_commands = 5000;
    try {
      const script::Reading r = script::read_script(file, options);
      for (const script::Pass& p : r.passes) {
        const script::Translated t = script::translated(r, p, {}, "p.data");
        REQUIRE(t.toml.starts_with("# Written by elamin import"));
        for (const char* number : {"= nan", "= -nan", "= inf", "= -inf", "[nan", "[-nan", "[inf", "[-inf", ", nan", ", -nan", ", inf", ", -inf"}) {
          INFO(t.toml);
          REQUIRE(without_remarks(t.toml).find(number) == std::string::npos);
        }
        REQUIRE(t.data.find(" nan") == std::string::npos);
      }
      REQUIRE_FALSE(script::report(r, {}).empty());
      ++read;
    } catch (const InputError& e) {
      REQUIRE_FALSE(e.mistakes().empty());
      REQUIRE(e.mistakes().size() <= 21);
      for (const Mistake& m : e.mistakes()) REQUIRE_FALSE(m.what.empty());
      ++refused;
    }
    std::filesystem::remove(file);
  }
};

const std::vector<std::string> script_words{"",     "0",      "-1",    "1e999", "nan",   "99999999999999999999", "*",    "2*",    "*0",      "all",  "$x",     "${d}", "$(1/0)", "v_x",
                                            "\"",   "'",      "\"\"\"", "&\n",   "#",     "\n",                   "NULL", "INF",   "EDGE",    "SELF", "delete", "\t",   "\xff",   "1e-320",
                                            "loop", "region", "label", "run 5", "units", "1e20",                 "clear", "group all id 1", "fix 1 all nve", "$(xcm(all,x))"};

}  // namespace

TEST_CASE("damaged scripts are read or refused", "[script][fuzz]") {
  ScriptAttempts attempt;
  std::mt19937 random(20261);
  const auto pick = [&](std::size_t n) { return static_cast<std::size_t>(random() % n); };
  std::vector<std::string> texts;
  for (const char* name : {"column", "grains", "glued", "stages"}) texts.push_back(text_of(std::string(ELAMIN_ROOT) + "/data/lammps/scripts/" + name + ".lmp"));
  for (int k = 0; k < 10000; ++k) {
    std::string text = texts[pick(texts.size())];
    for (unsigned changes = 1 + random() % 3; changes > 0; --changes) {
      const std::size_t at = pick(text.size());
      switch (random() % 5) {
        case 0: text[at] = static_cast<char>(random()); break;
        case 1: {                                 // a word is another one
          const std::size_t begin = std::min(text.find_first_not_of(" \n", at), text.size()), end = std::min(text.find_first_of(" \n", begin), text.size());
          text = text.substr(0, begin) + script_words[pick(script_words.size())] + text.substr(end);
          break;
        }
        case 2: {                                 // a line is gone, or twice
          const std::size_t begin = std::min(text.find('\n', at), text.size() - 1) + 1, end = std::min(text.find('\n', begin), text.size());
          if (random() % 2) text.erase(begin, end - begin);
          else text.insert(begin, text.substr(begin, end - begin) + "\n");
          break;
        }
        case 3: text = text.substr(0, at); break;
        default: {                                // a line of another script
          const std::string& other = texts[pick(texts.size())];
          const std::size_t begin = std::min(other.find('\n', pick(other.size())), other.size() - 1) + 1, end = std::min(other.find('\n', begin), other.size());
          text.insert(std::min(text.find('\n', at), text.size()), "\n" + other.substr(begin, end - begin));
        }
      }
      if (text.empty()) text = "\n";
    }
    attempt(text);
  }
  CHECK(attempt.read > 1000);                     // both ends are reached
  CHECK(attempt.refused > 1000);
}
