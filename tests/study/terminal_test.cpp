// What the program shows on a terminal, and in a pipe.
#include "catch.hpp"
#include "scratch_directory.hpp"
#include "study/column.hpp"
#include "study/program.hpp"

#include <nlohmann/json.hpp>

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <pty.h>
#include <unistd.h>

namespace {

const std::string held = "[[support]]\ngroup = \"bottom\"\n[[support]]\ngroup = \"top\"\ndisplacement = [0, 0, -0.4e-3]\n";
const std::string mid = "[[group]]\nname = \"mid\"\nof = \"column\"\nmiddle = 2\n[[observe]]\nname = \"x\"\ngroup = \"mid\"\nquantity = \"position.x\"\n";
const std::string pushed_in_steps = column_and_ends + held + mid + "[path]\nsteps = 10\n";

/// What `elamin ARGUMENTS` writes to a terminal of so many columns.
std::string on_terminal(std::vector<std::string> arguments, const char* kind, const char* no_color, int columns = 100) {
  winsize size{};
  size.ws_col = static_cast<unsigned short>(columns), size.ws_row = 40;
  int terminal = -1;
  const pid_t child = forkpty(&terminal, nullptr, nullptr, &size);
  if (child == 0) {
    setenv("TERM", kind, 1), setenv("NO_COLOR", no_color, 1);
    arguments.insert(arguments.begin(), ELAMIN_PROGRAM);
    std::vector<char*> pointers;
    for (std::string& a : arguments) pointers.push_back(a.data());
    pointers.push_back(nullptr);
    execv(ELAMIN_PROGRAM, pointers.data());
    _exit(127);
  }
  std::string text;
  char block[4096];
  for (ssize_t n; (n = read(terminal, block, sizeof block)) > 0;) text.append(block, static_cast<std::size_t>(n));
  close(terminal);
  int status = 0;
  waitpid(child, &status, 0);
  CHECK(WIFEXITED(status));
  CHECK(WEXITSTATUS(status) == 0);
  return text;
}

bool has(const std::string& text, const std::string& part) { return text.find(part) != std::string::npos; }

std::size_t letters(const std::string& text) {
  return static_cast<std::size_t>(std::count_if(text.begin(), text.end(), [](char c) { return (static_cast<unsigned char>(c) & 0xC0) != 0x80; }));
}

}  // namespace

TEST_CASE("a terminal has a line that is overwritten, colours where they are wanted, and the end in sentences", "[terminal]") {
  const ScratchDirectory scratch;
  const std::string file = scratch.file("p.toml", pushed_in_steps), out = scratch / "out";
  const std::string colours = on_terminal({file, "-o", out}, "xterm", "");
  INFO(colours);
  CHECK(has(colours, "▏  0 %  load factor 0  \x1b[32mstable\x1b[0m"));
  CHECK(has(colours, "\x1b[1mbranch:1\x1b[0m"));
  CHECK(has(colours, "\x1b[1mevent "));
  CHECK(has(colours, "\x1b[32mdone\x1b[0m: "));
  CHECK(has(colours, "written: " + out + "\r\n"));
  CHECK(has(colours, "next: elamin report " + out + " (a page to look at), elamin plot " + out + " (a figure)"));
  const std::string plain = on_terminal({file, "-o", out}, "xterm", "1");
  CHECK(has(plain, "\r████"));
  CHECK(!has(plain, "\x1b[3"));
  CHECK(!has(plain, "\x1b[1m"));
  // Of a narrow terminal no line that is overwritten reaches the last column.
  const std::string narrow = on_terminal({file, "-o", out}, "xterm", "1", 40);
  std::size_t bars = 0;
  for (std::size_t at = narrow.find("▏"); at != narrow.npos; at = narrow.find("▏", at + 1)) {
    const std::size_t begin = narrow.rfind('\r', at) + 1, end = narrow.find("\x1b[K", at);
    CHECK(letters(narrow.substr(begin, end - begin)) < 40);
    ++bars;
  }
  CHECK(bars > 0);
  const std::string dumb = on_terminal({file, "-o", out}, "dumb", "");
  CHECK(!has(dumb, "\x1b"));
  CHECK(has(dumb, "step    0  load factor 0 "));
}

TEST_CASE("a diagram in the terminal", "[terminal]") {
  const ScratchDirectory scratch;
  const Answer answer = elamin_says("'" + scratch.file("p.toml", pushed_in_steps) + "' --plot");
  INFO(answer.text);
  REQUIRE(answer.status == 0);
  CHECK(has(answer.text, "load factor λ"));
  CHECK(has(answer.text, "⣀") + has(answer.text, "⠤") + has(answer.text, "⠒") + has(answer.text, "⠉") > 0);
  CHECK(has(answer.text, "b branch, j jump"));
}

TEST_CASE("what is no path does not speak of one", "[terminal]") {
  const ScratchDirectory scratch;
  const std::string file = scratch.file("p.toml", column_and_ends + held + mid);
  const Answer equilibrium = elamin_says("'" + file + "'");
  INFO(equilibrium.text);
  CHECK(equilibrium.status == 0);
  CHECK(equilibrium.text.starts_with("energy "));
  CHECK(has(equilibrium.text, "\n  x  "));
  for (const char* word : {"path", "event", "load factor"}) CHECK(!has(equilibrium.text.substr(0, equilibrium.text.find("written")), word));
  const Answer modes = elamin_says("'" + file + "' --set study.type=modes --set modes.count=3");
  INFO(modes.text);
  CHECK(modes.status == 0);
  const auto rows = csv_rows(scratch / "p/modes.csv");
  REQUIRE(rows.size() == 4);
  CHECK(modes.text.starts_with("mode        eigenvalue\n"));
  char first[32];
  std::snprintf(first, sizeof first, "\n   1  %16.10g\n", std::stod(rows[1][1]));
  CHECK(has(modes.text, first));
}

TEST_CASE("strains that leave what the model means are told of, and whose they are", "[terminal]") {
  const ScratchDirectory scratch;
  const std::string bar = "[[beam]]\nname = \"bar\"\nparticles = 5\nfrom = [0, 0, 0]\nto = [4, 0, 0]\ndiameter = 1\nyoungs_modulus = 1000\n[[group]]\nname = \"foot\"\n"
                          "of = \"bar\"\nfirst = 2\n[[support]]\ngroup = \"foot\"\n[[load]]\ngroup = \"bar\"\nforce = ";
  // N = 3 F in the bond of the second and third particle, K = πE/8: strain 3 F / (2 K) = 12 F/(πE).
  const std::string file = scratch.file("p.toml", bar + "[200, 0, 0]\n[path]\nsteps = 10\n");
  const Answer answer = elamin_says("'" + file + "'");
  INFO(answer.text);
  CHECK(answer.status == 0);
  CHECK(has(answer.text, "warning: the bond of bar 2 and bar 3 is strained by 0.764 at load factor 1, above 0.1 from load factor 0.2 on; "));
  const auto summary = nlohmann::json::parse(text_of(scratch / "p/summary.json"));
  REQUIRE(summary["warnings"].size() == 1);
  CHECK(has(answer.text, "warning: " + summary["warnings"][0].get<std::string>() + "\n"));
  CHECK(has(text_of(scratch / "p/log.txt"), "warning: the bond of bar 2"));
  // As little as 1/8 of it is still small.
  CHECK(!has(elamin_says("'" + file + "' --set load.1.force='[25, 0, 0]'").text, "warning"));
  CHECK(nlohmann::json::parse(text_of(scratch / "p/summary.json"))["warnings"].empty());
  const Answer bent = elamin_says("'" + scratch.file("q.toml", bar + "[0, 0, 40]\n") + "'");
  INFO(bent.text);
  CHECK(has(bent.text, "warning: the angle at bar 2 is bent by "));
  const Answer friction = elamin_says("'" + file + "' --set load.1.force='[25, 0, 0]' --set viscosity.1.coefficient=1");
  CHECK(friction.status == 1);                                   // there is none
  const std::string drag = scratch.file("r.toml", bar + "[25, 0, 0]\n[[contact]]\nbetween = [\"bar\", \"bar\"]\neffective_modulus = 1\ndamping = \"velocity\"\ndamping_coefficient = 1\nfriction = 0.5\n[[viscosity]]\n"
                                                        "coefficient = 1\n");
  for (const char* command : {"", "check "}) {
    const Answer idle = elamin_says(command + ("'" + drag + "'"));
    INFO(idle.text);
    CHECK(idle.status == 0);
    CHECK(has(idle.text, "warning: " + drag + ":22:12: contact.1.friction: acts in dynamics only; in this study, of equilibria, it does nothing\n"));
    CHECK(has(idle.text, "contact.1.damping: acts in dynamics only"));
    CHECK(has(idle.text, "viscosity.1.coefficient: acts in dynamics only"));
  }
}

TEST_CASE("words of the command line that mean nothing", "[terminal]") {
  const ScratchDirectory scratch;
  const std::string file = scratch.file("p.toml", pushed_in_steps), quoted = "'" + file + "'";
  const auto says = [&](const std::string& arguments, const std::string& sentence) {
    const Answer answer = elamin_says(arguments);
    INFO(arguments << "\n" << answer.text);
    CHECK(answer.status == 1);
    CHECK(has(answer.text, sentence));
    CHECK(answer.text.size() < 600);
    CHECK(!std::filesystem::exists(scratch / "p"));
  };
  says("chekc " + quoted, "chekc: is no command and no file; did you mean \"check\"?");
  says("veryfy", "veryfy: is no command and no file; did you mean \"verify\"?");
  says("'" + (scratch / "p'"), "p: is no problem file; did you mean \"" + file + "\"?");
  says("no-such-file.toml", "no-such-file.toml: there is no such file");
  says(quoted + " " + quoted, "is one word too many; a run has one problem file");
  says("check " + quoted + " " + quoted, "is one word too many");
  says(quoted + " --set path.steps=3 path.to=2", "path.to=2: every KEY=VALUE needs a --set of its own: --set path.to=2");
  says("--set path.steps=3 path.to=2 " + quoted, "path.to=2: every KEY=VALUE needs a --set of its own: --set path.to=2");
  says("check " + quoted + " --set path.steps=3 path.to=2", "path.to=2: every KEY=VALUE needs a --set of its own");
  says(quoted + " --outptu x", "--outptu: is no option; there are: ");
  says(quoted + " --outptu x", "; did you mean \"--output\"?");
  says(quoted + " --threads 0", "--threads: must be a positive integer, is 0");
  for (const char* wrong : {"nan", "inf", "-inf", "x"}) says("energy " + quoted + " --lambda " + wrong, std::string("--lambda: must be a finite number, is ") + wrong);
  says("compare " + quoted + " --limit 0", "--limit: must be a positive number, is 0");
}

TEST_CASE("results are read whatever stands in the title", "[terminal]") {
  const ScratchDirectory scratch;
  const std::string quoted = "'" + scratch.file("p.toml", pushed_in_steps) + "'", out = "'" + (scratch / "out") + "'";
  for (const char* title : {"a\\u007fb", "a\\u0001b", "a</script>\\nb", "\\ufffe"}) {
    CAPTURE(title);
    REQUIRE(elamin_says(quoted + " --quiet -o " + out + " --set 'title=\"" + title + "\"'").status == 0);
    for (const char* command : {"report ", "plot "}) {
      const Answer answer = elamin_says(command + out);
      INFO(answer.text);
      CHECK(answer.status == 0);
    }
  }
}
