#include "MemoryRates.hpp"

#include "Median.hpp"

#include <Teuchos_BLAS.hpp>
#include <Teuchos_DefaultSerialComm.hpp>

#include <array>
#include <functional>

// Teuchos has no product with a packed matrix. The name is Fortran's:
// NOLINTNEXTLINE(readability-identifier-naming)
extern "C" void dspmv_(const char* uplo, const int* n, const double* alpha, const double* ap, const double* x,
                       const int* incx, const double* beta, double* y, const int* incy);

namespace epafi::drivers {
namespace {

constexpr int columns = 8;
constexpr double one = 1, zero = 0;

/// Boundaries Δ of inner subdomains with H/h = 8, 16, …, 128: four edges without corners.
constexpr std::array<int, 5> sizes{28, 60, 124, 252, 508};

using Kernel = std::function<void(int size, const double* matrix, const double* x, double* y)>;

void multiplyFull(int size, const double* matrix, const double* x, double* y) {
  Teuchos::BLAS<int, double>().GEMV(Teuchos::NO_TRANS, size, size, one, matrix, size, x, 1, zero, y, 1);
}

void multiplyPacked(int size, const double* matrix, const double* x, double* y) {
  constexpr int step = 1;
  dspmv_("L", &size, &one, matrix, x, &step, &zero, y, &step);
}

void multiplySeveral(int size, const double* matrix, const double* x, double* y) {
  Teuchos::BLAS<int, double>().GEMM(Teuchos::NO_TRANS, Teuchos::NO_TRANS, size, columns, size, one, matrix,
                                    size, x, size, zero, y, size);
}

/// The pointers do not overlap.
void triad(std::size_t size, const double* __restrict__ b, const double* __restrict__ c,
           double* __restrict__ a) {
  for (std::size_t i = 0; i < size; ++i)
    a[i] = b[i] + 3.0 * c[i];
}

} // namespace

double streamBandwidth(const Comm& comm, double bytes) {
  const auto size = static_cast<std::size_t>(bytes / (3 * sizeof(double)) / comm.getSize());
  std::vector<double> a(size), b(size, 1.0), c(size, 2.0);
  const double seconds = medianSeconds(comm, 1.0, [&] { triad(size, b.data(), c.data(), a.data()); });
  return 3 * sizeof(double) * static_cast<double>(size) * comm.getSize() / seconds;
}

Table timeBlockProducts(double bytes, double streamRate) {
  const Teuchos::SerialComm<int> alone;
  const std::vector<double> numbers(static_cast<std::size_t>(bytes / sizeof(double)), 1e-3);
  Table products("n,kernel,seconds,bytes_per_second,stream_bytes_per_second");
  for (const int size : sizes) {
    const std::vector<double> x(columns * size, 1.0);
    std::vector<double> y(x.size());
    const auto add = [&](const char* name, std::size_t entries, int numColumns, const Kernel& kernel) {
      const std::size_t numBlocks = numbers.size() / entries;
      const double seconds = medianSeconds(alone, 0.3, [&] {
        for (std::size_t block = 0; block < numBlocks; ++block)
          kernel(size, numbers.data() + block * entries, x.data(), y.data());
      });
      const double perBlock = seconds / static_cast<double>(numBlocks);
      products.rows.push_back({{"n", size},
                               {"kernel", name},
                               {"seconds", perBlock / numColumns},
                               {"bytes_per_second", static_cast<double>(entries * sizeof(double)) / perBlock},
                               {"stream_bytes_per_second", streamRate}});
    };
    const auto full = static_cast<std::size_t>(size) * static_cast<std::size_t>(size);
    add("dgemv", full, 1, multiplyFull);
    add("dspmv", (full + static_cast<std::size_t>(size)) / 2, 1, multiplyPacked);
    add("dgemm", full, columns, multiplySeveral);
  }
  return products;
}

} // namespace epafi::drivers
