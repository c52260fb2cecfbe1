#include "Watch.hpp"

#include "epafi/base/Collective.hpp"

#include <Teuchos_Time.hpp>

#include <utility>

namespace epafi::python {

namespace py = pybind11;

Watch::Watch(RCP<const Comm> comm, py::object progress)
    : comm_(std::move(comm)), progress_(std::move(progress)), lastLine_(Teuchos::Time::wallTime()) {}

bool Watch::isDue(double interval, double& last) const {
  const double now = Teuchos::Time::wallTime();
  if (now - last < interval)
    return false;
  last = now;
  return true;
}

void Watch::requireNone() {
  if (holdsAnywhere(*comm_, wantsToStop()))
    throw simulation::Interrupted("interrupted before the iteration: there is nothing to keep");
}

RCP<const Vector> Watch::begin(const decomposition::DecomposedProblem& /*problem*/) {
  lastLook_ = 0;
  requireNone();
  tell("factorising", {});
  return Teuchos::null;
}

void Watch::beforeIteration() {
  lastLook_ = 0;
  requireNone();
}

void Watch::meshing() {
  tell("meshing", {});
}

void Watch::step(const qp::StepRecord& record) {
  tell("iterating", record);
}

void Watch::tell(const std::string& what, const qp::StepRecord& record) {
  if (progress_.is_none() || error_ || !isDue(0.2, lastLine_))
    return;
  const py::gil_scoped_acquire lock;
  try {
    progress_(what, record.iteration, record.projectedGradient, record.hessianMultiplications);
  } catch (py::error_already_set& error) {
    error_.emplace(std::move(error));
  }
}

/// Python has noted signals; their handlers run here.
bool Watch::wantsToStop() {
  if (!error_ && isDue(0.05, lastLook_)) {
    const py::gil_scoped_acquire lock;
    if (PyErr_CheckSignals() != 0)
      error_.emplace();
  }
  return error_.has_value();
}

void Watch::raise() {
  if (error_)
    throw py::error_already_set(std::move(*error_));
  PyErr_SetNone(PyExc_KeyboardInterrupt);
  throw py::error_already_set();
}

} // namespace epafi::python
