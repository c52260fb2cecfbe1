#include "HandedOver.hpp"

#include "Gathered.hpp"

#include "epafi/base/Compatibility.hpp"
#include "epafi/fem/SubdomainAssembly.hpp"
#include "epafi/model/BodyLayout.hpp"

#include <Teuchos_Comm.hpp>
#include <Tpetra_CrsMatrix.hpp>
#include <Tpetra_Map.hpp>
#include <Tpetra_Vector.hpp>

#include <utility>

namespace epafi::decomposition {
namespace {

scene::Scene withoutSupports(scene::Scene scene) {
  for (scene::Body& body : scene.bodies)
    body.supports.clear();
  return scene;
}

using Models = std::vector<std::unique_ptr<fem::BodyModel>>;

Models modelsOf(const scene::Scene& scene, const std::vector<BodyLayout>& bodies) {
  Models models;
  for (std::size_t b = 0; b < scene.bodies.size(); ++b)
    models.push_back(makeModel(scene.bodies[b], *bodies[b].mesh));
  return models;
}

std::vector<GlobalOrdinal> firstNodesOf(const std::vector<BodyLayout>& bodies) {
  std::vector<GlobalOrdinal> first{0};
  for (const BodyLayout& body : bodies)
    first.push_back(first.back() + body.mesh->numNodes());
  return first;
}

} // namespace

std::vector<GlobalOrdinal> firstNodes(const Decomposition& decomposition) {
  return firstNodesOf(decomposition.bodies);
}

std::unique_ptr<UnassembledProblem> handOver(const scene::Scene& scene,
                                             std::vector<SubdomainMatrix> matrices) {
  const std::vector<BodyLayout> bodies = layoutBodies(scene, *world());
  std::vector<std::string> names;
  for (const BodyLayout& body : bodies)
    names.push_back(body.name);
  auto problem =
      std::make_unique<UnassembledProblem>(world(), mesh::dimensionOf(bodies.front().mesh->cellType()),
                                           modelsOf(scene, bodies).front()->components(), std::move(names));
  for (SubdomainMatrix& matrix : matrices)
    problem->add(std::move(matrix));
  return problem;
}

std::vector<SubdomainMatrix> matricesOf(const scene::Scene& scene, Supports supports) {
  const std::vector<BodyLayout> bodies = layoutBodies(scene, *world());
  const scene::Scene assembled = supports == Supports::prescribed ? withoutSupports(scene) : scene;
  const Models models = modelsOf(assembled, bodies), supported = modelsOf(scene, bodies);
  const std::vector<GlobalOrdinal> first = firstNodesOf(bodies);
  const int dimension = mesh::dimensionOf(bodies.front().mesh->cellType()),
            components = models.front()->components();
  std::vector<SubdomainMatrix> matrices;
  const model::Share share = model::shareOf(bodies, *world());
  for (int number = share.begin; number < share.end; ++number) {
    std::size_t b = bodies.size() - 1;
    while (number < bodies[b].firstSubdomain)
      --b;
    const fem::AssembledSubdomain assembledPart =
        fem::assemble(*models[b], bodies[b].partition->elementsOf(number - bodies[b].firstSubdomain));
    SubdomainMatrix& matrix = matrices.emplace_back();
    matrix.body = static_cast<int>(b);
    matrix.stiffness = assembledPart.stiffness;
    matrix.load = assembledPart.data.rightHandSide();
    matrix.coordinates.resize(matrix.load.size(), dimension);
    for (const int position : assembledPart.unknownPosition) {
      const GlobalOrdinal node = assembledPart.nodes[position / components];
      const Eigen::Index row = matrix.unknowns.size();
      for (Eigen::Index c = 0; c < dimension; ++c)
        matrix.coordinates(row, c) = bodies[b].mesh->point(node)[c];
      matrix.unknowns.push_back((first[b] + node) * components + position % components);
      if (supports == Supports::prescribed)
        if (const auto value = supported[b]->prescribed(node, position % components))
          matrix.prescribed.emplace_back(matrix.unknowns.back(), *value);
    }
  }
  return matrices;
}

ConstraintMatrix contactOf(const scene::Scene& scene, const Decomposition& decomposition, Supports supports) {
  const Models models = modelsOf(scene, decomposition.bodies);
  const std::vector<GlobalOrdinal> first = firstNodes(decomposition);
  const int components = models.front()->components();
  const RCP<const Map> rows =
      rcp(new Map(static_cast<Tpetra::global_size_t>(decomposition.problem.numInequalities), 0, world()));
  const RCP<const Map> unknowns =
      rcp(new Map(static_cast<Tpetra::global_size_t>(first.back() * components), 0, world()));
  const RCP<CrsMatrix> matrix = rcp(new CrsMatrix(rows, static_cast<std::size_t>(2 * components)));
  const RCP<Vector> gaps = rcp(new Vector(rows));
  for (const ContactLayout& contact : decomposition.contacts)
    for (std::size_t k = 0; k < contact.firstNodes.size(); ++k) {
      const GlobalOrdinal row = contact.firstRow + static_cast<GlobalOrdinal>(k);
      if (!rows->isNodeGlobalElement(row))
        continue;
      double gap = contact.gaps[k];
      const auto enter = [&](int body, GlobalOrdinal node, double sign) {
        const std::size_t b = body;
        for (int c = 0; c < components; ++c) {
          const double value =
              sign *
              contact.directions[k * static_cast<std::size_t>(components) + static_cast<std::size_t>(c)];
          const auto held = models[b]->prescribed(node, c);
          if (held && supports == Supports::eliminated)
            gap -= value * *held;
          else if (value != 0)
            matrix->insertGlobalValues(row, Teuchos::tuple<GlobalOrdinal>((first[b] + node) * components + c),
                                       Teuchos::tuple(value));
        }
      };
      enter(contact.firstBody, contact.firstNodes[k], 1);
      if (contact.secondBody >= 0)
        enter(contact.secondBody, contact.secondNodes[k].front().node, -1);
      gaps->replaceGlobalValue(row, gap);
    }
  matrix->fillComplete(unknowns, rows);
  return {matrix, gaps};
}

} // namespace epafi::decomposition
