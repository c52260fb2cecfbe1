#pragma once

/// What goes along with a run that Python has started: progress, and the interrupt key.

#include "epafi/simulation/SceneRun.hpp"

#include <pybind11/pybind11.h>

#include <optional>
#include <string>

namespace epafi::python {

/// Methods are called without Python's lock, the constructor, raise() and the destructor with it.
class Watch final : public simulation::RunCompanion {
public:
  /// \param progress  called as progress(what, iteration, projected gradient, products) a few times a second;
  /// or None
  Watch(RCP<const Comm> comm, pybind11::object progress);

  /// \throws simulation::Interrupted if a rank has been.
  RCP<const Vector> begin(const decomposition::DecomposedProblem& problem) override;
  void beforeIteration() override; ///< likewise
  void meshing() override;
  void step(const qp::StepRecord& record) override;
  [[nodiscard]] bool wantsToStop() override;

  /// After a run that was interrupted: what the signal's handler has raised on this rank, on others
  /// KeyboardInterrupt.
  [[noreturn]] void raise();

private:
  void tell(const std::string& what, const qp::StepRecord& record);
  void requireNone();
  [[nodiscard]] bool isDue(double interval, double& last) const;

  RCP<const Comm> comm_;
  pybind11::object progress_;
  double lastLine_, lastLook_ = 0; ///< wall times
  std::optional<pybind11::error_already_set> error_;
};

} // namespace epafi::python
