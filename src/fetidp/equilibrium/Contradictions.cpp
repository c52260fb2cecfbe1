#include "epafi/fetidp/equilibrium/Contradictions.hpp"

#include "epafi/base/AccurateSum.hpp"
#include "epafi/base/Collective.hpp"
#include "epafi/base/Columns.hpp"
#include "epafi/base/Errors.hpp"
#include "epafi/base/SortUnique.hpp"
#include "epafi/base/Text.hpp"
#include "epafi/fetidp/equilibrium/FeasibleForces.hpp"
#include "epafi/fetidp/equilibrium/ProblemScales.hpp"
#include "epafi/fetidp/operator/RowProducts.hpp"
#include "epafi/qp/operators/NormEstimate.hpp"
#include "epafi/qp/solve/MprgpSolve.hpp"
#include "epafi/qp/solve/RecessionDirection.hpp"

#include <Tpetra_Map.hpp>

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>
#include <vector>

namespace epafi::fetidp {
namespace {

using decomposition::DecomposedProblem;
using decomposition::OwnedMultiplier;
using decomposition::ProblemData;
using decomposition::RowKind;

/// Displacements may be so many times what overlaps: more, and only what is round-off in a row could make
/// room.
constexpr double reach = 1e3;

bool isFriction(const DecomposedProblem& problem, LocalOrdinal row) {
  return problem.kindOf(OwnedMultiplier(row)) == RowKind::friction;
}

/// By how much u = 0 violates a row.
double violationOf(const DecomposedProblem& problem, LocalOrdinal row, double gap) {
  switch (problem.kindOf(OwnedMultiplier(row))) {
  case RowKind::contact:
    return std::max(-gap, 0.0);
  case RowKind::friction:
    return 0; // it slips
  default:
    return std::abs(gap);
  }
}

/// Tells of the rows that d weighs most. Collective. \throws ContradictionError
[[noreturn]] void refuse(const DecomposedProblem& problem, const Vector& d, double overlap) {
  constexpr double worthAWord = 0.1;
  struct Weighed {
    GlobalOrdinal row;
    double weight;
  };
  std::vector<Weighed> rows;
  const auto weight = d.getData();
  double most = 0;
  for (LocalOrdinal row = 0; row < weight.size(); ++row)
    if (problem.kindOf(OwnedMultiplier(row)) != RowKind::gluing) {
      rows.push_back({problem.multiplierMap->getGlobalElement(row), std::abs(weight[row])});
      most = std::max(most, rows.back().weight);
    }
  most = maxOverRanks(*problem.comm, most);
  std::erase_if(rows, [&](const Weighed& each) { return !(each.weight >= worthAWord * most); });
  rows = gatherOnAll(*problem.comm, rows);
  std::sort(rows.begin(), rows.end(), [](const Weighed& a, const Weighed& b) {
    return a.weight > b.weight || (a.weight == b.weight && a.row < b.row);
  });
  std::vector<GlobalOrdinal> numbers;
  std::vector<std::string> names;
  for (const Weighed& each : rows) {
    numbers.push_back(each.row);
    names.push_back((each.row < problem.numInequalities ? "contact row " : "tied row ") +
                    std::to_string(each.row));
  }
  const bool isTied = std::any_of(numbers.begin(), numbers.end(),
                                  [&](GlobalOrdinal row) { return row >= problem.numInequalities; });
  throw ContradictionError(std::move(numbers),
                           (isTied ? "what they hold is apart by " : "they overlap by ") + text(overlap),
                           std::move(names));
}

/// By how much rows are violated that no displacement can help: those without an unknown, and those that are
/// much shorter than others and far more violated for their length, whose unknowns are there by round-off of
/// weights. \param norms of rows Collective.
Vector heldRows(const DecomposedProblem& problem, const Vector& gap, const Vector& norms, double roundOff) {
  const auto gaps = gap.getData(), norm = norms.getData();
  AccurateSum sums[2]; // violation and length of violated rows
  double longest = 0;
  for (LocalOrdinal row = 0; row < gaps.size(); ++row)
    if (problem.kindOf(OwnedMultiplier(row)) != RowKind::gluing) {
      longest = std::max(longest, norm[row]);
      if (const double violation = violationOf(problem, row, gaps[row]); violation > roundOff) {
        sums[0].add(violation);
        sums[1].add(norm[row]);
      }
    }
  sumOverRanks(*problem.comm, sums);
  longest = maxOverRanks(*problem.comm, longest);
  Vector held(problem.multiplierMap);
  for (LocalOrdinal row = 0; row < gaps.size(); ++row)
    if (const double violation = violationOf(problem, row, gaps[row]);
        violation > roundOff &&
        (norm[row] == 0 ||
         (reach * norm[row] < longest && violation * sums[1].value() > reach * sums[0].value() * norm[row])))
      held.replaceLocalValue(row, violation);
  return held;
}

/// SBBᵀS, S = diag(1/‖b‖): rows of length 1.
class RowGram final : public SymmetricOperator {
public:
  RowGram(const RowProducts& products, const Vector& inverseNorms)
      : SymmetricOperator(inverseNorms.getMap()), products_(products), inverseNorms_(inverseNorms),
        scaled_(inverseNorms.getMap()) {}

private:
  void multiply(const MultiVector& x, MultiVector& y) const override {
    forEachColumn(x, y, [&](const Vector& in, Vector& out) {
      scaled_.elementWiseMultiply(1.0, inverseNorms_, in, 0.0);
      products_.gram(scaled_, out);
      scaled_.assign(out);
      out.elementWiseMultiply(1.0, inverseNorms_, scaled_, 0.0);
    });
  }
  const RowProducts& products_;
  const Vector& inverseNorms_;
  mutable Vector scaled_;
};

/// Whether rows with these gaps, made of length 1, can hold by displacements within reach. Collective.
/// \param overlap  what reach is measured by
/// \returns what proves that they cannot, or null
RCP<Vector> provedContradiction(const DecomposedProblem& problem, const RowProducts& products,
                                const Vector& inverseNorms, const RCP<const Vector>& target, double overlap) {
  constexpr int patience = 1000;
  const RCP<const Operator> gram = rcp(new RowGram(products, inverseNorms));
  const double norm = qp::estimateNorm(*gram, {}).norm;
  const RCP<const qp::ConvexSet> set = feasibleForcesWithoutFriction(problem);
  Vector d(problem.multiplierMap);
  qp::MprgpParameters parameters;
  parameters.maxMultiplications = patience;
  const qp::SolveReport report =
      qp::solveByMprgp({.hessian = gram, .linearTerm = target, .set = set, .operatorNorm = norm}, d,
                       {.gradient = 0.0, .absolute = 1e-3 * overlap}, parameters);
  const auto inRows = [&](const Vector& scaled) {
    const RCP<Vector> result = rcp(new Vector(problem.multiplierMap));
    result->elementWiseMultiply(1.0, inverseNorms, scaled, 0.0);
    return result;
  };
  if (report.status == qp::Status::converged) {
    const RCP<Vector> proof = inRows(d);
    double largest = 0;
    for (const Eigen::VectorXd& u : products.forces(*proof))
      largest = u.size() > 0 ? std::max(largest, u.lpNorm<Eigen::Infinity>()) : largest;
    return maxOverRanks(*problem.comm, largest) > reach * overlap ? proof : Teuchos::null;
  }
  const RCP<Vector> direction =
      qp::findRecessionDirection(gram, norm, *target, *set, Teuchos::null, patience).direction;
  return direction.is_null() ? Teuchos::null : inRows(*direction);
}

/// Each once, of many the first ones.
std::string listedOnce(std::vector<std::string> names) {
  constexpr std::size_t most = 4;
  sortUnique(names);
  if (names.size() > most) {
    names[most - 1] = std::to_string(names.size() - most + 1) + " more";
    names.resize(most);
  }
  return listed(names);
}

} // namespace

ContradictionError::ContradictionError(std::vector<GlobalOrdinal> rows, std::string misfit,
                                       std::vector<std::string> names, const std::string& place)
    : SolvabilityError(Kind::noSolution, "no solution: supports and " + listedOnce(std::move(names)) +
                                             " contradict each other" +
                                             (place.empty() ? "" : " at " + place) +
                                             ", no displacement satisfies them all, " + misfit +
                                             "; change a gap, an obstacle, a support or a joint"),
      rows_(std::move(rows)), misfit_(std::move(misfit)) {}

void requireFeasibleGaps(const DecomposedProblem& problem, const ProblemData& data) {
  const auto gaps = data.gap().getData();
  double overlap = 0;
  for (LocalOrdinal row = 0; row < gaps.size(); ++row)
    overlap = std::max(overlap, violationOf(problem, row, gaps[row]));
  // Gaps are differences of prescribed values: what is round-off of these does not overlap.
  const double roundOff = ProblemScales::roundOff * ProblemScales(problem, data).length();
  if (!holdsAnywhere(*problem.comm, overlap > roundOff))
    return;
  const RowProducts products(problem);
  const RCP<Vector> inverseNorms = products.norms(), target = rcp(new Vector(problem.multiplierMap));
  const Vector held = heldRows(problem, data.gap(), *inverseNorms, roundOff);
  if (const double most = held.normInf(); most > 0)
    refuse(problem, held, most);
  double worst = 0; // of the rows of length 1
  {
    const auto inverse = inverseNorms->getDataNonConst(), rhs = target->getDataNonConst();
    for (LocalOrdinal row = 0; row < gaps.size(); ++row) {
      inverse[row] = inverse[row] > 0 ? 1 / inverse[row] : 0;
      rhs[row] = isFriction(problem, row) ? 0.0 : -gaps[row] * inverse[row];
      worst = std::max(worst, violationOf(problem, row, gaps[row]) * inverse[row]);
    }
    worst = maxOverRanks(*problem.comm, worst);
    for (double& value : rhs) // what is farther away does not come into it
      value = std::max(value, -reach * worst);
  }
  if (const RCP<Vector> proof = provedContradiction(problem, products, *inverseNorms, target, worst);
      !proof.is_null())
    refuseContradiction(problem, data, *proof);
}

void refuseContradiction(const DecomposedProblem& problem, const ProblemData& data, const Vector& d) {
  constexpr double small = 1e-3 / reach;
  const Comm& comm = *problem.comm;
  const RowProducts products(problem);
  const auto largestOf = [&](bool isMagnitude) {
    double largest = 0;
    for (const Eigen::VectorXd& force : products.forces(d, isMagnitude))
      largest = force.size() > 0 ? std::max(largest, force.lpNorm<Eigen::Infinity>()) : largest;
    return maxOverRanks(comm, largest);
  };
  const double left = largestOf(false), terms = largestOf(true);
  AccurateSum gaps[2]; // cᵀd and the size of its terms
  double heaviest = 0;
  Vector tension(d, Teuchos::Copy); // what is not allowed
  feasibleForcesWithoutFriction(problem)->project(tension);
  tension.update(1.0, d, -1.0);
  const auto mine = d.getData(), gap = data.gap().getData();
  for (LocalOrdinal row = 0; row < mine.size(); ++row) {
    gaps[0].add(gap[row] * mine[row]);
    gaps[1].add(std::abs(gap[row] * mine[row]));
    if (problem.kindOf(OwnedMultiplier(row)) != RowKind::gluing)
      heaviest = std::max(heaviest, std::abs(mine[row]));
  }
  sumOverRanks(comm, gaps);
  heaviest = maxOverRanks(comm, heaviest);
  if (terms > 0 && left <= small * terms && tension.normInf() <= small * d.normInf() &&
      gaps[0].value() < -small * gaps[1].value())
    refuse(problem, d, -gaps[0].value() / heaviest);
}

} // namespace epafi::fetidp
