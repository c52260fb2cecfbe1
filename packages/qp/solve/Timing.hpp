#pragma once

/// Times a scope with a Teuchos timer, as TimeMonitor does, but without its allocations.

#include <Teuchos_Time.hpp>

namespace epafi::qp {

class Timing {
public:
  explicit Timing(Teuchos::Time& timer) : timer_(timer), wasRunning_(timer.isRunning()) {
    if (!wasRunning_)
      timer_.start();
  }
  Timing(const Timing&) = delete;
  Timing& operator=(const Timing&) = delete;
  ~Timing() {
    if (wasRunning_)
      return;
    timer_.stop();
    timer_.incrementNumCalls();
  }

private:
  Teuchos::Time& timer_;
  bool wasRunning_; ///< a solve inside a solve
};

} // namespace epafi::qp
