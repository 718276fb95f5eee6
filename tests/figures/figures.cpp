#include "figures/figure.hpp"

#include "catch.hpp"
#include "core/error.hpp"
#include "core/text.hpp"
#include "figures/diagram.hpp"
#include "figures/scene.hpp"
#include "results/stored_run.hpp"
#include "scratch_directory.hpp"

#include <algorithm>
#include <cstdio>
#include <cstdlib>

using namespace elamin;

namespace {

// A path that loses stability at a branch point, goes on, and where it ends snaps; a second branch leaves the branch point.
const std::string path_csv =
    "step,label,branch,lambda,energy,negative,stable,odd_name,height,parent,negative_rigid\n"
    "0,initial,0,0,0,0,true,1,0,,0\n"
    "1,,0,0.1,0,0,true,1,0.1,,0\n"
    "2,branch:1,0,0.2,0,0,false,1,0.2,,0\n"
    "3,limit:1,0,0.3,0,1,false,1,0.4,,0\n"
    "4,jump:1,1,0.3,0,0,true,1,2,limit:1,0\n"
    "5,,2,0.25,0,0,true,1,1,branch:1,0\n"
    "6,final,2,0.35,0,0,true,1,1.5,branch:1,0\n";

std::string sentence(const FigureOptions& options) {
  try {
    write_figure(options);
  } catch (const InputError& error) {
    return error.what();
  }
  return "";
}

std::string said_by(const std::string& command) {
  std::string text;
  std::FILE* pipe = popen(command.c_str(), "r");
  char block[4096];
  for (std::size_t n; (n = std::fread(block, 1, sizeof block, pipe)) > 0;) text.append(block, n);
  pclose(pipe);
  return text;
}

}  // namespace

TEST_CASE("ticks stand at round numbers, with a power of ten where they are large or small", "[figures]") {
  CHECK(ticks_of({0, 1}).labels == std::vector<std::string>{"0.0", "0.2", "0.4", "0.6", "0.8", "1.0"});
  const Ticks small = ticks_of({-2.1e-5, 1e-5});
  CHECK(small.exponent == -5);
  CHECK(small.labels == std::vector<std::string>{"−2.0", "−1.5", "−1.0", "−0.5", "0.0", "0.5", "1.0"});
  CHECK(ticks_of({0.9, 2.1}, true).labels == std::vector<std::string>{"1", "2"});
  const Extent one = with_room({0.3, 0.1 + 0.2});
  CHECK((one.lo < 0.28 && one.hi > 0.32));                           // rounding is no range
}

TEST_CASE("a line loses only what is not seen", "[figures]") {
  Polyline line;
  for (int k = 0; k <= 100; ++k) line.emplace_back(k, k == 50 ? 3 : 0.01 * (k % 2));
  const Polyline rest = thinned(line, 0.05);
  CHECK(rest.size() == 5);
  CHECK(rest[2] == Vec2(50, 3));
  CHECK(thinned(line, 0).size() > 90);
}

TEST_CASE("a path as curves: stable, unstable, a snap, a branch from where it left", "[figures]") {
  ScratchDirectory scratch;
  const Table path = read_table(scratch.file("path.csv", path_csv));
  const Diagram d = path_diagram(path, {}, "path.csv");
  CHECK(d.x == "load factor λ");
  CHECK(d.y == "height");                                            // odd_name never changes
  REQUIRE(d.curves.size() == 4);
  CHECK(d.curves[0].kind == Curve::Kind::stable);
  CHECK(d.curves[0].points == Polyline{{0, 0}, {0.1, 0.1}, {0.2, 0.2}});
  CHECK(d.curves[1].kind == Curve::Kind::unstable);
  CHECK(d.curves[1].points == Polyline{{0.2, 0.2}, {0.3, 0.4}});
  CHECK(d.curves[2].kind == Curve::Kind::snap);
  CHECK(d.curves[2].points == Polyline{{0.3, 0.4}, {0.3, 2}});
  CHECK(d.curves[3].points == Polyline{{0.2, 0.2}, {0.25, 1}, {0.35, 1.5}});
  CHECK((d.curves[3].colour == 1 && d.curves[2].colour == 0));
  REQUIRE(d.marks.size() == 3);
  CHECK(d.marks[0].kind == "branch");
  CHECK(d.marks[2].at == Vec2(0.3, 2));
}

TEST_CASE("stages begin anew along the load factor, and go on along anything else", "[figures]") {
  ScratchDirectory scratch;
  const Table path = read_table(scratch.file("path.csv", "label,branch,lambda,stable,w,parent,stage\ninitial,0,0,true,0,,a\n,0,1,true,1,,a\n"
                                                         ",0,0,true,1,,b\nfinal,0,1,true,3,,b\n"));
  const Diagram d = path_diagram(path, {}, "path.csv");
  REQUIRE(d.curves.size() == 2);
  CHECK(d.curves[1].points == Polyline{{0, 1}, {1, 3}});
  CHECK(d.names == std::vector<std::string>{"a", "b"});
  CHECK(path_diagram(path, {"w", "lambda"}, "path.csv").curves[1].points.size() == 3);
}

TEST_CASE("a sweep: what is swept, and the first event that there is", "[figures]") {
  ScratchDirectory scratch;
  const std::string head = "beam.a.particles,expect.1.value,status,branch:1,limit:1,step,stable,parent\n";
  const Table sweep = read_table(scratch.file("sweep.csv", head + "9,1,done,,0.25,4,true,\n5,2,done,,0.5,3,true,\n"));
  const Diagram d = sweep_diagram(sweep, {}, "sweep.csv");
  CHECK(d.x == "a.particles");
  CHECK(d.y == "load factor λ of limit:1");
  REQUIRE(d.curves.size() == 1);
  CHECK(d.curves[0].points == Polyline{{5, 0.5}, {9, 0.25}});
}

TEST_CASE("a refinement: the distance from the limit, in decades, of what has an order", "[figures]") {
  ScratchDirectory scratch;
  const std::string table = "at,quantity,value,error,order,approach,level_1,level_2,level_3\n"
                            "final,w,2,1e-3,2,asymptotic,2.2,2.02,2\nfinal,force,0,,,none,1,2,1\nlimit:1,lambda,-4,1e-3,1,asymptotic,-3.6,-3.96,-4.0004\n";
  const Diagram d = refinement_diagram(read_table(scratch.file("refine.csv", table)), "refine.csv");
  CHECK(d.decades);
  CHECK(d.names == std::vector<std::string>{"w at final, order 2.00", "lambda at limit:1, order 1.00"});
  REQUIRE(d.curves.size() == 2);
  REQUIRE(d.curves[0].points.size() == 2);                        // what is the limit itself has no logarithm
  CHECK(d.curves[0].points[1].y() == Approx(-2));
  CHECK(d.curves[1].points[2].x() == 3);
  CHECK(d.curves[1].points[2].y() == Approx(-4));
  CHECK(decades_of({-4.5, -1.9}).labels == std::vector<std::string>{"10⁻⁴", "10⁻³", "10⁻²"});
  CHECK(braille(d, 60, 8).find("0.0001") != std::string::npos);
  scratch.file("sweep.csv", "beam.a.particles,status,energy\n9,done,1\n17,done,2\n");
  const auto words = [&](const std::string& y) { return read_text(write_figure({scratch / ".", "", y, {}, true, scratch / "f.svg"})); };
  CHECK(words("").find("w at final") != std::string::npos);
  CHECK(words("energy").find("w at final") == std::string::npos);
}

TEST_CASE("a figure has its words as text, and the same bits twice", "[figures]") {
  ScratchDirectory scratch;
  scratch.file("path.csv", path_csv);
  std::filesystem::create_directories(scratch / "states");
  scratch.file("states/final.particles.csv", "id,kind,x,y,z,radius,energy,fx,fy,fz\n3,particle,0,0,0,0.1,0,0,0,0\n9,particle,1,0,0,0.1,0,0,0,0\n");
  scratch.file("states/final.bonds.csv", "first,second,length,strain,tension\n3,9,1,0.5,-2\n");
  scratch.file("states/final.walls.csv", "name,shape,x,y,z,nx,ny,nz,xlo,ylo,zlo,xhi,yhi,zhi,lo,hi,radius_lo,radius_hi,open\n"
                                         "w,plane,0,0,-0.1,0,0,1,,,,,,,,,,,\n");
  const std::string directory = scratch / ".";
  const std::string file = write_figure({directory, "", "", {"final"}, true, scratch / "a.svg"});
  CHECK(file == scratch / "a.svg");
  const std::string svg = text_of(file);
  CHECK(svg.starts_with("<svg xmlns="));
  CHECK(svg.ends_with("</svg>\n"));
  for (const char* word : {">load factor λ<", ">height<", ">unstable<", ">limit point<", ">final<", ">2  tension<", "width=\"240.94pt\""})
    CHECK(svg.find(word) != std::string::npos);
  CHECK(std::count(svg.begin(), svg.end(), '<') == std::count(svg.begin(), svg.end(), '>'));
  CHECK(svg.find("nan") == std::string::npos);
  write_figure({directory, "", "", {"final"}, true, scratch / "b.svg"});
  CHECK(text_of(scratch / "b.svg") == svg);
  const Scene scene = read_scene(directory, "final");
  REQUIRE((scene.bonds.size() == 1 && scene.walls.size() == 1));
  CHECK(scene.bonds[0].tension == -2);
  CHECK(scene.walls[0].center == Vec3(0, 0, -0.1));
}

TEST_CASE("a figure as PDF: lines, not pixels, and words that can be read", "[figures]") {
  ScratchDirectory scratch;
  scratch.file("path.csv", path_csv);
  FigureOptions options;
  options.directory = scratch / ".", options.file = scratch / "a b's.pdf";
  CHECK(write_figure(options) == options.file);
  CHECK(text_of(options.file).starts_with("%PDF-1."));
  const auto said = [&](const std::string& command) { return said_by(command + " \"" + options.file + "\""); };
  CHECK(said("pdfinfo").find("Page size:       240.94 x ") != std::string::npos);      // as the SVG: 85 mm
  CHECK(said("pdfimages -list").find("image") == std::string::npos);
  CHECK(said("pdfimages -list").find("page") == 0);
  CHECK(said("pdffonts").find(" yes yes yes ") != std::string::npos);      // its fonts are in it
  const std::string words = said_by("pdftotext \"" + options.file + "\" -");
  for (const char* word : {"load factor λ", "height", "unstable", "limit point"}) CHECK(words.find(word) != std::string::npos);
  // What cannot be written, and what is not there.
  options.file = scratch / "none/a.pdf";
  CHECK(sentence(options) == options.file + ": cannot be written: rsvg-convert has failed");
  const std::string path = std::getenv("PATH");
  setenv("PATH", "/nowhere", 1);
  CHECK(sentence(options) == options.file + ": a PDF is made by rsvg-convert, which is not installed; it is in the Debian package librsvg2-bin (an .svg needs "
                                            "nothing)");
  setenv("PATH", path.c_str(), 1);
}

TEST_CASE("a diagram in characters", "[figures]") {
  Diagram d;
  d.x = "t", d.y = "w";
  d.curves = {{{{0, 0}, {10, 4}}, Curve::Kind::stable, 0}, {{{0, 3}, {10, 3}}, Curve::Kind::unstable, 0}, {{{0, 3.5}, {10, 3.5}}, Curve::Kind::snap, 0}};
  d.marks = {{"branch", {0, 0}}, {"bend", {10, 4}}};
  CHECK(braille(d, 23, 3) == "w\n"
                             "4 │⣂⠐⣀⠂⣐ ⣂⠐⣀⠂⣐ ⣂⢐⣀⡢⣴⠒⣒e\n"
                             "  │      ⢀⣀⠤⠤⠒⠒⠉⠁\n"
                             "0 │b⠤⠤⠒⠊⠉⠁\n"
                             "   0        t        10\n"
                             "   e bend, b branch\n");
  d.curves = {{{{2, 5}}, Curve::Kind::points, 0}, {{{4, 5}}, Curve::Kind::points, 0}};
  d.marks = {};
  CHECK(braille(d, 23, 3) == "  w\n"
                             "5.5 │\n"
                             "    │o                o\n"
                             "4.5 │\n"
                             "     2       t        4\n");
}

TEST_CASE("a frame of a path is drawn by its step", "[figures]") {
  ScratchDirectory scratch;
  scratch.file("path.csv", path_csv), scratch.file("resolved.toml", "");
  const std::string head = "id,kind,x,y,z,radius,energy,fx,fy,fz\n";
  for (const auto& [name, z] : {std::pair("frames/1", "0.25"), {"states/branch-1", "0.5"}}) {
    std::filesystem::create_directories((scratch / name).substr(0, (scratch / name).rfind('/')));
    scratch.file(std::string(name) + ".data", ""), scratch.file(std::string(name) + ".particles.csv", head + "3,particle,0,0," + z + ",0.1,0,0,0,0\n");
  }
  scratch.file("states/branch-1.modes.csv", "id,ux1,uy1,uz1\n3,0,0,1\n");
  CHECK(read_scene(scratch / ".", "step=1").particles.at(0).at.z() == 0.25);
  CHECK(read_scene(scratch / ".", "step=2").particles.at(0).at.z() == 0.5);       // a state with a label has a step, too
  CHECK(read_scene(scratch / ".", "step=2").label == "step=2");
  CHECK(read_scene(scratch / ".", "step=2+mode").particles.size() == 1);
  CHECK(sentence({scratch / ".", "", "", {"step=5"}, false, ""}).ends_with(
      "no state of step 5 was kept; there are those of the steps 1, 2 ([path] frames or every keep more)"));
}

TEST_CASE("what is missing for a figure is said", "[figures]") {
  ScratchDirectory scratch;
  FigureOptions options;
  options.directory = scratch / "none";
  CHECK(sentence(options).find("none: is not a directory of results: there is no path.csv") != std::string::npos);
  options.directory = scratch / ".";
  scratch.file("path.csv", path_csv);
  options.y = "heigth";
  CHECK(sentence(options).find("has no column \"heigth\"; there are: step, label") != std::string::npos);
  CHECK(sentence(options).find("did you mean \"height\"?") != std::string::npos);
  options.y = "", options.shapes = {"limit:1"};
  CHECK(sentence(options).find("limit-1.particles.csv: is not there; this run has left no such states") != std::string::npos);
  std::filesystem::create_directories(scratch / "states");
  std::filesystem::create_directories(scratch / "modes");
  scratch.file("states/final.particles.csv", "id,kind,x,y,z,radius\n");
  options.shapes = {"mode:1"};
  CHECK(sentence(options).find(": has no \"mode:1\"; it has no modes") != std::string::npos);
  scratch.file("modes/mode-1.csv", "id,ux,uy,uz\n");
  options.shapes = {"mode:2"};
  CHECK(sentence(options).find(": has no \"mode:2\"; there are mode:1 to mode:1") != std::string::npos);
  options.shapes = {"final+mode"};
  CHECK(sentence(options).find(": the state \"final\" has no null vectors to be moved along, final.modes.csv; events have them") != std::string::npos);
  options.shapes = {}, options.file = "f.png";
  CHECK(sentence(options) == "f.png: a figure is an SVG or a PDF; a name that ends in .svg or .pdf is needed");
  CHECK(!std::filesystem::exists(scratch / "figure.svg"));
}
