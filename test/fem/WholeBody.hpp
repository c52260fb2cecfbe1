#pragma once

#include "epafi/fem/SubdomainAssembly.hpp"

#include <numeric>
#include <vector>

namespace epafi::fem {

/// The whole body as one subdomain.
inline AssembledSubdomain assembled(const BodyModel& model) {
  std::vector<GlobalOrdinal> elements(model.mesh().numElements());
  std::iota(elements.begin(), elements.end(), GlobalOrdinal{0});
  return assemble(model, elements);
}

} // namespace epafi::fem
