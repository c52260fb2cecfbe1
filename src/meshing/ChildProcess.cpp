#include "epafi/meshing/ChildProcess.hpp"

#include "epafi/base/Errors.hpp"

#include <sys/prctl.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <csignal>
#include <cstdlib>
#include <cstring>
#include <ctime>
#include <exception>
#include <fcntl.h>
#include <poll.h>

namespace epafi::meshing {
namespace {

// What the copy says first when it is done; then the error's text.
constexpr char done = 'd', wrongInput = 'i', failed = 'f';

[[noreturn]] void leave() noexcept {
  ::_exit(EXIT_FAILURE); // no function that this process has registered for its own end is called
}

void say(int pipe, char what, const std::string& text) {
  const std::string message = what + text.substr(0, 4000); // a pipe holds it, read or not
  if (::write(pipe, message.data(), message.size()) < 0)
    leave();
}

[[noreturn]] void workAndLeave(const std::function<void()>& work, int pipe, pid_t parent) {
  ::prctl(PR_SET_PDEATHSIG, SIGKILL);
  if (::getppid() != parent)
    leave();
  for (const int signal : {SIGSEGV, SIGBUS, SIGABRT, SIGFPE, SIGILL}) // no stack traces of message passing
    std::signal(signal, SIG_DFL);
  const rlimit none{0, 0};
  ::setrlimit(RLIMIT_CORE, &none);
  std::set_terminate(leave);
  std::atexit(leave); // called first
  try {
    work();
    say(pipe, done, "");
  } catch (const InputError& error) {
    say(pipe, wrongInput, error.what());
  } catch (const std::exception& error) {
    say(pipe, failed, error.what());
  }
  leave();
}

/// Seconds on the processor; −1 if nobody knows.
double processorTimeOf(pid_t process) {
  clockid_t clock = 0;
  timespec time{};
  if (::clock_getcpuclockid(process, &clock) != 0 || ::clock_gettime(clock, &time) != 0)
    return -1;
  return static_cast<double>(time.tv_sec) + 1e-9 * static_cast<double>(time.tv_nsec);
}

/// Ends a process that waits for itself: one that uses no processor for a while.
class StallWatch {
public:
  /// \param patience  seconds
  StallWatch(pid_t process, int patience)
      : process_(process), patience_(patience), used_(processorTimeOf(process)) {}
  /// To be asked every second.
  void look() {
    constexpr double nothing = 0.001; // seconds on the processor
    const double used = processorTimeOf(process_);
    idle_ = used - used_ < nothing ? idle_ + 1 : 0;
    used_ = used;
    if (idle_ == patience_)
      ::kill(process_, SIGKILL);
    hasStalled_ = hasStalled_ || idle_ >= patience_;
  }
  [[nodiscard]] bool hasStalled() const { return hasStalled_; }

private:
  pid_t process_;
  int patience_;
  double used_;
  int idle_ = 0;
  bool hasStalled_ = false;
};

std::string readAll(int pipe, StallWatch& watch) {
  constexpr int second = 1000; // milliseconds
  std::string text;
  std::array<char, 4096> part{};
  for (;;) {
    pollfd waiting{pipe, POLLIN, 0};
    if (::poll(&waiting, 1, second) == 0) {
      watch.look();
      continue;
    }
    const ssize_t size = ::read(pipe, part.data(), part.size());
    if (size > 0)
      text.append(part.data(), size);
    else if (size == 0 || errno != EINTR)
      return text;
  }
}

/// "by signal 11 (Segmentation fault)"
std::string endOf(pid_t child) {
  int status = 0;
  pid_t ended = 0;
  do
    ended = ::waitpid(child, &status, 0);
  while (ended < 0 && errno == EINTR);
  if (ended != child || !WIFSIGNALED(status))
    return "of its own accord";
  const int signal = WTERMSIG(status);
  return "by signal " + std::to_string(signal) + " (" + ::strsignal(signal) + ')';
}

} // namespace

void inChildProcess(const std::function<void()>& work, const std::string& name, const std::string& remedy,
                    int patience) {
  std::array<int, 2> pipe{};
  if (::pipe2(pipe.data(), O_CLOEXEC) != 0)
    throw Error(name + " cannot begin: " + std::strerror(errno) + "; close files or end other programs");
  const pid_t parent = ::getpid(), child = ::fork();
  if (child == 0)
    workAndLeave(work, pipe[1], parent);
  const int reason = errno;
  ::close(pipe[1]);
  StallWatch watch(child > 0 ? child : parent, patience);
  const std::string message = child > 0 ? readAll(pipe[0], watch) : "";
  ::close(pipe[0]);
  if (child < 0)
    throw Error(name + " cannot begin: " + std::strerror(reason) + "; free memory or end other programs");
  const std::string end = endOf(child); // it is waited for, whatever has become of it
  if (watch.hasStalled())
    throw InputError(name + " waited for itself, " + std::to_string(patience) +
                     " seconds long, and was stopped; " + remedy);
  if (message.empty())
    throw InputError(name + " ended " + end + "; " + remedy);
  if (message.front() == wrongInput)
    throw InputError(message.substr(1));
  if (message.front() == failed)
    throw Error(message.substr(1));
}

} // namespace epafi::meshing
