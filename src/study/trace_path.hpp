#pragma once
#include "study/trace.hpp"

namespace elamin {

/// The study "path": the path that [path] asks for, or one after the other those of its stages. Watches the [[event]]s.
Outcome trace_path(const Problem& problem, const Model& model, const Sink& sink);

}  // namespace elamin
