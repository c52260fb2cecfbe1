#pragma once

/// Linear problems cut into subdomains, and what dense algebra says of them.

#include "DenseProblem.hpp"
#include "SolidScenes.hpp"

#include "epafi/linear/UnassembledOperator.hpp"
#include "epafi/model/GlobalUnknowns.hpp"

#include <memory>
#include <string>
#include <vector>

namespace epafi::linear {

using fetidp::gathered;
using fetidp::relativeError;
using fetidp::world;
using model::Decomposition;

/// A scene and its name.
struct LinearCase {
  std::string name;
  scene::Scene scene;
};

inline scene::Scene plate(int elements, const scene::Decomposition& cut) {
  return decomposition::oneBody(elements, elements, cut, {{"left", "left", {0.25}}, {"top", "top", {0.25}}});
}

/// A grid whose conductivity jumps from subdomain to subdomain.
inline scene::Scene patchwork(int elements, double jump) {
  scene::Scene scene = plate(elements, decomposition::grid(2, 2));
  scene.bodies.front().regions = {{"corner", mesh::rectangle(0, 0.5, 0, 0.5), "", {jump}},
                                  {"other corner", mesh::rectangle(0.5, 1, 0.5, 1), "", {jump}}};
  return scene;
}

/// An elastic block in the plane (depth 0) or in space, clamped at its left side: averages along edges are
/// coarse unknowns.
inline scene::Scene elasticBlock(int elements, int depth, const scene::Decomposition& cut) {
  scene::Scene scene;
  scene.bodies = {test::block("block", {{0, 0, 0}, {1, 1, 1}}, {elements, elements, depth}, cut)};
  scene::Body& solid = scene.bodies.front();
  solid.supports = {{"wall", "left", {0.0, 0.0, 0.0}}};
  solid.loads = {test::weight({1, -2, 0.5})};
  return scene;
}

inline std::vector<LinearCase> linearCases() {
  using decomposition::grid;
  using decomposition::metis;
  return {{"2 x 2", plate(6, grid(2, 2))},
          {"one subdomain", plate(4, grid(1, 1))},
          {"uneven grid", plate(7, grid(3, 2))},
          {"METIS", plate(8, metis(5))},
          {"jumps of 1e4", patchwork(8, 1e4)},
          {"elastic in the plane", elasticBlock(8, 0, test::cutInGrid({2, 2, 1}))},
          {"elastic in the plane, METIS", elasticBlock(9, 0, test::cutByMetis(4))},
          {"elastic in space", elasticBlock(4, 3, test::cutInGrid({2, 2, 1}))}};
}

/// A scene, cut, and its unassembled K.
struct LinearProblem {
  explicit LinearProblem(const scene::Scene& scene, const RCP<const Comm>& comm = world())
      : decomposition(std::make_shared<Decomposition>(model::decompose(scene, comm))),
        k(rcp(new UnassembledOperator({decomposition, &decomposition->problem},
                                      globalUnknowns(*decomposition)))) {}

  [[nodiscard]] RCP<Vector> load() const { return k->load(decomposition->data); } ///< b

  std::shared_ptr<Decomposition> decomposition;
  RCP<const UnassembledOperator> k;
};

/// Any operator's matrix on every rank, rows and columns by ascending numbers of its map. Collective.
Eigen::MatrixXd denseOf(const Operator& a);
/// A vector likewise. Collective.
Eigen::MatrixXd denseOf(const MultiVector& x);
/// The columns of a matrix, which every rank holds, as a multivector on the map. Not collective but for the
/// map's first use.
RCP<MultiVector> spreadOn(const RCP<const Map>& map, const Eigen::MatrixXd& values);

} // namespace epafi::linear
