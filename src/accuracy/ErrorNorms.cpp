#include "epafi/accuracy/ErrorNorms.hpp"

#include "epafi/accuracy/Transfer.hpp"
#include "epafi/base/AccurateSum.hpp"
#include "epafi/base/Collective.hpp"

#include <algorithm>
#include <cmath>

namespace epafi::accuracy {

using model::Decomposition;

ErrorNorms errorNorms(const scene::Scene& scene, const Decomposition& decomposition,
                      std::span<const Eigen::VectorXd> displacement, const ExactField& exact) {
  const auto& problem = decomposition.problem;
  AccurateSum sums[2];
  collectively(*problem.comm, [&] {
    std::vector<BodyElements> bodies = elementsOfBodies(scene, decomposition);
    for (std::size_t s = 0; s < problem.subdomains.size(); ++s) {
      const decomposition::Subdomain& subdomain = problem.subdomains[s];
      BodyElements& body = bodies[subdomain.body];
      std::function<fem::FieldValue(const Point&)> here;
      if (exact)
        here = [&](const Point& point) { return exact(subdomain.body, point); };
      // A closed form needs the points where they are, not where the first of all congruent elements lies.
      body.visit(subdomain, body.elementsOf(subdomain), displacement[s],
                 exact ? Points::inPlace : Points::shape, [&](const ElementView& element) {
                   const fem::DisplacementNorms norms = fem::differenceNorms(
                       body.typeOf(element), element.points, body.physics(), body.materialOf(element.region),
                       element.displacements, here, element.state);
                   sums[0].add(norms.energy);
                   sums[1].add(norms.square);
                 });
    }
  });
  sumOverRanks(*problem.comm, sums);
  return {std::sqrt(sums[0].value()), std::sqrt(sums[1].value())};
}

ErrorNorms errorAgainst(const scene::Scene& referenceScene, const Decomposition& reference,
                        std::span<const Eigen::VectorXd> referenceDisplacement,
                        const Decomposition& decomposition, std::span<const Eigen::VectorXd> displacement) {
  std::vector<Eigen::VectorXd> difference =
      interpolate(decomposition, displacement, reference, NodesOf::subdomains);
  for (std::size_t s = 0; s < difference.size(); ++s)
    difference[s] -= referenceDisplacement[s];
  return errorNorms(referenceScene, reference, difference, {});
}

} // namespace epafi::accuracy
