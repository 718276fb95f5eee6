#pragma once
#include "input/document.hpp"

namespace elamin {

/// Gives keys and words of a problem file that had another name the one they have now; a sentence for each. A table that has both keeps both.
std::vector<std::string> take_old_names(Document& document);

}  // namespace elamin
