#pragma once

/// The history of an iteration as a CSV table: a header, then a line a step.

#include "epafi/qp/solve/SolveReport.hpp"

#include <iomanip>
#include <ostream>

namespace epafi::qp {

/// Writes every step as it happens. Give a stream on one rank only; a null stream writes nothing.
class CsvHistory final : public Observer {
public:
  /// \param stream  kept; null on the ranks that shall not write
  explicit CsvHistory(std::ostream* stream) : stream_(stream) {
    if (stream_ != nullptr)
      *stream_ << "iteration,outer,step,projected_gradient,constraint_residual,objective,active_bounds,"
                  "hessian_multiplications\n"
               << std::setprecision(16);
  }

  void step(const StepRecord& record) override {
    if (stream_ != nullptr)
      *stream_ << record.iteration << ',' << record.outer << ',' << static_cast<char>(record.kind) << ','
               << record.projectedGradient << ',' << record.constraintResidual << ',' << record.objective
               << ',' << record.activeBounds << ',' << record.hessianMultiplications << '\n';
  }

private:
  std::ostream* stream_;
};

} // namespace epafi::qp
