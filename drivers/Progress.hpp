#pragma once

/// Tells people that a long solve is alive: a line every few seconds, from one rank.

#include "epafi/qp/SolveReport.hpp"

#include <ostream>

namespace epafi::drivers {

class Progress final : public qp::Observer {
public:
  /// Prints to `out` once `interval` seconds have passed since the last line.
  Progress(std::ostream& out, double interval);
  void step(const qp::StepRecord& record) override;

private:
  std::ostream& out_;
  double interval_, last_;
};

} // namespace epafi::drivers
