#include "Twice.hpp"

#include "SolidScenes.hpp"

#include "epafi/base/Collective.hpp"

#include <Teuchos_Comm.hpp>

#include <algorithm>
#include <cmath>

namespace epafi::fetidp {

using namespace decomposition;

scene::Scene twoBlocks(int dimension, const scene::Decomposition& cut) {
  scene::Scene scene;
  const int n = 4, depth = dimension == 3 ? n : 0;
  scene.bodies = {test::block("held", {{0, 0, 0}, {1, 1, 1}}, {n, n, depth}, cut),
                  test::block("floating", {{1, 0, 0}, {2, 1, 1}}, {n, n, depth}, cut)};
  for (scene::Body& body : scene.bodies) {
    body.supports.push_back(test::slide("bottom"));
    if (dimension == 3)
      body.supports.push_back(test::slide("front", 0.01));
  }
  scene.bodies[0].supports.push_back(test::slide("left"));
  scene.bodies[1].loads.push_back(test::weight({-1, -2, 0}));
  scene.contacts.push_back(test::between("joint", 0, "right", 1, "left"));
  return scene;
}

std::vector<Case> handedCases() {
  std::vector<Case> cases;
  for (const bool coercive : {true, false}) {
    const std::string kind = coercive ? "coercive " : "semicoercive ";
    cases.push_back({kind + "grid", twoMembranes(coercive, 8, grid(2, 2))});
    cases.push_back({kind + "strips", twoMembranes(coercive, 7, grid(3, 1))});
    cases.push_back({kind + "whole bodies", twoMembranes(coercive, 4, grid(1, 1))});
    cases.push_back({kind + "parts of METIS", twoMembranes(coercive, 9, metis(7))});
  }
  for (Case& c : cases) {
    setHalves(c.scene.bodies[0], 4.0, -5.0);
    setHalves(c.scene.bodies[1], -3.0, 2.0);
  }
  cases.push_back({"blocks in the plane, grid", twoBlocks(2, test::cutInGrid({2, 2, 1}))});
  cases.push_back({"blocks in the plane, parts of METIS", twoBlocks(2, test::cutByMetis(3))});
  cases.push_back({"blocks in space, grid", twoBlocks(3, test::cutInGrid({2, 2, 2}))});
  cases.push_back({"blocks in space, parts of METIS", twoBlocks(3, test::cutByMetis(5))});
  return cases;
}

double Twice::difference() const {
  double largest = 0, difference = 0;
  const DecomposedProblem& problem = direct.decomposition.problem;
  const std::vector<GlobalOrdinal> first = firstNodes(direct.decomposition);
  for (std::size_t s = 0; s < problem.subdomains.size(); ++s) {
    const Subdomain& subdomain = problem.subdomains[s];
    const Eigen::VectorXd& u = direct.solution.displacement[s];
    const std::vector<GlobalOrdinal> global = handed->globalUnknowns(s);
    for (std::size_t position = 0; position < global.size(); ++position) {
      if (global[position] < 0)
        continue;
      const GlobalOrdinal node = global[position] / problem.components - first[subdomain.body];
      const auto place = std::lower_bound(subdomain.nodes.begin(), subdomain.nodes.end(), node);
      const double expected =
          u[(place - subdomain.nodes.begin()) * problem.components + global[position] % problem.components];
      largest = std::max(largest, std::abs(expected));
      difference = std::max(difference, std::abs(expected - solution.displacement[s][position]));
    }
  }
  return maxOverRanks(*world(), difference) / maxOverRanks(*world(), largest);
}

} // namespace epafi::fetidp
