#include "SceneOracle.hpp"

#include "Cones.hpp"
#include "MeasuredSystem.hpp"
#include "support/DenseOracle.hpp"

#include "epafi/base/EigenCompatibility.hpp"
#include "epafi/base/Errors.hpp"
#include "epafi/direct/DenseOrthogonal.hpp"

#include <Eigen/SparseCholesky>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <stdexcept>

namespace epafi::test {
namespace {

using drivers::UndecomposedSystem;
using RealSparse = Eigen::SparseMatrix<Real>;

/// u, λ, α of a problem that has a solution.
struct Solution {
  RealVector u, multiplier; ///< λ of rows of length 1
  Eigen::VectorXd slack;    ///< of the contacts, c − Bu
};

/// K with springs at as many unknowns as there are motions, which these do not leave at rest: a generalised
/// inverse of K.
class GeneralisedInverse {
public:
  explicit GeneralisedInverse(const Measured& measured)
      : stiffness_(measured.system.stiffness.cast<Real>()), held_(stiffness_) {
    if (const Eigen::Index k = measured.motion.cols(); k > 0) {
      const std::vector<Eigen::Index> order = direct::pivotedColumns(measured.motion.transpose()).order;
      for (Eigen::Index i = 0; i < k; ++i) {
        const auto unknown = static_cast<int>(order[i]);
        held_.coeffRef(unknown, unknown) *= 2;
      }
    }
    factor_.compute(held_);
    if (factor_.info() != Eigen::Success)
      throw Uncertain{"factor of the stiffness"};
  }

  [[nodiscard]] RealMatrix solve(const RealMatrix& right) const {
    RealMatrix x = factor_.solve(right);
    const RealMatrix left = right - held_ * x;
    x += factor_.solve(left);
    return x;
  }
  [[nodiscard]] const RealSparse& stiffness() const { return stiffness_; }

private:
  RealSparse stiffness_, held_;
  Eigen::SimplicialLDLT<RealSparse> factor_;
};

/// The dual problem, min ½λᵀFλ − λᵀd, λ_I ≥ 0, Zᵀ(f − Bᵀλ) = 0, in forces of about 1.
DenseProgram dualProgram(const Measured& measured, const RealMatrix& f, const RealVector& d,
                         const Eigen::VectorXd& unit) {
  const Eigen::Index m = d.size();
  const RealVector scale = unit.cast<Real>();
  DenseProgram program;
  program.hessian = (scale.asDiagonal() * f * scale.asDiagonal()).cast<double>();
  program.linear = scale.cwiseProduct(d).cast<double>();
  program.lower = Eigen::VectorXd::Constant(m, -std::numeric_limits<double>::infinity());
  program.lower.head(measured.numContacts()).setZero();
  program.upper = Eigen::VectorXd::Constant(m, std::numeric_limits<double>::infinity());
  program.rows = measured.motion.transpose() * measured.rows.transpose() * unit.asDiagonal();
  program.values = measured.motion.transpose() * measured.system.load;
  const double size = program.hessian.cwiseAbs().maxCoeff();
  program.hessian /= size;
  program.linear /= size;
  return program;
}

Solution solutionOf(const Measured& measured) {
  const Eigen::Index m = measured.gap.size(), n = measured.system.load.size();
  const GeneralisedInverse inverse(measured);
  const RealMatrix rows = measured.rows.cast<Real>();
  const RealVector load = measured.system.load.cast<Real>();
  Solution solution{RealVector::Zero(n), RealVector::Zero(m), {}};
  RealVector alpha = RealVector::Zero(measured.motion.cols());
  if (m > 0) {
    const RealMatrix f = rows * inverse.solve(rows.transpose());
    const RealVector d = rows * inverse.solve(load) - measured.gap.cast<Real>();
    // Forces: of the loads, or of what stiffness makes of gaps.
    const Eigen::VectorXd diagonal = f.diagonal().cast<double>();
    const double typical = diagonal.maxCoeff();
    const double force = std::max(measured.loadScale, static_cast<double>(d.cwiseAbs().maxCoeff()) / typical);
    const Eigen::VectorXd unit = (diagonal.array() > 1e-12 * typical)
                                     .select(force * (typical / diagonal.array().max(1e-300)).sqrt(),
                                             Eigen::ArrayXd::Constant(m, force));
    if (force > 0) {
      const OracleAnswer answer = solveByProximalSteps(dualProgram(measured, f, d, unit));
      if (!answer.isFeasible)
        throw Uncertain{"equilibrium"};
      solution.multiplier = answer.x.cwiseProduct(unit.cast<Real>());
      const Real size =
          (unit.cast<Real>().asDiagonal() * f * unit.cast<Real>().asDiagonal()).cwiseAbs().maxCoeff();
      alpha = -answer.multiplier * size;
    }
  }
  solution.u =
      inverse.solve(load - rows.transpose() * solution.multiplier) + measured.motion.cast<Real>() * alpha;
  solution.slack = measured.gap - (rows * solution.u).cast<double>();
  const RealVector left = inverse.stiffness() * solution.u - load + rows.transpose() * solution.multiplier;
  const double force =
                   std::max(measured.loadScale, static_cast<double>(solution.multiplier.cwiseAbs().sum())),
               length = std::max(measured.gapScale, static_cast<double>(solution.u.cwiseAbs().maxCoeff()));
  const auto contacts = measured.numContacts();
  const bool fits =
      static_cast<double>(left.cwiseAbs().maxCoeff()) <= 1e-11 * force &&
      (contacts == 0 || solution.slack.head(contacts).minCoeff() >= -1e-9 * length) &&
      (m == contacts || solution.slack.tail(m - contacts).cwiseAbs().maxCoeff() <= 1e-9 * length);
  if (!fits) // or not a number
    throw Uncertain{"residuals of the reference"};
  return solution;
}

/// Rows of B Z T, by the row.
Eigen::MatrixXd chosen(const Eigen::MatrixXd& rows, const std::vector<Eigen::Index>& which) {
  return rows(which, allOf);
}

/// Rows of closed contacts: those that carry force, and those that do not.
struct Closed {
  std::vector<Eigen::Index> pressed, touching;
};

Closed closedRows(const Measured& measured, const Solution& solution, double force, double length,
                  double forceLimit, double lengthLimit) {
  Closed closed;
  for (Eigen::Index i = 0; i < measured.numContacts(); ++i)
    if (static_cast<double>(solution.multiplier[i]) > forceLimit * force)
      closed.pressed.push_back(i);
    else if (solution.slack[i] <= lengthLimit * length)
      closed.touching.push_back(i);
  return closed;
}

/// Whether some motion leaves every closed contact as it is, or opens it at no cost.
bool restsAnywhere(const Measured& measured, const Solution& solution, const Eigen::MatrixXd& along,
                   double force, double length) {
  bool first = true, result = false;
  for (const double forceLimit : {roundOff, clear})
    for (const double lengthLimit : {roundOff, clear}) {
      const Closed closed = closedRows(measured, solution, force, length, forceLimit, lengthLimit);
      const bool rests = !isPointed(chosen(along, closed.touching), chosen(along, closed.pressed));
      if (!first && rests != result)
        throw Uncertain{"contacts that hardly touch"};
      first = false;
      result = rests;
    }
  return result;
}

/// The columns of a cone, those of length 0 left out.
Eigen::MatrixXd directionsOf(const Eigen::MatrixXd& along) {
  Eigen::MatrixXd directions(along.cols(), along.rows());
  Eigen::Index count = 0;
  for (Eigen::Index i = 0; i < along.rows(); ++i)
    if (const double length = along.row(i).norm(); isClear(length, "what contacts hinder"))
      directions.col(count++) = along.row(i).transpose() / length;
  return directions.leftCols(count);
}

/// Whether forces along the rows are well determined by what they do to nodes.
bool areIndependent(const Eigen::MatrixXd& rows) {
  if (rows.rows() == 0 || rows.rows() > rows.cols())
    return rows.rows() == 0;
  return direct::pivotedColumns(rows.transpose(), 1e-2).rank == rows.rows();
}

void fill(const Measured& measured, const Solution& solution, double force, Truth& truth) {
  const UndecomposedSystem& system = measured.system;
  const Eigen::VectorXd u = solution.u.cast<double>();
  const double strain = 0.5 * u.dot(system.stiffness * u), work = system.load.dot(u);
  truth.energy = strain - work + system.energyOffset;
  // Where there is nothing else, round-off of places:
  const double stiffness = std::exp(system.stiffness.diagonal().array().log().mean());
  truth.largest = 1e-6 * force / stiffness + 1e-7 * measured.size;
  truth.energyScale = std::max(strain + std::abs(work) + std::abs(system.energyOffset),
                               stiffness * truth.largest * truth.largest);
  const Eigen::VectorXd lambda = solution.multiplier.cast<double>().cwiseQuotient(measured.lengths);
  truth.force = lambda.head(measured.numContacts()).sum();
  const double closed = roundOff * std::max(measured.gapScale, u.cwiseAbs().maxCoeff());
  std::vector<Eigen::Index> active; // with those that touch: they may share
  for (Eigen::Index i = 0; i < measured.gap.size(); ++i)
    if (i >= measured.numContacts() || static_cast<double>(solution.multiplier[i]) > roundOff * force ||
        solution.slack[i] < closed)
      active.push_back(i);
  if (areIndependent(chosen(measured.rows, active)))
    truth.forceScale = std::max(force, lambda.cwiseAbs().sum());
  truth.displacement = system.valuesOf(u);
  for (const Eigen::VectorXd& values : truth.displacement)
    truth.largest = std::max(truth.largest, values.size() > 0 ? values.cwiseAbs().maxCoeff() : 0.0);
}

/// The solution, if bodies do not rest anywhere. \param along rows of the contacts by the motions that ties
/// leave
Truth restOf(const Measured& measured, const Eigen::MatrixXd& along) {
  Truth truth;
  Solution solution;
  try {
    solution = solutionOf(measured);
  } catch (const std::runtime_error&) {
    throw Uncertain{"end of the reference"};
  }
  const double length = std::max(measured.gapScale, static_cast<double>(solution.u.cwiseAbs().maxCoeff()));
  const Eigen::VectorXd diagonal = measured.system.stiffness.diagonal();
  double force = std::max(measured.loadScale, static_cast<double>(solution.multiplier.cwiseAbs().sum()));
  force = std::max(force, measured.gapScale * std::exp(diagonal.array().log().mean()) * 1e-3);
  if (along.cols() > 0 && restsAnywhere(measured, solution, along, force, length)) {
    truth.verdict = Verdict::notUnique;
    truth.reason = "no force holds a motion";
    return truth;
  }
  fill(measured, solution, force, truth);
  return truth;
}

/// What is true of a system that could be assembled.
Truth truthOf(const Measured& measured) {
  Truth truth;
  const Eigen::Index contacts = measured.numContacts(), ties = measured.gap.size() - contacts;
  const Eigen::MatrixXd meeting = measured.rows * measured.motion;
  const Eigen::MatrixXd joint = nullSpace(meeting.bottomRows(ties), "motions that ties leave");
  const Eigen::MatrixXd along = meeting.topRows(contacts) * joint;
  const Eigen::MatrixXd directions = directionsOf(along);
  truth.isFree = joint.cols() > 0 && nullSpace(directions.transpose(), "what contacts hinder").cols() > 0;
  if (measured.gapScale > 0 && !isFeasible(measured.rows, measured.gap / measured.gapScale, contacts)) {
    truth.verdict = Verdict::contradiction;
    truth.reason = "no displacement";
    return truth;
  }
  if (joint.cols() > 0 && measured.loadScale > 0) {
    const Eigen::VectorXd e =
        joint.transpose() * (measured.motion.transpose() * measured.system.load) / measured.loadScale;
    if (isClear(imbalance(directions, e).norm(), "loads on motions")) {
      truth.verdict = Verdict::noSolution;
      truth.reason = "loads on " + std::to_string(joint.cols()) + " motions are not balanced";
      return truth;
    }
  }
  if (truth.isFree) {
    truth.verdict = Verdict::notUnique;
    truth.reason = "a motion meets nothing";
    return truth;
  }
  return restOf(measured, along);
}

} // namespace

std::string toString(Verdict verdict) {
  static const std::array<const char*, 6> names{"solved",        "no solution", "not unique",
                                                "contradiction", "wrong input", "not converged"};
  return names[static_cast<std::size_t>(verdict)];
}

Truth truthOf(const scene::Scene& scene) {
  try {
    return truthOf(Measured(drivers::undecomposedSystem(scene), scene));
  } catch (const InputError& error) {
    return {Verdict::wrongInput, error.what()};
  } catch (const SolvabilityError& error) {
    return {Verdict::contradiction, error.what()};
  }
}

} // namespace epafi::test
