#include "lammps/script/words.hpp"

#include <cctype>

namespace elamin::script {
namespace {

bool space(char c) { return std::isspace(static_cast<unsigned char>(c)) != 0; }

bool triple_at(std::string_view text, std::size_t i) { return text.substr(i, 3) == "\"\"\""; }

/// Goes over a text and knows whether it is within quotes.
class Quotes {
 public:
  /// Takes what stands at i; returns how many bytes of it belong together (three of a triple quote).
  std::size_t step(std::string_view text, std::size_t i) {
    if (triple_at(text, i) && (open_ == 0 || open_ == '3')) {
      open_ = open_ ? 0 : '3';
      return 3;
    }
    const char c = text[i];
    if (c == '"' || c == '\'') {
      if (open_ == 0) open_ = c;
      else if (open_ == c) open_ = 0;
    }
    return 1;
  }
  bool within() const { return open_ != 0; }

 private:
  char open_ = 0;
};

/// How many """ there are.
int triples(std::string_view text) {
  int n = 0;
  for (std::size_t i = 0; i + 2 < text.size(); ++i)
    if (triple_at(text, i)) ++n, i += 2;
  return n;
}

/// Behind the ")" that closes the "(" at i, or npos.
std::size_t closing(std::string_view text, std::size_t i) {
  int depth = 0;
  for (; i < text.size(); ++i) {
    if (text[i] == '(') ++depth;
    if (text[i] == ')' && --depth == 0) return i;
  }
  return std::string_view::npos;
}

}  // namespace

Place Line::place(std::size_t offset) const {
  Place at{pieces.empty() ? 1 : pieces.front().line, static_cast<int>(offset) + 1};
  for (const Piece& p : pieces)
    if (p.offset <= offset) at = {p.line, static_cast<int>(offset - p.offset) + 1};
  return at;
}

std::vector<Line> lines_of(const std::string& text) {
  std::vector<Line> lines;
  Line line;
  int number = 0;
  for (std::size_t begin = 0; begin < text.size();) {
    const std::size_t end = std::min(text.find('\n', begin), text.size());
    std::string_view piece(text.data() + begin, end - begin);
    begin = end + 1;
    line.pieces.push_back({line.text.size(), ++number});
    while (!piece.empty() && space(piece.back())) piece.remove_suffix(1);
    const bool goes_on = !piece.empty() && piece.back() == '&';
    if (goes_on) piece.remove_suffix(1);
    line.text += piece;
    if (begin < text.size() && (goes_on || triples(line.text) % 2)) {
      if (!goes_on) line.text += '\n';
      continue;
    }
    if (line.text.find_first_not_of(" \t\r\f\v\n") != std::string::npos) lines.push_back(std::move(line));
    line = {};
  }
  return lines;
}

std::string_view without_comment(std::string_view text) {
  Quotes quotes;
  for (std::size_t i = 0; i < text.size(); i += quotes.step(text, i))
    if (text[i] == '#' && !quotes.within()) return text.substr(0, i);
  return text;
}

std::string substituted(std::string_view text, const Substitution& by, std::vector<std::size_t>* offsets) {
  std::string result;
  Quotes quotes;
  const auto put = [&](std::string_view what, std::size_t from, bool moves) {
    for (std::size_t k = 0; offsets && k < what.size(); ++k) offsets->push_back(moves ? from + k : from);
    result += what;
  };
  for (std::size_t i = 0; i < text.size();) {
    if (text[i] != '$' || quotes.within()) {
      const std::size_t n = quotes.step(text, i);
      put(text.substr(i, n), i, true);
      i += n;
      continue;
    }
    const std::size_t from = i++;
    if (i >= text.size() || space(text[i])) throw Wrong(0, "a $ is followed by no variable; $x, ${name} or $(formula) is wanted");
    std::string value;
    if (text[i] == '{') {
      const std::size_t end = text.find('}', i);
      if (end == std::string_view::npos) throw Wrong(0, "a ${ is not closed; ${name} is wanted");
      value = by.variable(std::string(text.substr(i + 1, end - i - 1)));
      i = end + 1;
    } else if (text[i] == '(') {
      const std::size_t end = closing(text, i);
      if (end == std::string_view::npos) throw Wrong(0, "a $( is not closed; $(formula) is wanted");
      value = by.formula(std::string(text.substr(i + 1, end - i - 1)));
      i = end + 1;
    } else {
      value = by.variable(std::string(1, text[i]));
      ++i;
    }
    put(value, from, false);
  }
  return result;
}

std::vector<Word> split(std::string_view text) {
  std::vector<Word> words;
  for (std::size_t i = 0; i < text.size();) {
    if (space(text[i])) {
      ++i;
      continue;
    }
    const std::size_t begin = i;
    if (text[i] != '"' && text[i] != '\'') {
      while (i < text.size() && !space(text[i])) ++i;
      words.push_back({std::string(text.substr(begin, i - begin)), begin, false});
      continue;
    }
    const std::string_view mark = triple_at(text, i) ? text.substr(i, 3) : text.substr(i, 1);
    const std::size_t end = text.find(mark, i + mark.size());
    if (end == std::string_view::npos) throw Wrong(words.size(), "a quote is not closed");
    i = end + mark.size();
    if (i < text.size() && !space(text[i])) throw Wrong(words.size(), "a closing quote is followed by no blank");
    words.push_back({std::string(text.substr(begin + mark.size(), end - begin - mark.size())), begin, true});
  }
  return words;
}

std::vector<Word> words_of(const Line& line, const Substitution& by) {
  const std::string_view text = without_comment(line.text);
  if (text.find('$') == std::string_view::npos) return split(text);
  std::vector<std::size_t> offsets;
  const std::string full = substituted(text, by, &offsets);
  std::vector<Word> words = split(full);
  for (Word& w : words) w.offset = offsets[w.offset];
  return words;
}

}  // namespace elamin::script
