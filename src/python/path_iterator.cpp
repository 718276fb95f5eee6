// A path as an iterator: `trace` works on a thread of its own and hands over one point at a time.
#include "core/parallel.hpp"
#include "python/module.hpp"
#include "results/columns.hpp"
#include "results/observables.hpp"
#include "results/record.hpp"
#include "results/summary.hpp"
#include "study/modes.hpp"
#include "study/trace.hpp"

#include <condition_variable>
#include <thread>

namespace elamin::python {

namespace {

/// One point and what is known of it.
struct Step {
  PathPoint point;
  std::string stage;
  std::vector<std::string> columns;
  Row row;                             // as in path.csv
  Field forces;                        // 3 × sites
  std::vector<Field> modes;            // null vectors of an event, 3 × sites
};

py::object cell(const Cell& cell) {
  return std::visit([](const auto& v) -> py::object {
    if constexpr (std::is_same_v<std::decay_t<decltype(v)>, Nothing>) return py::none();
    else return py::cast(v);
  }, cell);
}

class PathIterator {
 public:
  explicit PathIterator(std::shared_ptr<System> system) : system_(std::move(system)), problem_(system_->problem) {
    problem_.study = StudyType::path;
  }
  ~PathIterator() { close(); }

  // Of several threads that ask, one at a time is answered.
  std::shared_ptr<Step> next() {
    std::unique_lock asking(asking_, std::defer_lock);
    {
      const py::gil_scoped_release release;
      asking.lock();
      const std::lock_guard joining(joining_);
      const std::lock_guard lock(mutex_);
      if (!worker_.joinable() && !ended_) worker_ = std::thread([this] { work(); });
      wanted_ = true;
      changed_.notify_all();
    }
    for (;;) {
      {
        const py::gil_scoped_release release;
        std::unique_lock lock(mutex_);
        changed_.wait_for(lock, std::chrono::milliseconds(50), [&] { return step_ || ended_; });
        if (step_) return std::exchange(step_, nullptr);
        if (ended_) break;
      }
      if (signals_.look()) {
        close();
        signals_.raise();
      }
    }
    close();
    if (failure_) std::rethrow_exception(std::exchange(failure_, nullptr));
    throw py::stop_iteration();
  }

  // Stops the work, if there is any, and waits for that.
  void close() {
    const py::gil_scoped_release release;
    stop_ = true;
    {
      const std::lock_guard lock(mutex_);
      changed_.notify_all();
    }
    const std::lock_guard joining(joining_);
    if (worker_.joinable()) worker_.join();
    const std::lock_guard lock(mutex_);
    ended_ = true;
  }

  std::string status() const { return worked_ ? status_name(outcome_.status) : ""; }
  std::string message() const { return outcome_.why; }
  std::vector<std::string> notes() const { return notes_; }

 private:
  struct Stopped {};

  void work() {
    const std::function<bool()> question = [this] { return stop_.load(); };
    const StopAsked stopping(question);
    take_default_threads();
    try {
      await();
      const Outcome outcome = trace_points();
      const std::lock_guard lock(mutex_);
      outcome_ = outcome, worked_ = true;
    } catch (const Stopped&) {
      outcome_ = {Status::interrupted, "the loop was left"}, worked_ = true;
    } catch (...) {
      failure_ = std::current_exception();
    }
    const std::lock_guard lock(mutex_);
    ended_ = true;
    changed_.notify_all();
  }

  // Until the next point is asked for.
  void await() {
    std::unique_lock lock(mutex_);
    changed_.wait(lock, [&] { return wanted_ || stop_; });
    if (stop_) throw Stopped();
  }

  void hand_over(std::shared_ptr<Step> step) {
    {
      const std::lock_guard lock(mutex_);
      step_ = std::move(step), wanted_ = false;
      changed_.notify_all();
    }
    await();
  }

  Outcome trace_points() {
    std::optional<StateSupplement> stored;
    if (!problem_.path.start.empty()) stored = read_supplement(problem_.path.start);
    Record record(problem_, system_->model);
    Energy* energy = nullptr;
    std::string stage_name;
    std::optional<LowestEigenvalues> lowest;
    const Sink sink{
        .stage = [&](const Stage& stage, Energy& in_force) {
          energy = &in_force, stage_name = stage.name;
          record.enter(stage, energy->model());
          if (problem_.path.eigenvalues > 0) lowest.emplace(energy->model(), problem_.path.eigenvalues);
        },
        .point = [&](const PathPoint& found, bool last) {
          if (stop_) throw Stopped();
          auto step = std::make_shared<Step>();
          step->point = found, step->stage = stage_name;
          if (last && step->point.label.empty()) step->point.label = "final";
          step->forces = energy->forces(found.state);
          record.add(step->point, step->forces, observed_touches(*energy, found.state, record.observables()),
                     lowest ? lowest->at(found.state) : std::vector<double>{});
          step->columns = record.path().columns, step->row = record.path().rows.back();
          for (Eigen::Index k = 0; k < found.modes.cols(); ++k)
            step->modes.push_back(energy->kinematics().extend(found.modes.col(k), found.state));
          hand_over(std::move(step));
        },
        .modes = {}, .note = [&](const std::string& note) { notes_.push_back(note); }};
    return trace(problem_, system_->model, stored, sink);
  }

  std::shared_ptr<System> system_;
  Problem problem_;
  Signals signals_;
  std::thread worker_;
  std::atomic<bool> stop_{false};
  std::mutex asking_, joining_;        // of who waits for a step, and of the worker's beginning and end
  std::mutex mutex_;
  std::condition_variable changed_;
  std::shared_ptr<Step> step_;         // handed over, not yet taken
  bool wanted_ = false, ended_ = false, worked_ = false;
  std::exception_ptr failure_;
  Outcome outcome_;
  std::vector<std::string> notes_;
};

}  // namespace

void add_paths(py::module_& module) {
  const auto point = [](auto PathPoint::*member) {
    return [member](const Step& s) { return s.point.*member; };
  };
  py::class_<Step, std::shared_ptr<Step>>(module, "Step", "An equilibrium of a path.")
      .def_property_readonly("x", [](const py::object& self) { return view(self.cast<const Step&>().point.state.position, self); },
                             "Positions (n, 3) [length]: a view of the solver's own numbers, read-only.")
      .def_property_readonly("state", [](const Step& s) { return s.point.state; }, "The state to all digits, to go on from.")
      .def_property_readonly("load_factor", [](const Step& s) { return s.point.state.load_factor; })
      .def_property_readonly("energy", [](const Step& s) { return s.point.energy.total(); }, "[energy]")
      .def_property_readonly("terms", [](const Step& s) { return dict_of(s.point.energy); }, "Energies by term [energy].")
      .def_property_readonly("forces", [](const py::object& self) {
        const Step& s = self.cast<const Step&>();
        return view(s.forces.leftCols(s.point.state.particles()), self);
      }, "−∂E/∂x of the particles (n, 3), loads included [force]: where a support holds, minus its reaction.")
      .def_property_readonly("stable", [](const Step& s) { return s.point.stability.stable; })
      .def_property_readonly("stability", [](const Step& s) { return s.point.stability; })
      .def_property_readonly("negative", [](const Step& s) { return s.point.stability.negative; })
      .def_property_readonly("number", point(&PathPoint::step), "From 0.")
      .def_property_readonly("label", point(&PathPoint::label), "\"initial\", \"final\", that of an event, or \"\".")
      .def_property_readonly("branch", point(&PathPoint::branch))
      .def_property_readonly("parent", point(&PathPoint::parent))
      .def_property_readonly("what", point(&PathPoint::what))
      .def_property_readonly("multiplicity", point(&PathPoint::multiplicity))
      .def_property_readonly("negative_before", point(&PathPoint::negative_before))
      .def_property_readonly("negative_after", point(&PathPoint::negative_after))
      .def_property_readonly("is_event", [](const Step& s) { return is_event(s.point.label) || s.point.negative_before >= 0; })
      .def_property_readonly("residual", [](const Step& s) { return s.point.report.residual; })
      .def_property_readonly("iterations", [](const Step& s) { return s.point.report.iterations; })
      .def_readonly("stage", &Step::stage)
      .def_property_readonly("modes", [](const py::object& self) {
        const Step& s = self.cast<const Step&>();
        py::list all;
        for (const Field& m : s.modes) all.append(view(m.leftCols(s.point.state.particles()), self));
        return all;
      }, "Of an event its null vectors, (n, 3) each.")
      .def_property_readonly("row", [](const Step& s) {
        py::dict dict;
        for (std::size_t k = 0; k < s.columns.size(); ++k) dict[py::str(s.columns[k])] = cell(s.row[k]);
        return dict;
      }, "The row of path.csv, with all that is observed.");

  py::class_<PathIterator>(module, "PathIterator", "The points of a path, found as they are asked for.")
      .def(py::init<std::shared_ptr<System>>(), py::arg("system"))
      .def("next", &PathIterator::next)
      .def("close", &PathIterator::close)
      .def_property_readonly("status", &PathIterator::status)
      .def_property_readonly("message", &PathIterator::message)
      .def_property_readonly("notes", &PathIterator::notes);
}

}  // namespace elamin::python
