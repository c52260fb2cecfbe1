#pragma once

/// What the linear solvers can be told.

#include "epafi/fetidp/operator/FetiParameters.hpp"

namespace epafi::linear {

/// Of FetiDpSolver.
struct FetiDpParameters : fetidp::FetiParameters {
  double tolerance = 1e-8; ///< on ‖b − Ku‖ relative to ‖b‖
  int maxIterations = 500; ///< conjugate gradient steps
  bool operator==(const FetiDpParameters& other) const = default;

  /// Names, defaults, ranges and meaning, for `validated`.
  static Teuchos::ParameterList validParameters();
  /// From a validated list.
  static FetiDpParameters from(const Teuchos::ParameterList& list);
};

/// Of BddcPreconditioner.
struct BddcParameters {
  fetidp::DirectSolvers directSolvers;
  fetidp::PreconditionerParameters::Scaling scaling = fetidp::PreconditionerParameters::Scaling::stiffness;

  /// Names, defaults, ranges and meaning, for `validated`.
  static Teuchos::ParameterList validParameters();
  /// From a validated list.
  static BddcParameters from(const Teuchos::ParameterList& list);
};

} // namespace epafi::linear
