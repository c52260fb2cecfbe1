#pragma once

/// Errors against solutions that are known: a closed form, or the solution on a finer mesh.

#include "epafi/accuracy/BodyElements.hpp"
#include "epafi/fem/FluxIntegrals.hpp"

#include <functional>
#include <span>
#include <vector>

namespace epafi::accuracy {

/// Energy norm and L2 norm.
struct ErrorNorms {
  double energy = 0, l2 = 0;
};

/// A closed form: displacement and flux of a body (its index in the scene) at a point.
using ExactField = std::function<fem::FieldValue(int body, const Point& point)>;

/// ‖u − exact‖; of an empty function ‖u‖.
/// \param displacement  u at all positions of each of this rank's subdomains
/// Collective.
ErrorNorms errorNorms(const scene::Scene& scene, const model::Decomposition& decomposition,
                      std::span<const Eigen::VectorXd> displacement, const ExactField& exact);

/// ‖u − reference‖ on the reference's mesh, to which u is carried over node by node; without error where each
/// element of the finer mesh lies in one of the coarser. The displacements of floating bodies must both have
/// their rigid part. Collective.
ErrorNorms errorAgainst(const scene::Scene& referenceScene, const model::Decomposition& reference,
                        std::span<const Eigen::VectorXd> referenceDisplacement,
                        const model::Decomposition& decomposition,
                        std::span<const Eigen::VectorXd> displacement);

} // namespace epafi::accuracy
