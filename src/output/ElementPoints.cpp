#include "epafi/output/ElementPoints.hpp"

#include "epafi/accuracy/BodyElements.hpp"
#include "epafi/base/Collective.hpp"

#include <algorithm>
#include <utility>

namespace epafi::output {

std::vector<ElementPoint> gatherElementPoints(const simulation::SolvedScene& solved, int body,
                                              fem::Integration integration) {
  const auto& problem = solved.decomposition.problem;
  std::vector<ElementPoint> own;
  collectively(solved.comm(), [&] {
    accuracy::BodyElements elements(solved.scene.bodies[body], solved.decomposition.bodies[body]);
    std::vector<fem::PointState> states;
    for (std::size_t s = 0; s < problem.subdomains.size(); ++s) {
      if (problem.subdomains[s].body != body)
        continue;
      const accuracy::SubdomainElements those = elements.elementsOf(problem.subdomains[s]);
      elements.visit(problem.subdomains[s], those, solved.solution.displacement[s], accuracy::Points::shape,
                     [&](const accuracy::ElementView& element) {
                       fem::pointStates(elements.typeOf(element), element.points,
                                        elements.materialOf(element.region), element.displacements,
                                        integration, element.state, states);
                       for (std::size_t k = 0; k < states.size(); ++k)
                         own.push_back({those.elements[element.number], static_cast<int>(k) + 1, states[k]});
                     });
    }
  });
  std::vector<ElementPoint> all = gatherOnFirst(solved.comm(), own);
  std::sort(all.begin(), all.end(), [](const ElementPoint& a, const ElementPoint& b) {
    return std::pair(a.element, a.point) < std::pair(b.element, b.point);
  });
  return all;
}

} // namespace epafi::output
