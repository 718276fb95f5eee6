#include "model/grains.hpp"

#include "model/append.hpp"

namespace elamin {

void add_grains(Model& model, const std::vector<Grains>& sets) {
  int more = 0;
  for (const Grains& grains : sets) more += static_cast<int>(grains.position.cols());
  Appender append(model, more);
  for (const Grains& grains : sets) {
    const int n = static_cast<int>(grains.position.cols()), first = append.apart(n, 0, grains.density);
    model.start.position.middleCols(first, n) = grains.position;
    std::copy_n(grains.diameter.begin(), n, model.diameter.begin() + first);
    model.structures.push_back({grains.name, "grains", first, n, 0, -1, -1});
  }
}

}  // namespace elamin
