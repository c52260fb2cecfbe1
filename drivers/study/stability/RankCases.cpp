/// One problem on 1, 2, 3, 4 and 7 ranks, some of which have nothing to do.

#include "ContactRun.hpp"
#include "Scenes.hpp"

#include <string>
#include <utility>

namespace epafi::drivers {

StabilityCases rankCases(bool quick) {
  struct Named {
    const char* name;
    scene::Scene scene;
  };
  scene::Scene cubes = pressedCubes(1, 2);
  const int elements = quick ? 4 : 16;
  const Named problems[] = {
      {"two subdomains", membranes(true, 1, elements)},
      {"two subdomains, floating", membranes(false, 1, elements)},
      {"six ragged subdomains, floating", cut(membranes(false, 1, elements), metis(3))},
      {"four elastic subdomains", cut(pressedSquares(1, elements), metis(2))},
      {"two elastic subdomains in space", cubes},
  };
  StabilityCases cases;
  for (const int ranks : {1, 2, 3, 4, 7})
    for (const Named& problem : problems) {
      const int subdomains =
          problem.scene.bodies[0].decomposition.method == scene::Decomposition::Method::metis
              ? 2 * problem.scene.bodies[0].decomposition.parts
              : 2;
      std::string parameter = std::to_string(ranks) + (ranks == 1 ? " rank" : " ranks");
      if (ranks > subdomains)
        parameter.append(", ").append(std::to_string(ranks - subdomains)).append(" empty");
      StabilityCase trial{"ranks", problem.name, parameter, solved(), {}};
      trial.run = [scene = problem.scene](const RCP<const Comm>& comm) {
        return solveContact({scene}, comm);
      };
      trial.value = ranks;
      trial.ranks = ranks;
      cases.push_back(std::move(trial));
    }
  return cases;
}

} // namespace epafi::drivers
