#include "QpCase.hpp"
#include "QpTraffic.hpp"
#include "Studies.hpp"

#include <Teuchos_Comm.hpp>

#include <iostream>

namespace epafi::drivers {
namespace {

/// Products of PERMON 3.18's plain MPGP on the journal bearing, tolerance 1e-6; not known elsewhere.
Row::Value permonMultiplications(const QpCase& row) {
  if (row.problem != "journal_bearing" || methodName(row) != "fixed_step" || row.preconditioner != "none")
    return {};
  return row.size == 100   ? Row::Value(444)
         : row.size == 200 ? Row::Value(1393)
         : row.size == 400 ? Row::Value(3962)
                           : Row::Value();
}

Row measure(const QpCase& row, const RCP<const Comm>& comm) {
  const QpResult result = solveCase(row, comm);
  const qp::StepCounts& counts = result.report.counts;
  return {{"problem", row.problem},
          {"size", row.size},
          {"method", methodName(row)},
          {"preconditioner", row.preconditioner},
          {"start", row.start},
          {"hessian_multiplications", counts.hessianMultiplications},
          {"cg_steps", counts.conjugateGradient},
          {"expansion_steps", counts.expansion},
          {"proportioning_steps", counts.proportioning},
          {"seconds", result.seconds},
          {"relative_projected_gradient", result.report.relativeProjectedGradient},
          {"status", qp::toString(result.report.status)},
          {"preconditioner_applications", counts.preconditionerApplications},
          {"safeguards", counts.safeguards},
          {"norm_multiplications", result.normMultiplications},
          {"start_multiplications", result.startMultiplications},
          {"start_seconds", result.startSeconds},
          {"proportioning_constant", row.proportioningConstant},
          {"expansion_step", row.expansionStep},
          {"permon_multiplications", permonMultiplications(row)}};
}

std::string lineOf(const Row& row) {
  const auto number = [&](const char* column) { return plain(row.number(column)); };
  return markdownLine({row.text("problem"), number("size") + "²", row.text("method"),
                       row.text("preconditioner"), row.text("start"), number("proportioning_constant"),
                       number("expansion_step"), number("hessian_multiplications"), number("cg_steps"),
                       number("expansion_steps"), number("proportioning_steps"),
                       number("preconditioner_applications"), plain(row.number("start_multiplications"), 3),
                       plain(row.number("seconds"), 3), row.text("status")});
}

} // namespace

bool studyQp(const std::filesystem::path& directory, bool quick, const RCP<const Comm>& comm) {
  Table table(
      "problem,size,method,preconditioner,start,hessian_multiplications,cg_steps,expansion_steps,"
      "proportioning_steps,seconds,relative_projected_gradient,status,preconditioner_applications,safeguards,"
      "norm_multiplications,start_multiplications,start_seconds,proportioning_constant,expansion_step,"
      "permon_multiplications");
  std::string markdown = markdownHeading("problem | size | method | preconditioner | start | Γ | ᾱ‖A‖ | "
                                         "products | CG | expansions | proportionings | V-cycles "
                                         "| products of the start | seconds | status");
  bool defaultsConverged = true;
  const bool speaks = comm->getRank() == 0;
  if (speaks)
    std::cout << markdown;
  for (const QpCase& one : qpCases(quick)) {
    table.rows.push_back(measure(one, comm));
    const Row& row = table.rows.back();
    markdown += lineOf(row);
    if (speaks)
      std::cout << lineOf(row) << std::flush;
    if (row.text("method") == "projected_cg")
      defaultsConverged = defaultsConverged && row.text("status") == qp::toString(qp::Status::converged);
  }
  const std::string traffic = measureTraffic(quick, comm).csv();
  tell(*comm, '\n' + traffic);
  writeFiles(directory, {{"qp.csv", table.csv()}, {"qp.md", markdown}, {"qp_traffic.csv", traffic}}, *comm);
  return defaultsConverged;
}

} // namespace epafi::drivers
