#include "epafi/base/PeakMemory.hpp"

#include <malloc.h>

#include <fstream>
#include <limits>
#include <string>

namespace epafi {
namespace {

/// A line of a file of /proc, in bytes; 0 without it.
double bytesIn(const char* file, const std::string& name) {
  std::ifstream status(file);
  for (std::string word; status >> word;)
    if (word == name) {
      double kilobytes = 0;
      status >> kilobytes;
      return 1024 * kilobytes;
    }
  return 0;
}

} // namespace

void keepFreedMemory() {
  constexpr int largest = 32 << 20; // that the C library allows; larger pieces always come from the system
  mallopt(M_MMAP_THRESHOLD, largest);
  mallopt(M_TRIM_THRESHOLD, std::numeric_limits<int>::max());
}

double resetPeakBytes() {
  malloc_trim(0);
  std::ofstream("/proc/self/clear_refs") << 5; // the peak becomes what is held now
  return bytesIn("/proc/self/status", "VmRSS:");
}

double peakBytes() {
  return bytesIn("/proc/self/status", "VmHWM:");
}

double freeBytes() {
  return bytesIn("/proc/meminfo", "MemAvailable:");
}

} // namespace epafi
