#include "results/terminal.hpp"

#include "catch.hpp"
#include "results/columns.hpp"
#include "results/sample.hpp"
#include "scratch_directory.hpp"

#include <algorithm>

using namespace elamin;

namespace {

/// What is shown of a path of 1000 steps with an event at step 500.
std::string shown(Progress::Style style) {
  ScratchDirectory scratch;
  const std::string file = scratch / "out";
  std::FILE* out = std::fopen(file.c_str(), "w");
  REQUIRE(out != nullptr);
  {
    const Model m = sample_model();
    Progress progress(out, style, 0, 1);
    for (int i = 0; i <= 1000; ++i) {
      PathPoint p = sample_point(m, i, i / 1000.0, i == 500 ? "branch:1" : "");
      if (i == 500) p.what = "ball 1 touches wall floor";
      progress.show(p, i < 500 ? 0 : 12);
    }
  }
  std::fclose(out);
  return text_of(file);
}

}  // namespace

TEST_CASE("a line of progress has step, load factor, energy, residual and stability", "[progress]") {
  const Model m = sample_model();
  PathPoint p = sample_point(m, 17, 0.125);
  CHECK(progress_line(p).find("step   17  load factor 0.125 ") == 0);
  CHECK(progress_line(p).find("residual 3e-14  stable  4 iterations") != std::string::npos);
  CHECK(progress_line(p).size() < 100);
  CHECK(progress_line(p, 1).ends_with("4 iterations  1 contact"));
  p.stability.stable = false, p.label = "limit:1";
  CHECK(progress_line(p).find("critical  limit:1") != std::string::npos);
  p.stability.negative = 2;
  CHECK(progress_line(p).find("unstable (2)  limit:1") != std::string::npos);
}

TEST_CASE("progress is quiet, sparse in a file, and one line on a terminal", "[progress]") {
  CHECK(shown(Progress::Style::silent).empty());
  const std::string plain = shown(Progress::Style::plain);
  const auto lines = std::count(plain.begin(), plain.end(), '\n');
  CHECK(lines >= 11);                                       // the first and every tenth
  CHECK(lines <= 40);                                       // more only if this takes many seconds
  CHECK(plain.find("branch:1") != std::string::npos);
  CHECK(plain.find('\r') == std::string::npos);
  const std::string terminal = shown(Progress::Style::terminal);
  CHECK(std::count(terminal.begin(), terminal.end(), '\n') == 1);      // the event stays
  CHECK(terminal.find("\rload factor 0.5            branch:1  ball 1 touches wall floor\x1b[K\n\r████████        ▏ 50 %  load factor 0.5  stable  step 500  12 contacts\x1b[K") != std::string::npos);
  CHECK(terminal.ends_with("\r\x1b[K"));
  ScratchDirectory scratch;
  std::FILE* out = std::fopen((scratch / "out").c_str(), "w");
  CHECK(Progress::style_for(out, true) == Progress::Style::silent);
  CHECK(Progress::style_for(out, false) == Progress::Style::plain);
  std::fclose(out);
}

TEST_CASE("the bar goes on through the stages, and what does not fit is left out", "[progress]") {
  ScratchDirectory scratch;
  std::FILE* out = std::fopen((scratch / "out").c_str(), "w");
  {
    Progress progress(out, Progress::Style::terminal, 0, 1);
    progress.enter(1, 4, 2, 1);
    progress.wait("at work on what comes after step 3", {"12 s at work", "iteration 7", std::string(40, 'x'), "y"});
    progress.keep("a line");
    progress.show(std::string(80, 'x'), 1.5);               // half of the second of four
  }
  std::fclose(out);
  CHECK(text_of(scratch / "out") == "\r████            ▏ 25 %  12 s at work  iteration 7  y\x1b[K\ra line\x1b[K\n\r██████          ▏ 37 %\x1b[K\r\x1b[K");
}

TEST_CASE("what has no way to go has no bar", "[progress]") {
  ScratchDirectory scratch;
  std::FILE* out = std::fopen((scratch / "out").c_str(), "w");
  Progress(out, Progress::Style::terminal, 1, 1).wait("", {"12 s at work", "iteration 7"});
  std::fclose(out);
  CHECK(text_of(scratch / "out") == "\r12 s at work  iteration 7\x1b[K\r\x1b[K");
}

TEST_CASE("the closing table lists the events", "[progress]") {
  const Model m = sample_model();
  Table events{event_columns({}), {}};
  CHECK(closing_table(events) == "No events on the path.\n");
  PathPoint p = sample_point(m, 2, 0.123456789012, "branch:1");
  p.multiplicity = 2, p.what = "ball 3 touches wall floor";
  events.rows.push_back(event_row(p, {}));
  const std::string text = closing_table(events);
  CHECK(std::count(text.begin(), text.end(), '\n') == 2);
  CHECK(text.find("branch:1") != std::string::npos);
  CHECK(text.find("0.123456789 ") != std::string::npos);
  CHECK(text.find("ball 3 touches wall floor\n") != std::string::npos);
  CHECK(text.find(" \n") == std::string::npos);
  while (events.rows.size() < 1000) events.rows.push_back(events.rows.front());
  const std::string most = closing_table(events);
  CHECK(std::count(most.begin(), most.end(), '\n') == 37);
  CHECK(most.ends_with("… and 965 more in events.csv\n"));
}

TEST_CASE("what is not a path closes with its values or its modes", "[progress]") {
  const Model m = sample_model();
  Table path{path_columns({"mid", "force_of_all"}), {}};
  CHECK(closing_values(path, {"mid"}).empty());
  PathPoint p = sample_point(m, 0, 1, "final");
  p.stability.stable = false;
  path.rows.push_back(path_row(p, {0.25, -3}));
  const std::string text = closing_values(path, {"mid", "force_of_all"});
  CHECK(text.ends_with("residual 3e-14  not stable\n  mid           0.25\n  force_of_all  -3\n"));
  CHECK(closing_modes({}).empty());
  CHECK(closing_modes({{-2.5, "", {}}, {0, "translation of 'a' along x", {}}}) ==
        "mode        eigenvalue\n   1              -2.5\n   2                 0  translation of 'a' along x\n");
}
