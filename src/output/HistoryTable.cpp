#include "epafi/output/HistoryTable.hpp"

#include "epafi/output/AtomicFile.hpp"

#include <array>
#include <charconv>

namespace epafi::output {
namespace {

/// Shortest decimal form that reads back as the same number, whatever the locale.
std::string exact(double value) {
  std::array<char, 32> text{};
  const auto result = std::to_chars(text.data(), text.data() + text.size(), value);
  return {text.data(), result.ptr};
}

} // namespace

std::string historyTable(const qp::History& history) {
  std::string table = "iteration,outer,step,projected_gradient,constraint_residual,objective,active_bounds,"
                      "hessian_multiplications\n";
  for (const qp::StepRecord& record : history) {
    table += std::to_string(record.iteration) + ',' + std::to_string(record.outer) + ',' +
             static_cast<char>(record.kind) + ',' + exact(record.projectedGradient) + ',' +
             exact(record.constraintResidual) + ',' + exact(record.objective) + ',' +
             std::to_string(record.activeBounds) + ',' + std::to_string(record.hessianMultiplications) + '\n';
  }
  return table;
}

void writeHistory(const qp::History& history, const std::filesystem::path& file, const Comm& comm) {
  writeTextFile(
      file, [&] { return historyTable(history); }, comm);
}

} // namespace epafi::output
