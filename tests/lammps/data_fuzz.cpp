// LAMMPS data files that are damaged in every way: each is read, or refused with a sentence and its line; none crashes,
// hangs or asks for more memory than a file of its size is worth.
#include "catch.hpp"
#include "core/error.hpp"
#include "lammps/data.hpp"
#include "lammps/small_data_file.hpp"
#include "processor_time.hpp"
#include "scratch_directory.hpp"

#include <cstring>
#include <filesystem>
#include <random>

#include <sys/resource.h>

using namespace elamin;

namespace {

/// Reads one text after another and holds what comes of it against what must hold of everything that is read.
class Attempts {
 public:
  int read = 0, refused = 0;

  void operator()(const std::string& text, const std::string& style = "") {
    // A new file each time: a file system may wait for its disk where an old one is overwritten.
    const std::string file = scratch_.file(std::to_string(read + refused) + ".data", text);
    try {
      check(read_lammps_data(file, style));
      ++read;
    } catch (const InputError& e) {
      REQUIRE_FALSE(e.mistakes().empty());
      REQUIRE(e.mistakes().size() <= 21);
      for (const Mistake& m : e.mistakes()) {
        const bool whole = m.what.find("binary") != std::string::npos;   // of the file, not of a line
        REQUIRE((whole || (m.line >= 1 && m.column >= 1)));
        REQUIRE_FALSE(m.what.empty());
      }
      ++refused;
    }
    std::filesystem::remove(file);
  }

 private:
  static void check(const LammpsData& data) {
    const auto n = static_cast<int>(data.id.size());
    REQUIRE(n > 0);
    REQUIRE(data.position.cols() == n);
    REQUIRE(data.position.allFinite());
    REQUIRE((data.velocity.cols() == 0 || (data.velocity.cols() == n && data.velocity.allFinite())));
    for (const BondType& t : data.bond_types) REQUIRE((t.stiffness >= 0 && t.rest_length >= 0));
    for (const AngleType& t : data.angle_types) REQUIRE((t.stiffness >= 0 && t.rest >= 0 && t.rest <= 3.1416));
    for (const Bond& b : data.bonds) {
      REQUIRE((b.type >= 0 && b.type < static_cast<int>(data.bond_types.size())));
      for (const int i : b.particles) REQUIRE((i >= 0 && i < n));
    }
    for (const Angle& a : data.angles) {
      REQUIRE((a.type >= 0 && a.type < static_cast<int>(data.angle_types.size())));
      for (const int i : a.particles) REQUIRE((i >= 0 && i < n));
    }
  }

  ScratchDirectory scratch_;
};

/// Words that stand where others should.
const std::vector<std::string> tokens{
    "", "0", "-1", "1e999", "nan", "inf", "99999999999999999999", "2147483647", "Atoms", "Bonds", "x", "\n",
    "#", "\r", "1e-999", "-0", "atoms", "\t", "Atoms # hybrid", "\xff", "Bond Coeffs", "Masses", "harmonic",
    "2147483648", "1.5", "bond types"};

/// Largest memory so far [bytes].
double memory() {
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  return 1024.0 * static_cast<double>(usage.ru_maxrss);
}

std::string with_shift() {
  std::string text = small_data_file;
  text.replace(text.find("# cosine\n\n1 5\n"), std::strlen("# cosine\n\n1 5\n"), "# cosine/shift\n\n1 5 150\n");
  return text;
}

}  // namespace

TEST_CASE("a data file that ends anywhere", "[lammps_data][fuzz]") {
  Attempts attempt;
  for (const std::string& text : {small_data_file, with_shift()})
    for (std::size_t n = 0; n <= text.size(); ++n) attempt(text.substr(0, n));
  // Whole, without the last end of line, and where the last id loses none of its digits.
  CHECK(attempt.read == 4);
  CHECK(attempt.refused > 600);
}

TEST_CASE("a data file with any byte wrong", "[lammps_data][fuzz]") {
  Attempts attempt;
  const std::string text = with_shift();
  for (std::size_t i = 0; i < text.size(); ++i)
    for (const char c : {'\0', '\n', ' ', '#', '-', '9', 'x', '\xff'}) {
      std::string damaged = text;
      damaged[i] = c;
      attempt(damaged);
    }
  std::mt19937 random(7);
  for (int k = 0; k < 3000; ++k) {
    std::string damaged = text;
    for (unsigned flips = 1 + random() % 4; flips > 0; --flips)
      damaged[random() % damaged.size()] ^= static_cast<char>(1u << (random() % 8));
    attempt(damaged);
  }
  CHECK(attempt.read > 300);        // both ends are reached
  CHECK(attempt.refused > 3000);
}

TEST_CASE("a data file with any word another one", "[lammps_data][fuzz]") {
  Attempts attempt;
  for (const std::string& text : {small_data_file, with_shift()})
    for (std::size_t begin = text.find_first_not_of(" \n"); begin != std::string::npos;) {
      const std::size_t end = std::min(text.find_first_of(" \n", begin), text.size());
      for (const std::string& token : tokens) attempt(text.substr(0, begin) + token + text.substr(end));
      begin = text.find_first_not_of(" \n", end);
    }
  CHECK(attempt.read > 300);
  CHECK(attempt.refused > 1000);
}

TEST_CASE("numbers that are far too large ask for no memory", "[lammps_data][fuzz]") {
  Attempts attempt;
  const double before = memory();
  for (const char* word :
       {"2147483647", "2147483648", "9223372036854775807", "99999999999999999999999999", "1e300", "nan", "-inf"})
    for (const char* place : {"3 atoms", "2 bonds", "1 angles", "1 atom types", "1 bond types", "1 angle types",
                              "1 1 1 2 4", "4 1 0 0 3", "1 100 1", "2 1 2 4"}) {
      std::string text = small_data_file;
      const std::size_t at = text.find(place);
      REQUIRE(at != std::string::npos);
      text.replace(at, text.find(' ', at) - at, word);
      attempt(text);
    }
  CHECK(attempt.refused > 50);
#ifndef __SANITIZE_ADDRESS__           // which keeps what was freed
  CHECK(memory() < before + 50e6);
#else
  (void)before;
#endif
}

TEST_CASE("files of real cases, damaged", "[lammps_data][fuzz]") {
  Attempts attempt;
  std::mt19937 random(20211);
  const auto pick = [&](std::size_t n) { return static_cast<std::size_t>(random() % n); };
  int files = 0;
  for (const auto& entry : std::filesystem::directory_iterator(std::string(ELAMIN_ROOT) + "/data/lammps")) {
    const std::string file = (entry.path() / "case.data").string();
    if (!entry.is_directory() || !std::filesystem::exists(file) || std::filesystem::file_size(file) > 40000) continue;
    ++files;
    const std::string text = text_of(file);
    for (int k = 0; k < 20; ++k) {
      attempt(text.substr(0, pick(text.size())));
      const std::size_t begin = text.find_first_not_of(" \n", pick(text.size() - 40));
      const std::size_t end = text.find_first_of(" \n", begin);
      attempt(text.substr(0, begin) + tokens[pick(tokens.size())] + text.substr(end));
      std::string damaged = text;
      damaged[pick(text.size())] = static_cast<char>(random());
      attempt(damaged);
      const std::size_t a = pick(text.size()), b = pick(text.size());   // a piece taken out, or twice
      attempt(text.substr(0, a) + text.substr(b));
    }
    for (const char* style : {"atomic", "sphere", "full", "hybrid", "hybrid angle sphere", "wheel", "hybrid  "})
      attempt(text, style);
  }
  CHECK(files >= 5);
  CHECK(attempt.read > 5);
  CHECK(attempt.refused > 300);
}

TEST_CASE("a long file of mistakes is refused soon", "[lammps_data][fuzz]") {
  Attempts attempt;
  std::string text = "title\n500000 atoms\n500000 bonds\n2 atom types\n500000 bond types\n\nAtoms # atomic\n\n";
  for (int i = 1; i <= 500000; ++i) text += std::to_string(i) + " 1 0 0 0\n";
  text += "Bonds\n\n";
  for (int i = 1; i <= 500000; ++i) text += std::to_string(i) + " " + std::to_string(i) + " 1 2\n";
  const std::clock_t start = std::clock();
  attempt(text);                       // every bond has a type without coefficients
  CHECK(attempt.refused == 1);
  CHECK(processor_seconds(start) < 20);
}
