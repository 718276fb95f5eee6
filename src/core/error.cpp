#include "core/error.hpp"

#include "core/find.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <tuple>

namespace elamin {

namespace {

std::string sentences(std::vector<Mistake>& mistakes) {
  std::vector<std::string> files;                      // in the order they come up
  for (const Mistake& m : mistakes)
    if (!contains(files, m.file)) files.push_back(m.file);
  const auto place = [&](const Mistake& m) {
    return std::tuple(std::find(files.begin(), files.end(), m.file) - files.begin(), m.line, m.column);
  };
  std::stable_sort(mistakes.begin(), mistakes.end(), [&](const Mistake& a, const Mistake& b) { return place(a) < place(b); });
  std::string all;
  for (const Mistake& m : mistakes) all.append(all.empty() ? 0 : 1, '\n').append(m.sentence());
  return all;
}

}  // namespace

std::string Mistake::sentence() const {
  const std::string place = line > 0 ? fmt::format("{}:{}:{}: ", file, line, column) : fmt::format("{}{}", file, file.empty() ? "" : ": ");
  return fmt::format("{}{}{}{}", place, key, key.empty() ? "" : ": ", what);
}

InputError::InputError(std::vector<Mistake> mistakes) : std::runtime_error(sentences(mistakes)), mistakes_(std::move(mistakes)) {}

}  // namespace elamin
