#include "epafi/fetidp/equilibrium/Solvability.hpp"

#include "epafi/base/Collective.hpp"
#include "epafi/base/Errors.hpp"
#include "epafi/base/Text.hpp"
#include "epafi/direct/DenseOrthogonal.hpp"
#include "epafi/direct/DenseSymmetric.hpp"
#include "epafi/direct/NonNegativeLeastSquares.hpp"
#include "epafi/fetidp/equilibrium/ContactDirections.hpp"
#include "epafi/fetidp/equilibrium/Friction.hpp"
#include "epafi/fetidp/equilibrium/LooseMotion.hpp"
#include "epafi/fetidp/equilibrium/MotionWords.hpp"
#include "epafi/fetidp/equilibrium/ProblemScales.hpp"
#include "epafi/fetidp/equilibrium/SlippingMotions.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <optional>
#include <sstream>
#include <string>

namespace epafi::fetidp {
namespace {

using decomposition::DecomposedProblem;
using decomposition::ProblemData;
using Kind = SolvabilityError::Kind;

/// `parts` one after the other, numbers as streams write them.
template <class... Parts>
std::string sentence(Kind kind, const Parts&... parts) {
  std::ostringstream text;
  text << (kind == Kind::noSolution ? "no solution: " : "not unique: ");
  (text << ... << parts);
  return text.str();
}

/// Refuses with such a sentence.
template <class... Parts>
[[noreturn]] void refuse(Kind kind, const Parts&... parts) {
  throw SolvabilityError(kind, sentence(kind, parts...));
}

/// `before` and what the motion is, if that is known.
std::string along(const MotionWords& words, const std::string& before) {
  return words.motion.empty() ? "" : before + words.motion;
}

/// Loads and contacts as rigid motions of the bodies meet them, measured by the problem's scales.
struct RigidBalance {
  const DecomposedProblem& problem;
  ProblemScales scales;
  std::map<int, Eigen::VectorXd> rows; ///< this rank's, see ProblemScales::hinderingRows
  Eigen::MatrixXd directions;          ///< of the contacts, k × (as many as differ)
  Eigen::VectorXd load;                ///< ẽ

  /// \param entries  see kernelConstraint
  /// Collective.
  RigidBalance(const DecomposedProblem& given, const ProblemData& data,
               const std::vector<KernelEntry>& entries)
      : problem(given), scales(given, data),
        rows(scales.hinderingRows(kernelConstraintOfBodies(given, entries))),
        directions(contactDirections(given, data, rows)),
        load(onBodies(given, kernelLoad(given, data)).cwiseQuotient(scales.motions())) {}

  /// Of a motion that is measured as the others are.
  [[nodiscard]] MotionWords words(const Eigen::VectorXd& motion) const {
    return wordsOf(problem, motion.cwiseQuotient(scales.motions()));
  }
  /// As they are, of motions that are measured as the others are.
  [[nodiscard]] Eigen::MatrixXd unmeasured(const Eigen::MatrixXd& motions) const {
    return scales.motions().cwiseInverse().asDiagonal() * motions;
  }
};

/// Motions α that nothing hinders in either direction, G̃ᵀα = 0, in columns of length 1.
Eigen::MatrixXd freeMotions(const RigidBalance& balance) {
  const direct::SymmetricEigen spectrum =
      direct::eigenOf(balance.directions * balance.directions.transpose() /
                      static_cast<double>(std::max<Eigen::Index>(balance.directions.cols(), 1)));
  return spectrum.vectors.leftCols(
      spectrum.numUpTo(ProblemScales::hindered * ProblemScales::hindered)); // in the root mean square
}

/// ẽᵀα must vanish for them.
void refuseLoadedMotion(const RigidBalance& balance, const Eigen::MatrixXd& free) {
  const Eigen::VectorXd pulls = free.transpose() * balance.load;
  const Eigen::VectorXd motion = free * pulls;
  if ((pulls.array().abs() <=
       ProblemScales::resultant * (free.transpose().cwiseAbs() * balance.scales.loads()).array())
          .all())
    return;
  const MotionWords words = balance.words(motion);
  throw FreeMotionError(
      Kind::noSolution,
      sentence(Kind::noSolution, words.bodies,
               " can move without meeting a support or a contact, and the load moves it (resultant ",
               motion.norm(), along(words, " to "), "); add a support or a contact pair"),
      freeMotionsOf(balance.problem, balance.unmeasured(free)));
}

/// Motions that are free even so. \param why  what follows on what bodies can do
void refuseMotions(const RigidBalance& balance, const Eigen::MatrixXd& free, double accuracy,
                   const char* why) {
  if (free.cols() == 0)
    return;
  const Eigen::MatrixXd motions = balance.unmeasured(free);
  throw FreeMotionError(Kind::notUnique,
                        sentence(Kind::notUnique, abilitiesOf(balance.problem, motions, accuracy), why),
                        freeMotionsOf(balance.problem, motions, accuracy));
}

/// Those that only facets of smooth surfaces hinder: where they lead to is the mesh's. Collective.
Eigen::MatrixXd slippingMotionsOf(const RigidBalance& balance) {
  return slippingMotions(balance.problem, balance.rows, balance.scales.motions(), [](int) { return true; });
}

/// Is ẽ in the cone of the directions? With each body's modes measured by the loads on it and the directions
/// of length 1 again: neither changes the answer, but a heavy body does not hide a light one.
struct ScaledCone {
  Eigen::VectorXd unit;       ///< by which a mode's resultant is divided
  Eigen::MatrixXd directions; ///< k × (as many as differ)
  Eigen::VectorXd resultant;  ///< k

  explicit ScaledCone(const RigidBalance& balance) : unit(balance.scales.loads()) {
    unit = (unit.array() > 0).select(unit, 1.0);
    directions = (unit.cwiseInverse().asDiagonal() * balance.directions).colwise().normalized();
    resultant = balance.load.cwiseQuotient(unit);
  }

  /// What of `target` no forces x ≥ 0 along the directions can balance: 0 where it is below the tolerance or
  /// within round-off of the forces that pass through.
  [[nodiscard]] Eigen::VectorXd imbalance(const Eigen::VectorXd& target) const {
    const direct::NonNegativeSolution forces = direct::nonNegativeLeastSquares(directions, target);
    const Eigen::ArrayXd passing = (directions.cwiseAbs() * forces.x).array();
    return (forces.residual.array().abs() <= ProblemScales::resultant + ProblemScales::roundOff * passing)
        .select(0.0, forces.residual.array());
  }

  /// A motion β that opens contacts or leaves them as they are, directionsᵀβ ≤ 0, without work of the loads:
  /// ẽ is not in the cone's interior then.
  [[nodiscard]] std::optional<Eigen::VectorXd> looseMotion() const {
    const Eigen::VectorXd works =
        (resultant.array().abs() <= ProblemScales::resultant).select(0.0, resultant.array());
    const Eigen::MatrixXd across = works.norm() > 0 ? direct::orthogonalComplement(works)
                                                    : Eigen::MatrixXd::Identity(works.size(), works.size());
    const std::optional<Eigen::VectorXd> loose = fetidp::looseMotion(
        directions, Eigen::VectorXd::Constant(directions.cols(), -1.0), across, ProblemScales::resultant);
    if (!loose)
      return std::nullopt;
    return loose->cwiseQuotient(unit);
  }
};

/// Whether contact would hold the loads if friction held any force. Collective.
void refuseIfTooSteep(const RigidBalance& balance) {
  const Eigen::Index k = balance.load.size();
  RigidBalance rough(balance);
  DistinctDirections directions(k);
  for (const auto& [row, vector] : balance.rows) {
    directions.add(vector, 0.0);
    if (isTied(balance.problem, row))
      directions.add(-vector, 0.0);
  }
  directions.gather(*balance.problem.comm);
  rough.directions = directions.matrix();
  const ScaledCone cone(balance), held(rough);
  if (held.imbalance(held.resultant).norm() == 0)
    refuseSliding(text(cone.imbalance(cone.resultant).norm() / cone.resultant.norm()) +
                  " of their resultant");
}

/// What forces of friction within their bounds do most work along a motion, G̃x with Tresca's law, both
/// measured as the cone's. Collective.
Eigen::VectorXd strongestAgainst(const Eigen::VectorXd& motion, const RigidBalance& balance,
                                 const ProblemData& data, const Eigen::VectorXd& unit) {
  Eigen::VectorXd sum = Eigen::VectorXd::Zero(motion.size());
  for (const decomposition::FrictionNode& node : balance.problem.frictionNodes) {
    const double bound = data.frictionBound(node, 0);
    Eigen::VectorXd force = Eigen::VectorXd::Zero(motion.size());
    double squared = 0;
    for (int k = 0; bound > 0 && k < balance.problem.components - 1; ++k)
      if (const auto row = balance.rows.find(node.firstTangent + k); row != balance.rows.end()) {
        const Eigen::VectorXd along = row->second.cwiseQuotient(unit);
        const double work = along.dot(motion);
        force += work * along;
        squared += work * work;
      }
    if (squared > 0)
      sum += bound / std::sqrt(squared) * force;
  }
  sumOverRanks(*balance.problem.comm, {sum.data(), static_cast<std::size_t>(sum.size())});
  return sum;
}

/// Both laws at once: whether a motion shows that the cones of Coulomb's and the bounds of Tresca's do not
/// hold the loads together, looked for by Frank, Wolfe, *Naval Res. Logist.* 3 (1956). Collective.
void refuseBeyondBounds(const RigidBalance& balance, const ProblemData& data,
                        const std::vector<KernelEntry>& entries) {
  constexpr int maxSteps = 60;
  constexpr double clear = 1e-9; // beside the load's work
  const std::vector<decomposition::FrictionNode>& nodes = balance.problem.frictionNodes;
  const bool isBounded =
      std::any_of(nodes.begin(), nodes.end(), [&](const auto& node) { return hasBoundAlone(data, node); });
  if (maxOverRanks(*balance.problem.comm, isBounded ? 1 : 0) == 0)
    return;
  const RigidBalance ofCones(balance.problem, data, withoutBoundedFriction(balance.problem, data, entries));
  const ScaledCone cone(ofCones);
  Eigen::VectorXd held = Eigen::VectorXd::Zero(cone.resultant.size());
  for (int step = 0; step < maxSteps; ++step) {
    const Eigen::VectorXd motion = cone.imbalance(cone.resultant - held);
    if (motion.norm() == 0)
      return;
    const Eigen::VectorXd strongest = strongestAgainst(motion, balance, data, cone.unit);
    const double work = motion.dot(cone.resultant), rest = work - motion.dot(strongest);
    if (rest > clear * std::abs(work))
      refuseSliding(text(rest / (motion.norm() * cone.resultant.norm())) + " of their resultant");
    held += 2.0 / (step + 2) * (strongest - held);
  }
}

} // namespace

void requireUniqueSolution(const DecomposedProblem& problem, const ProblemData& data,
                           const std::vector<KernelEntry>& entries) {
  if (problem.numRigidModes() == 0)
    return;
  const RigidBalance balance(problem, data, withoutIdleFriction(problem, data, entries));
  const Eigen::MatrixXd free = freeMotions(balance);
  refuseLoadedMotion(balance, free);

  const ScaledCone cone(balance);
  const Eigen::VectorXd pulled = cone.imbalance(cone.resultant);
  if (pulled.norm() > 0 && data.hasCoulombFriction())
    refuseIfTooSteep(balance);
  if (pulled.norm() == 0 && data.hasCoulombFriction())
    refuseBeyondBounds(balance, data, entries);
  if (pulled.norm() > 0) {
    const Eigen::VectorXd motion = pulled.cwiseQuotient(cone.unit); // allowed, and driven by the load
    refuse(Kind::noSolution, "the load pulls ", balance.words(pulled).bodies,
           " away from its contacts (resultant ", balance.load.dot(motion) / motion.norm(),
           " along a motion that no contact hinders", along(balance.words(motion), ": "),
           "); turn the load or add a support");
  }
  refuseMotions(balance, free, 0, " without meeting a support or a contact; add a support or a contact pair");
  refuseMotions(balance, slippingMotionsOf(balance), facetNoise, facetsAlone);

  if (const auto loose = cone.looseMotion())
    refuse(Kind::notUnique, "the load does not press ", balance.words(loose->cwiseProduct(cone.unit)).bodies,
           " onto its contacts (zero resultant",
           along(balance.words(*loose), " along a motion that no contact hinders: "),
           "), so that it may come to rest anywhere; add a load or a support");
}

void requireContactForEveryMotion(const DecomposedProblem& problem, const ProblemData& data,
                                  const std::vector<KernelEntry>& entries) {
  if (problem.numRigidModes() > 0 && freeMotions(RigidBalance(problem, data, entries)).cols() > 0)
    requireUniqueSolution(problem, data, entries); // which says what the loads there are make of it
}

} // namespace epafi::fetidp
