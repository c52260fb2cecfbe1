#include "epafi/direct/BlasMemory.hpp"

#include <Teuchos_LAPACK.hpp>

#include <array>
#include <cstdlib>
#include <new>

namespace epafi::direct {

void takeBlasMemory() {
  static const bool isTaken = [] {
    constexpr std::size_t needed = std::size_t{132} << 20U; // 128 MiB and what surrounds them
    void* volatile probe = std::malloc(needed);             // volatile: a compiler may leave the pair out
    if (probe == nullptr)
      throw std::bad_alloc();
    std::free(probe);
    std::array<double, 4> matrix{2, 1, 1, 2};
    int info = 0;
    Teuchos::LAPACK<int, double>().POTRF('L', 2, matrix.data(), 2, &info);
    return info == 0;
  }();
  static_cast<void>(isTaken);
}

} // namespace epafi::direct
