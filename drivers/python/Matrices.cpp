#include "Arrays.hpp"
#include "Doors.hpp"
#include "Sparse.hpp"
#include "Watch.hpp"

#include "epafi/ContactSolver.hpp"
#include "epafi/base/Errors.hpp"
#include "epafi/decomposition/ElementMatrices.hpp"
#include "epafi/decomposition/UnassembledProblem.hpp"
#include "epafi/scene/ParameterFile.hpp"

#include <Teuchos_DefaultMpiComm.hpp>
#include <Teuchos_Time.hpp>
#include <Tpetra_CrsMatrix.hpp>
#include <Tpetra_Map.hpp>
#include <Tpetra_Vector.hpp>
#include <metis.h>
#include <pybind11/stl.h>

#include <map>
#include <memory>
#include <optional>

namespace epafi::python {
namespace {

/// Rows of a table as Eigen has them.
Eigen::MatrixXd tableOf(const Row<double>& table) {
  using Rows = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;
  return Eigen::Map<const Rows>(table.data(), table.shape(0), table.shape(1));
}

/// A contact problem of an application's matrices, all of it on this rank. Unknowns are numbered through all
/// bodies, which come before `begin`.
class Problem {
public:
  Problem(int dimension, int components)
      : dimension_(dimension), components_(components), comm_(rcp(new Teuchos::MpiComm<int>(MPI_COMM_SELF))) {
  }

  /// A body that is one subdomain. \param unknowns  of each row of the matrix \param places  of each node
  void add(int body, const Row<GlobalOrdinal>& unknowns, const CompressedRows& stiffness,
           const Row<double>& places, GlobalOrdinal firstNode, const std::map<GlobalOrdinal, double>& held) {
    const Eigen::MatrixXd table = tableOf(places);
    std::vector<decomposition::SubdomainMatrix> only(1);
    decomposition::SubdomainMatrix& matrix = only[0];
    matrix.body = body;
    matrix.unknowns.assign(unknowns.data(), unknowns.data() + unknowns.size());
    const auto& [starts, columns, values] = stiffness;
    matrix.stiffness = Eigen::Map<const decomposition::SparseMatrix>( // symmetric: its rows are its columns
        unknowns.size(), unknowns.size(), columns.size(), starts.data(), columns.data(), values.data());
    matrix.load = Eigen::VectorXd::Zero(unknowns.size());
    matrix.coordinates.resize(unknowns.size(), table.cols());
    for (py::ssize_t i = 0; i < unknowns.size(); ++i)
      matrix.coordinates.row(i) = table.row(unknowns.data()[i] / components_ - firstNode);
    take(std::move(only), held);
  }

  /// A body of element matrices. \param unknowns  m × e \param stiffness  m × e × e \param parts  m
  void addElements(int body, const Row<GlobalOrdinal>& unknowns, const Row<double>& stiffness,
                   const Row<int>& parts, const Row<double>& places, GlobalOrdinal firstNode,
                   const std::map<GlobalOrdinal, double>& held) {
    const Eigen::MatrixXd table = tableOf(places);
    const py::ssize_t perElement = unknowns.shape(1);
    const Eigen::VectorXd noLoad = Eigen::VectorXd::Zero(perElement);
    Eigen::MatrixXd coordinates(perElement, table.cols());
    decomposition::ElementMatrices elements(static_cast<int>(table.cols()));
    for (py::ssize_t element = 0; element < unknowns.shape(0); ++element) {
      const std::span<const GlobalOrdinal> own(unknowns.data(element, 0), perElement);
      for (py::ssize_t i = 0; i < perElement; ++i)
        coordinates.row(i) = table.row(own[i] / components_ - firstNode);
      const Eigen::MatrixXd matrix =
          Eigen::Map<const Eigen::MatrixXd>(stiffness.data(element, 0, 0), perElement, perElement);
      elements.add(parts.data()[element], {own, coordinates, matrix, noLoad}, body);
    }
    take(elements.take(), held);
  }

  /// \param names  of the bodies
  void begin(std::vector<std::string> names, const std::string& parameters) {
    solver_ = std::make_unique<ContactSolver>(scene::parseParameters(parameters, "parameters"));
    problem_.emplace(comm_, dimension_, components_, std::move(names));
    for (std::vector<decomposition::SubdomainMatrix>& body : matrices_)
      for (decomposition::SubdomainMatrix& matrix : body)
        problem_->add(std::move(matrix));
    matrices_.clear();
  }

  /// B and c of contact, or of ties.
  void setRows(bool areTied, const CompressedRows& rows, const Row<double>& gaps, int numUnknowns) {
    decomposition::ConstraintMatrix given{matrixOf(rows, numUnknowns, comm_), Teuchos::null};
    given.gap = vectorOf(gaps, given.rows->getRowMap(), "the gaps");
    if (areTied)
      problem_->setTies(given);
    else
      problem_->setContact(contact_ = given);
  }

  /// \param tangents      T and s; nothing: along the tangents of each row of contact
  /// \param nodes         of each node with friction its row of contact; without tangents all rows
  /// \param coefficients, bounds  of each node
  void setFriction(const std::optional<std::pair<CompressedRows, Row<double>>>& tangents,
                   const std::vector<GlobalOrdinal>& nodes, const std::vector<double>& coefficients,
                   const std::vector<double>& bounds, int numUnknowns) {
    coefficients_ = coefficients;
    bounds_ = bounds;
    if (!tangents) {
      problem_->setFriction(decomposition::frictionAlong(contact_, components_));
      return;
    }
    const RCP<const CrsMatrix> rows = matrixOf(tangents->first, numUnknowns, comm_);
    problem_->setFriction({{rows, vectorOf(tangents->second, rows->getRowMap(), "the slips")}, nodes});
  }

  void complete() {
    const double began = Teuchos::Time::wallTime();
    problem_->complete();
    seconds_ = Teuchos::Time::wallTime() - began;
    std::vector<bool> isTaken; // the first subdomain has the load of an unknown
    for (const std::vector<GlobalOrdinal>& own : unknowns_)
      for (const GlobalOrdinal unknown : own) {
        isTaken.resize(std::max<std::size_t>(isTaken.size(), unknown + 1));
        hasLoad_.push_back(!isTaken[unknown]);
        isTaken[unknown] = true;
      }
  }

  /// \param loads  of all unknowns  \param gaps  of all rows of contact, friction and ties
  py::dict solve(const Row<double>& loads, const Row<double>& gaps, const py::object& progress);

private:
  void take(std::vector<decomposition::SubdomainMatrix> body, const std::map<GlobalOrdinal, double>& held) {
    for (decomposition::SubdomainMatrix& matrix : body) {
      for (const GlobalOrdinal unknown : matrix.unknowns)
        if (const auto found = held.find(unknown); found != held.end())
          matrix.prescribed.emplace_back(unknown, found->second);
      unknowns_.push_back(matrix.unknowns);
    }
    matrices_.push_back(std::move(body));
  }
  void setLoads(const Row<double>& loads) {
    std::size_t place = 0;
    for (std::size_t s = 0; s < unknowns_.size(); ++s) {
      Eigen::VectorXd load = Eigen::VectorXd::Zero(std::ssize(unknowns_[s]));
      for (std::size_t i = 0; i < unknowns_[s].size(); ++i, ++place)
        if (hasLoad_[place])
          load[static_cast<Eigen::Index>(i)] = loads.data()[unknowns_[s][i]];
      problem_->setLoad(s, load);
    }
  }
  /// \param values  u
  py::dict resultOf(const fetidp::ContactSolution& solution, const Vector& values,
                    py::ssize_t numUnknowns) const {
    std::vector<double> u(numUnknowns, 0.0);
    const auto data = values.getData();
    for (Teuchos::Ordinal i = 0; i < data.size(); ++i)
      u[values.getMap()->getGlobalElement(static_cast<LocalOrdinal>(i))] = data[i];
    const auto multipliers = solution.multiplier->getData();
    const auto forcesOf = [&](GlobalOrdinal first, GlobalOrdinal count) {
      std::vector<double> forces;
      for (GlobalOrdinal row = first; row < first + count; ++row)
        forces.push_back(multipliers[solution.multiplier->getMap()->getLocalElement(row)]);
      return arrayOf(std::move(forces));
    };
    const decomposition::DecomposedProblem& all = problem_->problem();
    const SolveFacts facts = solver_->facts();
    using namespace py::literals;
    return py::dict("u"_a = arrayOf(std::move(u)), "forces"_a = forcesOf(0, all.numInequalities),
                    "tangential"_a = forcesOf(all.numInequalities, all.numFriction),
                    "tie_forces"_a = forcesOf(all.firstTie(), all.numTies), "energy"_a = solution.energy,
                    "status"_a = toString(facts.status), "reason"_a = facts.statusReason,
                    "products"_a = facts.counts.hessianMultiplications, "setup_seconds"_a = facts.times.setup,
                    "seconds"_a = seconds_, "subdomains"_a = facts.numSubdomains,
                    "feasibility"_a = solution.feasibility, "complementarity"_a = solution.complementarity,
                    "projected_gradient"_a = solution.relativeProjectedGradient);
  }

  int dimension_, components_;
  RCP<const Comm> comm_;
  std::vector<std::vector<decomposition::SubdomainMatrix>> matrices_; ///< of each body, before `begin`
  std::optional<decomposition::UnassembledProblem> problem_;
  std::vector<std::vector<GlobalOrdinal>> unknowns_; ///< of each subdomain
  std::vector<bool> hasLoad_;                        ///< of their unknowns, one subdomain after the other
  decomposition::ConstraintMatrix contact_;
  std::vector<double> coefficients_, bounds_; ///< of nodes with friction
  std::unique_ptr<ContactSolver> solver_;
  RCP<Vector> last_;   ///< multipliers of the last solution
  double seconds_ = 0; ///< of the library in the last call
};

py::dict Problem::solve(const Row<double>& loads, const Row<double>& gaps, const py::object& progress) {
  Watch watch(comm_, progress);
  fetidp::ContactSolution solution;
  RCP<Vector> values;
  {
    const py::gil_scoped_release noLock;
    const double began = Teuchos::Time::wallTime();
    setLoads(loads);
    decomposition::ProblemData data = problem_->data();
    data.setGaps(*vectorOf(gaps, rcp(new Map(gaps.size(), 0, comm_)), "the gaps"));
    if (!coefficients_.empty()) {
      data.setFrictionCoefficients(problem_->problem(), coefficients_);
      data.setFrictionBounds(problem_->problem(), bounds_);
    }
    if (last_.is_null())
      solver_->setup(problem_->problem(), data);
    solution = solver_->solve(data, last_.get(), &watch);
    values = problem_->unknowns(solution.displacement);
    seconds_ = (last_.is_null() ? seconds_ : 0) + Teuchos::Time::wallTime() - began;
  }
  if (solver_->report().status == qp::Status::interrupted)
    watch.raise();
  last_ = solution.multiplier;
  return resultOf(solution, *values, loads.size());
}

/// Cuts elements into parts that hang together. \param nodes  m × k
py::array_t<int> partsOf(const Row<idx_t>& nodes, idx_t numNodes, idx_t numParts, idx_t common) {
  idx_t count = static_cast<idx_t>(nodes.shape(0)), zero = 0, one = 1, cut = 0, *starts = nullptr,
        *others = nullptr;
  std::vector<idx_t> first(count + 1), copy(nodes.data(), nodes.data() + nodes.size());
  for (idx_t k = 0; k <= count; ++k)
    first[k] = k * static_cast<idx_t>(nodes.shape(1));
  std::vector<int> parts(count, 0);
  if (METIS_MeshToDual(&count, &numNodes, first.data(), copy.data(), &common, &zero, &starts, &others) !=
      METIS_OK)
    throw InputError("METIS does not take these elements");
  std::array<idx_t, METIS_NOPTIONS> options{};
  METIS_SetDefaultOptions(options.data());
  options[METIS_OPTION_CONTIG] = 1;
  const int status =
      numParts < 2 ? METIS_OK
                   : METIS_PartGraphKway(&count, &one, starts, others, nullptr, nullptr, nullptr, &numParts,
                                         nullptr, nullptr, options.data(), &cut, parts.data());
  METIS_Free(starts);
  METIS_Free(others);
  if (status != METIS_OK)
    throw InputError("METIS cannot cut these elements into " + std::to_string(numParts) +
                     " parts that hang together");
  return arrayOf(std::move(parts));
}

} // namespace

void defineMatrices(py::module_& module) {
  py::class_<Problem>(module, "Problem")
      .def(py::init<int, int>())
      .def("begin", &Problem::begin)
      .def("add", &Problem::add)
      .def("add_elements", &Problem::addElements)
      .def("set_rows", &Problem::setRows)
      .def("set_friction", &Problem::setFriction)
      .def("complete", &Problem::complete)
      .def("solve", &Problem::solve);
  module.def("parts_of", &partsOf);
  module.def("solver_schema", [] { return schemaOf(ContactSolver::validParameters()); });
}

} // namespace epafi::python
