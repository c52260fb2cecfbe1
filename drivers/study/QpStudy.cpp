#include "QpStudy.hpp"

#include "QpCase.hpp"
#include "QpTraffic.hpp"

#include "epafi/output/AtomicFile.hpp"

#include <Teuchos_Comm.hpp>

#include <algorithm>
#include <iomanip>
#include <iostream>
#include <sstream>
#include <string>
#include <utility>
#include <vector>

namespace epafi::drivers {
namespace {

/// How far a size goes into what has lost on smaller ones already and takes minutes on large ones.
enum class Depth { all, plainExpansions, baseline };

/// Which expansion and which release, without a preconditioner and with one.
void addMethods(const QpCase& base, Depth depth, std::vector<QpCase>& rows) {
  for (const auto preconditioning : {Preconditioning::none, Preconditioning::multigrid}) {
    const bool isPlain = preconditioning == Preconditioning::none;
    const bool hasAll = depth == Depth::all || (depth == Depth::plainExpansions && isPlain);
    const auto add = [&](const char* expansion, const char* release) {
      QpCase row = base;
      row.preconditioning = preconditioning;
      row.expansion = expansion;
      row.release = release;
      rows.push_back(row);
    };
    add("projected CG", "projected gradient");
    add("projected CG", "chopped gradient");
    if (hasAll)
      for (const char* expansion : {"fixed step", "optimal", "Barzilai-Borwein"})
        add(expansion, "projected gradient");
    if (hasAll || isPlain)
      add("fixed step", "chopped gradient"); // as published
  }
}

/// Which start, with which preconditioner; the start from zero is among the methods.
void addStarts(const QpCase& base, std::vector<QpCase>& rows) {
  for (const auto start : {Start::unconstrained, Start::nested})
    for (const auto preconditioning :
         {Preconditioning::none, Preconditioning::multigrid, Preconditioning::faceMultigrid}) {
      QpCase row = base;
      row.start = start;
      row.preconditioning = preconditioning;
      rows.push_back(row);
    }
}

/// Γ and ᾱ, for the default expansion and for the one that takes ᾱ as its length.
void addScan(const QpCase& base, std::vector<QpCase>& rows) {
  for (const char* expansion : {"projected CG", "fixed step"})
    for (const double constant : {0.5, 1.0, 2.0})
      for (const double step : {1.5, 1.9, 1.95}) {
        QpCase row = base;
        row.expansion = expansion;
        row.proportioningConstant = constant;
        row.expansionStep = step;
        if (constant != base.proportioningConstant || step != base.expansionStep) // that row is there already
          rows.push_back(row);
      }
}

std::vector<QpCase> allRows(bool quick) {
  const std::vector<std::pair<int, Depth>> sizes =
      quick ? std::vector<std::pair<int, Depth>>{{50, Depth::all}, {100, Depth::baseline}}
            : std::vector<std::pair<int, Depth>>{
                  {100, Depth::all}, {200, Depth::plainExpansions}, {400, Depth::baseline}};
  std::vector<QpCase> rows;
  for (const char* problem : {"journal_bearing", "obstacle", "torsion"})
    for (const auto& [size, depth] : sizes) {
      QpCase base;
      base.problem = problem;
      base.size = size;
      addMethods(base, depth, rows);
      addStarts(base, rows);
      if (base.problem == "journal_bearing" && depth != Depth::baseline)
        addScan(base, rows);
    }
  return rows;
}

/// Products of PERMON 3.18's plain MPGP on the journal bearing, tolerance 1e-6; 0 where none are known.
int permonMultiplications(const QpCase& row) {
  const bool isPublished = methodName(row) == "published" && row.preconditioning == Preconditioning::none;
  if (row.problem != "journal_bearing" || !isPublished)
    return 0;
  return row.size == 100 ? 444 : row.size == 200 ? 1393 : row.size == 400 ? 3962 : 0;
}

constexpr const char* csvHeader =
    "problem,size,method,preconditioner,start,hessian_multiplications,cg_steps,expansion_steps,"
    "proportioning_steps,seconds,relative_projected_gradient,status,preconditioner_applications,safeguards,"
    "norm_multiplications,start_multiplications,start_seconds,proportioning_constant,expansion_step,"
    "permon_multiplications\n";

std::string csvRow(const QpCase& row, const QpResult& result) {
  const qp::StepCounts& counts = result.report.counts;
  const int permon = permonMultiplications(row);
  std::ostringstream text;
  text << row.problem << ',' << row.size << ',' << methodName(row) << ',' << toString(row.preconditioning)
       << ',' << toString(row.start) << ',' << counts.hessianMultiplications << ','
       << counts.conjugateGradient << ',' << counts.expansion << ',' << counts.proportioning << ','
       << result.seconds << ',' << result.report.relativeProjectedGradient << ','
       << qp::toString(result.report.status) << ',' << counts.preconditionerApplications << ','
       << counts.safeguards << ',' << result.normMultiplications << ',' << result.startMultiplications << ','
       << result.startSeconds << ',' << row.proportioningConstant << ',' << row.expansionStep << ','
       << (permon > 0 ? std::to_string(permon) : "") << '\n';
  return text.str();
}

constexpr const char* markdownHeader =
    "| problem | size | method | preconditioner | start | Γ | ᾱ‖A‖ | products | CG | expansions | "
    "proportionings | V-cycles | products of the start | seconds | status |\n"
    "| --- | --- | --- | --- | --- | --- | --- | --- | --- | --- | --- | --- | --- | --- | --- |\n";

std::string markdownRow(const QpCase& row, const QpResult& result) {
  const qp::StepCounts& counts = result.report.counts;
  std::ostringstream text;
  text << "| " << row.problem << " | " << row.size << "² | " << methodName(row) << " | "
       << toString(row.preconditioning) << " | " << toString(row.start) << " | " << row.proportioningConstant
       << " | " << row.expansionStep << " | " << counts.hessianMultiplications << " | "
       << counts.conjugateGradient << " | " << counts.expansion << " | " << counts.proportioning << " | "
       << counts.preconditionerApplications << " | " << std::setprecision(3) << result.startMultiplications
       << " | " << result.seconds << " | " << qp::toString(result.report.status) << " |\n";
  return text.str();
}

} // namespace

bool studyQp(const std::filesystem::path& directory, bool quick, const RCP<const Comm>& comm) {
  std::string csv = csvHeader, markdown = markdownHeader;
  bool defaultsConverged = true;
  const bool speaks = comm->getRank() == 0;
  if (speaks)
    std::cout << markdownHeader;
  for (const QpCase& row : allRows(quick)) {
    const QpResult result = solveCase(row, comm);
    csv += csvRow(row, result);
    markdown += markdownRow(row, result);
    if (speaks)
      std::cout << markdownRow(row, result) << std::flush;
    if (methodName(row) == "projected_cg")
      defaultsConverged = defaultsConverged && result.report.status == qp::Status::converged;
  }
  std::string traffic = measureTraffic(quick, comm);
  output::writeTextFile(
      directory / "qp.csv", [&] { return csv; }, *comm);
  output::writeTextFile(
      directory / "qp.md", [&] { return markdown; }, *comm);
  output::writeTextFile(
      directory / "qp_traffic.csv", [&] { return traffic; }, *comm);
  if (speaks)
    std::cout << '\n'
              << traffic << "written: " << (directory / "qp.csv").string() << ", "
              << (directory / "qp.md").string() << " and " << (directory / "qp_traffic.csv").string() << '\n';
  return defaultsConverged;
}

} // namespace epafi::drivers
