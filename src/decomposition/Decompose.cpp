#include "epafi/decomposition/Decompose.hpp"

#include "epafi/base/Collective.hpp"
#include "epafi/base/Errors.hpp"
#include "epafi/decomposition/ContactRows.hpp"
#include "epafi/decomposition/Crosspoints.hpp"
#include "epafi/decomposition/FillProblem.hpp"
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
  const Outline outline = outlineOf(layout);
  const CrosspointNumbering crosspoints(outline, pieces, *comm);

  DecomposedProblem& problem = result.problem;
  problem.comm = comm;
  describe(scene, layout, problem);
  for (const ContactLayout& contact : result.contacts)
    problem.numInequalities += contact.numRows();
  const Rows contact = contactRows(layout, result.contacts, comm, pieces);
  const std::vector<std::vector<Average>> averages = changeBasis(outline, pieces);
  const Rows gluing = gluingRows(outline, pieces, problem.numInequalities, comm, problem.numEqualities);

  fillSubdomains(outline, crosspoints, averages, pieces, problem);
  for (Subdomain& subdomain : problem.subdomains)
    subdomain.frames = framesOf(*layout.models[static_cast<std::size_t>(subdomain.body)], subdomain.nodes);
  attachRows(contact, gluing, pieces, problem);
  for (const GlobalOrdinal row : contact.owned)
    problem.gap->replaceGlobalValue(row, contactGap(layout, result.contacts, row));
  return result;
}

} // namespace epafi::decomposition
