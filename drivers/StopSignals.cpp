#include "StopSignals.hpp"

#include <array>
#include <csignal>
#include <ctime>

namespace epafi::drivers {
namespace {

volatile std::sig_atomic_t received = 0;
// Of the first signal. Written by the handler before `received` only.
timespec when{};

/// What comes so soon after the first signal is the same wish: mpirun, a batch system and the terminal may
/// all pass it on.
constexpr double sameWish = 0.2;

void remember(int signal) {
  timespec now{};
  clock_gettime(CLOCK_MONOTONIC, &now);
  if (received == 0) {
    when = now;
    received = signal;
    return;
  }
  const double since =
      static_cast<double>(now.tv_sec - when.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec - when.tv_nsec);
  if (since < sameWish)
    return;
  std::signal(signal, SIG_DFL);
  std::raise(signal); // delivered as soon as the handler has returned
}

constexpr std::array stopping{SIGINT, SIGTERM, SIGHUP, SIGUSR1};

} // namespace

void listenToStopSignals() {
  struct sigaction action {};
  action.sa_handler = remember;
  action.sa_flags = SA_RESTART; // reads and writes under way go on
  sigemptyset(&action.sa_mask);
  for (const int signal : stopping)
    sigaddset(&action.sa_mask, signal);
  for (const int signal : stopping) {
    struct sigaction before {};
    sigaction(signal, nullptr, &before);
    if (before.sa_handler != SIG_IGN)
      sigaction(signal, &action, nullptr);
  }
  std::signal(SIGPIPE, SIG_IGN);
  std::signal(SIGXFSZ, SIG_IGN);
}

std::string stopSignal() {
  switch (received) {
  case 0:
    return "";
  case SIGINT:
    return "SIGINT";
  case SIGTERM:
    return "SIGTERM";
  case SIGHUP:
    return "SIGHUP";
  default:
    return "SIGUSR1";
  }
}

} // namespace epafi::drivers
