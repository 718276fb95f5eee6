#pragma once
// What is done with CHOLMOD for factors of either kind.
#include "solve/multifrontal.hpp"

#include <cholmod.h>
#include <omp.h>

#include <string>

namespace elamin {

/// Of the lower triangle, no copy.
cholmod_sparse view(const SparseMatrix& m);
/// Order and symbolic factor; throws as cholmod_failed.
cholmod_factor* analysis_of(const SparseMatrix& pattern, cholmod_common& common);
/// The pattern of a supernodal factor; a view, no copy.
Supernodes supernodes(const cholmod_factor& l);
/// Throws OutOfMemory where that is what the status says, else a runtime_error.
[[noreturn]] void cholmod_failed(const std::string& what, int status);

/// CHOLMOD opens teams of four threads for loops of a few hundred numbers, whatever it is told: none while this lives.
struct OneThread {
  int levels = omp_get_max_active_levels();
  OneThread() { omp_set_max_active_levels(0); }
  ~OneThread() { omp_set_max_active_levels(levels); }
};

}  // namespace elamin
