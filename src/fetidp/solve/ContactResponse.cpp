#include "epafi/fetidp/solve/ContactResponse.hpp"

#include "epafi/base/Collective.hpp"
#include "epafi/base/Errors.hpp"
#include "epafi/fetidp/equilibrium/ProjectedOperator.hpp"
#include "epafi/fetidp/operator/MultiplierExchange.hpp"
#include "epafi/qp/constraints/FaceEquality.hpp"
#include "epafi/qp/solve/ConjugateGradient.hpp"

#include <Tpetra_Map.hpp>
#include <Tpetra_Vector.hpp>

#include <algorithm>
#include <functional>
#include <utility>

namespace epafi::fetidp {
namespace {

using decomposition::DecomposedProblem;
using decomposition::OwnedMultiplier;
using decomposition::RowKind;

/// Rows that hold both ways, and the equilibrium of floating bodies in them.
class Face {
public:
  /// Keeps a reference to `dual`. Collective.
  Face(const DualProblem& dual, const Vector& closed)
      : space_(dual.coarseSpace()), rows_(closed.getMap()), equality_(space_, closed.getMap()) {
    const auto isClosed = closed.getData();
    const auto isFree = rows_.isFree.getDataNonConst();
    for (LocalOrdinal row = 0; row < isFree.size(); ++row) {
      const RowKind kind = dual.problem().kindOf(OwnedMultiplier(row));
      isFree[row] = kind == RowKind::contact || kind == RowKind::friction ? isClosed[row] : 1;
    }
    equality_.setFace(rows_);
  }

  /// x ← P x on the face, 0 off it. With floating bodies a message of k numbers. Collective.
  void restrict(Vector& x) { equality_.project(x); }
  /// The shortest λ on the face with G̃_a λ = ẽ. Collective. \throws Error if there is none.
  void balance(const Eigen::VectorXd& resultants, Vector& lambda) {
    constexpr double roundOff = 1e-9;
    const std::size_t size = resultants.size();
    std::vector<double> mu(size);
    equality_.multiplierOf({resultants.data(), size}, mu);
    lambda.putScalar(0.0);
    equality_.addTransposed(mu, 1.0, lambda);
    const Eigen::VectorXd rest = space_->product(lambda) - resultants;
    if (space_->normOf(rest) > roundOff * space_->normOf(resultants))
      throw UnheldResultant(
          "the load has a resultant on a floating body that its closed contacts cannot take");
  }
  /// α with G̃_aᵀ α = x on the face, by least squares; 0 for motions that it leaves free. x becomes 0 off the
  /// face. Collective.
  [[nodiscard]] Eigen::VectorXd motionOf(Vector& x) {
    const std::span<const double> alpha = equality_.fit(x);
    return Eigen::Map<const Eigen::VectorXd>(alpha.data(), alpha.size());
  }

private:
  RCP<const NaturalCoarseSpace> space_;
  qp::Face rows_;
  qp::FaceEquality equality_;
};

/// B̄K̄⁺(f̄ − B̄ᵀλ) − Cλ − c, and K̄⁺(…).
struct Jumps {
  Jumps(const DualProblem& dual, const DataChange& change, const Vector* lambda)
      : values(rcp(new Vector(dual.problem().multiplierMap))) {
    SubdomainVectors forces(change.load.begin(), change.load.end());
    MultiplierExchange exchange(dual.inverse().multiplierPlan());
    if (lambda != nullptr)
      dual.inverse().subtractForces(exchange.toSubdomains(*lambda), forces);
    dual.inverse().apply(forces, u);
    dual.inverse().constraint(u, exchange.values());
    exchange.sumToOwners(*values);
    if (lambda != nullptr && !dual.problem().compliance.is_null())
      values->elementWiseMultiply(-1.0, *dual.problem().compliance, *lambda, 1.0);
    if (!change.gap.is_null())
      values->update(-1.0, *change.gap, 1.0);
  }
  /// max |K̄⁺(…)| + max |c|. Collective.
  [[nodiscard]] double termSize(const DualProblem& dual, const DataChange& change) const {
    double largest = 0;
    for (const Eigen::MatrixXd& own : u)
      largest = own.size() > 0 ? std::max(largest, own.lpNorm<Eigen::Infinity>()) : largest;
    return maxOverRanks(*dual.problem().comm, largest) + (change.gap.is_null() ? 0.0 : change.gap->normInf());
  }
  SubdomainVectors u;
  RCP<Vector> values;
};

/// λ̇. Collective.
RCP<Vector> multiplierOf(const DualProblem& dual, Face& face, const DataChange& change, double tolerance,
                         qp::SolveReport& report) {
  const DecomposedProblem& problem = dual.problem();
  const DualOperators& operators = dual.operators();
  const Jumps start(dual, change, nullptr);
  const RCP<Vector> whole = start.values; // d̃
  const RCP<Vector> rhs = rcp(new Vector(*whole, Teuchos::Copy)),
                    lambda = rcp(new Vector(problem.multiplierMap));
  if (!operators.deflated.is_null())
    operators.deflated->space().projectTransposed(*rhs);
  Vector balanced(problem.multiplierMap); // λ̃
  if (problem.kernelDimension > 0) {
    face.balance(kernelLoad(problem, {change.load.begin(), change.load.end()}), balanced);
    operators.flexibility()->apply(balanced, *rhs, Teuchos::NO_TRANS, -1.0, 1.0);
  }
  face.restrict(*rhs);
  constexpr double roundOff = 1e-12; // of what cancels in it, as for a change that moves a body as a whole
  if (rhs->normInf() > roundOff * start.termSize(dual, change)) {
    const std::function<void(Vector&)> restrict = [&face](Vector& x) { face.restrict(x); };
    const RCP<const Operator> hessian = rcp(new ProjectedOperator(operators.flexibility(), restrict));
    RCP<const Operator> preconditioner;
    if (!operators.facePreconditioner.is_null())
      preconditioner = rcp(new ProjectedOperator(operators.facePreconditioner, restrict));
    report = qp::solveUnconstrained(hessian, rhs, lambda, tolerance,
                                    dual.parameters().mprgp.maxMultiplications, nullptr, preconditioner);
    for (int pass = 0; pass < 2; ++pass) // the operator does not see what round-off adds beside equilibrium
      face.restrict(*lambda);
  }
  lambda->update(1.0, balanced, 1.0);
  if (!operators.deflated.is_null())
    operators.deflated->complete(*whole, *lambda);
  return lambda;
}

} // namespace

UnknownsResponse unknownsResponse(const DualProblem& dual, const Vector& closed, const DataChange& change,
                                  double tolerance) {
  const DecomposedProblem& problem = dual.problem();
  Face face(dual, closed);
  UnknownsResponse response;
  response.report.status = qp::Status::converged;
  response.multiplier = dual.algorithm() == Algorithm::direct
                            ? rcp(new Vector(problem.multiplierMap))
                            : multiplierOf(dual, face, change, tolerance, response.report);
  Jumps jumps(dual, change, response.multiplier.get());
  response.unknowns = std::move(jumps.u);
  if (problem.kernelDimension == 0)
    return response;
  jumps.values->scale(-1.0); // ċ − Bu̇, what is left for rigid motions
  const Eigen::VectorXd alpha = face.motionOf(*jumps.values);
  for (std::size_t s = 0; s < problem.subdomains.size(); ++s) {
    const decomposition::Subdomain& subdomain = problem.subdomains[s];
    if (subdomain.kernel.cols() > 0)
      response.unknowns[s] +=
          subdomain.kernel * alpha.segment(problem.kernelOffsetOf(subdomain), subdomain.kernel.cols());
  }
  return response;
}

ContactResponse contactResponse(const DualProblem& dual, const Vector& closed, const DataChange& change,
                                double tolerance) {
  UnknownsResponse found = unknownsResponse(dual, closed, change, tolerance);
  ContactResponse response{{}, std::move(found.multiplier), std::move(found.report)};
  const auto& subdomains = dual.problem().subdomains;
  for (std::size_t s = 0; s < subdomains.size(); ++s)
    response.displacement.push_back(decomposition::atAllPositions(
        subdomains[s], found.unknowns[s], Eigen::VectorXd::Zero(dual.problem().numPositions(subdomains[s]))));
  return response;
}

} // namespace epafi::fetidp
