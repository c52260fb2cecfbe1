#include "PeakMemory.hpp"

#include <malloc.h>

#include <fstream>
#include <string>

namespace epafi::drivers {
namespace {

/// A line of /proc/self/status, in bytes; 0 without it.
double statusBytes(const std::string& name) {
  std::ifstream status("/proc/self/status");
  for (std::string word; status >> word;)
    if (word == name) {
      double kilobytes = 0;
      status >> kilobytes;
      return 1024 * kilobytes;
    }
  return 0;
}

} // namespace

double resetPeakBytes() {
  malloc_trim(0);
  std::ofstream("/proc/self/clear_refs") << 5; // the peak becomes what is held now
  return statusBytes("VmRSS:");
}

double peakBytes() {
  return statusBytes("VmHWM:");
}

} // namespace epafi::drivers
