#pragma once

/// Stiffness, load and kernel of one subdomain: a body's elements added up, supported values eliminated.

#include "epafi/fem/BodyModel.hpp"

#include <Eigen/Core>
#include <Eigen/SparseCore>

#include <span>
#include <vector>

namespace epafi::fem {

/// The arrays of decomposition::Subdomain that physics fills; see there for shapes.
struct AssembledSubdomain {
  std::vector<GlobalOrdinal> nodes; ///< ascending
  std::vector<int> unknownPosition; ///< n_s
  std::vector<int> unknownOf;       ///< unknown at each position, −1 where supported
  Eigen::SparseMatrix<double, Eigen::ColMajor, int> stiffness;
  Eigen::VectorXd load;
  Eigen::VectorXd prescribed;
  double energyOffset = 0;
  Eigen::MatrixXd kernel;
};

/// \param elements  of the subdomain, in any order
/// K is symmetric to the last digit. Not collective.
AssembledSubdomain assemble(const BodyModel& model, std::span<const GlobalOrdinal> elements);

} // namespace epafi::fem
