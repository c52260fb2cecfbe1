/// A membrane over an obstacle, by Epafi's MPRGP and by methods of ROL for problems with bounds, to the same
/// accuracy:
///     ObstacleRol [N] [REPEATS]
/// N × N unknowns; times are medians of REPEATS runs of each, in turns. Ends with 1 if one misses the
/// accuracy.

#include "MueLuPreconditioner.hpp"
#include "Obstacle.hpp"
#include "RolSolver.hpp"

#include "epafi/base/Collective.hpp"
#include "epafi/qp/constraints/Box.hpp"
#include "epafi/qp/solve/QpSolver.hpp"

#include <Teuchos_Time.hpp>
#include <Tpetra_Core.hpp>
#include <Tpetra_CrsMatrix.hpp>
#include <Tpetra_Vector.hpp>

#include <algorithm>
#include <functional>
#include <iomanip>
#include <iostream>
#include <limits>
#include <string>
#include <utility>
#include <vector>

using namespace epafi;

namespace {

constexpr double tolerance = 1e-6;

/// Counts the products with an operator.
class Counted : public Operator {
public:
  explicit Counted(RCP<const Operator> counted) : counted_(std::move(counted)) {}

  [[nodiscard]] RCP<const Map> getDomainMap() const override { return counted_->getDomainMap(); }
  [[nodiscard]] RCP<const Map> getRangeMap() const override { return counted_->getRangeMap(); }
  void apply(const MultiVector& x, MultiVector& y, Teuchos::ETransp mode, Scalar alpha,
             Scalar beta) const override {
    ++products_;
    counted_->apply(x, y, mode, alpha, beta);
  }
  [[nodiscard]] int products() const { return products_; }

private:
  RCP<const Operator> counted_;
  mutable int products_ = 0;
};

/// One method, with a preconditioner or without, and what its runs took.
struct Method {
  std::string name;
  std::function<void(const RCP<const Operator>& a, const RCP<const Operator>& m, const RCP<Vector>& u)> solve;
  bool isPreconditioned = false;
  std::vector<double> seconds = {};
  int products = 0, cycles = 0;
  double accuracy = 0;
};

Method preconditioned(Method method) {
  method.name += ", MueLu";
  method.isPreconditioned = true;
  return method;
}

void solveByEpafi(const Obstacle& obstacle, const RCP<const Operator>& a, const RCP<const Operator>& m,
                  const RCP<Vector>& u) {
  qp::QuadraticProgram problem;
  problem.hessian = a;
  problem.linearTerm = obstacle.load;
  problem.set = rcp(new qp::Box(obstacle.floor));
  problem.preconditioner = m;
  Teuchos::ParameterList parameters;
  parameters.set("Tolerance", tolerance);
  qp::QpSolver(parameters).solve(problem, *u);
}

/// A method of ROL. The Krylov method inside of it ends at a share 0.3 of the residual, and after `limit`
/// steps: these took the fewest products of what was tried.
Method rol(const Obstacle& obstacle, const std::string& name, Teuchos::ParameterList parameters, int limit) {
  Teuchos::ParameterList& krylov = parameters.sublist("General").sublist("Krylov");
  krylov.set("Relative Tolerance", 0.3);
  krylov.set("Absolute Tolerance", std::numeric_limits<double>::max()); // ROL takes the smaller of both
  krylov.set("Iteration Limit", limit);
  Teuchos::ParameterList& status = parameters.sublist("Status Test");
  status.set("Gradient Tolerance", tolerance * obstacle.load->norm2());
  status.set("Step Tolerance", 0.0); // the gradient alone counts
  status.set("Iteration Limit", 10000);
  return {"ROL " + name, [=](const auto& a, const auto& m, const auto& u) {
            solveByRol({a, obstacle.load, obstacle.floor, m}, parameters, u);
          }};
}

/// Lin, Moré, *SIAM J. Optim.* 9 (1999).
Method linMore(const Obstacle& obstacle) {
  Teuchos::ParameterList parameters;
  Teuchos::ParameterList& step = parameters.sublist("Step");
  step.set("Type", "Trust Region");
  step.sublist("Trust Region").set("Subproblem Model", "Lin-More");
  step.sublist("Trust Region").set("Initial Radius", 1e6); // the quadratic model is the objective itself
  return rol(obstacle, "Lin-More trust region", parameters, 20);
}

/// Hintermüller, Ito, Kunisch, *SIAM J. Optim.* 13 (2003).
Method activeSet(const Obstacle& obstacle) {
  Teuchos::ParameterList parameters;
  Teuchos::ParameterList& step = parameters.sublist("Step");
  step.set("Type", "Primal Dual Active Set");
  step.sublist("Primal Dual Active Set")
      .set("Iteration Limit", 1); // guess the set anew after each inexact solve
  return rol(obstacle, "primal-dual active set", parameters, 1000);
}

void run(Method& method, const Obstacle& obstacle, const RCP<const Operator>& multigrid) {
  const Comm& comm = *obstacle.a->getComm();
  const RCP<Counted> a = rcp(new Counted(obstacle.a)), m = rcp(new Counted(multigrid));
  const RCP<Vector> u = rcp(new Vector(obstacle.a->getDomainMap()));
  comm.barrier();
  const double begin = Teuchos::Time::wallTime();
  method.solve(a, method.isPreconditioned ? m : Teuchos::null, u);
  method.seconds.push_back(maxOverRanks(comm, Teuchos::Time::wallTime() - begin));
  method.products = a->products();
  method.cycles = m->products();

  // ‖u − P(u − g)‖ / ‖b‖, P the projection onto u ≥ l: what ROL stops at. ‖gᴾ‖, Epafi's, is no smaller.
  Vector step(u->getMap());
  obstacle.a->apply(*u, step);
  step.update(1.0, *u, 1.0, *obstacle.load, -1.0); // u − (Au − b)
  qp::Box(obstacle.floor).project(step);
  step.update(1.0, *u, -1.0);
  method.accuracy = step.norm2() / obstacle.load->norm2();
}

double median(std::vector<double> values) {
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

void print(const std::vector<Method>& methods) {
  std::cout << std::left << std::setw(36) << ""
            << "  seconds  products  V-cycles  accuracy\n";
  for (const Method& method : methods)
    std::cout << std::left << std::setw(36) << method.name << std::right << std::setw(9)
              << std::setprecision(3) << median(method.seconds) << std::setw(10) << method.products
              << std::setw(10) << method.cycles << std::setw(10) << std::setprecision(2) << method.accuracy
              << '\n';
}

} // namespace

int main(int argc, char** argv) {
  Tpetra::ScopeGuard scope(&argc, &argv);
  const auto comm = Tpetra::getDefaultComm();
  const GlobalOrdinal n = argc > 1 ? std::stoi(argv[1]) : 100;
  const int repeats = argc > 2 ? std::stoi(argv[2]) : 1;
  const Obstacle obstacle = makeObstacle(n, comm);
  const RCP<const Operator> multigrid = makeMueLu(obstacle.a);

  const Method mprgp{"Epafi MPRGP",
                     [&](const auto& a, const auto& m, const auto& u) { solveByEpafi(obstacle, a, m, u); }};
  std::vector<Method> methods{mprgp, linMore(obstacle), activeSet(obstacle)};
  for (std::size_t i = 0; i < 3; ++i)
    methods.push_back(preconditioned(methods[i]));
  for (int round = 0; round < repeats; ++round)
    for (Method& method : methods)
      run(method, obstacle, multigrid);
  if (comm->getRank() == 0)
    print(methods);
  return std::all_of(methods.begin(), methods.end(),
                     [](const Method& method) { return method.accuracy <= tolerance; })
             ? 0
             : 1;
}
