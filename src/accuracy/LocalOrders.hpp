#pragma once

/// At which order the error falls, element by element, as two meshes tell.
///
/// Where the solution is smooth the error of a part of the body falls with h^p, p the order of the elements;
/// at an edge, a re-entrant corner or the rim of contact, where it goes like r^α, with h^α alone. Elements
/// there have to get much smaller.

#include "epafi/base/Types.hpp"

#include <span>
#include <vector>

namespace epafi::accuracy {

/// The estimates on a mesh.
struct ElementErrors {
  std::vector<double> squared;  ///< η² of each element
  std::vector<double> measures; ///< area or volume of each
  std::vector<double>
      orders; ///< q of each: that at which η falls with the size; of a first mesh p everywhere
};

/// q on a finer mesh: from an element T of the last mesh with η_T², in which an element K lies, η_K² / (η_T²
/// |K|/|T|) = (h_K/h_T)^2q. Within [least, p]; T's own where K is about as large; as far as that, q is
/// smoothed over the elements of one T.
/// \param ancestors  T of each K
std::vector<double> localOrders(const ElementErrors& last, std::span<const LocalOrdinal> ancestors,
                                std::span<const double> squaredErrors, std::span<const double> measures,
                                int dimension, int order);

} // namespace epafi::accuracy
