#pragma once

/// The number that a scene is solved for, with an error bar: the list Accuracy/Quantity.

#include "epafi/ContactSolver.hpp"
#include "epafi/accuracy/Quantity.hpp"
#include "epafi/simulation/SolvedScene.hpp"

#include <Teuchos_ParameterList.hpp>

#include <string>
#include <vector>

namespace epafi::simulation {

struct QuantityParameters {
  /// What is asked for.
  enum class Kind { none, force, displacement, pressure };
  Kind kind = Kind::none;
  std::string contact, body, surface;
  std::vector<double> point, direction;

  /// Adds the list Quantity to the list Accuracy of the schema.
  static void addTo(Teuchos::ParameterList& accuracy);
  /// From a validated list Quantity. \throws InputError if entries do not go together.
  static QuantityParameters from(const Teuchos::ParameterList& list);
};

/// J_h, and how far it may be off.
struct Quantity {
  std::string name;    ///< "force of contact 'foot'"
  std::string failure; ///< why there is no bar; else empty
  double value = 0;
  double error = 0;                          ///< estimate of J − J_h
  double bar = 0;                            ///< of the mesh: what |J − J_h| hardly exceeds
  double remainder = 0;                      ///< of what is looked at: within the bar (LargestPressure.hpp)
  double width = 0;                          ///< of what is looked at, where it shrinks with the mesh; else 0
  double algebraic = 0;                      ///< of the iteration: a bound
  std::vector<std::vector<double>> elements; ///< |e_T|, as ErrorEstimate::elements
  int multiplications = 0;                   ///< products with F for the dual solution
};

/// A quantity of a scene that is cut: made before the solve, so that a wrong name is found at once.
class QuantityOfScene {
public:
  /// Keeps references. Not collective. \throws InputError, the same on all ranks, if the scene has no such
  /// thing.
  QuantityOfScene(const QuantityParameters& parameters, const scene::Scene& scene,
                  const model::Decomposition& decomposition);

  /// A linear solve with contact as the solution has it, and a few passes of the estimator. Collective.
  /// \param estimate  of the solution
  Quantity operator()(const ContactSolver& solver, const SolvedScene& solved,
                      accuracy::ErrorEstimator& estimator, const accuracy::ErrorEstimate& estimate) const;

private:
  using Kind = QuantityParameters::Kind;

  /// J_h, and what has its dual solution as response. Collective.
  fetidp::DataChange evaluate(const SolvedScene& solved, Quantity& quantity) const;

  const model::Decomposition& decomposition_;
  Kind kind_;
  std::string name_;
  const contact::ContactLayout* contact_ = nullptr;
  std::vector<Eigen::VectorXd> weights_; ///< of displacements
};

} // namespace epafi::simulation
