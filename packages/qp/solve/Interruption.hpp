#pragma once

/// Whether somebody on this rank wants an iteration to end before its time.

#include "epafi/qp/solve/SolveReport.hpp"

#include <Teuchos_Time.hpp>

namespace epafi::qp {

class Interruption {
public:
  /// \param timeLimit  seconds from now; 0 for none
  explicit Interruption(double timeLimit)
      : deadline_(timeLimit > 0 ? Teuchos::Time::wallTime() + timeLimit : 0.0) {}

  void setObserver(Observer* observer) { observer_ = observer; } ///< of the present run; may be null
  [[nodiscard]] Observer* observer() const { return observer_; } ///< the same
  [[nodiscard]] bool timeIsUp() const { return deadline_ > 0 && Teuchos::Time::wallTime() > deadline_; }
  [[nodiscard]] bool isWanted() const { return observer_ != nullptr && observer_->wantsToStop(); }
  [[nodiscard]] bool isLookWanted() const { return observer_ != nullptr && observer_->wantsToLook(); }

private:
  double deadline_;
  Observer* observer_ = nullptr;
};

} // namespace epafi::qp
