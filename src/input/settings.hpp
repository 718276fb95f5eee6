#pragma once
// Changes of a problem file from outside: `--set path.steps=50`, and the values of a sweep.
#include "input/constants.hpp"
#include "input/document.hpp"
#include "input/keys.hpp"

#include <string>
#include <utility>
#include <vector>

namespace elamin {

/// A key and its new value. The key is dotted: `path.steps`, `beam.column.particles` (one of several tables by its
/// name), `support.2.displacement` (or by its number, from 1), `support.2.displacement.3` (one component of a list).
/// The value is TOML; what is no TOML is a string.
struct Setting {
  std::string key, value;
  Place place{};          // of the value, if a sweep of the file gives it
};

/// `KEY=VALUE` as on the command line. Throws InputError if there is no '='.
Setting parse_setting(const std::string& text);

/// Changes the document; a key that is allowed but not there is made. What addresses nothing goes to the mistakes.
void apply(const Setting& setting, Document& document, Mistakes& mistakes);

/// The value of a setting as a number, where it is an expression in place of one; else as it is.
std::string computed(const Setting& setting, const Document& document, const Constants& constants);

/// Why a key is no number that may take any value, as the end of a sentence, or "".
std::string wrong_number(const std::string& key, const Document& document);

/// Whether a problem file may hold [key] or [[key]].
bool has_table(const std::string& key);

/// The key as the tables are numbered, so that `beam.column.particles` and `beam.1.particles` are the same; "" if it
/// addresses nothing.
std::string canonical_key(const std::string& key, const Document& document);

}  // namespace elamin
