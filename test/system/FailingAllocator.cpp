// Linked with the driver's main program, this makes a driver that runs out of memory on one rank: the
// allocation number n of rank r fails, EPAFI_TEST_FAIL=r:n. With n = 0 it tells at the end how many there
// were.

#include <cstdio>
#include <cstdlib>
#include <new>

namespace {

struct Plan {
  long number = -1; // of the allocation that fails; -1: none, 0: none, but they are counted
  long count = 0;

  Plan() noexcept {
    const char *text = std::getenv("EPAFI_TEST_FAIL"), *rank = std::getenv("OMPI_COMM_WORLD_RANK");
    char* end = nullptr;
    if (text == nullptr ||
        std::strtol(text, &end, 10) != (rank == nullptr ? 0 : std::strtol(rank, nullptr, 10)))
      return;
    number = std::strtol(end + 1, nullptr, 10);
  }
  Plan(const Plan&) = delete;
  Plan& operator=(const Plan&) = delete;
  ~Plan() {
    if (number == 0)
      std::fprintf(stderr, "allocations: %ld\n", count);
  }
};

Plan& plan() noexcept {
  static Plan instance;
  return instance;
}

} // namespace

void* operator new(std::size_t size) {
  Plan& our = plan();
  if (++our.count == our.number)
    throw std::bad_alloc();
  if (void* memory = std::malloc(size > 0 ? size : 1))
    return memory;
  throw std::bad_alloc();
}

// Whoever asks in this way goes on without (std::stable_sort does), so that it is no failure to plan.
void* operator new(std::size_t size, const std::nothrow_t& /*unused*/) noexcept {
  return std::malloc(size > 0 ? size : 1);
}

void operator delete(void* memory) noexcept {
  std::free(memory);
}

void operator delete(void* memory, const std::nothrow_t& /*unused*/) noexcept {
  std::free(memory);
}

void operator delete(void* memory, std::size_t /*size*/) noexcept {
  std::free(memory);
}
