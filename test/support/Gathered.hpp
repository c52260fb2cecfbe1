#pragma once

/// Small decomposed problems and what the tests look at: the matrices of the whole problem, dense, on every
/// rank.

#include "epafi/base/Collective.hpp"
#include "epafi/model/Decompose.hpp"

#include <Eigen/Core>

#include <memory>
#include <span>
#include <string>
#include <vector>

namespace epafi::decomposition {

using contact::ContactLayout;
using meshing::GraphPartition;
using meshing::GridPartition;
using meshing::Partition;
using model::BodyLayout;
using model::decompose;
using model::Decomposition;
using model::layoutBodies;
using model::makeModel;

/// Lets `change(matrix)` change the stiffness of one subdomain, and of no other that shares it.
template <class Change>
void changeStiffness(Subdomain& subdomain, const Change& change) {
  const auto matrix = std::make_shared<SparseMatrix>(*subdomain.stiffness);
  change(*matrix);
  subdomain.stiffness = matrix;
}

/// The communicator of all ranks.
RCP<const Comm> world();

/// The paper's membranes with any cut: Ω² stands on Ω¹'s right side.
scene::Scene twoMembranes(bool coercive, int elements, const scene::Decomposition& cut);

scene::Decomposition grid(int nx, int ny);
scene::Decomposition metis(int parts);
/// The same, `size` subdomains a cluster.
scene::Decomposition clustered(scene::Decomposition cut, int size);

/// One square body of n × m elements, without contact.
scene::Scene oneBody(int n, int m, const scene::Decomposition& cut,
                     const std::vector<fem::SolidSupport>& supports);

/// Sums a vector or matrix over ranks. Collective.
template <class Matrix>
void sumEntries(const Comm& comm, Matrix& matrix) {
  sumOverRanks(comm, std::span(matrix.data(), static_cast<std::size_t>(matrix.size())));
}

/// A node of the whole problem as one number: unique over bodies.
double nodeKey(const Subdomain& subdomain, int unknown, int components);

/// Column of each unknown of this rank's subdomains in the whole problem: remainder unknowns first,
/// crosspoint unknowns last, one column for all copies of a crosspoint.
std::vector<std::vector<Eigen::Index>> mergedColumns(const DecomposedProblem& problem);
/// Number of those columns.
Eigen::Index mergedSize(const DecomposedProblem& problem);

/// K̄ of the whole problem: remainder unknowns first, crosspoint unknowns last. Collective.
Eigen::MatrixXd mergedStiffness(const DecomposedProblem& problem);

/// B of the whole problem over the columns of mergedStiffness. Collective.
Eigen::MatrixXd mergedConstraint(const DecomposedProblem& problem);

/// Smallest pivot of every K_rr of this rank's subdomains over its largest diagonal entry; ≤ 0 if one is
/// singular.
double smallestPivot(const DecomposedProblem& problem);

/// Number of eigenvalues below 1e-10 of the largest.
int kernelDimension(const Eigen::MatrixXd& symmetric);

/// The scenes on which every structural property is checked.
struct Case {
  std::string name;
  scene::Scene scene;
};
std::vector<Case> smallCases();

} // namespace epafi::decomposition
