#include "LinearSolve.hpp"

#include "epafi/base/Types.hpp"

#include <BelosPseudoBlockCGSolMgr.hpp>
#include <BelosTpetraAdapter.hpp>
#include <MueLu_CreateTpetraPreconditioner.hpp>
#include <Teuchos_ParameterList.hpp>
#include <Teuchos_Time.hpp>
#include <Tpetra_Core.hpp>
#include <Tpetra_CrsMatrix.hpp>
#include <Tpetra_Vector.hpp>

#include <algorithm>
#include <stdexcept>
#include <string>

namespace epafi::drivers {
namespace {

using Problem = Belos::LinearProblem<double, MultiVector, Operator>;
using ConjugateGradients = Belos::PseudoBlockCGSolMgr<double, MultiVector, Operator>;

/// Shares columns and values with the system. Tpetra's interface knows no const; sorted rows stay as they
/// are.
RCP<CrsMatrix> tpetraMatrix(const LinearSystem& system) {
  const auto& k = system.matrix;
  const auto map = rcp(new Map(static_cast<std::size_t>(k.rows()), 0, Tpetra::getDefaultComm()));
  Teuchos::ArrayRCP<std::size_t> rowStarts(static_cast<int>(k.rows()) + 1);
  std::copy(k.outerIndexPtr(), k.outerIndexPtr() + k.rows() + 1, rowStarts.begin());
  const auto size = static_cast<int>(k.nonZeros());
  const auto columns = Teuchos::arcp(const_cast<int*>(k.innerIndexPtr()), 0, size, false);
  const auto values = Teuchos::arcp(const_cast<double*>(k.valuePtr()), 0, size, false);
  const auto matrix = rcp(new CrsMatrix(map, map, rowStarts, columns, values));
  matrix->fillComplete();
  return matrix;
}

/// MueLu's defaults but for the smoother. Of higher degrees of the polynomial, other dampings and dropping
/// none is faster by more than 2 % at 1/h = 512.
Teuchos::ParameterList multigridParameters() {
  Teuchos::ParameterList list;
  list.set("verbosity", "none");
  list.set("problem: symmetric", true);
  list.set("smoother: type", "CHEBYSHEV");
  return list;
}

} // namespace

LinearSolution solveByMueLu(const LinearSystem& system, double tolerance) {
  const RCP<CrsMatrix> k = tpetraMatrix(system);
  const auto load =
      rcp(new Vector(k->getRangeMap(), Teuchos::arrayView(system.load.data(), system.load.size())));
  const auto u = rcp(new Vector(k->getDomainMap()));

  LinearSolution result;
  const double start = Teuchos::Time::wallTime();
  Teuchos::ParameterList list = multigridParameters();
  const auto cycle =
      MueLu::CreateTpetraPreconditioner<Scalar, LocalOrdinal, GlobalOrdinal, Vector::node_type>(
          Teuchos::rcp_implicit_cast<Operator>(k), list);
  const double prepared = Teuchos::Time::wallTime();
  const auto problem = rcp(new Problem(k, u, load));
  problem->setLeftPrec(cycle);
  problem->setProblem();
  const auto parameters = Teuchos::parameterList();
  parameters->set("Convergence Tolerance", tolerance);
  parameters->set("Maximum Iterations", 1000);
  ConjugateGradients solver(problem, parameters);
  const Belos::ReturnType outcome = solver.solve();
  result.setupSeconds = prepared - start;
  result.solveSeconds = Teuchos::Time::wallTime() - prepared;
  result.iterations = solver.getNumIters();
  if (outcome != Belos::Converged)
    throw std::runtime_error("conjugate gradients with MueLu did not reach the tolerance in " +
                             std::to_string(result.iterations) + " steps");
  const auto values = u->getData();
  result.u = Eigen::Map<const Eigen::VectorXd>(values.getRawPtr(), values.size());
  return result;
}

} // namespace epafi::drivers
