#include "epafi/decomposition/Decompose.hpp"

#include "epafi/base/Collective.hpp"
#include "epafi/base/Errors.hpp"
#include "epafi/decomposition/ContactRows.hpp"
#include "epafi/decomposition/Crosspoints.hpp"
#include "epafi/decomposition/GluingRows.hpp"
#include "epafi/decomposition/Pieces.hpp"

#include <Teuchos_OrdinalTraits.hpp>
#include <Tpetra_Map.hpp>
#include <Tpetra_Vector.hpp>

#include <algorithm>
#include <utility>

namespace epafi::decomposition {
namespace {

void requireCut(const scene::Body& body) {
  const scene::Decomposition& cut = body.decomposition;
  const std::string where = "body '" + body.name + "' has ";
  if (cut.method == scene::Decomposition::Method::metis) {
    const GlobalOrdinal numElements = static_cast<GlobalOrdinal>(body.elements[0]) * body.elements[1];
    if (cut.parts < 1 || cut.parts > numElements)
      throw InputError(where + std::to_string(numElements) + " elements and cannot be cut into " +
                       std::to_string(cut.parts) + " parts; choose between 1 and " +
                       std::to_string(numElements));
    return;
  }
  for (std::size_t d = 0; d < 2; ++d)
    if (cut.counts[d] < 1 || cut.counts[d] > body.elements[d])
      throw InputError(where + std::to_string(body.elements[d]) + " elements in " + (d == 0 ? "x" : "y") +
                       " and cannot be cut into " + std::to_string(cut.counts[d]) +
                       " subdomains there; choose between 1 and " + std::to_string(body.elements[d]));
}

/// Collective.
std::unique_ptr<Partition> makePartition(const scene::Body& body, const fem::RectangleMesh& mesh,
                                         const Comm& comm) {
  if (body.decomposition.method == scene::Decomposition::Method::metis)
    return std::make_unique<GraphPartition>(mesh, body.decomposition.parts, comm);
  return std::make_unique<GridPartition>(mesh, body.decomposition.counts);
}

/// Collective.
std::vector<BodyLayout> layoutBodies(const scene::Scene& scene, const Comm& comm) {
  std::vector<BodyLayout> bodies;
  int firstSubdomain = 0;
  for (const scene::Body& body : scene.bodies) {
    auto mesh = std::make_unique<fem::RectangleMesh>(body.rectangle, body.elements);
    auto partition = makePartition(body, *mesh, comm);
    const int numParts = partition->numParts();
    bodies.push_back({body.name, std::move(mesh), std::move(partition), firstSubdomain});
    firstSubdomain += numParts;
  }
  return bodies;
}

RCP<const Map> makeMap(std::vector<GlobalOrdinal> indices, const RCP<const Comm>& comm) {
  std::sort(indices.begin(), indices.end());
  indices.erase(std::unique(indices.begin(), indices.end()), indices.end());
  return rcp(new Map(Teuchos::OrdinalTraits<Tpetra::global_size_t>::invalid(),
                     Teuchos::arrayViewFromVector(indices), 0, comm));
}

/// Splits the unknowns of a piece in remainder and crosspoints.
Subdomain makeSubdomain(const Layout& layout, const CrosspointNumbering& crosspoints, Piece& piece) {
  const fem::BodyModel& model = *layout.models[static_cast<std::size_t>(piece.body)];
  Subdomain subdomain;
  subdomain.body = piece.body;
  subdomain.number = piece.number;
  const int components = model.components();
  for (std::size_t unknown = 0; unknown < piece.assembled.unknownPosition.size(); ++unknown) {
    const int position = piece.assembled.unknownPosition[unknown];
    const auto node = static_cast<std::size_t>(position / components);
    if (piece.isCrosspoint[node] == 0) {
      subdomain.remainderUnknowns.push_back(static_cast<int>(unknown));
    } else {
      subdomain.crosspointUnknowns.push_back(static_cast<int>(unknown));
      subdomain.crosspointIndices.push_back(
          crosspoints.index(piece.body, piece.assembled.nodes[node], model, position % components));
    }
  }
  subdomain.nodes = piece.assembled.nodes;
  subdomain.unknownPosition = std::move(piece.assembled.unknownPosition);
  subdomain.stiffness.swap(piece.assembled.stiffness); // Eigen 3.4 cannot move sparse matrices
  subdomain.load = std::move(piece.assembled.load);
  subdomain.prescribed = std::move(piece.assembled.prescribed);
  subdomain.energyOffset = piece.assembled.energyOffset;
  subdomain.kernel = std::move(piece.assembled.kernel);
  return subdomain;
}

/// Crosspoint values that this rank owns: those of which no lower subdomain has a copy.
std::vector<GlobalOrdinal> ownedCrosspoints(const Layout& layout, const CrosspointNumbering& crosspoints,
                                            const std::vector<Piece>& pieces) {
  std::vector<GlobalOrdinal> owned;
  for (const Piece& piece : pieces) {
    const fem::BodyModel& model = *layout.models[static_cast<std::size_t>(piece.body)];
    for (std::size_t i = 0; i < piece.assembled.nodes.size(); ++i)
      if (piece.isCrosspoint[i] != 0 && piece.sharing[i].front() == piece.part)
        for (int c = 0; c < model.components(); ++c)
          if (!model.prescribed(piece.assembled.nodes[i], c))
            owned.push_back(crosspoints.index(piece.body, piece.assembled.nodes[i], model, c));
  }
  return owned;
}

std::vector<Body> describeBodies(const scene::Scene& scene, const Layout& layout) {
  std::vector<Body> bodies;
  int offset = 0;
  for (std::size_t b = 0; b < scene.bodies.size(); ++b) {
    const int modes = layout.models[b]->kernelDimension();
    bodies.push_back({scene.bodies[b].name, modes, offset});
    offset += modes;
  }
  return bodies;
}

/// The multiplier maps and B: entries named by global rows become local.
void attachRows(const std::vector<Rows>& groups, const RCP<const Comm>& comm, DecomposedProblem& problem) {
  std::vector<GlobalOrdinal> owned, touched;
  for (const Rows& rows : groups) {
    owned.insert(owned.end(), rows.owned.begin(), rows.owned.end());
    for (const RowEntry& entry : rows.entries)
      touched.push_back(entry.row);
  }
  problem.multiplierMap = makeMap(std::move(owned), comm);
  problem.multiplierGhostMap = makeMap(std::move(touched), comm);
  for (const Rows& rows : groups)
    for (const RowEntry& entry : rows.entries)
      problem.subdomains[entry.piece].constraint.push_back(
          {problem.multiplierGhostMap->getLocalElement(entry.row), entry.unknown, entry.coefficient});
}

} // namespace

Decomposition decompose(const scene::Scene& scene, const RCP<const Comm>& comm) {
  collectively(*comm, [&] { std::for_each(scene.bodies.begin(), scene.bodies.end(), requireCut); });
  Decomposition result;
  result.bodies = layoutBodies(scene, *comm);
  Layout layout{result.bodies, {}, 0};
  collectively(*comm, [&] {
    result.contacts = layoutContacts(scene, result.bodies);
    for (std::size_t b = 0; b < scene.bodies.size(); ++b) {
      layout.models.push_back(std::make_unique<fem::MembraneModel>(scene.bodies[b], *result.bodies[b].mesh));
      layout.numSubdomains += result.bodies[b].partition->numParts();
    }
  });

  std::vector<Piece> pieces;
  collectively(*comm, [&] { pieces = assemblePieces(layout, *comm); });
  const CrosspointNumbering crosspoints(layout, pieces, *comm);

  DecomposedProblem& problem = result.problem;
  problem.comm = comm;
  problem.components = layout.models.empty() ? 1 : layout.models.front()->components();
  problem.numSubdomains = layout.numSubdomains;
  problem.bodies = describeBodies(scene, layout);
  for (const Body& body : problem.bodies)
    problem.kernelDimension += body.kernelDimension;
  problem.numCrosspoints = crosspoints.numNodes();
  problem.crosspointMap = makeMap(ownedCrosspoints(layout, crosspoints, pieces), comm);

  for (const ContactLayout& contact : result.contacts)
    problem.numInequalities += contact.numRows;
  std::vector<Rows> rows{contactRows(layout, result.contacts, pieces)};
  rows.push_back(gluingRows(layout, pieces, problem.numInequalities, comm, problem.numEqualities));

  GlobalOrdinal positions = 0, remainders = 0;
  problem.subdomains.reserve(pieces.size());
  for (Piece& piece : pieces) {
    positions += piece.assembled.prescribed.size();
    problem.subdomains.push_back(makeSubdomain(layout, crosspoints, piece));
    remainders += static_cast<GlobalOrdinal>(problem.subdomains.back().remainderUnknowns.size());
  }
  problem.primalDimension = sumOverRanks(*comm, positions);
  problem.remainderMap = rcp(new Map(Teuchos::OrdinalTraits<Tpetra::global_size_t>::invalid(),
                                     static_cast<std::size_t>(remainders), 0, comm));
  attachRows(rows, comm, problem);

  problem.gap = rcp(new Vector(problem.multiplierMap));
  for (const GlobalOrdinal row : rows.front().owned)
    problem.gap->replaceGlobalValue(row, contactGap(layout, result.contacts, row));
  return result;
}

} // namespace epafi::decomposition
