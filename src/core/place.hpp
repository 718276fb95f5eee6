#pragma once

namespace elamin {

/// Where something stands in a file, line and column from 1; line 0: it came from the command line.
struct Place { int line = 0, column = 0; };

}  // namespace elamin
