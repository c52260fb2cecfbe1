#include "epafi/fetidp/ContactResponse.hpp"

#include "epafi/base/Collective.hpp"
#include "epafi/base/Columns.hpp"
#include "epafi/base/Errors.hpp"
#include "epafi/base/SymmetricOperator.hpp"
#include "epafi/direct/DenseSymmetric.hpp"
#include "epafi/fetidp/MultiplierExchange.hpp"
#include "epafi/qp/ConjugateGradient.hpp"

#include <Tpetra_Map.hpp>
#include <Tpetra_Vector.hpp>

#include <algorithm>
#include <iterator>
#include <utility>

namespace epafi::fetidp {
namespace {

using decomposition::DecomposedProblem;
using decomposition::OwnedMultiplier;

/// Rows that hold both ways, and the equilibrium of floating bodies in them: G_a = T G̃_a with G_a G_aᵀ = I.
class Face {
public:
  /// Collective.
  Face(const DualProblem& dual, const Vector& closed);

  /// x ← P x on the face, 0 off it. With floating bodies a message of k numbers. Collective.
  void restrict(Vector& x) const;
  /// The shortest λ on the face with G̃_a λ = ẽ. Collective. \throws Error if there is none.
  void balance(const Eigen::VectorXd& resultants, Vector& lambda) const;
  /// α with G̃_aᵀ α = x on the face, by least squares; 0 for motions that it leaves free. Valid until the next call. Collective.
  [[nodiscard]] const Eigen::VectorXd& motionOf(const Vector& x) const {
    held_.noalias() = transform_ * product(x);
    motion_.noalias() = transform_.transpose() * held_;
    return motion_;
  }

private:
  /// G̃_a x. Collective.
  [[nodiscard]] const Eigen::VectorXd& product(const Vector& x) const;
  /// y += factor · G̃_aᵀ μ
  void addTransposed(const Eigen::VectorXd& mu, double factor, Vector& y) const;

  const Comm& comm_;
  std::vector<LocalOrdinal> openRows_;
  std::vector<KernelEntry> entries_; ///< G̃_aᵀ
  Eigen::MatrixXd transform_;        ///< T, (motions held) × k
  mutable std::vector<AccurateSum> sums_;
  mutable Eigen::VectorXd product_, held_, motion_; ///< work: G̃_a x, G_a x, α
};

Face::Face(const DualProblem& dual, const Vector& closed) : comm_(*dual.problem().comm) {
  const DecomposedProblem& problem = dual.problem();
  const auto isClosed = closed.getData();
  const auto isOpen = [&](LocalOrdinal row) {
    return problem.kindOf(OwnedMultiplier(row)) == decomposition::RowKind::contact && isClosed[row] == 0;
  };
  for (LocalOrdinal row = 0; row < isClosed.size(); ++row)
    if (isOpen(row))
      openRows_.push_back(row);
  const Eigen::Index k = problem.kernelDimension;
  if (k == 0)
    return;
  sums_.resize(static_cast<std::size_t>(k));
  product_.resize(k);
  std::copy_if(dual.kernelEntries().begin(), dual.kernelEntries().end(), std::back_inserter(entries_),
               [&](const KernelEntry& entry) { return !isOpen(entry.row); });
  constexpr double roundOff = 1e-12; // of the largest eigenvalue
  const direct::SymmetricEigen spectrum = direct::eigenOf(kernelGram(problem, entries_));
  const Eigen::Index held = k - spectrum.numUpTo(roundOff * spectrum.values.maxCoeff());
  transform_ = spectrum.values.tail(held).cwiseSqrt().cwiseInverse().asDiagonal() *
               spectrum.vectors.rightCols(held).transpose();
}

const Eigen::VectorXd& Face::product(const Vector& x) const {
  std::fill(sums_.begin(), sums_.end(), AccurateSum());
  const auto values = x.getData();
  for (const KernelEntry& entry : entries_)
    sums_[static_cast<std::size_t>(entry.mode)].add(entry.value * values[entry.row]);
  sumOverRanks(comm_, sums_, product_.data());
  return product_;
}

void Face::addTransposed(const Eigen::VectorXd& mu, double factor, Vector& y) const {
  const auto values = y.getDataNonConst();
  for (const KernelEntry& entry : entries_)
    values[entry.row] += factor * entry.value * mu[entry.mode];
}

void Face::restrict(Vector& x) const {
  {
    const auto values = x.getDataNonConst();
    for (const LocalOrdinal row : openRows_)
      values[row] = 0;
  }
  if (transform_.cols() > 0)
    addTransposed(motionOf(x), -1.0, x);
}

void Face::balance(const Eigen::VectorXd& resultants, Vector& lambda) const {
  constexpr double roundOff = 1e-9;
  const Eigen::VectorXd e = transform_ * resultants;
  lambda.putScalar(0.0);
  addTransposed(transform_.transpose() * e, 1.0, lambda);
  if ((product(lambda) - resultants).norm() > roundOff * resultants.norm())
    throw Error("the load has a resultant on a floating body that its closed contacts cannot take");
}

/// x ↦ Z P A P Z x, Z = 1 on the face and 0 off it. From both sides: of round-off off the face CG would make negative curvature.
class FaceOperator final : public SymmetricOperator {
public:
  FaceOperator(RCP<const Operator> a, const Face& face)
      : SymmetricOperator(a->getDomainMap()), a_(std::move(a)), face_(face), restricted_(getDomainMap()) {}

private:
  void multiply(const MultiVector& x, MultiVector& y) const override {
    forEachColumn(x, y, [&](const Vector& in, Vector& out) {
      restricted_.assign(in);
      face_.restrict(restricted_);
      a_->apply(restricted_, out);
      face_.restrict(out);
    });
  }

  RCP<const Operator> a_;
  const Face& face_;
  mutable Vector restricted_; ///< work
};

/// B̄K̄⁺(f̄ − B̄ᵀλ) − c, and K̄⁺(…).
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
RCP<Vector> multiplierOf(const DualProblem& dual, const Face& face, const DataChange& change,
                         double tolerance, qp::SolveReport& report) {
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
    const RCP<const Operator> hessian = rcp(new FaceOperator(operators.flexibility(), face));
    RCP<const Operator> preconditioner;
    if (!operators.facePreconditioner.is_null())
      preconditioner = rcp(new FaceOperator(operators.facePreconditioner, face));
    report = qp::solveUnconstrained(hessian, rhs, lambda, tolerance,
                                    dual.parameters().mprgp.maxMultiplications, nullptr, preconditioner);
  }
  lambda->update(1.0, balanced, 1.0);
  if (!operators.deflated.is_null())
    operators.deflated->complete(*whole, *lambda);
  return lambda;
}

} // namespace

ContactResponse contactResponse(const DualProblem& dual, const Vector& closed, const DataChange& change,
                                double tolerance) {
  const DecomposedProblem& problem = dual.problem();
  const Face face(dual, closed);
  ContactResponse response;
  response.report.status = qp::Status::converged;
  response.multiplier = dual.algorithm() == Algorithm::direct
                            ? rcp(new Vector(problem.multiplierMap))
                            : multiplierOf(dual, face, change, tolerance, response.report);
  Jumps jumps(dual, change, response.multiplier.get());
  jumps.values->scale(-1.0); // ċ − Bu̇, what is left for rigid motions
  const Eigen::VectorXd alpha =
      problem.kernelDimension > 0 ? face.motionOf(*jumps.values) : Eigen::VectorXd();
  for (std::size_t s = 0; s < problem.subdomains.size(); ++s) {
    const decomposition::Subdomain& subdomain = problem.subdomains[s];
    const int offset = problem.bodies[static_cast<std::size_t>(subdomain.body)].kernelOffset;
    if (subdomain.kernel.cols() > 0)
      jumps.u[s] += subdomain.kernel * alpha.segment(offset, subdomain.kernel.cols());
    response.displacement.push_back(decomposition::atAllPositions(
        subdomain, jumps.u[s], Eigen::VectorXd::Zero(subdomain.prescribed.size())));
  }
  return response;
}

} // namespace epafi::fetidp
