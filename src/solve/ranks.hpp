#pragma once
// The processes that mpirun has started together, the ranks: they share factorisations, or the runs of a sweep. elamin_petsc, a
// module of its own, connects them by MPI, PETSc and SLEPc (src/petsc); the program without it knows nothing of these.
#include "solve/factorization.hpp"

#include <functional>
#include <memory>
#include <optional>
#include <string>

namespace elamin {

/// Rank 0 runs the program; the others serve what it asks of all.
class Ranks {
 public:
  /// What the others were released for.
  enum class Release { end, sweep };

  virtual ~Ranks() = default;
  virtual int rank() const = 0;
  virtual int size() const = 0;
  /// How many of them are on this machine.
  virtual int on_this_machine() const = 0;

  // Of rank 0.
  /// A factorisation that all ranks share; `definite`: of positive definite matrices alone, as Cholesky's. LDLᵀ by MUMPS, or what
  /// PETSc's options say.
  virtual std::unique_ptr<Factorization> factorization(bool definite) = 0;
  /// Options in PETSc's words, "-mat_mumps_icntl_14 80", for the factorisations from now on.
  virtual void set_options(const std::string& options) = 0;
  /// The others leave serve().
  virtual void release(Release to) = 0;
  /// From now on each of the numbers 0 … count − 1 is for the rank that takes it.
  virtual void deal(int count) = 0;

  // Of all.
  /// The next number; none is left: nothing.
  virtual std::optional<int> take() = 0;
  /// Takes no more; rank 0 waits until no other does.
  virtual void close() = 0;

  // Of the others.
  virtual Release serve() = 0;
};

/// The ranks of this program; null: it is alone.
Ranks* ranks();
/// Joins the ranks where mpirun has started this program, else null. Throws InputError if there is no module for that.
Ranks* join_ranks();

/// The last call of each rank.
void leave_ranks();

/// While it lives, factorisations that this thread begins are those of all ranks, if there are ranks.
class [[nodiscard]] ShareFactorizations {
 public:
  explicit ShareFactorizations(bool shared = true);
  ~ShareFactorizations();
  ShareFactorizations(const ShareFactorizations&) = delete;
  ShareFactorizations& operator=(const ShareFactorizations&) = delete;

 private:
  bool before_;
};

/// A factorisation of all ranks (see Ranks::factorization) where this thread shares its own; else null.
std::unique_ptr<Factorization> shared_factorization(bool definite);

}  // namespace elamin
