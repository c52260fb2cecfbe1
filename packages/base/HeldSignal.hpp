#pragma once

/// A signal kept waiting.

#include <csignal>
#include <pthread.h>

namespace epafi {

/// While it lives, a signal does not reach the thread that made it, nor threads that this thread starts,
/// which never take it afterwards either. One that is sent to the process meanwhile arrives at the end, if
/// all other threads were started so. Not collective.
class HeldSignal {
public:
  explicit HeldSignal(int signal) {
    sigset_t held;
    sigemptyset(&held);
    sigaddset(&held, signal);
    pthread_sigmask(SIG_BLOCK, &held, &before_);
  }
  ~HeldSignal() { pthread_sigmask(SIG_SETMASK, &before_, nullptr); }
  HeldSignal(const HeldSignal&) = delete;
  HeldSignal& operator=(const HeldSignal&) = delete;

private:
  sigset_t before_{};
};

} // namespace epafi
