#pragma once
// What OpenBLAS, under CHOLMOD, MUMPS and LAPACK, needs before it is called; and what of it two factorisations call.
#include <stdexcept>

extern "C" void dtrsm_(const char* side, const char* uplo, const char* trans, const char* diag, const int* m, const int* n, const double* alpha,
                       const double* a, const int* lda, double* b, const int* ldb);

namespace elamin {

/// There is not enough memory for what what() names.
class OutOfMemory : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// Has OpenBLAS compute on this thread alone (threaded sums would depend on the number of threads) and take the memory that it works in on this thread.
/// Without that it would ask for it inside its first call, again and again without end where there is none. Throws OutOfMemory.
void ready_blas();

}  // namespace elamin
