#include "RolSolver.hpp"

#include <ROL_Objective.hpp>
#include <ROL_Problem.hpp>
#include <ROL_Solver.hpp>
#include <ROL_TpetraBoundConstraint.hpp>
#include <ROL_TpetraMultiVector.hpp>
#include <Tpetra_Operator.hpp>
#include <Tpetra_Vector.hpp>

using namespace epafi;

namespace {

using RolVector = ROL::TpetraMultiVector<Scalar, LocalOrdinal, GlobalOrdinal, Vector::node_type>;
using RolBounds = ROL::TpetraBoundConstraint<Scalar, LocalOrdinal, GlobalOrdinal, Vector::node_type>;

const MultiVector& tpetra(const ROL::Vector<Scalar>& x) {
  return *dynamic_cast<const RolVector&>(x).getVector();
}

MultiVector& tpetra(ROL::Vector<Scalar>& x) {
  return *dynamic_cast<RolVector&>(x).getVector();
}

/// ½uᵀAu − bᵀu. ROL asks for the value of a trial point and, once it has accepted it, for the gradient: both
/// come from one product Au.
class Quadratic : public ROL::Objective<Scalar> {
public:
  explicit Quadratic(const RolProblem& problem)
      : problem_(problem), au_(problem.b->getMap(), 1, false), work_(problem.b->getMap(), 1, false) {}

  using ROL::Objective<Scalar>::update;
  void update(const ROL::Vector<Scalar>&, ROL::UpdateType type, int) override {
    const bool trialAccepted = type == ROL::UpdateType::Accept && trial_;
    trial_ = type == ROL::UpdateType::Trial;
    if (!trialAccepted)
      known_ = false;
  }

  Scalar value(const ROL::Vector<Scalar>& u, Scalar&) override {
    work_.update(0.5, product(u), -1.0, *problem_.b, 0.0); // ½Au − b
    return dot(tpetra(u), work_);
  }

  void gradient(ROL::Vector<Scalar>& g, const ROL::Vector<Scalar>& u, Scalar&) override {
    tpetra(g).update(1.0, product(u), -1.0, *problem_.b, 0.0); // Au − b
  }

  void hessVec(ROL::Vector<Scalar>& av, const ROL::Vector<Scalar>& v, const ROL::Vector<Scalar>&,
               Scalar&) override {
    problem_.a->apply(tpetra(v), tpetra(av));
  }

  void precond(ROL::Vector<Scalar>& mv, const ROL::Vector<Scalar>& v, const ROL::Vector<Scalar>&,
               Scalar&) override {
    if (problem_.preconditioner.is_null())
      mv.set(v);
    else
      problem_.preconditioner->apply(tpetra(v), tpetra(mv));
  }

private:
  static Scalar dot(const MultiVector& x, const MultiVector& y) {
    Scalar sum = 0;
    x.dot(y, Teuchos::arrayView(&sum, 1));
    return sum;
  }

  const MultiVector& product(const ROL::Vector<Scalar>& u) {
    if (!known_)
      problem_.a->apply(tpetra(u), au_);
    known_ = true;
    return au_;
  }

  RolProblem problem_;
  MultiVector au_, work_;
  bool known_ = false, trial_ = false;
};

/// ROL's bounds for Tpetra vectors, which do not show their bounds; the primal-dual active set method asks
/// for them.
class Bounds : public RolBounds {
public:
  Bounds(const RCP<Vector>& lower, const RCP<Vector>& upper) : RolBounds(lower, upper) {
    lower_ = rcp(new RolVector(lower));
    upper_ = rcp(new RolVector(upper));
  }
};

} // namespace

int solveByRol(const RolProblem& problem, Teuchos::ParameterList parameters, const RCP<Vector>& u) {
  const RCP<Vector> upper = rcp(new Vector(problem.lower->getMap()));
  upper->putScalar(ROL::ROL_INF<Scalar>());
  const auto posed = ROL::makePtr<ROL::Problem<Scalar>>(rcp(new Quadratic(problem)), rcp(new RolVector(u)));
  posed->addBoundConstraint(rcp(new Bounds(problem.lower, upper)));
  posed->finalize();
  ROL::Solver<Scalar> solver(posed, parameters);
  solver.solve();
  return solver.getAlgorithmState()->iter;
}
