#pragma once

/// Notices that an iteration gets nowhere any more: neither has the objective fallen by more than its
/// round-off, nor the projected gradient below nine tenths of its best, for a number of steps in a row.

#include <cmath>
#include <limits>

namespace epafi::qp {

class ProgressWatch {
public:
  explicit ProgressWatch(int patience) : patience_(patience) {}

  void restart() { *this = ProgressWatch(patience_); }
  /// After a step.
  void look(double projectedGradient, double objective) {
    const bool gradientFell = projectedGradient < 0.9 * bestGradient_;
    const bool objectiveFell = objective < bestObjective_ - 1e-14 * std::abs(objective);
    if (gradientFell)
      bestGradient_ = projectedGradient;
    if (objectiveFell)
      bestObjective_ = objective;
    idleSteps_ = gradientFell || objectiveFell ? 0 : idleSteps_ + 1;
  }
  [[nodiscard]] bool standsStill() const { return idleSteps_ >= patience_; }
  /// Waits for as many steps again.
  void forgive() { idleSteps_ = 0; }

private:
  int patience_;
  int idleSteps_ = 0;
  double bestGradient_ = std::numeric_limits<double>::infinity();
  double bestObjective_ = std::numeric_limits<double>::infinity();
};

} // namespace epafi::qp
