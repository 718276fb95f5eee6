#pragma once
// Help with a word that is not known: the nearest one, and all that are.
#include <string>
#include <string_view>
#include <vector>

namespace elamin {

/// `; did you mean "steps"?` with the candidate that `word` is a letter or an abbreviation of, that is nearest to it or has it
/// as a part; "" if there is none.
std::string did_you_mean(const std::string& word, const std::vector<std::string>& candidates);

/// The parts between these characters.
std::vector<std::string> parts_of(const std::string& word, std::string_view separators);

/// `a, b, c`; a long list is cut short.
std::string listed(const std::vector<std::string>& words);

/// `there are: a, b; did you mean "a"?` of the words that `word` might have been; `there is none`.
std::string there_are(const std::vector<std::string>& words, const std::string& word);

/// `a, b and c`, with another word for "and".
std::string enumerated(const std::vector<std::string>& words, const char* last);

/// `"a", "b" or "c"`.
std::string quoted_choice(const std::vector<std::string>& words);

/// `"word"`, with control characters and what is too long left out.
std::string in_quotes(const std::string& word);

}  // namespace elamin
