#include "epafi/output/HistoryTable.hpp"

#include "epafi/base/ParameterValue.hpp"
#include "epafi/output/AtomicFile.hpp"

namespace epafi::output {
std::string historyTable(const qp::History& history) {
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

void writeHistory(const qp::History& history, const std::filesystem::path& file, const Comm& comm) {
  writeTextFile(
      file, [&] { return historyTable(history); }, comm);
}

} // namespace epafi::output
