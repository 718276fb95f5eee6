#include "solve/ranks.hpp"

#include "core/error.hpp"

#include <dlfcn.h>
#include <fmt/format.h>

#include <cstdlib>
#include <filesystem>
#include <utility>

namespace elamin {

namespace {

Ranks* joined = nullptr;
thread_local bool sharing = false;

// What mpirun, mpiexec or srun tell each process that they start.
bool started_with_others() {
  for (const char* const told : {"OMPI_COMM_WORLD_SIZE", "PMI_SIZE", "PMIX_RANK"})
    if (std::getenv(told)) return true;
  return false;
}

// The module stands beside the program where that was built, above its tests, or in a folder of its own where it is installed.
std::filesystem::path module_file() {
  const std::filesystem::path folder = std::filesystem::read_symlink("/proc/self/exe").parent_path();
  for (const char* const place : {".", ".."})
    if (const auto file = folder / place / ELAMIN_MODULE; std::filesystem::exists(file)) return file;
  return folder / ELAMIN_MODULES / ELAMIN_MODULE;
}

}  // namespace

Ranks* ranks() { return joined; }

Ranks* join_ranks() {
  if (joined || !started_with_others()) return joined;
  const std::string file = module_file();
  if (!std::filesystem::exists(file))
    throw InputError(fmt::format("mpirun has started this program, which was built without PETSc and SLEPc: {} is not there; install petsc-dev and slepc-dev and "
                                 "build again (cmake -DELAMIN_PETSC=ON), or start it without mpirun", file));
  // PETSc brings the MUMPS that works over MPI; this program has the one that does not, whose functions have the same names: each keeps its own.
  void* const module = dlopen(file.c_str(), RTLD_NOW | RTLD_LOCAL | RTLD_DEEPBIND);
  if (!module) throw InputError(fmt::format("{} cannot be loaded: {}", file, dlerror()));
  const auto join = reinterpret_cast<Ranks* (*)()>(dlsym(module, "elamin_join_ranks"));
  joined = join ? join() : nullptr;
  if (!joined) throw InputError(file + ": MPI does not begin");
  return joined;
}

void leave_ranks() { delete std::exchange(joined, nullptr); }

ShareFactorizations::ShareFactorizations(bool shared) : before_(std::exchange(sharing, shared && joined != nullptr)) {}
ShareFactorizations::~ShareFactorizations() { sharing = before_; }

std::unique_ptr<Factorization> shared_factorization(bool definite) { return sharing ? joined->factorization(definite) : nullptr; }

}  // namespace elamin
