#pragma once
#include "study/trace.hpp"

namespace elamin {

/// The study "path": the path that [path] asks for, or one after the other those of its stages. Watches the [[event]]s.
/// stored: what stands beside the state to start from; if it is of this very path, that goes on as if it had never stopped.
Outcome trace_path(const Problem& problem, const Model& model, const std::optional<StateSupplement>& stored, const Sink& sink, Archive* stopped = nullptr);

}  // namespace elamin
