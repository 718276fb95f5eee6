#pragma once
// Whether a list holds something.
#include <algorithm>
#include <iterator>
#include <string>

namespace elamin {

template <class List, class Value> bool contains(const List& list, const Value& value) {
  return std::find(std::begin(list), std::end(list), value) != std::end(list);
}

/// The first element of that name, or null.
template <class List> auto find_named(List& list, const std::string& name) -> decltype(&*std::begin(list)) {
  const auto found = std::find_if(std::begin(list), std::end(list), [&](const auto& element) { return element.name == name; });
  return found == std::end(list) ? nullptr : &*found;
}

}  // namespace elamin
