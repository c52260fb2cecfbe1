#pragma once

/// The history of an iteration as a CSV table: a header, then a line a step.

#include "epafi/qp/SolveReport.hpp"

#include <ostream>

namespace epafi::qp {

/// Writes every step as it happens. Give a stream on one rank only; a null stream writes nothing.
class CsvHistory final : public Observer {
public:
  /// \param stream  kept; null on the ranks that shall not write
  explicit CsvHistory(std::ostream* stream);
  void step(const StepRecord& record) override;

private:
  std::ostream* stream_;
};

} // namespace epafi::qp
