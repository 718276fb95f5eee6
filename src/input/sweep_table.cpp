#include "input/sweep_table.hpp"

namespace elamin {

void describe(Keys& keys, Sweep& t) {
  keys.about("One run for each value of a key; of several sweeps all combinations. Or a search for the value at which an outcome changes.");
  keys.must_one_or_more("key", t.keys, "such as \"beam.column.particles\"; all of them get the same value");
  keys.may("zip", t.zip, "sweeps with the same word here go in step");
  keys.values("values", t.values, "the values");
  keys.may("range", t.range, "or first, last and step");
  keys.values("between", t.between, "or two values, to halve …");
  keys.may("bisect", t.bisect, "… where this observable passes the level");
  keys.may("at", t.at, "the row where it is looked at");
  keys.may("level", t.level, "the level");
  keys.may("tolerance", t.tolerance, "of the key; by default a thousandth of what is between", range::positive);
}

}  // namespace elamin
