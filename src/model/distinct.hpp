#pragma once
// Values that are the same to rounding, as types.
#include <algorithm>
#include <numeric>
#include <vector>

namespace elamin {

/// Types of values, numbered from `first` as they come; one type holds what lies within the tolerance above its smallest
/// value, and has the value that comes first.
struct Distinct {
  std::vector<int> type;
  std::vector<double> value;
};
inline Distinct distinct(const std::vector<double>& values, int first, double absolute, double relative) {
  std::vector<int> order(values.size()), cluster(values.size());
  std::iota(order.begin(), order.end(), 0);
  std::sort(order.begin(), order.end(), [&](int a, int b) { return values[a] < values[b]; });
  int clusters = 0;
  double smallest = 0;
  for (const int v : order) {
    if (clusters == 0 || values[v] > smallest + absolute + relative * smallest) smallest = values[v], ++clusters;
    cluster[v] = clusters - 1;
  }
  std::vector<int> type_of(clusters, -1);
  Distinct d;
  for (std::size_t v = 0; v < values.size(); ++v) {
    int& type = type_of[cluster[v]];
    if (type < 0) type = first + static_cast<int>(d.value.size()), d.value.push_back(values[v]);
    d.type.push_back(type);
  }
  return d;
}

}  // namespace elamin
