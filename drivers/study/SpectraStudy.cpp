#include "CaseTable.hpp"
#include "Studies.hpp"
#include "Table.hpp"
#include "epafi/simulation/SceneRun.hpp"

#include "epafi/base/Compatibility.hpp"
#include "epafi/base/SymmetricOperator.hpp"
#include "epafi/qp/operators/SpectrumEstimate.hpp"
#include "epafi/scene/SceneReader.hpp"

#include <Tpetra_MultiVector.hpp>

#include <functional>
#include <utility>
#include <vector>

namespace epafi::drivers {
namespace {

using decomposition::RowKind;

/// E A E, E the rows of one kind: what a face is made of whose other rows are held.
class PartOfOperator final : public SymmetricOperator {
public:
  /// \param isIn  of each of this rank's rows
  PartOfOperator(RCP<const Operator> a, std::vector<char> isIn)
      : SymmetricOperator(a->getDomainMap()), a_(std::move(a)), isIn_(std::move(isIn)) {}

private:
  void multiply(const MultiVector& x, MultiVector& y) const override {
    MultiVector part(x, Teuchos::Copy);
    clearOthers(part);
    a_->apply(part, y);
    clearOthers(y);
  }
  void clearOthers(MultiVector& x) const {
    for (std::size_t j = 0; j < x.getNumVectors(); ++j) {
      const auto values = x.getDataNonConst(j);
      for (std::size_t i = 0; i < isIn_.size(); ++i)
        if (isIn_[i] == 0)
          values[static_cast<Teuchos_Ordinal>(i)] = 0;
    }
  }

  RCP<const Operator> a_;
  std::vector<char> isIn_;
};

struct Part {
  const char* name;
  std::function<bool(RowKind)> has;
};
const std::vector<Part> parts{{"all", [](RowKind) { return true; }},
                              {"gluing", [](RowKind kind) { return kind == RowKind::gluing; }},
                              {"contact", [](RowKind kind) { return kind == RowKind::contact; }}};

RCP<const Operator> partOf(const RCP<const Operator>& a, const decomposition::DecomposedProblem& problem,
                           const Part& part) {
  if (a.is_null())
    return a;
  std::vector<char> isIn;
  for (LocalOrdinal row = 0; row < static_cast<LocalOrdinal>(numLocal(*a->getDomainMap())); ++row)
    isIn.push_back(part.has(problem.kindOf(decomposition::OwnedMultiplier{row})) ? 1 : 0);
  return rcp(new PartOfOperator(a, std::move(isIn)));
}

/// One row for the whole Hessian and, of whole bodies, for the parts of it that gluing and contact make.
/// Where bodies are cut into clusters, P mixes them.
std::vector<Row> measure(const Case& which, const char* preconditioner, const RCP<const Comm>& comm) {
  Teuchos::ParameterList parameters;
  parameters.sublist("Preconditioner").set("Type", preconditioner);
  parameters.set("Algorithm", "MPRGP");
  const scene::Scene scene = scene::readScene(which.scene(), which.name);
  const simulation::SceneRun run = simulation::solveScene(scene, parameters, comm);
  const fetidp::DualProblem& dual = run.solver->dualProblem();
  const int cluster = std::max(0, scene.bodies.front().decomposition.cluster);
  std::vector<Row> rows;
  for (const Part& part : parts) {
    if (cluster > 0 && !rows.empty())
      break;
    const qp::SpectrumEstimate spectrum =
        qp::estimateSpectrum(*partOf(dual.hessian(), dual.problem(), part),
                             partOf(dual.preconditioner(), dual.problem(), part), {.maxIterations = 2000});
    rows.push_back({{"problem", which.name},
                    {"cluster", cluster},
                    {"series", which.parameter},
                    {"value", which.value},
                    {"part", part.name},
                    {"preconditioner", preconditioner},
                    {"smallest_eigenvalue", spectrum.smallest},
                    {"largest_eigenvalue", spectrum.largest},
                    {"condition", spectrum.condition()},
                    {"accurate", spectrum.smallestIsAccurate(0.02) && spectrum.largestIsAccurate(0.02)},
                    {"hessian_multiplications", run.solver->report().counts.hessianMultiplications},
                    {"cg_iterations", run.solver->report().counts.conjugateGradient},
                    {"outer_iterations", run.solver->report().counts.outer},
                    {"converged", run.solver->report().status == qp::Status::converged}});
  }
  return rows;
}

std::string methodOf(const Row& row) {
  const auto cluster = static_cast<int>(row.number("cluster"));
  return cluster == 0 ? "FETI-DP" : cluster == 1 ? "FETI" : "hybrid, clusters of " + std::to_string(cluster);
}

/// A line a case: eigenvalues plain and preconditioned of each part, and products.
std::string reportOf(const Table& table) {
  std::string text =
      markdownHeading("problem | method | growing | part | smallest | largest | κ | products | "
                      "M: smallest | largest | κ | products");
  for (const Row& row : table.rows) {
    if (row.text("preconditioner") != "none")
      continue;
    Row like = row;
    like["preconditioner"] = "dirichlet";
    const Row* preconditioned =
        table.find(like, {"problem", "cluster", "series", "value", "part", "preconditioner"});
    std::vector<std::string> entries{row.text("problem"), methodOf(row),
                                     row.text("series") + " = " + plain(row.number("value")),
                                     row.text("part")};
    for (const Row* one : {&row, preconditioned}) {
      for (const char* column : {"smallest_eigenvalue", "largest_eigenvalue", "condition"})
        entries.push_back(inDigits(one->number(column)));
      entries.push_back(row.text("part") == "all" ? count(one->number("hessian_multiplications")) : "");
    }
    text += markdownLine(entries);
  }
  return text;
}

} // namespace

bool studySpectra(const std::filesystem::path& directory, bool quick, const RCP<const Comm>& comm) {
  Table table("problem,cluster,series,value,part,preconditioner,smallest_eigenvalue,largest_eigenvalue,"
              "condition,accurate,hessian_multiplications,cg_iterations,outer_iterations,converged");
  bool isRight = true;
  for (const Case& one : expandCases(caseText("spectra"), "spectra", quick))
    for (const char* preconditioner : {"none", "dirichlet"})
      for (const Row& row : measure(one, preconditioner, comm)) {
        table.rows.push_back(row);
        isRight = isRight && row.number("converged") == 1 && row.number("accurate") == 1;
      }
  const std::string report = reportOf(table);
  tell(*comm, report);
  writeFiles(directory, {{"spectra.csv", table.csv()}, {"spectra.md", report}}, *comm);
  return isRight;
}

} // namespace epafi::drivers
