#include "epafi/accuracy/EnergyBound.hpp"

#include "epafi/accuracy/EquilibratedTractions.hpp"
#include "epafi/accuracy/TractionModes.hpp"
#include "epafi/base/AccurateSum.hpp"
#include "epafi/base/Collective.hpp"
#include "epafi/base/Errors.hpp"
#include "epafi/mesh/ElementGeometry.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>
#include <sstream>

namespace epafi::accuracy {
namespace {

/// Only what is the same on all ranks.
void requireCovered(const scene::Scene& scene) {
  for (const scene::Body& body : scene.bodies)
    if (body.physics == fem::Physics::axisymmetric)
      throw InputError("guaranteed bounds are not there for solids of revolution (" + toString(body.physics) +
                       "), as body '" + body.name + "' is; leave out \"Bound\"");
}

ContactPressure contactsOf(const scene::Scene& scene, const model::Decomposition& decomposition) {
  requireCovered(scene);
  if (decomposition.problem.kernelDimension > 0)
    throw InputError("guaranteed bounds are there for bodies that supports hold, each of one cluster of "
                     "subdomains; leave out \"Bound\"");
  return {scene, decomposition};
}

} // namespace

double EnergyBound::relative() const {
  const double least = energyNorm - error - correction;
  return least > 0 ? error / least : std::numeric_limits<double>::infinity();
}

EnergyBounds::EnergyBounds(const scene::Scene& scene, const model::Decomposition& decomposition)
    : decomposition_(decomposition), pressure_(contactsOf(scene, decomposition)) {
  collectively(*decomposition.problem.comm, [&] {
    for (std::size_t b = 0; b < scene.bodies.size(); ++b) {
      cells_.push_back(std::make_unique<BoundCells>(scene.bodies[b], decomposition.bodies[b],
                                                    decomposition.problem, static_cast<int>(b)));
      loads_.push_back(boundLoads(*cells_.back()));
    }
  });
}

EnergyBound EnergyBounds::operator()(std::span<const Eigen::VectorXd> displacement,
                                     std::span<const Eigen::VectorXd> balanced) {
  const RCP<const Comm>& comm = decomposition_.problem.comm;
  const std::vector<Eigen::MatrixXd> solution = displacementsOf(cells_, decomposition_, displacement);
  EnergyBound bound;
  std::vector<Eigen::MatrixXd> data;
  std::vector<Eigen::VectorXd> squares;
  {
    std::vector<BoundLoads> loads = loads_;
    pressure_.addTo(loads);
    const std::vector<Eigen::MatrixXd> around = displacementsOf(cells_, decomposition_, balanced);
    double largest = 0, left = 0;
    for (std::size_t b = 0; b < cells_.size(); ++b) {
      EquilibratedTractions tractions = equilibratedTractions(*cells_[b], loads[b], around[b]);
      largest = std::max(largest, tractions.largestForce);
      left = left > tractions.imbalance ? left : tractions.imbalance; // NaN counts
      data.push_back(std::move(tractions.data));
    }
    const bool isSound = !holdsAnywhere(*comm, !std::isfinite(left));
    largest = maxOverRanks(*comm, largest);
    bound.imbalance = largest > 0 ? maxOverRanks(*comm, left) / largest : 0;
    constexpr double most = 1e-9;
    if (!isSound || bound.imbalance > most) {
      std::ostringstream text;
      text.precision(2);
      text << "at a node, forces are out of balance by " << bound.imbalance
           << " of the largest one, and a bound allows " << most;
      bound.failure = text.str();
      return bound;
    }
    RelaxedEnergies relaxed = relaxTractions(cells_, loads, comm, around, data);
    bound.steps = relaxed.steps;
    squares = std::move(relaxed.squares);
  }
  const AdmissibleDisplacement admissible = admissibleDisplacement(cells_, pressure_, comm, solution);
  bound.failure = agreedText(*comm, admissible.failure);
  if (!bound.failure.empty())
    return bound;
  bound.contact = std::max(0.0, pressure_.work(admissible.slack));
  addEnergies(solution, admissible, data, squares, bound);
  return bound;
}

/// ‖f − mean‖ in the dual of the energy norm, by Poincaré's constant of a convex domain (L. E. Payne, H. F.
/// Weinberger, *Arch. Rational Mech. Anal.* 5 (1960)).
double EnergyBounds::missingAt(std::size_t body, std::size_t place) const {
  const double missing = loads_[body].missing[place];
  if (missing == 0)
    return 0;
  std::vector<Point> points;
  cells_[body]->mesh().elementPoints(cells_[body]->elementAt(place), points);
  return missing * mesh::diameterOf(points) /
         (std::numbers::pi * std::sqrt(cells_[body]->materialAt(place).conductivity));
}

void EnergyBounds::addEnergies(const std::vector<Eigen::MatrixXd>& solution,
                               const AdmissibleDisplacement& admissible,
                               const std::vector<Eigen::MatrixXd>& data,
                               const std::vector<Eigen::VectorXd>& squares, EnergyBound& bound) const {
  enum Term : std::size_t { energy, norm, difference, whole, other, correction, jump, numTerms };
  std::array<AccurateSum, numTerms> sums;
  Eigen::MatrixXd ownStiffness;
  std::optional<fem::CellStress> own;
  for (std::size_t b = 0; b < cells_.size(); ++b)
    for (std::size_t place = 0; place < cells_[b]->numOwn(); ++place) {
      const Eigen::VectorXd v = admissible.values[b].col(place), mean = admissible.means[b].col(place),
                            moved = mean - v, jumps = solution[b].col(place) - mean;
      const Eigen::MatrixXd& stiffness = cells_[b]->stiffnessAt(place, ownStiffness);
      const double square = v.dot(stiffness * v);
      sums[norm].add(square);
      sums[energy].add(0.5 * square - loads_[b].whole.col(place).dot(v));
      sums[correction].add(moved.dot(stiffness * moved));
      sums[jump].add(jumps.dot(stiffness * jumps));
      const fem::CellStress& stress = cells_[b]->stressAt(place, own);
      const auto distance = [&](const Eigen::VectorXd& u) {
        return stress.difference(squares[b][static_cast<Eigen::Index>(place)], data[b].col(place), u,
                                 stiffness);
      };
      const double missing = missingAt(b, place), rest = distance(v), with = std::sqrt(rest) + missing,
                   reflected = moved.isZero(0) ? with : std::sqrt(distance(mean + moved)) + missing;
      sums[difference].add(rest);
      sums[whole].add(with * with);
      sums[other].add(reflected * reflected);
    }
  std::array<double, numTerms> values{};
  sumOverRanks(*decomposition_.problem.comm, sums, values.data());
  bound.energyNorm = std::sqrt(values[norm]);
  bound.correction = std::sqrt(values[correction]);
  bound.upper = values[energy];
  bound.discretisation = 0.5 * values[difference];
  bound.oscillation = 0.5 * (values[whole] - values[difference]);
  const double left = bound.imbalance * bound.energyNorm, root = std::sqrt(values[whole]) + left;
  bound.roundOff = 0.5 * (root * root - values[whole]);
  bound.lower = bound.upper - (bound.discretisation + bound.contact + bound.oscillation + bound.roundOff);
  bound.error = 0.5 * (std::sqrt(values[other]) + left + std::hypot(root, 2 * std::sqrt(bound.contact))) +
                std::sqrt(values[jump]);
}

} // namespace epafi::accuracy
