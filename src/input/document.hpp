#pragma once
// A TOML text as a tree that knows where everything stands and that settings may change before it is read.
#include "input/problem.hpp"

#include <cstdint>
#include <optional>
#include <string>
#include <variant>
#include <vector>

namespace elamin {

struct Node;
struct Entry;
struct Date { std::string text; };     // a date or time, as it stands: no key wants one. Not trivial to copy, for the reason that Nothing (results/table.hpp) is not
using List = std::vector<Node>;
using Entries = std::vector<Entry>;    // of a table, in the order of the file

struct Node {
  Place place;
  std::variant<bool, std::int64_t, double, std::string, Date, List, Entries> value;
};

struct Entry {
  std::string key;
  Place place;                         // of the key
  Node node;
};

struct Document {
  std::string file, sha256;            // as given; of the bytes
  Entries root;
  std::optional<ScriptReading> script; // what [lammps] input gave besides tables
};

/// Reads a TOML file. Throws InputError if it is not there, not a text in UTF-8, or not TOML.
Document read_document(const std::string& file);

/// The same of a text; `file`: what mistakes call it, and from whose folder the files that it names are sought.
Document parse_document(const std::string& text, const std::string& file);
/// The entries of a text in TOML, which is told of as `file`. Throws InputError if it is not TOML.
Entries parse_entries(const std::string& text, const std::string& file);

/// Puts the node, and all that is in it, at a place.
void set_place(Node& node, Place place);

/// One TOML value, such as `[0, 0, 1e-3]`; what is no TOML value is taken as a string of these letters.
Node parse_value(const std::string& text, Place place);

/// The entry of that key, or null.
const Node* find(const Entries& entries, const std::string& key);
Node* find(Entries& entries, const std::string& key);

/// The elements of [[key]] (or of a list of inline tables); false if the node is something else.
bool is_tables(const Node& node);

/// What a node is, for messages: `3.5`, `the string "abc"`, `a list of 2`, `a table`.
std::string shown(const Node& node);

/// The whole as TOML, which reads back to the same, but for places.
std::string to_toml(const Document& document);
/// The node as TOML on one line.
std::string to_toml(const Node& node);
std::string to_toml(double value);               // 17 digits: reads back to the same bits
std::string to_toml(const std::string& value);   // quoted and escaped

/// Gives keys and words of a problem file that had another name the one they have now; a sentence for each. A table that has both keeps both.
std::vector<std::string> take_old_names(Document& document);

}  // namespace elamin
