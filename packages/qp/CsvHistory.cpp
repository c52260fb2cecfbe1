#include "epafi/qp/CsvHistory.hpp"

#include <iomanip>

namespace epafi::qp {

CsvHistory::CsvHistory(std::ostream* stream) : stream_(stream) {
  if (stream_ != nullptr)
    *stream_ << "iteration,outer,step,projected_gradient,constraint_residual,objective,active_bounds,"
                "hessian_multiplications\n"
             << std::setprecision(16);
}

void CsvHistory::step(const StepRecord& record) {
  if (stream_ != nullptr)
    *stream_ << record.iteration << ',' << record.outer << ',' << static_cast<char>(record.kind) << ','
             << record.projectedGradient << ',' << record.constraintResidual << ',' << record.objective << ','
             << record.activeBounds << ',' << record.hessianMultiplications << '\n';
}

} // namespace epafi::qp
