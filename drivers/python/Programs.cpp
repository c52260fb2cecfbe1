#include "Arrays.hpp"
#include "Doors.hpp"
#include "Sparse.hpp"
#include "Watch.hpp"

#include "epafi/base/Errors.hpp"
#include "epafi/qp/constraints/Box.hpp"
#include "epafi/qp/constraints/Discs.hpp"
#include "epafi/qp/solve/QpSolver.hpp"
#include "epafi/scene/ParameterFile.hpp"

#include <Teuchos_DefaultMpiComm.hpp>
#include <Tpetra_CrsMatrix.hpp>
#include <Tpetra_Map.hpp>
#include <Tpetra_Operator.hpp>
#include <Tpetra_Vector.hpp>
#include <pybind11/stl.h>

#include <optional>

namespace epafi::python {
namespace {

/// y = A x by a function of Python, symmetric, on one rank.
class PythonOperator final : public Operator {
public:
  PythonOperator(py::object product, RCP<const Map> map)
      : product_(std::move(product)), map_(std::move(map)) {}
  [[nodiscard]] RCP<const Map> getDomainMap() const override { return map_; }
  [[nodiscard]] RCP<const Map> getRangeMap() const override { return map_; }
  [[nodiscard]] bool hasTransposeApply() const override { return true; }
  void apply(const MultiVector& x, MultiVector& y, Teuchos::ETransp /*mode*/, Scalar alpha,
             Scalar beta) const override;

  /// Goes on with what Python has raised, if it has.
  void rethrow() const {
    if (error_)
      throw py::error_already_set(std::move(*error_));
  }

private:
  py::object product_;
  RCP<const Map> map_;
  mutable std::optional<py::error_already_set> error_;
};

void PythonOperator::apply(const MultiVector& x, MultiVector& y, Teuchos::ETransp /*mode*/, Scalar alpha,
                           Scalar beta) const {
  const py::gil_scoped_acquire lock;
  for (std::size_t column = 0; column < x.getNumVectors(); ++column) {
    const auto from = x.getData(column);
    Row<double> product;
    try {
      product = Row<double>(product_(py::array_t<double>(from.size(), from.getRawPtr())));
    } catch (py::error_already_set& error) {
      error_.emplace(std::move(error));
      throw Error("a product with an operator of Python's has failed");
    }
    if (product.size() != from.size())
      throw InputError("a product with an operator of " + std::to_string(from.size()) + " rows has " +
                       std::to_string(product.size()) + " entries");
    const auto to = y.getDataNonConst(column);
    for (Teuchos::Ordinal row = 0; row < to.size(); ++row)
      to[row] = (beta == 0 ? 0 : beta * to[row]) + alpha * product.data()[row];
  }
}

/// A matrix, or a function that multiplies.
RCP<const Operator> operatorOf(const py::object& given, const RCP<const Map>& map) {
  if (given.is_none())
    return Teuchos::null;
  if (py::isinstance<py::tuple>(given))
    return matrixOf(given.cast<CompressedRows>(), static_cast<int>(map->getGlobalNumElements()),
                    map->getComm());
  return rcp(new PythonOperator(given, map));
}

RCP<const qp::ConvexSet> setOf(const std::optional<Row<double>>& lower,
                               const std::optional<Row<double>>& upper,
                               const std::vector<std::tuple<int, int, double, double, double>>& discs,
                               const RCP<const Map>& map) {
  if (!lower && !upper && discs.empty())
    return Teuchos::null;
  const qp::Box box(lower ? vectorOf(*lower, map, "lower") : Teuchos::null,
                    upper ? vectorOf(*upper, map, "upper") : Teuchos::null);
  if (discs.empty())
    return rcp(new qp::Box(box));
  std::vector<qp::Disc> all;
  for (const auto& [first, second, radius, x, y] : discs)
    all.push_back({first, second, radius, {x, y}});
  std::sort(all.begin(), all.end(), [](const qp::Disc& a, const qp::Disc& b) { return a.first < b.first; });
  return rcp(new qp::Discs(box, std::move(all), map));
}

py::object copyOf(const RCP<const Vector>& vector) {
  if (vector.is_null())
    return py::none();
  const auto data = vector->getData();
  return py::array_t<double>(data.size(), data.getRawPtr());
}

py::dict resultOf(const qp::QpSolution& solution, const Vector& x) {
  const qp::SolveReport& report = solution.report;
  using namespace py::literals;
  return py::dict("x"_a = copyOf(rcp(&x, false)), "bound_multiplier"_a = copyOf(solution.boundMultiplier),
                  "equality_multiplier"_a = copyOf(solution.equalityMultiplier),
                  "status"_a = toString(report.status), "reason"_a = report.reason,
                  "objective"_a = report.objective, "certificate"_a = copyOf(report.certificate),
                  "kkt"_a = py::dict("stationarity"_a = report.kkt.stationarity,
                                     "dual_feasibility"_a = report.kkt.dualFeasibility,
                                     "feasibility"_a = report.kkt.feasibility,
                                     "complementarity"_a = report.kkt.complementarity,
                                     "equality"_a = report.kkt.equality),
                  "products"_a = report.counts.hessianMultiplications);
}

/// \param hessian, preconditioner  a matrix's arrays, or a function; the second may be None
/// \param equality                 B and c, or nothing
/// \param parameters               of QpSolver, as XML
py::dict solveProgram(const py::object& hessian, const Row<double>& linearTerm,
                      const std::optional<Row<double>>& lower, const std::optional<Row<double>>& upper,
                      const std::vector<std::tuple<int, int, double, double, double>>& discs,
                      const std::optional<std::pair<CompressedRows, Row<double>>>& equality,
                      const py::object& preconditioner, const Row<double>& start,
                      const std::string& parameters, const py::object& progress) {
  const RCP<const Comm> comm = rcp(new Teuchos::MpiComm<int>(MPI_COMM_SELF));
  const auto numUnknowns = static_cast<int>(linearTerm.size());
  const RCP<const Map> map = rcp(new Map(numUnknowns, 0, comm));
  qp::QuadraticProgram program;
  program.hessian = operatorOf(hessian, map);
  program.linearTerm = vectorOf(linearTerm, map, "the linear term");
  program.preconditioner = operatorOf(preconditioner, map);
  program.set = setOf(lower, upper, discs, map);
  if (equality) {
    const RCP<const CrsMatrix> rows = matrixOf(equality->first, numUnknowns, comm);
    program.constraintMatrix = rows;
    program.constraintValues = vectorOf(equality->second, rows->getRangeMap(), "the right side of equations");
  }
  const RCP<Vector> x = vectorOf(start, map, "the start");
  qp::QpSolver solver(scene::parseParameters(parameters, "parameters"));
  Watch watch(comm, progress);
  qp::QpSolution solution;
  const auto rethrow = [&] {
    for (const Operator* const used : {program.hessian.get(), program.preconditioner.get()})
      if (const auto* const ofPython = dynamic_cast<const PythonOperator*>(used))
        ofPython->rethrow();
  };
  try {
    const py::gil_scoped_release noLock;
    solution = solver.solve(program, *x, &watch);
  } catch (const Error&) {
    rethrow();
    throw;
  }
  rethrow();
  if (solution.report.status == qp::Status::interrupted)
    watch.raise();
  return resultOf(solution, *x);
}

} // namespace

void definePrograms(py::module_& module) {
  module.def("program_schema", [] { return schemaOf(qp::QpSolver::validParameters()); });
  module.def("solve_program", &solveProgram);
}

} // namespace epafi::python
