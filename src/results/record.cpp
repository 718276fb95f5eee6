#include "results/record.hpp"

#include "results/columns.hpp"

#include <limits>

namespace elamin {

Record::Record(const Problem& problem, const Model& model)
    : observables_(problem, model),
      names_(observable_columns(problem)),
      path_{path_columns(names_), {}},
      events_{event_columns(names_), {}} {}

void Record::add(const PathPoint& point, const Field& forces, const std::vector<Touch>& touches,
                 const std::vector<double>& eigenvalues) {
  std::vector<double> values = observables_.evaluate(point.state, forces, touches);
  values.insert(values.end(), eigenvalues.begin(), eigenvalues.end());
  values.resize(names_.size(), std::numeric_limits<double>::quiet_NaN());     // fewer dofs than modes asked for
  path_.rows.push_back(path_row(point, values));
  if (is_event(point.label)) events_.rows.push_back(event_row(point, values));
}

}  // namespace elamin
