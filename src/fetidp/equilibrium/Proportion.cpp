#include "epafi/fetidp/equilibrium/Proportion.hpp"

#include "epafi/base/Collective.hpp"
#include "epafi/base/Errors.hpp"
#include "epafi/direct/DenseSymmetric.hpp"
#include "epafi/fetidp/equilibrium/MotionWords.hpp"

#include <Tpetra_Vector.hpp>

#include <algorithm>
#include <cmath>
#include <span>
#include <sstream>
#include <vector>

namespace epafi::fetidp {
namespace {

using decomposition::DecomposedProblem;
using decomposition::Subdomain;
using Eigen::MatrixXd;
using Eigen::VectorXd;

/// R of whole bodies in a subdomain.
MatrixXd modesOf(const DecomposedProblem& problem, const Subdomain& subdomain) {
  return subdomain.kernel * problem.clusterAt(subdomain).ofBody;
}

/// The rigid motions that are nearest to u, body by body. Collective.
std::vector<VectorXd> rigidParts(const DecomposedProblem& problem, const SubdomainVectors& u) {
  std::vector<MatrixXd> sums; // [RᵀR, Rᵀu] of each body
  for (const auto& body : problem.bodies)
    sums.emplace_back(MatrixXd::Zero(body.kernelDimension, body.kernelDimension + 1));
  for (std::size_t s = 0; s < u.size(); ++s) {
    const MatrixXd modes = modesOf(problem, problem.subdomains[s]);
    MatrixXd& sum = sums[problem.subdomains[s].body];
    sum.leftCols(modes.cols()) += modes.transpose() * modes;
    sum.rightCols(1) += modes.transpose() * u[s].leftCols(1);
  }
  std::vector<VectorXd> parts;
  for (MatrixXd& sum : sums) {
    sumOverRanks(*problem.comm, std::span(sum.data(), sum.size()));
    parts.emplace_back(direct::solvedSymmetric(sum.leftCols(sum.rows()), sum.rightCols(1)));
  }
  return parts;
}

double largestOf(const DecomposedProblem& problem, const Subdomain& subdomain, const VectorXd& unknowns) {
  const VectorXd values =
      decomposition::atAllPositions(subdomain, unknowns, VectorXd::Zero(problem.numPositions(subdomain)));
  return values.size() > 0 ? values.lpNorm<Eigen::Infinity>() : 0.0;
}

/// Bodies that meet surfaces whose normals are known but up to their facets. Where all are exact, the linear
/// problem's answer stands. Collective.
std::vector<double> uncertainBodies(const DecomposedProblem& problem) {
  constexpr double exact = 1e-6; // radians
  std::vector<double> isUncertain(problem.bodies.size(), 0.0);
  for (const decomposition::ContactPlace& place : problem.places)
    if (std::max(place.first.uncertainty, place.second.uncertainty) > exact)
      for (const int body : {place.first.body, place.second.body})
        isUncertain[body] = 1;
  for (double& each : isUncertain)
    each = maxOverRanks(*problem.comm, each);
  return isUncertain;
}

} // namespace

void requireProportion(const DecomposedProblem& problem, const decomposition::ProblemData& data,
                       const SubdomainVectors& u, const Vector& lambda) {
  if (problem.numRigidModes() == 0)
    return;
  const std::vector<double> isUncertain = uncertainBodies(problem);
  if (std::count(isUncertain.begin(), isUncertain.end(), 1.0) == 0)
    return;
  const std::vector<VectorXd> rigid = rigidParts(problem, u);
  std::vector<double> moved(problem.bodies.size(), 0.0);
  double usual = 0; // deformations, prescribed displacements, and gaps that closed
  for (std::size_t s = 0; s < u.size(); ++s) {
    const Subdomain& subdomain = problem.subdomains[s];
    const std::size_t body = subdomain.body;
    const VectorXd motion = modesOf(problem, subdomain) * rigid[body];
    moved[body] = std::max(moved[body], largestOf(problem, subdomain, motion));
    usual = std::max(usual, largestOf(problem, subdomain, u[s].col(0) - motion));
    if (const VectorXd& prescribed = data.subdomains()[s].prescribed; prescribed.size() > 0)
      usual = std::max(usual, prescribed.lpNorm<Eigen::Infinity>());
  }
  const auto gap = data.gap().getData(), force = lambda.getData();
  for (Teuchos_Ordinal row = 0; row < gap.size(); ++row)
    if (force[row] > 0)
      usual = std::max(usual, std::abs(gap[row]));
  usual = maxOverRanks(*problem.comm, usual);
  constexpr double often = 100;
  for (std::size_t b = 0; b < moved.size(); ++b) {
    const decomposition::Body& body = problem.bodies[b];
    const double distance = maxOverRanks(*problem.comm, moved[b]);
    if (isUncertain[b] == 0 || !body.motions || distance <= std::max(2 * body.motions->size, often * usual))
      continue;
    VectorXd motion = VectorXd::Zero(problem.numRigidModes());
    motion.segment(body.kernelOffset, body.kernelDimension) = rigid[b];
    std::ostringstream text;
    text << "not unique: the floating body '" << body.name << "' would move by " << distance << ", "
         << distance / (2 * body.motions->size) << " times its size, almost as a rigid body ("
         << wordsOf(problem, motion).motion
         << "), while nothing is deformed, and no gap closed, by more than " << usual
         << ": gaps are linear in the displacements, so that this solves nothing; contacts hinder that "
            "motion, but do not hold it; "
            "add a support";
    throw SolvabilityError(SolvabilityError::Kind::notUnique, text.str());
  }
}

} // namespace epafi::fetidp
