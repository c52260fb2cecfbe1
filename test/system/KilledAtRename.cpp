// Linked with the driver's main program, this makes a driver that is killed right before a file gets its
// name: in place of the rename number n of rank r, EPAFI_TEST_KILL=r:n. With n = 0 it tells at the end how
// many there were.

#include <fcntl.h>

#include <csignal>
#include <cstdio>
#include <cstdlib>

namespace {

struct Plan {
  long number = -1; // of the rename; -1: none, 0: none, but they are counted
  long count = 0;

  Plan() noexcept {
    const char *text = std::getenv("EPAFI_TEST_KILL"), *rank = std::getenv("OMPI_COMM_WORLD_RANK");
    char* end = nullptr;
    if (text != nullptr &&
        std::strtol(text, &end, 10) == (rank == nullptr ? 0 : std::strtol(rank, nullptr, 10)))
      number = std::strtol(end + 1, nullptr, 10);
  }
  Plan(const Plan&) = delete;
  Plan& operator=(const Plan&) = delete;
  ~Plan() {
    if (number == 0)
      std::fprintf(stderr, "renames: %ld\n", count);
  }
};

} // namespace

extern "C" int renameOrDie(const char* from, const char* to) noexcept
    __asm__("rename"); // in place of the system's

extern "C" int renameOrDie(const char* from, const char* to) noexcept {
  static Plan plan;
  if (++plan.count == plan.number)
    std::raise(SIGKILL);
  return ::renameat(AT_FDCWD, from, AT_FDCWD, to);
}
