#include "petsc/shared_factor.hpp"

#include <slepceps.h>

#include <algorithm>
#include <array>
#include <cstring>
#include <numeric>

namespace elamin {

namespace {

constexpr int first_room = 50, most_room = 4000;           // % of memory for delayed pivots, ICNTL(14)
constexpr double solved = 1e-12;                           // of iterations: the residual, relative

int own_rank() {
  int r = 0;
  MPI_Comm_rank(PETSC_COMM_WORLD, &r);
  return r;
}

int world_size() {
  int n = 1;
  MPI_Comm_size(PETSC_COMM_WORLD, &n);
  return n;
}

template <class T> std::vector<T> dealt(const std::vector<T>& whole, const std::vector<int>& counts, const std::vector<int>& places, int own, MPI_Datatype type) {
  std::vector<T> part(static_cast<std::size_t>(own));
  MPI_Scatterv(whole.data(), counts.data(), places.data(), type, part.data(), own, type, 0, PETSC_COMM_WORLD);
  return part;
}

}  // namespace

void must(PetscErrorCode error) {
  if (error == 0) return;
  const char* text = nullptr;
  PetscErrorMessage(error, &text, nullptr);
  std::fprintf(stderr, "elamin: rank %d: PETSc: %s; the run ends, what is written stays\n", own_rank(), text ? text : "an error");
  MPI_Abort(PETSC_COMM_WORLD, 2);
}

SharedFactor::SharedFactor(bool definite) : definite_(definite) {
  must(KSPCreate(PETSC_COMM_WORLD, &solver_));
  must(KSPSetType(solver_, KSPPREONLY));
  PC pc = nullptr;
  must(KSPGetPC(solver_, &pc));
  must(PCSetType(pc, PCCHOLESKY));
  must(PCFactorSetMatSolverType(pc, MATSOLVERMUMPS));
  if (!definite_) return;                                  // indefinite ones need a factor, for its inertia
  must(KSPSetFromOptions(solver_));
  PCType type = nullptr;
  must(PCGetType(pc, &type));
  direct_ = std::strcmp(type, PCCHOLESKY) == 0;
  if (direct_) return;
  KSPType iteration = nullptr;
  must(KSPGetType(solver_, &iteration));
  if (std::strcmp(iteration, KSPPREONLY) == 0) must(KSPSetType(solver_, KSPCG));
  must(KSPSetTolerances(solver_, solved, PETSC_DEFAULT, PETSC_DEFAULT, PETSC_DEFAULT));
  must(KSPSetFromOptions(solver_));
}

SharedFactor::~SharedFactor() {
  drop_matrix();
  must(KSPDestroy(&solver_));
}

void SharedFactor::drop_matrix() {
  must(KSPReset(solver_));
  must(MatDestroy(&matrix_));
  must(MatDestroy(&spread_));
  must(MatNullSpaceDestroy(&near_null_));
  must(VecDestroy(&b_));
  must(VecDestroy(&x_));
}

void SharedFactor::set_pattern(const UpperRows& whole, const Eigen::MatrixXd& near_null) {
  drop_matrix();
  // Rank r has rows r_at … of about equally many entries, one at least where there are enough.
  std::array<int, 2> of_this{};                            // rows, entries
  const std::size_t n = static_cast<std::size_t>(world_size());
  if (own_rank() == 0) {
    const int rows = whole.rows();
    row_at_.assign(n + 1, rows);
    row_at_[0] = 0;
    for (std::size_t r = 1; r < n; ++r) {
      const double share = static_cast<double>(whole.columns.size()) * static_cast<double>(r) / static_cast<double>(n);
      const auto row = std::lower_bound(whole.starts.begin(), whole.starts.end(), share);
      row_at_[r] = std::clamp(static_cast<int>(row - whole.starts.begin()), row_at_[r - 1], rows);
    }
    rows_of_.resize(n), entries_of_.resize(n), entry_at_.resize(n);
    for (std::size_t r = 0; r < n; ++r) {
      rows_of_[r] = row_at_[r + 1] - row_at_[r];
      entry_at_[r] = whole.starts[static_cast<std::size_t>(row_at_[r])];
      entries_of_[r] = whole.starts[static_cast<std::size_t>(row_at_[r + 1])] - entry_at_[r];
    }
  }
  std::vector<std::array<int, 2>> shares;
  for (std::size_t r = 0; r < rows_of_.size() && own_rank() == 0; ++r) shares.push_back({rows_of_[r], entries_of_[r]});
  MPI_Scatter(shares.data(), 2, MPI_INT, of_this.data(), 2, MPI_INT, 0, PETSC_COMM_WORLD);
  const auto [rows, entries] = of_this;
  std::vector<int> lengths;
  for (int i = 0; i + 1 < static_cast<int>(whole.starts.size()); ++i) lengths.push_back(whole.starts[i + 1] - whole.starts[i]);
  lengths = dealt(lengths, rows_of_, row_at_, rows, MPI_INT);
  columns_ = dealt(whole.columns, entries_of_, entry_at_, entries, MPI_INT);
  starts_.assign(1, 0);
  std::partial_sum(lengths.begin(), lengths.end(), std::back_inserter(starts_));

  must(MatCreate(PETSC_COMM_WORLD, &matrix_));
  must(MatSetSizes(matrix_, rows, rows, PETSC_DETERMINE, PETSC_DETERMINE));
  must(MatSetType(matrix_, MATSBAIJ));
  const std::vector<double> zeros(columns_.size(), 0.0);
  must(MatSeqSBAIJSetPreallocationCSR(matrix_, 1, starts_.data(), columns_.data(), zeros.data()));
  must(MatMPISBAIJSetPreallocationCSR(matrix_, 1, starts_.data(), columns_.data(), zeros.data()));
  must(MatSetOption(matrix_, MAT_SYMMETRIC, PETSC_TRUE));
  if (definite_) must(MatSetOption(matrix_, MAT_SPD, PETSC_TRUE));
  must(MatGetOwnershipRange(matrix_, &first_, nullptr));
  must(MatCreateVecs(matrix_, &x_, &b_));

  if (direct_) return;
  PetscInt count = near_null.cols();
  MPI_Bcast(&count, 1, MPIU_INT, 0, PETSC_COMM_WORLD);
  if (count == 0) return;
  std::vector<Vec> motions(static_cast<std::size_t>(count));
  for (PetscInt j = 0; j < count; ++j) {
    must(VecDuplicate(b_, &motions[static_cast<std::size_t>(j)]));
    const std::vector<double> column = own_rank() == 0 ? std::vector<double>(near_null.col(j).begin(), near_null.col(j).end()) : std::vector<double>{};
    const std::vector<double> part = dealt(column, rows_of_, row_at_, rows, MPI_DOUBLE);
    double* place = nullptr;
    must(VecGetArray(motions[static_cast<std::size_t>(j)], &place));
    std::copy(part.begin(), part.end(), place);
    must(VecRestoreArray(motions[static_cast<std::size_t>(j)], &place));
  }
  for (std::size_t j = 0; j < motions.size(); ++j) {       // orthonormal, as PETSc wants them
    for (int twice = 0; twice < 2; ++twice)
      for (std::size_t i = 0; i < j; ++i) {
        double along = 0;
        must(VecDot(motions[j], motions[i], &along));
        must(VecAXPY(motions[j], -along, motions[i]));
      }
    must(VecNormalize(motions[j], nullptr));
  }
  must(MatNullSpaceCreate(PETSC_COMM_WORLD, PETSC_FALSE, count, motions.data(), &near_null_));
  for (Vec& v : motions) must(VecDestroy(&v));
}

SharedFactor::Outcome SharedFactor::factorize(const std::vector<double>& values) {
  const std::vector<double> own = dealt(values, entries_of_, entry_at_, static_cast<int>(columns_.size()), MPI_DOUBLE);
  for (int i = 0; i + 1 < static_cast<int>(starts_.size()); ++i) {
    const PetscInt row = first_ + i, length = starts_[i + 1] - starts_[i];
    must(MatSetValues(matrix_, 1, &row, length, columns_.data() + starts_[i], own.data() + starts_[i], INSERT_VALUES));
  }
  must(MatAssemblyBegin(matrix_, MAT_FINAL_ASSEMBLY));
  must(MatAssemblyEnd(matrix_, MAT_FINAL_ASSEMBLY));
  negative_ = 0;
  if (direct_) return outcome_of_direct();

  must(MatConvert(matrix_, MATAIJ, spread_ ? MAT_REUSE_MATRIX : MAT_INITIAL_MATRIX, &spread_));
  if (definite_) must(MatSetOption(spread_, MAT_SPD, PETSC_TRUE));
  if (near_null_) must(MatSetNearNullSpace(spread_, near_null_));
  must(KSPSetOperators(solver_, spread_, spread_));
  must(KSPSetUp(solver_));
  // Conjugate gradients from a right-hand side without order meet every negative eigenvalue, as Lanczos's method does.
  PetscRandom random = nullptr;
  must(PetscRandomCreate(PETSC_COMM_WORLD, &random));
  must(VecSetRandom(b_, random));
  must(PetscRandomDestroy(&random));
  must(KSPSolve(solver_, b_, x_));
  KSPConvergedReason reason = KSP_CONVERGED_ITERATING;
  must(KSPGetConvergedReason(solver_, &reason));
  return reason > 0 ? Outcome::made : Outcome::none;
}

SharedFactor::Outcome SharedFactor::outcome_of_direct() {
  PC pc = nullptr;
  must(KSPGetPC(solver_, &pc));
  must(KSPSetOperators(solver_, matrix_, matrix_));
  must(PCFactorSetUpMatSolverType(pc));
  Mat factor = nullptr;
  must(PCFactorGetMatrix(pc, &factor));
  MatSolverType package = nullptr;
  must(MatFactorGetSolverType(factor, &package));
  const bool mumps = std::strcmp(package, MATSOLVERMUMPS) == 0;
  for (int room = first_room;; room *= 3) {
    if (mumps) {
      must(MatMumpsSetIcntl(factor, 14, room));
      if (!definite_) must(MatMumpsSetIcntl(factor, 13, 1));              // no parallel root: its pivots would not be counted
      if (!definite_) must(MatMumpsSetIcntl(factor, 24, 0));
    }
    must(KSPSetUp(solver_));
    MatFactorError error = MAT_FACTOR_NOERROR;
    must(PCFactorGetMatrix(pc, &factor));
    must(MatFactorGetError(factor, &error));
    if (error == MAT_FACTOR_OUTMEMORY && mumps && room <= most_room) {
      must(MatAssemblyBegin(matrix_, MAT_FINAL_ASSEMBLY));                // counts as a new one, and is factorised again
      must(MatAssemblyEnd(matrix_, MAT_FINAL_ASSEMBLY));
      continue;
    }
    if (error == MAT_FACTOR_OUTMEMORY) return Outcome::no_memory;
    if (error != MAT_FACTOR_NOERROR) return Outcome::none;
    break;
  }
  PetscInt negative = 0, zero = 0;
  if (mumps) must(MatMumpsGetInfog(factor, 12, &negative));
  else must(MatGetInertia(factor, &negative, &zero, nullptr));
  negative_ = static_cast<int>(negative);
  return definite_ && negative + zero > 0 ? Outcome::none : Outcome::made;
}

Vector SharedFactor::gathered(Vec v) const {
  PetscInt own = 0;
  must(VecGetLocalSize(v, &own));
  Vector whole(rows());
  const double* part = nullptr;
  must(VecGetArrayRead(v, &part));
  MPI_Gatherv(part, static_cast<int>(own), MPI_DOUBLE, whole.data(), rows_of_.data(), row_at_.data(), MPI_DOUBLE, 0, PETSC_COMM_WORLD);
  must(VecRestoreArrayRead(v, &part));
  return whole;
}

Vector SharedFactor::solve(const Vector& b) {
  double* part = nullptr;
  PetscInt own = 0;
  must(VecGetLocalSize(b_, &own));
  must(VecGetArray(b_, &part));
  MPI_Scatterv(b.data(), rows_of_.data(), row_at_.data(), MPI_DOUBLE, part, static_cast<int>(own), MPI_DOUBLE, 0, PETSC_COMM_WORLD);
  must(VecRestoreArray(b_, &part));
  must(KSPSolve(solver_, b_, x_));
  KSPConvergedReason reason = KSP_CONVERGED_ITERATING;
  must(KSPGetConvergedReason(solver_, &reason));
  if (reason < 0) must(VecSet(x_, 0));
  return gathered(x_);
}

Eigen::MatrixXd SharedFactor::lowest(int count) {
  PetscInt own = 0;
  must(VecGetLocalSize(b_, &own));
  Mat inverse = nullptr;                                   // SLEPc's own would be factorised once more
  must(MatCreateShell(PETSC_COMM_WORLD, own, own, PETSC_DETERMINE, PETSC_DETERMINE, solver_, &inverse));
  must(MatShellSetOperation(inverse, MATOP_MULT, reinterpret_cast<void (*)()>(static_cast<PetscErrorCode (*)(Mat, Vec, Vec)>([](Mat a, Vec x, Vec y) {
    KSP solver = nullptr;
    must(MatShellGetContext(a, &solver));
    return KSPSolve(solver, x, y);
  }))));
  EPS eigen = nullptr;
  must(EPSCreate(PETSC_COMM_WORLD, &eigen));
  must(EPSSetOperators(eigen, inverse, nullptr));
  must(EPSSetProblemType(eigen, EPS_HEP));
  must(EPSSetDimensions(eigen, count, PETSC_DEFAULT, PETSC_DEFAULT));
  must(EPSSetWhichEigenpairs(eigen, EPS_LARGEST_MAGNITUDE));
  must(EPSSetFromOptions(eigen));
  must(EPSSolve(eigen));
  PetscInt found = 0;
  must(EPSGetConverged(eigen, &found));
  found = std::min<PetscInt>(found, count);
  Eigen::MatrixXd vectors(rows(), found);
  for (PetscInt j = 0; j < found; ++j) {
    must(EPSGetEigenvector(eigen, j, x_, nullptr));
    const Vector v = gathered(x_);
    if (own_rank() == 0) vectors.col(j) = v;
  }
  must(EPSDestroy(&eigen));
  must(MatDestroy(&inverse));
  return vectors;
}

}  // namespace elamin
