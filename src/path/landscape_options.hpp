#pragma once

namespace elamin {

struct LandscapeOptions {
  int modes = 4;                       // soft ones that are followed uphill from a minimum, both ways
  int starts = 8;                      // random ones, from which the energy goes down
  int deflate = 0;                     // equilibria to look for by deflation
  int seed = 1;                        // of the random starts
  int most = 100;                      // nodes; no further ones are looked for then
  bool strings = true;                 // join minima that no saddle joins
  bool operator==(const LandscapeOptions&) const = default;
};

}  // namespace elamin
