#pragma once

/// The fields of one contact pair, each rank holding a contiguous slab of its rows.

#include "epafi/decomposition/Decompose.hpp"
#include "epafi/fetidp/ContactSolution.hpp"
#include "epafi/output/Slab.hpp"

#include <vector>

namespace epafi::output {

/// One row a contact node, in the order of the first body's edge.
struct ContactFields {
  GlobalOrdinal numRows = 0;
  RowRange rows;                  ///< this rank's rows
  std::vector<double> points;     ///< n × 3, on the first body's edge
  std::vector<double> initialGap; ///< c
  std::vector<double> gap;        ///< c − Bu, what remains open
  std::vector<double> multiplier; ///< λ_I, force that pushes the bodies apart
  std::vector<int> active;        ///< 1 where contact is closed
};

/// Brings the rows of contact pair `contact` from multiplierMap to the slabs.
/// Collective. Precondition: the solution's vectors lie on the problem's multiplierMap.
ContactFields gatherContactFields(const decomposition::Decomposition& decomposition,
                                  const fetidp::ContactSolution& solution, int contact);

} // namespace epafi::output
