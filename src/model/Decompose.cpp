#include "epafi/model/Decompose.hpp"

#include "epafi/base/Collective.hpp"
#include "epafi/base/Errors.hpp"
#include "epafi/base/Text.hpp"
#include "epafi/decomposition/EqualMatrices.hpp"
#include "epafi/decomposition/UnassembledProblem.hpp"
#include "epafi/fem/SubdomainAssembly.hpp"
#include "epafi/mesh/BracedElements.hpp"
#include "epafi/mesh/ElementGeometry.hpp"
#include "epafi/model/ContactData.hpp"
#include "epafi/model/SceneContacts.hpp"
#include "epafi/model/SceneEquations.hpp"
#include "epafi/model/ScenePlaces.hpp"

#include <Teuchos_Comm.hpp>
#include <Tpetra_CrsMatrix.hpp>

#include <algorithm>
#include <cmath>
#include <optional>
#include <span>
#include <string>
#include <utility>

namespace epafi::model {
namespace {

using decomposition::Body;
using decomposition::NodalSubdomain;
using decomposition::NodeFrame;
using decomposition::SparseMatrix;
using decomposition::Subdomain;

using Models = std::vector<std::unique_ptr<fem::BodyModel>>;

/// What K R may keep of the sum of its terms' magnitudes: far above round-off, far below a mode that is none.
constexpr double kernelTolerance = 1e-6;

/// Beside the diagonal: sums of terms that are themselves round-off prove nothing.
constexpr double leastMagnitude = 1e-8;

std::vector<NodeFrame> framesOf(const fem::BodyModel& model, const std::vector<GlobalOrdinal>& nodes) {
  std::vector<NodeFrame> frames;
  if (!model.hasFrames())
    return frames;
  for (std::size_t place = 0; place < nodes.size(); ++place)
    if (const Eigen::Matrix3d* axes = model.frame(nodes[place]))
      frames.push_back({static_cast<int>(place), *axes});
  return frames;
}

std::vector<Body> describeBodies(const std::vector<BodyLayout>& layouts, const Models& models) {
  std::vector<Body> bodies;
  int kernelOffset = 0;
  const std::vector<GlobalOrdinal> firstNode = firstNodes(layouts);
  for (std::size_t b = 0; b < layouts.size(); ++b) {
    const int modes = models[b]->kernelDimension();
    Body& body = bodies.emplace_back(Body{layouts[b].name, modes, kernelOffset, firstNode[b]});
    if (modes > 0)
      body.motions = models[b]->rigidMotions();
    body.isOfRevolution = models[b]->isOfRevolution();
    kernelOffset += modes;
  }
  return bodies;
}

decomposition::NodePlaces placesOf(const Models& models) {
  const auto mapOf = [&models](int body) -> const fem::UnknownMap& { return models[body]->unknowns(); };
  return {mesh::dimensionOf(models.front()->mesh().cellType()),
          [mapOf](int body, GlobalOrdinal node) { return mapOf(body).point(node); },
          [mapOf](int body, GlobalOrdinal node) { return mapOf(body).isBoundaryNode(node); }};
}

/// Body of a subdomain.
std::size_t bodyOf(const std::vector<BodyLayout>& bodies, int number) {
  const auto next =
      std::upper_bound(bodies.begin(), bodies.end(), number,
                       [](int wanted, const BodyLayout& body) { return wanted < body.firstSubdomain; });
  return next - bodies.begin() - 1;
}

/// A part must have no motions without energy but rigid ones. \throws InputError
void requireBraced(const BodyLayout& body, std::span<const GlobalOrdinal> elements) {
  const auto isIn = [&](GlobalOrdinal other) {
    return std::binary_search(elements.begin(), elements.end(), other);
  };
  std::vector<Point> points;
  for (const GlobalOrdinal element : elements) {
    if (isBraced(*body.mesh, element, isIn))
      continue;
    body.mesh->elementPoints(element, points);
    const bool isPlane = dimensionOf(body.mesh->cellType()) == 2;
    throw InputError("body '" + body.name + "': reduced integration leaves the element at " +
                     text(mesh::centreOf(points)) + " loose, since " +
                     (isPlane ? "it has no neighbours in its part of the body"
                      : points.size() == 6
                          ? "it is a prism with no neighbour at its sides in its part of the body"
                          : "its neighbours in its part of the body lie along one axis of it "
                            "at most") +
                     "; choose fewer parts if it has others in the body, else the integration \"full\"");
  }
}

/// Assembles this rank's subdomains and hands them over, in the order of their numbers. Not collective.
void addSubdomains(const scene::Scene& scene, const std::vector<BodyLayout>& bodies, const Models& models,
                   const Share& share, decomposition::UnassembledProblem& problem) {
  std::optional<fem::SubdomainAssembler> assembler;
  decomposition::EqualMatrices matrices;
  SparseMatrix scratch;
  std::size_t last = bodies.size();
  for (int number = share.begin; number < share.end; ++number) {
    const std::size_t b = bodyOf(bodies, number);
    if (std::exchange(last, b) != b)
      assembler.emplace(*models[b]);
    fem::AssembledSubdomain values;
    values.stiffness.swap(scratch); // its memory is used again if the last matrix was a known one
    const std::vector<GlobalOrdinal> elements =
        bodies[b].partition->elementsOf(number - bodies[b].firstSubdomain);
    if (scene.bodies[b].reducedIntegration)
      requireBraced(bodies[b], elements);
    assembler->assemble(elements, values);
    NodalSubdomain nodal{
        std::move(values.unknownOf), std::move(values.borderNodes), matrices.store(values.stiffness), {}};
    scratch.swap(values.stiffness);
    Subdomain subdomain;
    subdomain.body = static_cast<int>(b);
    subdomain.nodes = std::move(values.nodes);
    subdomain.unknownPosition = std::move(values.unknownPosition);
    subdomain.frames = framesOf(*models[b], subdomain.nodes);
    subdomain.kernel = std::move(values.kernel);
    subdomain.held = std::move(values.held);
    if (models[b]->components() > 1) // of a scalar field R = 1, and nothing can go wrong
      requireKernel(*nodal.stiffness, subdomain.kernel, bodies[b].name);
    problem.add(std::move(subdomain), std::move(values.data), std::move(nodal));
  }
}

/// Some rank's piece of a mesh has to have what the scene names. Collective. \throws InputError
void requireNeedsMet(const Models& models, const Comm& comm) {
  std::vector<int> isMet;
  for (const auto& model : models)
    for (const auto& need : model->needs())
      isMet.push_back(need.isMet ? 1 : 0);
  sumOverRanks(comm, std::span(isMet));
  auto next = isMet.begin();
  for (const auto& model : models)
    for (const auto& need : model->needs())
      if (*next++ == 0)
        throw InputError(need.refusal);
}

} // namespace

void requireKernel(const SparseMatrix& k, const Eigen::MatrixXd& r, const std::string& body) {
  if (r.size() == 0) // held, or without an unknown of its own
    return;
  const Eigen::MatrixXd motions = r.transpose(); // a node's values side by side: K is read once
  const Eigen::ArrayXd largest = motions.cwiseAbs().rowwise().maxCoeff();
  Eigen::ArrayXd sum(r.cols()), magnitude(r.cols());
  for (Eigen::Index j = 0; j < k.cols(); ++j) {
    sum.setZero();
    magnitude = leastMagnitude * k.coeff(j, j) * largest;
    for (SparseMatrix::InnerIterator entry(k, j); entry; ++entry) { // K is symmetric: columns are rows
      const auto terms = entry.value() * motions.col(entry.row()).array();
      sum += terms;
      magnitude += terms.abs();
    }
    for (Eigen::Index mode = 0; mode < r.cols(); ++mode)
      if (!(std::abs(sum[mode]) <= kernelTolerance * magnitude[mode]))
        throw Error("body '" + body + "': its stiffness does not vanish on the rigid motion number " +
                    std::to_string(mode) + " that its supports seem to leave free (" +
                    std::to_string(sum[mode]) + " beside terms of " + std::to_string(magnitude[mode]) +
                    "); this is a fault of Epafi, please report the scene");
  }
}

Decomposition decompose(const scene::Scene& scene, const RCP<const Comm>& comm, Meshes meshes) {
  return decompose(scene, layoutBodies(scene, *comm, meshes), comm);
}

Decomposition decompose(const scene::Scene& scene, std::vector<BodyLayout> bodies,
                        const RCP<const Comm>& comm) {
  Decomposition result;
  result.bodies = std::move(bodies);
  Models models;
  collectively(*comm, [&] {
    for (std::size_t b = 0; b < scene.bodies.size(); ++b)
      models.push_back(makeModel(scene.bodies[b], *result.bodies[b].mesh));
  });
  requireNeedsMet(models, *comm);
  const std::vector<GlobalOrdinal> held = heldNodes(scene, result.bodies, *comm);
  collectively(*comm, [&] {
    SceneContacts all = layoutContacts(scene, result.bodies, supportedNodes(models));
    result.contacts = std::move(all.contacts);
    result.ties = std::move(all.ties);
    result.equations = equationsOf(scene, models, held);
    for (const contact::ContactLayout& section : all.sections)
      result.sections.push_back(addSection(scene, section, models, result.equations));
  });
  decomposition::UnassembledProblem problem(comm, models.front()->components(),
                                            describeBodies(result.bodies, models), placesOf(models));
  std::vector<int> clusters;
  for (std::size_t b = 0; b < result.bodies.size(); ++b) {
    const int asked = scene.bodies[b].decomposition.cluster;
    clusters.push_back(asked >= 0 ? asked : result.bodies[b].cluster);
  }
  problem.setClusterSizes(std::move(clusters));
  const Share share = shareOf(result.bodies, *comm);
  collectively(*comm, [&] { addSubdomains(scene, result.bodies, models, share, problem); });
  const contact::NodeUnknowns unknowns = nodeUnknowns(result.bodies, models, comm);
  if (!result.contacts.empty()) {
    decomposition::ConstraintMatrix matrix = contact::contactMatrix(result.contacts, unknowns, comm);
    matrix.places = contactPlaces(result.bodies, result.contacts, models, *matrix.rows->getRowMap());
    problem.setContact(matrix);
  }
  if (std::any_of(result.contacts.begin(), result.contacts.end(),
                  [](const contact::ContactLayout& each) { return each.firstFriction >= 0; }))
    problem.setFriction(contact::frictionRows(result.contacts, unknowns, comm));
  if (!result.ties.empty() || !result.equations.empty())
    problem.setTies(contact::contactMatrix(result.ties, unknowns, comm, result.equations));
  problem.complete();
  result.data = problem.data();
  setFrictionData(scene, result.contacts, problem.problem(), result.data);
  problem.setCompliance(
      complianceOf(scene, result.contacts, result.ties, result.equations, problem.problem()));
  result.problem = problem.take();
  return result;
}

} // namespace epafi::model
