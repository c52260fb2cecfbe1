#pragma once

/// Times of work that is done again and again: the median, which neither a slow first time nor a disturbed
/// one moves.

#include "epafi/base/Collective.hpp"

#include <Teuchos_Comm.hpp>
#include <Teuchos_Time.hpp>

#include <algorithm>
#include <functional>
#include <vector>

namespace epafi::drivers {

/// Precondition: at least one value.
inline double median(std::vector<double> values) {
  std::sort(values.begin(), values.end());
  const std::size_t middle = values.size() / 2;
  return values.size() % 2 == 1 ? values[middle] : (values[middle - 1] + values[middle]) / 2;
}

/// Median of the seconds that `work` takes, each the largest over the ranks. Collective.
/// \param budget  seconds after which no more is tried, once there are 5 values
inline double medianSeconds(const Comm& comm, double budget, const std::function<void()>& work) {
  constexpr std::size_t least = 5, most = 101;
  std::vector<double> seconds;
  double spent = 0;
  while (seconds.size() < least || (spent < budget && seconds.size() < most)) {
    comm.barrier();
    const double begin = Teuchos::Time::wallTime();
    work();
    seconds.push_back(maxOverRanks(comm, Teuchos::Time::wallTime() - begin));
    spent += seconds.back(); // the same on all ranks
  }
  return median(seconds);
}

} // namespace epafi::drivers
