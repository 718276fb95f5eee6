#include "results/record.hpp"

#include "results/columns.hpp"

namespace elamin {

Record::Record(const Problem& problem, const Model& model)
    : observables_(problem, model),
      names_(observables_.names()),
      path_{path_columns(names_), {}},
      events_{event_columns(names_), {}} {}

void Record::add(const PathPoint& point, const Field& forces) {
  const std::vector<double> values = observables_.evaluate(point.state, forces);
  path_.rows.push_back(path_row(point, values));
  if (is_event(point.label)) events_.rows.push_back(event_row(point, values));
}

}  // namespace elamin
