#include "core/suggest.hpp"

#include "core/find.hpp"

#include <algorithm>
#include <cctype>
#include <utility>

namespace elamin {
namespace {

std::string lower(std::string s) {
  for (char& c : s) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  return s;
}

/// Smallest number of letters inserted, removed, replaced or swapped with the next one (optimal string alignment).
int edit_distance(const std::string& a, const std::string& b) {
  const int n = static_cast<int>(a.size()), m = static_cast<int>(b.size());
  std::vector<std::vector<int>> d(n + 1, std::vector<int>(m + 1));
  for (int i = 0; i <= n; ++i) d[i][0] = i;
  for (int j = 0; j <= m; ++j) d[0][j] = j;
  for (int i = 1; i <= n; ++i)
    for (int j = 1; j <= m; ++j) {
      d[i][j] = std::min({d[i - 1][j] + 1, d[i][j - 1] + 1, d[i - 1][j - 1] + (a[i - 1] != b[j - 1])});
      if (i > 1 && j > 1 && a[i - 1] == b[j - 2] && a[i - 2] == b[j - 1])
        d[i][j] = std::min(d[i][j], d[i - 2][j - 2] + 1);
    }
  return d[n][m];
}

constexpr std::string_view between_parts = "._-";

/// "disp.x" for "displacement.x", "tol" for "tolerance": each part begins one of the other word's, in their order.
bool abbreviates(const std::string& word, const std::string& candidate) {
  const std::vector<std::string> parts = parts_of(word, between_parts), whole = parts_of(candidate, between_parts);
  if (word.size() < 3 || parts.size() > whole.size()) return false;
  return std::equal(parts.begin(), parts.end(), whole.begin(), [](const std::string& p, const std::string& w) { return w.starts_with(p); });
}

/// "modulus" for "youngs_modulus".
bool is_part(const std::string& word, const std::string& candidate) {
  const std::vector<std::string> whole = parts_of(candidate, between_parts);
  return word.size() >= 3 && contains(whole, word);
}

/// The letters of papers.
constexpr std::pair<const char*, const char*> letters[]{
    {"E", "youngs_modulus"}, {"nu", "poissons_ratio"}, {"rho", "density"}, {"mu", "friction"}, {"K", "bond_stiffness"},
    {"B", "angle_stiffness"}, {"EA", "axial_stiffness"}, {"EI", "bending_stiffness"}, {"N", "particles"}, {"d", "diameter"}, {"D", "diameter"}, {"t", "thickness"},
    {"r", "radius"}, {"R", "radius"}, {"F", "force"}, {"g", "acceleration"}, {"p", "pressure"}, {"dt", "timestep"}, {"r0", "rest_length"},
    {"x", "position.x"}, {"y", "position.y"}, {"z", "position.z"}, {"ux", "displacement.x"}, {"uy", "displacement.y"},
    {"uz", "displacement.z"}, {"fx", "reaction.x"}, {"fy", "reaction.y"}, {"fz", "reaction.z"}, {"vx", "velocity.x"}, {"vy", "velocity.y"}, {"vz", "velocity.z"}};

const std::string* meant(const std::string& word, const std::vector<std::string>& candidates) {
  constexpr std::size_t longest = 64, most = 1000;
  if (word.empty() || word.size() > longest) return nullptr;
  const std::size_t count = std::min(candidates.size(), most);
  const std::string sought = lower(word);
  const auto first = [&](const auto& is_meant) {
    for (std::size_t i = 0; i < count; ++i)
      if (candidates[i].size() <= longest && is_meant(candidates[i])) return &candidates[i];
    return static_cast<const std::string*>(nullptr);
  };
  for (const auto& [letter, name] : letters)
    if (word == letter)
      if (const auto* found = first([&, &wanted = name](const std::string& c) { return c == wanted; })) return found;
  if (const auto* found = first([&](const std::string& c) { return abbreviates(sought, lower(c)); })) return found;
  int nearest = std::max(1, static_cast<int>(word.size()) / 3) + 1;
  const std::string* best = nullptr;
  first([&](const std::string& candidate) {
    const int distance = edit_distance(sought, lower(candidate));
    // A word of which nothing is left is no help: "x" for "y".
    if (distance < nearest && distance < static_cast<int>(std::max(sought.size(), candidate.size())))
      nearest = distance, best = &candidate;
    return false;
  });
  return best ? best : first([&](const std::string& c) { return is_part(sought, lower(c)); });
}

}  // namespace

std::string did_you_mean(const std::string& word, const std::vector<std::string>& candidates) {
  const std::string* best = meant(word, candidates);
  return best ? "; did you mean \"" + *best + "\"?" : "";
}

std::vector<std::string> parts_of(const std::string& word, std::string_view separators) {
  std::vector<std::string> parts(1);
  for (const char c : word)
    if (separators.find(c) != separators.npos) parts.emplace_back();
    else parts.back() += c;
  return parts;
}

std::string listed(const std::vector<std::string>& words) {
  constexpr std::size_t most = 32;
  std::string text;
  for (std::size_t i = 0; i < std::min(words.size(), most); ++i) text += (i ? ", " : "") + words[i];
  if (words.size() > most) text += ", and " + std::to_string(words.size() - most) + " more";
  return text;
}

std::string enumerated(const std::vector<std::string>& words, const char* last) {
  std::string text;
  for (std::size_t i = 0; i < words.size(); ++i) text += (i == 0 ? "" : i + 1 == words.size() ? std::string(" ") + last + " " : ", ") + words[i];
  return text;
}

std::string quoted_choice(const std::vector<std::string>& words) {
  std::vector<std::string> quoted;
  for (const std::string& word : words) quoted.push_back('"' + word + '"');
  return enumerated(quoted, "or");
}

std::string in_quotes(const std::string& word) {
  constexpr std::size_t longest = 60;
  std::string text = "\"";
  for (const char c : word) {
    // Cut between characters, not inside one (bytes 10xxxxxx continue a character).
    if (text.size() > longest && (static_cast<unsigned char>(c) & 0xC0) != 0x80) {
      text += "…";
      break;
    }
    text += static_cast<unsigned char>(c) < 0x20 || c == 0x7f ? '?' : c;
  }
  return text + '"';
}

std::string there_are(const std::vector<std::string>& words, const std::string& word) {
  return (words.empty() ? "there is none" : "there are: " + listed(words)) + did_you_mean(word, words);
}

}  // namespace elamin
