#pragma once

/// Energies below and above that of the exact solution, as no estimate is: by a displacement that does not
/// penetrate and a stress in balance with the loads and with pressures ≥ 0 of contacts (W. Prager, J. L.
/// Synge, *Quart. Appl. Math.* 5 (1947); for variational inequalities J. Haslinger, I. Hlaváček). Exact are
/// the differential equations on the meshed bodies, with the normals and gaps of the discrete contacts.

#include "epafi/accuracy/AdmissibleDisplacement.hpp"
#include "epafi/accuracy/BoundLoads.hpp"
#include "epafi/accuracy/ContactPressure.hpp"

#include <Eigen/Core>

#include <memory>
#include <span>
#include <string>
#include <vector>

namespace epafi::accuracy {

struct EnergyBound {
  double lower = 0, upper = 0; ///< J*(τ) ≤ J(u) ≤ J(v)
  /// ‖u − u_h‖_K at most, of the displacements as they are, and ‖v‖_K.
  double error = 0, energyNorm = 0;
  // What upper − lower consists of:
  double discretisation = 0; ///< ½‖Cε(v) − τ‖²
  double contact = 0;        ///< pressure times open gap
  double oscillation = 0;    ///< of loads that are not constant in an element
  double roundOff = 0;       ///< of the forces that are left over at nodes; this one is estimated
  double correction = 0;     ///< ‖u_h − v‖_K, what it took for v not to penetrate between nodes
  double imbalance = 0;      ///< largest force left over at a node by the largest force
  int steps = 0;             ///< of conjugate gradients for τ
  /// `error` by the norm of the exact solution, which is as large as `error` allows at least.
  [[nodiscard]] double relative() const;
  std::string failure; ///< why there is no bound; most often empty
};

class EnergyBounds {
public:
  /// Keeps references. Collective. \throws InputError for a scene that is not covered, the same on all ranks.
  EnergyBounds(const scene::Scene& scene, const model::Decomposition& decomposition);

  /// Forces of all rows of contact that come from pressures and are near to these. Of the whole problem, on
  /// all ranks alike.
  std::vector<double> contactForces(std::span<const double> forces) { return pressure_.fit(forces); }

  /// \param displacement  the solution at all positions of this rank's subdomains
  /// \param balanced  displacements of the same subdomains in balance with the last contactForces(); they
  /// may jump
  /// Collective.
  EnergyBound operator()(std::span<const Eigen::VectorXd> displacement,
                         std::span<const Eigen::VectorXd> balanced);

private:
  [[nodiscard]] double missingAt(std::size_t body, std::size_t place) const;
  void addEnergies(const std::vector<Eigen::MatrixXd>& solution, const AdmissibleDisplacement& admissible,
                   const std::vector<Eigen::MatrixXd>& data, const std::vector<Eigen::VectorXd>& squares,
                   EnergyBound& bound) const;

  const model::Decomposition& decomposition_;
  std::vector<std::unique_ptr<BoundCells>> cells_;
  std::vector<BoundLoads> loads_;
  ContactPressure pressure_;
};

} // namespace epafi::accuracy
