#include "core/suggest.hpp"

#include <algorithm>
#include <cctype>

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

}  // namespace

std::string did_you_mean(const std::string& word, const std::vector<std::string>& candidates) {
  constexpr std::size_t longest = 64, most = 1000;
  if (word.empty() || word.size() > longest) return "";
  const std::string sought = lower(word);
  const int allowed = std::max(1, static_cast<int>(word.size()) / 3);
  int nearest = allowed + 1;
  const std::string* best = nullptr;
  for (std::size_t i = 0; i < std::min(candidates.size(), most); ++i) {
    const std::string& candidate = candidates[i];
    if (candidate.size() > longest) continue;
    const int distance = edit_distance(sought, lower(candidate));
    // A word of which nothing is left is no help: "x" for "y".
    if (distance < nearest && distance < static_cast<int>(std::max(sought.size(), candidate.size())))
      nearest = distance, best = &candidate;
  }
  return best ? "; did you mean \"" + *best + "\"?" : "";
}

std::string listed(const std::vector<std::string>& words) {
  constexpr std::size_t most = 32;
  std::string text;
  for (std::size_t i = 0; i < std::min(words.size(), most); ++i) text += (i ? ", " : "") + words[i];
  if (words.size() > most) text += ", and " + std::to_string(words.size() - most) + " more";
  return text;
}

std::string quoted_choice(const std::vector<std::string>& words) {
  std::string text;
  for (std::size_t i = 0; i < words.size(); ++i)
    text += (i == 0 ? "" : i + 1 == words.size() ? " or " : ", ") + ('"' + words[i] + '"');
  return text;
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

}  // namespace elamin
