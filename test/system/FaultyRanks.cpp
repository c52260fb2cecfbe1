// Programs that fail on some ranks: faulty_ranks KIND ends as the driver would.

#include "JointEnd.hpp"

#include "epafi/base/Collective.hpp"
#include "epafi/base/Errors.hpp"
#include "epafi/qp/solve/QpSolver.hpp"

#include <Teuchos_Comm.hpp>
#include <Tpetra_Core.hpp>
#include <Tpetra_Map.hpp>
#include <Tpetra_Operator.hpp>
#include <Tpetra_Vector.hpp>

#include <new>
#include <string>

namespace {

using namespace epafi;

/// A diagonal matrix that throws in a product, on one rank.
class Throwing final : public Operator {
public:
  explicit Throwing(RCP<const Map> map) : map_(std::move(map)) {}
  [[nodiscard]] RCP<const Map> getDomainMap() const override { return map_; }
  [[nodiscard]] RCP<const Map> getRangeMap() const override { return map_; }
  void apply(const MultiVector& x, MultiVector& y, Teuchos::ETransp /*mode*/, double alpha,
             double beta) const override {
    if (++products_ == 15 && map_->getComm()->getRank() == 1)
      throw std::runtime_error("product number 15\n  went wrong");
    const auto from = x.getData(0);
    const auto to = y.getDataNonConst(0);
    for (Teuchos_Ordinal i = 0; i < to.size(); ++i)
      to[i] =
          alpha * static_cast<double>(1 + map_->getGlobalElement(static_cast<LocalOrdinal>(i))) * from[i] +
          (beta == 0 ? 0.0 : beta * to[i]);
  }

private:
  RCP<const Map> map_;
  mutable int products_ = 0;
};

void iterate(const RCP<const Comm>& comm) {
  const RCP<const Map> map = rcp(new Map(100, 0, comm));
  const RCP<Vector> b = rcp(new Vector(map)), x = rcp(new Vector(map));
  b->putScalar(1.0);
  qp::QuadraticProgram problem;
  problem.hessian = rcp(new Throwing(map));
  problem.linearTerm = b;
  Teuchos::ParameterList parameters;
  parameters.set("Operator Norm", 100.0).set("Tolerance", 1e-12);
  qp::QpSolver(parameters).solve(problem, *x);
}

int work(const std::string& kind, const RCP<const Comm>& comm) {
  const int rank = comm->getRank();
  if (kind == "operator")
    iterate(comm);
  if (kind == "input" && rank == 1)
    throw InputError("the list says nonsense to one rank; correct it");
  if (kind == "unsolvable" && rank == 1)
    throw SolvabilityError(SolvabilityError::Kind::noSolution, "no solution: it slides; hold it");
  if (kind == "several" && rank > 0)
    throw std::bad_alloc();
  if (kind == "all")
    throw InputError("all say so; correct it");
  if (kind == "agreed")
    collectively(*comm, [&] {
      if (rank == 1)
        throw std::bad_alloc();
    });
  if (kind == "nothing")
    throw 1;       // NOLINT: whatever a library may throw
  comm->barrier(); // in which the others wait
  return drivers::solved;
}

} // namespace

int main(int argc, char** argv) {
  const Tpetra::ScopeGuard scope(&argc, &argv);
  const RCP<const Comm> comm = Tpetra::getDefaultComm();
  const std::string kind = argc > 1 ? argv[1] : "";
  return drivers::endTogether(*comm, [&] { return work(kind, comm); });
}
