#include "epafi/decomposition/Decompose.hpp"

#include "epafi/base/Collective.hpp"
#include "epafi/base/Errors.hpp"
#include "epafi/decomposition/ContactRows.hpp"
#include "epafi/decomposition/Crosspoints.hpp"
#include "epafi/decomposition/EdgeAverages.hpp"
#include "epafi/decomposition/GluingRows.hpp"
#include "epafi/decomposition/Pieces.hpp"

#include <Teuchos_OrdinalTraits.hpp>
#include <Tpetra_Map.hpp>
#include <Tpetra_Vector.hpp>

#include <algorithm>
#include <span>
#include <utility>

namespace epafi::decomposition {
namespace {

RCP<const Map> makeMap(std::vector<GlobalOrdinal> indices, const RCP<const Comm>& comm) {
  if (!std::is_sorted(indices.begin(), indices.end()))
    std::sort(indices.begin(), indices.end());
  indices.erase(std::unique(indices.begin(), indices.end()), indices.end());
  return rcp(new Map(Teuchos::OrdinalTraits<Tpetra::global_size_t>::invalid(),
                     Teuchos::arrayViewFromVector(indices), 0, comm));
}

/// Splits the unknowns of a piece in remainder and crosspoints, and lists the crosspoint values that this rank
/// owns: those of which no lower subdomain has a copy.
void splitUnknowns(const CrosspointNumbering& crosspoints, const Piece& piece, std::size_t components,
                   Subdomain& subdomain, std::vector<GlobalOrdinal>& ownedCrosspoints) {
  const fem::AssembledSubdomain& assembled = piece.assembled;
  subdomain.remainderUnknowns.reserve(assembled.unknownPosition.size());
  for (std::size_t node = 0; node < assembled.nodes.size(); ++node) {
    const auto unknowns = std::span(assembled.unknownOf).subspan(node * components, components);
    if (piece.isCrosspoint[node] == 0) {
      for (const int unknown : unknowns)
        if (unknown >= 0)
          subdomain.remainderUnknowns.push_back(unknown);
      continue;
    }
    const bool owned = piece.sharing.isLowest(piece.part, node);
    GlobalOrdinal index = crosspoints.firstIndex(piece.body, assembled.nodes[node]);
    for (const int unknown : unknowns)
      if (unknown >= 0) {
        subdomain.crosspointUnknowns.push_back(unknown);
        subdomain.crosspointIndices.push_back(index);
        if (owned)
          ownedCrosspoints.push_back(index);
        ++index;
      }
  }
}

/// Averages along edges become unknowns of the pieces, whose rows are so far those of contact; returns them piece by
/// piece.
std::vector<std::vector<Average>> changeBasis(const Layout& layout, std::vector<Piece>& pieces) {
  std::vector<std::vector<Average>> averages;
  AverageBasis basis;
  for (Piece& piece : pieces) {
    const fem::BodyModel& model = *layout.models[static_cast<std::size_t>(piece.body)];
    averages.push_back(averagesOf(piece, static_cast<std::size_t>(model.components())));
    changeBasisOfRows(averages.back(), 0, piece.rows);
    basis.change(averages.back(), piece);
  }
  return averages;
}

/// Moves what is assembled out of a piece; what it takes to attach B stays.
void takeAssembled(Piece& piece, Subdomain& subdomain) {
  fem::AssembledSubdomain& assembled = piece.assembled;
  subdomain.body = piece.body;
  subdomain.number = piece.number;
  subdomain.nodes = std::move(assembled.nodes);
  subdomain.unknownPosition = std::move(assembled.unknownPosition);
  subdomain.stiffness = std::move(piece.stiffness);
  subdomain.load = std::move(assembled.load);
  subdomain.prescribed = std::move(assembled.prescribed);
  subdomain.energyOffset = assembled.energyOffset;
  subdomain.kernel = std::move(assembled.kernel);
}

std::vector<NodeFrame> framesOf(const fem::BodyModel& model, const std::vector<GlobalOrdinal>& nodes) {
  std::vector<NodeFrame> frames;
  if (!model.hasFrames())
    return frames;
  for (std::size_t place = 0; place < nodes.size(); ++place)
    if (const Eigen::Matrix3d* axes = model.frame(nodes[place]))
      frames.push_back({static_cast<int>(place), *axes});
  return frames;
}

std::vector<Body> describeBodies(const scene::Scene& scene, const Layout& layout) {
  std::vector<Body> bodies;
  int offset = 0;
  for (std::size_t b = 0; b < scene.bodies.size(); ++b) {
    const int modes = layout.models[b]->kernelDimension();
    Body& body = bodies.emplace_back(Body{scene.bodies[b].name, modes, offset});
    if (const auto motions = modes > 0 ? layout.models[b]->rigidMotions() : std::nullopt)
      body.motions = {
          {motions->centre[0], motions->centre[1], motions->centre[2]}, motions->size, motions->twists};
    offset += modes;
  }
  return bodies;
}

/// The multiplier maps and B: entries named by global rows become local.
void attachRows(const Rows& contact, const Rows& gluing, const std::vector<Piece>& pieces,
                DecomposedProblem& problem) {
  const auto both = [](const std::vector<GlobalOrdinal>& a, const std::vector<GlobalOrdinal>& b) {
    std::vector<GlobalOrdinal> joined;
    joined.reserve(a.size() + b.size());
    joined.insert(joined.end(), a.begin(), a.end());
    joined.insert(joined.end(), b.begin(), b.end());
    return joined;
  };
  problem.multiplierMap = makeMap(both(contact.owned, gluing.owned), problem.comm);
  problem.multiplierGhostMap = makeMap(both(contact.touched, gluing.touched), problem.comm);
  for (std::size_t p = 0; p < pieces.size(); ++p) {
    std::vector<ConstraintEntry>& constraint = problem.subdomains[p].constraint;
    constraint.reserve(pieces[p].rows.size());
    for (const RowEntry& entry : pieces[p].rows)
      constraint.push_back(
          {problem.multiplierGhostMap->getLocalElement(entry.row), entry.unknown, entry.coefficient});
  }
}

/// The bodies and the numbers of the whole problem that are known before it is assembled.
void describe(const scene::Scene& scene, const Layout& layout, DecomposedProblem& problem) {
  problem.components = layout.models.empty() ? 1 : layout.models.front()->components();
  problem.numSubdomains = layout.numSubdomains;
  problem.bodies = describeBodies(scene, layout);
  for (const Body& body : problem.bodies)
    problem.kernelDimension += body.kernelDimension;
}

} // namespace

void toSpace(const Subdomain& subdomain, Eigen::Ref<Eigen::VectorXd> values) {
  if (subdomain.frames.empty())
    return;
  const Eigen::Index components = values.size() / static_cast<Eigen::Index>(subdomain.nodes.size());
  for (const NodeFrame& frame : subdomain.frames) {
    auto own = values.segment(frame.node * components, components);
    own = (frame.axes.topLeftCorner(components, components) * own).eval();
  }
}

Eigen::VectorXd unknownsOf(const Subdomain& subdomain, Eigen::VectorXd values) {
  const Eigen::Index components = values.size() / static_cast<Eigen::Index>(subdomain.nodes.size());
  for (const NodeFrame& frame : subdomain.frames) {
    auto own = values.segment(frame.node * components, components);
    own = (frame.axes.topLeftCorner(components, components).transpose() * own).eval();
  }
  Eigen::VectorXd u = values(subdomain.unknownPosition);
  for (const Average& average : subdomain.averages) {
    double mean = u[average.carrier];
    for (const int other : average.others)
      mean += u[other];
    mean /= static_cast<double>(average.others.size() + 1);
    u[average.carrier] = mean;
    for (const int other : average.others)
      u[other] -= mean;
  }
  return u;
}

Decomposition decompose(const scene::Scene& scene, const RCP<const Comm>& comm) {
  Decomposition result;
  result.bodies = layoutBodies(scene, *comm);
  Layout layout{result.bodies, {}, 0};
  collectively(*comm, [&] {
    result.contacts = layoutContacts(scene, result.bodies);
    for (std::size_t b = 0; b < scene.bodies.size(); ++b) {
      layout.models.push_back(makeModel(scene.bodies[b], *result.bodies[b].mesh));
      layout.numSubdomains += result.bodies[b].partition->numParts();
    }
  });

  std::vector<Piece> pieces;
  collectively(*comm, [&] { pieces = assemblePieces(layout, *comm); });
  const CrosspointNumbering crosspoints(layout, pieces, *comm);

  DecomposedProblem& problem = result.problem;
  problem.comm = comm;
  describe(scene, layout, problem);
  problem.numCrosspoints = crosspoints.numNodes();
  for (const ContactLayout& contact : result.contacts)
    problem.numInequalities += contact.numRows();
  const Rows contact = contactRows(layout, result.contacts, comm, pieces);
  const std::vector<std::vector<Average>> averages = changeBasis(layout, pieces);
  const Rows gluing = gluingRows(layout, pieces, problem.numInequalities, comm, problem.numEqualities);

  GlobalOrdinal positions = 0, remainders = 0;
  std::vector<GlobalOrdinal> ownedCrosspoints;
  problem.subdomains.resize(pieces.size());
  for (std::size_t p = 0; p < pieces.size(); ++p) {
    Subdomain& subdomain = problem.subdomains[p];
    const auto body = static_cast<std::size_t>(pieces[p].body);
    splitUnknowns(crosspoints, pieces[p], static_cast<std::size_t>(layout.models[body]->components()),
                  subdomain, ownedCrosspoints);
    takeAssembled(pieces[p], subdomain);
    subdomain.averages = averages[p];
    subdomain.frames = framesOf(*layout.models[body], subdomain.nodes);
    positions += subdomain.prescribed.size();
    remainders += static_cast<GlobalOrdinal>(subdomain.remainderUnknowns.size());
  }
  problem.primalDimension = sumOverRanks(*comm, positions);
  problem.crosspointMap = makeMap(std::move(ownedCrosspoints), comm);
  problem.remainderMap = rcp(new Map(Teuchos::OrdinalTraits<Tpetra::global_size_t>::invalid(),
                                     static_cast<std::size_t>(remainders), 0, comm));
  attachRows(contact, gluing, pieces, problem);

  problem.gap = rcp(new Vector(problem.multiplierMap));
  for (const GlobalOrdinal row : contact.owned)
    problem.gap->replaceGlobalValue(row, contactGap(layout, result.contacts, row));
  return result;
}

} // namespace epafi::decomposition
