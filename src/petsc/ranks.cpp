// The module: rank 0 asks, the others do with it what it asks, each by the same call of the same object.
#include "solve/ranks.hpp"

#include "petsc/shared_factor.hpp"
#include "solve/blas.hpp"

#include <slepcsys.h>

#include <atomic>
#include <chrono>
#include <cmath>
#include <map>
#include <mutex>
#include <thread>
#include <utility>

namespace elamin {

namespace {

enum class Task : int { begin, pattern, numbers, solution, eigenvectors, drop, options, release };

struct Message {
  Task task;
  int which = 0;                                 // of the shared factors
  int number = 0;                                // a flag, a count, a length
};

constexpr int number_wanted = 1, number_given = 2;         // tags
constexpr int spins = 20'000;                              // asked so often without a pause: answers come within microseconds …
constexpr auto pause = std::chrono::microseconds(100);     // … or the others compute, and want the cores

class PetscRanks;

/// A shared factor, as rank 0 has it.
class OfAll final : public Factorization {
 public:
  OfAll(PetscRanks& ranks, int which, bool definite) : ranks_(ranks), which_(which), factor_(definite) {}
  ~OfAll() override;
  void analyze(const SparseMatrix& pattern, int borders) override;
  bool factorize(const SparseMatrix& hessian, double shift, const Eigen::MatrixXd& borders) override;
  int negative() const override { return factor_.negative(); }
  using Factorization::solve;
  Eigen::MatrixXd solve(const Eigen::MatrixXd& b) override;
  Eigen::MatrixXd lowest(int count) override;
  bool iterates() const override { return factor_.iterates(); }
  void set_near_null(const Eigen::MatrixXd& motions) override { near_null_ = motions; }

 private:
  PetscRanks& ranks_;
  int which_, borders_ = 0;
  SharedFactor factor_;
  Eigen::MatrixXd near_null_;
  std::vector<double> values_;
};

class PetscRanks final : public Ranks {
 public:
  PetscRanks() {
    MPI_Comm_rank(PETSC_COMM_WORLD, &rank_);
    MPI_Comm_size(PETSC_COMM_WORLD, &size_);
    MPI_Comm beside = MPI_COMM_NULL;
    MPI_Comm_split_type(PETSC_COMM_WORLD, MPI_COMM_TYPE_SHARED, rank_, MPI_INFO_NULL, &beside);
    MPI_Comm_size(beside, &on_this_machine_);
    MPI_Comm_free(&beside);
  }
  ~PetscRanks() override {
    if (SlepcInitializeCalled) SlepcFinalize();
    int finalized = 0;
    MPI_Finalized(&finalized);
    if (!finalized) MPI_Finalize();
  }
  int rank() const override { return rank_; }
  int size() const override { return size_; }
  int on_this_machine() const override { return on_this_machine_; }

  std::unique_ptr<Factorization> factorization(bool definite) override {
    const int which = next_++;
    ask({Task::begin, which, definite});
    return std::make_unique<OfAll>(*this, which, definite);
  }
  void set_options(const std::string& text) override {
    ask({Task::options, 0, static_cast<int>(text.size())});
    std::string copy = text;
    MPI_Bcast(copy.data(), static_cast<int>(copy.size()), MPI_CHAR, 0, PETSC_COMM_WORLD);
    read_options(copy);
  }
  void release(Release to) override { ask({Task::release, 0, static_cast<int>(to)}); }

  void deal(int count) override {
    next_number_ = 0, numbers_ = count;
    dealer_ = std::jthread([this] {                        // alone in MPI until close()
      for (int others = size_ - 1; others > 0;) {
        MPI_Status status;
        int there = 0;
        MPI_Iprobe(MPI_ANY_SOURCE, number_wanted, PETSC_COMM_WORLD, &there, &status);
        if (!there) {
          std::this_thread::sleep_for(10 * pause);
          continue;
        }
        int leaves = 0;
        MPI_Recv(&leaves, 1, MPI_INT, status.MPI_SOURCE, number_wanted, PETSC_COMM_WORLD, MPI_STATUS_IGNORE);
        const int number = leaves ? -1 : taken();
        if (number < 0) --others;
        if (!leaves) MPI_Send(&number, 1, MPI_INT, status.MPI_SOURCE, number_given, PETSC_COMM_WORLD);
      }
    });
  }
  std::optional<int> take() override {
    int number = -1;
    if (rank_ == 0) {
      number = taken();
    } else if (!told_none_) {
      wish(0);
      MPI_Recv(&number, 1, MPI_INT, 0, number_given, PETSC_COMM_WORLD, MPI_STATUS_IGNORE);
      told_none_ = number < 0;
    }
    return number < 0 ? std::nullopt : std::optional(number);
  }
  void close() override {
    if (rank_ > 0 && !std::exchange(told_none_, true)) wish(1);
    dealer_ = {};                                          // joins
  }

  Release serve() override {
    told_none_ = false;
    for (;;) {
      const Message message = heard();
      switch (message.task) {
        case Task::begin: factors_.try_emplace(message.which, std::make_unique<SharedFactor>(message.number != 0)); break;
        case Task::pattern: of(message).set_pattern({}, {}); break;
        case Task::numbers: (void)of(message).factorize({}); break;
        case Task::solution: for (int j = 0; j < message.number; ++j) of(message).solve({}); break;
        case Task::eigenvectors: of(message).lowest(message.number); break;
        case Task::drop: factors_.erase(message.which); break;
        case Task::options: {
          std::string text(static_cast<std::size_t>(message.number), ' ');
          MPI_Bcast(text.data(), message.number, MPI_CHAR, 0, PETSC_COMM_WORLD);
          read_options(text);
          break;
        }
        case Task::release: return static_cast<Release>(message.number);
      }
    }
  }

  void ask(Message message) {                              // as heard() hears it: MPI matches no broadcast that waits with one that does not
    MPI_Request request;
    MPI_Ibcast(&message, sizeof message, MPI_BYTE, 0, PETSC_COMM_WORLD, &request);
    MPI_Wait(&request, MPI_STATUS_IGNORE);
  }

 private:
  SharedFactor& of(const Message& message) { return *factors_.at(message.which); }
  int taken() {
    const int number = next_number_++;
    return number < numbers_ ? number : -1;
  }
  static void wish(int leaves) { MPI_Send(&leaves, 1, MPI_INT, 0, number_wanted, PETSC_COMM_WORLD); }
  static void read_options(const std::string& text) { must(PetscOptionsInsertString(nullptr, text.c_str())); }
  static Message heard() {
    Message message{};
    MPI_Request request;
    MPI_Ibcast(&message, sizeof message, MPI_BYTE, 0, PETSC_COMM_WORLD, &request);
    int there = 0;
    for (int k = 0; MPI_Test(&request, &there, MPI_STATUS_IGNORE), !there; ++k)
      if (k > spins) std::this_thread::sleep_for(pause);
    return message;
  }

  int rank_ = 0, size_ = 1, on_this_machine_ = 1, next_ = 0;
  std::map<int, std::unique_ptr<SharedFactor>> factors_;   // of ranks above 0
  std::atomic<int> next_number_{0};
  int numbers_ = 0;
  bool told_none_ = false;
  std::jthread dealer_;
};

OfAll::~OfAll() { ranks_.ask({Task::drop, which_}); }

void OfAll::analyze(const SparseMatrix& pattern, int borders) {
  const int n = static_cast<int>(pattern.rows());
  borders_ = borders;
  UpperRows rows;
  rows.starts.reserve(static_cast<std::size_t>(n + borders) + 1);
  rows.columns.reserve(static_cast<std::size_t>(pattern.nonZeros()) + static_cast<std::size_t>(n + 1) * static_cast<std::size_t>(borders));
  for (int j = 0; j < n + borders; ++j) {
    rows.starts.push_back(static_cast<int>(rows.columns.size()));
    if (j < n) {
      rows.columns.insert(rows.columns.end(), pattern.innerIndexPtr() + pattern.outerIndexPtr()[j], pattern.innerIndexPtr() + pattern.outerIndexPtr()[j + 1]);
      for (int b = 0; b < borders; ++b) rows.columns.push_back(n + b);
    } else {
      rows.columns.push_back(j);
    }
  }
  rows.starts.push_back(static_cast<int>(rows.columns.size()));
  values_.resize(rows.columns.size());
  ranks_.ask({Task::pattern, which_});
  factor_.set_pattern(rows, near_null_);
}

bool OfAll::factorize(const SparseMatrix& hessian, double shift, const Eigen::MatrixXd& borders) {
  const double* const h = hessian.valuePtr();
  const double scale = borders_ > 0 ? border_scale(hessian, shift) : 0;
  std::size_t k = 0;
  for (int j = 0; j < hessian.outerSize(); ++j) {
    for (int i = hessian.outerIndexPtr()[j]; i < hessian.outerIndexPtr()[j + 1]; ++i) values_[k++] = h[i] + (i == hessian.outerIndexPtr()[j] ? shift : 0.0);
    for (int b = 0; b < borders_; ++b) values_[k++] = scale * borders(j, b);
  }
  std::fill(values_.end() - borders_, values_.end(), 0.0);
  ranks_.ask({Task::numbers, which_});
  const SharedFactor::Outcome outcome = factor_.factorize(values_);
  if (outcome == SharedFactor::Outcome::no_memory) throw OutOfMemory("there is not enough memory for a factor of the Hessian (MUMPS over MPI)");
  return outcome == SharedFactor::Outcome::made;
}

Eigen::MatrixXd OfAll::solve(const Eigen::MatrixXd& b) {
  if (b.size() == 0) return b;
  Eigen::MatrixXd x(b.rows(), b.cols());
  ranks_.ask({Task::solution, which_, static_cast<int>(b.cols())});
  for (Eigen::Index j = 0; j < b.cols(); ++j) {
    Vector column = Vector::Zero(factor_.rows());
    column.head(b.rows()) = b.col(j);
    x.col(j) = factor_.solve(column).head(b.rows());
  }
  return x;
}

Eigen::MatrixXd OfAll::lowest(int count) {
  ranks_.ask({Task::eigenvectors, which_, count});
  return factor_.lowest(count);
}

}  // namespace

}  // namespace elamin

/// Joins the ranks; the one function that the program looks for in the module. Null: MPI has not begun.
extern "C" elamin::Ranks* elamin_join_ranks() {
  int provided = 0;
  if (MPI_Init_thread(nullptr, nullptr, MPI_THREAD_SERIALIZED, &provided) != MPI_SUCCESS || provided < MPI_THREAD_SERIALIZED) return nullptr;
  PetscOptionsSetValue(nullptr, "-no_signal_handler", nullptr);            // signals are the program's
  if (SlepcInitialize(nullptr, nullptr, nullptr, nullptr) != 0) return nullptr;
  return new elamin::PetscRanks;
}
