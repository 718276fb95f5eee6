#include "input/imperfection.hpp"

#include <fmt/format.h>

namespace elamin {
namespace {

constexpr Word<Distribution> distribution_words[]{{"uniform", Distribution::uniform}, {"normal", Distribution::normal}};

}  // namespace

void describe(Keys& keys, ImperfectionTable& t) {
  keys.about("The structure is not quite as its tables say: every particle is moved before anything else happens.");
  keys.may("modes", t.modes, "numbers of modes, from 1: of the structure as built and held, or of a run", Range{1, most_modes});
  keys.may("amplitudes", t.amplitudes, "of each of them how far it moves the particle that it moves most [length]; the sign turns the mode over");
  keys.may_file("run", t.run, "the directory of a stored run that the modes are of, instead of the structure as built: a study of modes …");
  keys.may("at", t.at, "… or the null vectors of this event of it, such as branch:1");
  keys.may_file("state", t.state, "a stored state, DIR/states/LABEL.data: its difference from the perfect shape …");
  keys.may("scale", t.scale, "… times this; by default 1");
  keys.may("random", t.random, "every coordinate by a random number of this size, the bound or the standard deviation [length]", range::positive);
  keys.may("seed", t.seed, "of the random numbers: the same ones for the same seed; by default 0", Range{0, range::id.hi});
  keys.word("distribution", t.distribution, distribution_words, "of the random numbers; by default uniform");
  keys.may("group", t.group, "what is moved");
  keys.may("stress_free", t.stress_free, "the structure was made so: rest lengths and rest angles follow the shape; else they stay those of the perfect one, "
                                         "which is strained where it is moved");
  keys.at_most_one({"modes", "state", "random"});
  keys.one_at_least({"modes", "state", "random"}, "give modes = [1] and amplitudes, state = \"DIR/states/final.data\" and scale, or random");
  keys.with({"amplitudes", "run"}, {"modes"}, "the modes that they are of");
  keys.with({"at"}, {"run"}, "whose event it is");
  keys.with({"scale"}, {"state"}, "which it scales");
  keys.with({"seed", "distribution"}, {"random"}, "which they are of");
}

void check(ImperfectionTable& t, Mistakes& mistakes) {
  if (t.random && !t.seed) t.seed = 0;           // so that it is recorded
  if (t.place.broken || !t.place.written("modes")) return;
  if (!t.place.written("amplitudes")) return mistakes.add(t.place, "amplitudes", "is missing; it must be a list of numbers, one a mode");
  const std::size_t given = t.amplitudes->size(), wanted = t.modes->size();
  if (given != wanted) mistakes.add(t.place, "amplitudes", fmt::format("has {} numbers for {} modes; give one a mode", given, wanted));
}

}  // namespace elamin
