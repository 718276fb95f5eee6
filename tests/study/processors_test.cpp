// Kinds of processors have BLAS of their own, which round otherwise: the events and what they are at stay the same.
#include "catch.hpp"
#include "scratch_directory.hpp"
#include "study/results_of.hpp"

#include <array>
#include <cmath>
#include <cstdlib>

#if defined(__x86_64__) && !defined(__SANITIZE_ADDRESS__)   // the kinds are of x86; under sanitizers it would take many times as long

TEST_CASE("events and the end of a path are the same with the kernels of other processors, to 1e-12 in load factor and energy", "[processors]") {
  const std::string flags = text_of("/proc/cpuinfo");
  const auto can = [&](const char* flag) { return flags.find(flag) != std::string::npos; };
  std::vector<std::string> kinds{"Nehalem"};
  if (can(" avx2")) kinds.insert(kinds.end(), {"Haswell", "Zen"});
  if (can(" avx512f")) kinds.push_back("SkylakeX");
  for (const std::string problem : {"truss_low", "hencky_clamped", "ring_pinched", "column_self_contact", "beam_in_tube"}) {
    const ScratchDirectory scratch;
    std::vector<std::string> labels;
    std::vector<std::array<double, 2>> first;
    for (const std::string& kind : kinds) {
      INFO(problem << " by the kernels of " << kind);
      setenv("OPENBLAS_CORETYPE", kind.c_str(), 1);
      const Answer answer = program_says("'" ELAMIN_ROOT "/problems/" + problem + ".toml' --quiet --threads 1 -o '" + (scratch / kind) + "'");
      unsetenv("OPENBLAS_CORETYPE");
      REQUIRE(answer.status == 0);
      std::vector<TableRow> rows = table_of(scratch / (kind + "/events.csv"));
      rows.push_back(table_of(scratch / (kind + "/path.csv")).back());
      std::vector<std::string> here;
      std::vector<std::array<double, 2>> values;
      for (const TableRow& row : rows) here.push_back(row.text("label")), values.push_back({row["lambda"], row["energy"]});
      if (first.empty()) labels = here, first = values;
      REQUIRE(here == labels);
      for (std::size_t c = 0; c < 2; ++c) {
        double largest = 0;
        for (const auto& v : first) largest = std::max(largest, std::abs(v[c]));
        for (std::size_t k = 0; k < first.size(); ++k) CHECK(std::abs(values[k][c] - first[k][c]) <= 1e-12 * largest);
      }
    }
  }
}

#endif
