#include "epafi/fetidp/equilibrium/Balancing.hpp"

#include "epafi/fetidp/equilibrium/ProblemScales.hpp"
#include "epafi/qp/constraints/FaceInverse.hpp"

#include <Tpetra_Map.hpp>
#include <Tpetra_Vector.hpp>

#include <algorithm>
#include <memory>
#include <vector>

namespace epafi::fetidp {

double gradientReference(const qp::ConvexSet& forces, const Vector& d, double roundOff) {
  constexpr double most = 10;
  Vector gradient(d, Teuchos::Copy), violated(d.getMap());
  gradient.scale(-1.0);
  forces.projectedGradient(Vector(d.getMap()), gradient, 0.0, violated); // without any force
  const double whole = accurateNorm(d), part = accurateNorm(violated);
  return violated.normInf() > roundOff ? std::min(whole, most * part) : whole;
}

double equilibriumReference(const decomposition::DecomposedProblem& problem,
                            const decomposition::ProblemData& data, const NaturalCoarseSpace& space,
                            const Eigen::VectorXd& resultants, double gradient, double norm) {
  const double resultant = space.normOf(resultants),
               largest = space.normOf(ProblemScales(problem, data).resultants());
  if (resultant > ProblemScales::resultant * largest)
    return resultant;
  return norm > 0 ? gradient / norm : largest;
}

double balance(const qp::ConvexSet& forces, const NaturalCoarseSpace& space,
               const Eigen::VectorXd& resultants, double wanted, Vector& lambda) {
  constexpr int maxSteps = 10;
  const auto left = [&](const Vector& given) -> Eigen::VectorXd { return space.product(given) - resultants; };
  Eigen::VectorXd rest = left(lambda);
  double size = space.normOf(rest);
  if (size <= wanted)
    return size;
  qp::Face face(lambda.getMap());
  Vector change(lambda.getMap()), next(lambda.getMap());
  const std::unique_ptr<qp::FaceInverse> inverse = space.faceInverse(lambda.getMap());
  std::vector<double> motion(rest.size());
  for (int step = 0; step < maxSteps && size > wanted; ++step) {
    forces.freeIndicator(lambda, face.isFree);
    inverse->setFace(face);
    inverse->apply({rest.data(), motion.size()}, motion);
    change.putScalar(0.0);
    space.addTransposedProduct(motion, -1.0, change);
    face.restrict(change, next);
    next.update(1.0, lambda, 1.0);
    forces.project(next);
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
