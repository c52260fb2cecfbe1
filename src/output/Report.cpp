#include "epafi/output/Report.hpp"

#include "epafi/base/ParameterValue.hpp"
#include "epafi/output/AtomicFile.hpp"

#include <Teuchos_XMLParameterListHelpers.hpp>

#include <sstream>
#include <string>

namespace epafi::output {
namespace {

std::string tableOf(const qp::History& history) {
  std::string table = "iteration,outer,step,projected_gradient,constraint_residual,objective,active_bounds,"
                      "hessian_multiplications\n";
  for (const qp::StepRecord& record : history) {
    table += std::to_string(record.iteration) + ',' + std::to_string(record.outer) + ',' +
             static_cast<char>(record.kind) + ',' + valueText(record.projectedGradient) + ',' +
             valueText(record.constraintResidual) + ',' + valueText(record.objective) + ',' +
             std::to_string(record.activeBounds) + ',' + std::to_string(record.hessianMultiplications) + '\n';
  }
  return table;
}

std::string xmlOf(const Teuchos::ParameterList& report) {
  std::ostringstream text;
  Teuchos::writeParameterListToXmlOStream(report, text);
  return text.str();
}

} // namespace

void writeReport(const Teuchos::ParameterList& report, const std::filesystem::path& file, const Comm& comm) {
  writeTextFile(
      file, [&] { return xmlOf(report); }, comm);
}

void writeReport(const Teuchos::ParameterList& report, const std::filesystem::path& file, FileSet& together) {
  together.write(file, [&] { return xmlOf(report); });
}

void writeHistory(const qp::History& history, const std::filesystem::path& file, const Comm& comm) {
  writeTextFile(
      file, [&] { return tableOf(history); }, comm);
}

void writeHistory(const qp::History& history, const std::filesystem::path& file, FileSet& together) {
  together.write(file, [&] { return tableOf(history); });
}

} // namespace epafi::output
