#include "epafi/fetidp/Balancing.hpp"

#include "epafi/fetidp/ProblemScales.hpp"
#include "epafi/qp/FaceInverse.hpp"

#include <Tpetra_Map.hpp>
#include <Tpetra_Vector.hpp>

#include <algorithm>
#include <memory>
#include <vector>

namespace epafi::fetidp {
namespace {

bool isContact(const decomposition::DecomposedProblem& problem, LocalOrdinal row) {
  return problem.kindOf(decomposition::OwnedMultiplier(row)) == decomposition::RowKind::contact;
}

/// 1 where rows may take more force or less.
void markFree(const decomposition::DecomposedProblem& problem, const Vector& lambda, Vector& face) {
  const auto force = lambda.getData();
  const auto isFree = face.getDataNonConst();
  for (LocalOrdinal row = 0; row < force.size(); ++row)
    isFree[row] = isContact(problem, row) && !(force[row] > 0) ? 0 : 1;
}

} // namespace

double gradientReference(const decomposition::DecomposedProblem& problem, const Vector& d, double roundOff) {
  constexpr double most = 10;
  Vector violated(d, Teuchos::Copy);
  {
    const auto values = violated.getDataNonConst();
    for (LocalOrdinal row = 0; row < values.size(); ++row)
      if (isContact(problem, row))
        values[row] = std::max(values[row], 0.0);
  }
  const double whole = accurateNorm(d), part = accurateNorm(violated);
  return violated.normInf() > roundOff ? std::min(whole, most * part) : whole;
}

double equilibriumReference(const decomposition::DecomposedProblem& problem, const NaturalCoarseSpace& space,
                            const Eigen::VectorXd& resultants, double gradient, double norm) {
  const double resultant = space.normOf(resultants),
               largest = space.normOf(ProblemScales(problem).resultants());
  if (resultant > ProblemScales::resultant * largest)
    return resultant;
  return norm > 0 ? gradient / norm : largest;
}

double balance(const decomposition::DecomposedProblem& problem, const NaturalCoarseSpace& space,
               const Eigen::VectorXd& resultants, double wanted, Vector& lambda) {
  constexpr int maxSteps = 10;
  const auto left = [&](const Vector& forces) -> Eigen::VectorXd {
    return space.product(forces) - resultants;
  };
  Eigen::VectorXd rest = left(lambda);
  double size = space.normOf(rest);
  if (size <= wanted)
    return size;
  Vector face(lambda.getMap()), change(lambda.getMap()), next(lambda.getMap());
  const std::unique_ptr<qp::FaceInverse> inverse = space.faceInverse(lambda.getMap());
  std::vector<double> motion(rest.size());
  for (int step = 0; step < maxSteps && size > wanted; ++step) {
    markFree(problem, lambda, face);
    inverse->setFace(face);
    inverse->apply({rest.data(), motion.size()}, motion);
    change.putScalar(0.0);
    space.addTransposedProduct(motion, -1.0, change);
    next.elementWiseMultiply(1.0, face, change, 0.0);
    next.update(1.0, lambda, 1.0);
    {
      const auto force = next.getDataNonConst();
      for (LocalOrdinal row = 0; row < force.size(); ++row)
        if (isContact(problem, row))
          force[row] = std::max(force[row], 0.0);
    }
    const Eigen::VectorXd nextRest = left(next);
    const double nextSize = space.normOf(nextRest);
    if (!(nextSize < 0.9 * size))
      break;
    lambda.assign(next);
    rest = nextRest;
    size = nextSize;
  }
  return size;
}

} // namespace epafi::fetidp
