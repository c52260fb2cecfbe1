#pragma once

/// Small contact problems, and dense copies of all that FETI-DP computes with, on every rank.

#include "Gathered.hpp"

#include "epafi/fetidp/operator/GeneralizedInverse.hpp"
#include "epafi/model/Decompose.hpp"

#include <Eigen/Core>

#include <string>
#include <vector>

namespace epafi::fetidp {

using decomposition::clustered;
using decomposition::DecomposedProblem;
using decomposition::grid;
using decomposition::metis;
using decomposition::twoMembranes;
using decomposition::world;
using model::decompose;

/// Three unit membranes side by side with a contact pair between neighbours. The first one is held on its
/// left side, the last one on its right side unless it floats; the middle one floats always.
scene::Scene threeMembranes(bool lastFloats, int elements, const scene::Decomposition& cut);

/// Constant load on a whole body, instead of what it carries.
void setLoad(scene::Body& body, double value);

/// Loads on the lower and the upper half of a body, instead of what it carries.
void setHalves(scene::Body& body, double lower, double upper);

/// A scene and its name. `coercive` means that no body floats.
struct ContactCase {
  std::string name;
  scene::Scene scene;
  bool coercive = true;
};

/// Two and three bodies, held and floating, cut in all ways that a small mesh allows. The loads press
/// floating bodies onto their contacts and open a part of these.
std::vector<ContactCase> contactCases();
/// Those of them that float.
std::vector<ContactCase> floatingCases();
/// Membranes of two clusters each, whose edges end at the other one.
std::vector<ContactCase> clusteredCases();

/// The matrices over merged unknowns (remainder first, crosspoints last), on every rank.
struct DenseProblem {
  Eigen::MatrixXd stiffness;  ///< K̄
  Eigen::MatrixXd constraint; ///< B̄
  Eigen::MatrixXd kernel;     ///< R
  Eigen::VectorXd load;       ///< f̄
  Eigen::VectorXd gap;        ///< c
};

/// Without loads and gaps. Collective.
DenseProblem densify(const DecomposedProblem& problem);
/// With them; f̄ without what prescribed values take. Collective.
DenseProblem densify(const DecomposedProblem& problem, const decomposition::ProblemData& data);

/// A vector over merged unknowns as values of this rank's subdomains; all copies of a crosspoint agree.
SubdomainVectors valuesOf(const DecomposedProblem& problem, const Eigen::VectorXd& merged);
/// The same for forces: a crosspoint's force goes to one of its copies. Collective.
SubdomainVectors forcesOf(const DecomposedProblem& problem, const Eigen::VectorXd& merged);
/// Merged values of the subdomains' values, whose copies must agree. Collective.
Eigen::VectorXd mergeValues(const DecomposedProblem& problem, const SubdomainVectors& u);

/// An operator's matrix: its products with all unit vectors, on every rank. Collective.
Eigen::MatrixXd matrixOf(const Operator& a);
/// A vector on every rank. Collective.
Eigen::VectorXd gathered(const Vector& x);
/// This rank's part of a vector that every rank holds.
RCP<Vector> spread(const RCP<const Map>& map, const Eigen::VectorXd& values);

/// Pseudo-inverse of a symmetric matrix; eigenvalues below 1e-10 of the largest count as zero.
Eigen::MatrixXd pseudoInverse(const Eigen::MatrixXd& symmetric);
/// ‖a − b‖ / max(‖b‖, tiny).
double relativeError(const Eigen::MatrixXd& a, const Eigen::MatrixXd& b);
/// Random vector, the same on all ranks.
Eigen::VectorXd randomVector(Eigen::Index n, unsigned seed);

} // namespace epafi::fetidp
