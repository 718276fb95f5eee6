#include "results/frame_choice.hpp"

#include "catch.hpp"
#include "results/sample.hpp"

#include <cmath>
#include <set>

using namespace elamin;

namespace {

/// The steps that are kept of a path; most: the largest number without label that were kept at once.
struct Kept {
  explicit Kept(const PathTable& path, double size = 1, int stages = 1) : choice(path, size, stages) { choice.enter(path); }
  void add(const PathPoint& point) {
    if (choice.take(point)) steps.insert(point.step);
    if (!point.label.empty()) labelled.insert(point.step);
    drop(choice.dropped());
    most = std::max(most, steps.size() - labelled.size());
  }
  void end() { drop(choice.dropped_at_end()); }
  void drop(const std::vector<int>& dropped) {
    for (const int step : dropped) {
      CHECK(steps.erase(step) == 1);
      CHECK(labelled.count(step) == 0);
    }
  }
  FrameChoice choice;
  std::set<int> steps, labelled;
  std::size_t most = 0;
};

PathTable frames(int n, PathMethod method = PathMethod::load_steps) {
  PathTable t;
  t.frames = n, t.method = method;
  return t;
}

PathPoint at(int step, double lambda, const std::string& label = "") { return sample_point(sample_model(), step, lambda, label); }

}  // namespace

TEST_CASE("frames of a whole path by load steps are exactly even", "[frames]") {
  Kept kept(frames(21));
  for (int k = 0; k <= 100; ++k) kept.add(at(k, k * 0.01, k == 0 ? "initial" : k == 100 ? "final" : ""));
  kept.end();
  std::set<int> every_fifth;
  for (int k = 0; k <= 100; k += 5) every_fifth.insert(k);
  CHECK(kept.steps == every_fifth);
  CHECK(kept.most <= 84);
}

TEST_CASE("frames of a path that breaks off are even, as far as its points allow", "[frames]") {
  for (const int last : {25, 37, 59, 83, 99}) {
    INFO(last);
    Kept kept(frames(6));
    for (int k = 0; k <= last; ++k) kept.add(at(k, k * 0.01, k == 0 ? "initial" : k == last ? "final" : ""));
    kept.end();
    CHECK(kept.most <= 24);
    REQUIRE(kept.steps.size() == 6);
    int n = 0;
    for (const int step : kept.steps) CHECK(std::abs(step - last * n++ / 5.0) <= last / 5.0 / 4);      // half a piece, of which a gap has two at least
  }
}

TEST_CASE("frames in arc length are even by the way of the particles too", "[frames]") {
  // λ stays while a particle goes on: |Δx|²/(N L²) of one of five particles by 0.01.
  Kept kept(frames(5, PathMethod::arc_length), 2.0);
  for (int k = 0; k <= 1000; ++k) {
    PathPoint p = at(k, 0, k == 0 ? "initial" : k == 1000 ? "final" : "");
    p.state.position(1, 3) += 0.01 * k * std::sqrt(5.0);
    kept.add(p);
  }
  kept.end();
  CHECK(kept.most <= 20);
  REQUIRE(kept.steps.size() == 5);
  int n = 0;
  for (const int step : kept.steps) CHECK(std::abs(step - 250 * n++) <= 250 / 4);
  // What turns round is as far along as it has gone.
  Kept turned(frames(5, PathMethod::arc_length), 2.0);
  for (int k = 0; k <= 400; ++k) turned.add(at(k, std::sin(k * pi / 400), k == 400 ? "final" : ""));
  turned.end();
  CHECK(turned.steps.size() == 5);
}

TEST_CASE("states with a label are kept whatever, and others beside them", "[frames]") {
  Kept kept(frames(3));
  for (int k = 0; k <= 500; ++k) kept.add(at(k, k / 500.0, k > 100 && k < 130 ? "contact:" + std::to_string(k) : ""));
  kept.end();
  for (int k = 101; k < 130; ++k) CHECK(kept.steps.count(k) == 1);
  CHECK(kept.steps.size() == 29 + 3);
  CHECK(kept.steps.count(0) + kept.steps.count(250) + kept.steps.count(500) == 3);
}

TEST_CASE("the way to another branch or stage counts nothing", "[frames]") {
  // Two stages, both with λ from 0 to 1, and a snap within the first.
  Kept kept(frames(5), 1, 2);
  int step = 0;
  for (int stage = 0; stage < 2; ++stage) {
    kept.choice.enter(frames(5));
    for (int k = 0; k <= 10; ++k) {
      PathPoint p = at(step++, k / 10.0);
      p.branch = stage == 0 && k < 5 ? 0 : 1;
      if (stage == 0 && k == 5) p.state.load_factor = 0.4;
      if (stage == 0 && k > 5) p.state.load_factor = 0.4 + 0.12 * (k - 5);
      kept.add(p);
    }
  }
  kept.end();
  // Steps 0 … 4 lead from 0 to 0.4, step 5 lands there, 6 … 10 lead to 1; 11 begins the second stage at 0.
  CHECK(kept.steps == std::set<int>{0, 6, 10, 16, 21});
}

TEST_CASE("each so many points, or none", "[frames]") {
  PathTable t;
  Kept none(t);
  t.every = 7;
  Kept kept(t);
  for (int k = 0; k <= 30; ++k) kept.add(at(k, k / 30.0)), none.add(at(k, k / 30.0));
  kept.end(), none.end();
  CHECK(kept.steps == std::set<int>{0, 7, 14, 21, 28});
  CHECK(none.steps.empty());
}
