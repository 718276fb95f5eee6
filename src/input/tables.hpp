#pragma once
// From a document to structs, with the defaults that follow from other keys, and checked.
#include "input/constants.hpp"
#include "input/document.hpp"
#include "input/mistakes.hpp"
#include "input/problem.hpp"

namespace elamin {

/// Reads all tables of a document; what is wrong goes to the mistakes, and its tables are marked as broken.
ProblemFile read_tables(const Document& document, Mistakes& mistakes);

/// The numbers of [constants], as far as nothing is wrong with them.
Constants constants_of(const Document& document);

}  // namespace elamin
