#pragma once
// From a problem file to plain structs.
#include "input/constants.hpp"
#include "input/document.hpp"
#include "input/keys.hpp"
#include "input/problem.hpp"
#include "input/settings.hpp"

#include <string>
#include <vector>

namespace elamin {

// From a document to structs, with the defaults that follow from other keys, and checked.

/// Reads all tables of a document; what is wrong goes to the mistakes, and its tables are marked as broken.
ProblemFile read_tables(const Document& document, Mistakes& mistakes);

/// The numbers of [constants], as far as nothing is wrong with them.
Constants constants_of(const Document& document);

/// Reads a problem file, changed by `settings` first, with every default in it. Its names and relations are checked;
/// its geometry is by build_model. Throws InputError with all mistakes, each with its place, and those that build_model
/// finds in what is whole.
Problem read_problem(const std::string& file, const std::vector<Setting>& settings = {});
/// The same of what has been read, or put together by a program.
Problem read_problem(Document document, const std::vector<Setting>& settings = {});
/// The same of a text; `file`: what mistakes call it, and from whose folder the files that it names are sought.
Problem read_problem_text(const std::string& text, const std::string& file, const std::vector<Setting>& settings = {});

}  // namespace elamin
