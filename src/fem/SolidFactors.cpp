#include "epafi/fem/SolidFactors.hpp"

#include "epafi/base/Text.hpp"
#include "epafi/fem/ElementIntegrals.hpp"
#include "epafi/mesh/ElementGeometry.hpp"

#include <algorithm>

namespace epafi::fem {

SolidFactors::SolidFactors(const SolidBody& body) : hasAny_(!body.solid.stiffnessFactors.empty()) {
  if (hasAny_ && body.components() == 1)
    throw body.refusal("membranes have no factors of the stiffness");
  for (const StiffnessFactor& factor : body.solid.stiffnessFactors)
    for (const GlobalOrdinal node : body.nodesOf("stiffness factor '" + factor.name + "'", factor.where))
      factors_[node] = factor.value;
  std::vector<GlobalOrdinal> elements;
  std::vector<double> own;
  for (const auto& [node, factor] : factors_) {
    body.mesh.nodeElements(node, elements);
    for (const GlobalOrdinal element : elements) {
      of(body.mesh, element, own);
      if (leastFactor(cellOf(body.mesh.cellType(), own.size()), own) > 0)
        continue;
      const auto [least, most] = std::minmax_element(own.begin(), own.end());
      throw body.refusal("its stiffness factors are from " + text(*least) + " to " + text(*most) +
                         " in one element, at " + text(body.mesh.point(node)) +
                         ", and negative between its nodes; make elements smaller there");
    }
  }
}

void SolidFactors::of(const mesh::Mesh& mesh, GlobalOrdinal element, std::vector<double>& factors) const {
  factors.clear();
  if (!hasAny_)
    return;
  for (const GlobalOrdinal node : mesh::ElementNodes(mesh, element)) {
    const auto own = factors_.find(node);
    factors.push_back(own == factors_.end() ? 1 : own->second);
  }
}

} // namespace epafi::fem
