#include "epafi/simulation/Deformation.hpp"

#include "epafi/accuracy/BodyElements.hpp"
#include "epafi/base/Collective.hpp"
#include "epafi/base/Text.hpp"
#include "epafi/mesh/ElementGeometry.hpp"
#include "epafi/mesh/ElementMap.hpp"

#include <Eigen/Eigenvalues>

#include <algorithm>
#include <cmath>
#include <numbers>

namespace epafi::simulation {
namespace {

/// ∇u at an element's centre, 0 in what the plane has not, of solids of revolution the hoop strain there.
Eigen::Matrix3d gradientAtCentre(const accuracy::BodyElements& body, const accuracy::ElementView& element) {
  return withShape(body.typeOf(element), [&]<int dim>(const mesh::Shape<dim>& shape) {
    const auto& sample = shape.centreSample();
    const mesh::ElementMap<dim> map(mesh::relativeCorners<dim>(element.points), sample);
    const auto nodal = Eigen::Map<const Eigen::Matrix<double, dim, Eigen::Dynamic>>(
        element.displacements.data(), dim, std::ssize(element.nodes));
    Eigen::Matrix3d gradient = Eigen::Matrix3d::Zero();
    gradient.topLeftCorner<dim, dim>() = nodal.lazyProduct(map.gradients(sample).transpose());
    if (body.physics() == fem::Physics::axisymmetric)
      gradient(2, 2) = 2 * std::numbers::pi * nodal.row(0).dot(sample.values) /
                       mesh::circumferenceAt(element.points, sample.values);
    return gradient;
  });
}

void enlarge(Deformation& largest, const Eigen::Matrix3d& gradient) {
  const Eigen::Matrix3d strain = (gradient + gradient.transpose()) / 2;
  constexpr double lengthOfAxial = std::numbers::sqrt2; // ‖W‖ = √2 |w| of a skew matrix W x = w × x
  largest.rotation = std::max(largest.rotation, (gradient - strain).norm() / lengthOfAxial);
  if (strain.norm() <= largest.strain) // no principal strain is larger than the norm
    return;
  Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> principal;
  principal.computeDirect(strain, Eigen::EigenvaluesOnly);
  largest.strain = std::max(largest.strain, principal.eigenvalues().cwiseAbs().maxCoeff());
}

} // namespace

std::string inWords(const Deformation& deformation) {
  const auto upToRoundOff = [](double value) { return text(std::round(1e9 * value) / 1e9, 2); };
  return "strain " + upToRoundOff(100 * deformation.strain) + " %, rotation " +
         upToRoundOff(180 / std::numbers::pi * deformation.rotation) + "°";
}

Deformation largestDeformation(const SolvedScene& solved, int body) {
  const decomposition::DecomposedProblem& problem = solved.decomposition.problem;
  Deformation largest;
  collectively(*problem.comm, [&] {
    accuracy::BodyElements elements(solved.scene.bodies[body], solved.decomposition.bodies[body]);
    for (std::size_t s = 0; s < problem.subdomains.size(); ++s)
      if (const decomposition::Subdomain& subdomain = problem.subdomains[s]; subdomain.body == body)
        elements.visit(subdomain, elements.elementsOf(subdomain), solved.solution.displacement[s],
                       accuracy::Points::shape, [&](const accuracy::ElementView& element) {
                         enlarge(largest, gradientAtCentre(elements, element));
                       });
  });
  return {maxOverRanks(*problem.comm, largest.strain), maxOverRanks(*problem.comm, largest.rotation)};
}

} // namespace epafi::simulation
