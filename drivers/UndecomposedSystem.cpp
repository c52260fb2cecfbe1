#include "UndecomposedSystem.hpp"

#include "epafi/base/Types.hpp"
#include "epafi/model/Decompose.hpp"

#include <Teuchos_ArrayRCP.hpp>
#include <Teuchos_DefaultSerialComm.hpp>
#include <Tpetra_Map.hpp>
#include <Tpetra_Vector.hpp>

#include <stdexcept>
#include <utility>

namespace epafi::drivers {
namespace {

using decomposition::DecomposedProblem;
using decomposition::Subdomain;
using model::Decomposition;

/// The scene with each body as one subdomain.
scene::Scene inOnePieceEach(scene::Scene scene) {
  for (scene::Body& body : scene.bodies) {
    body.decomposition.method = scene::Decomposition::Method::metis;
    body.decomposition.parts = 1;
  }
  return scene;
}

/// The first unknown of each body, and the number of all.
std::vector<int> firstUnknowns(const DecomposedProblem& problem) {
  std::vector<int> first{0};
  for (const Subdomain& subdomain : problem.subdomains)
    first.push_back(first.back() + static_cast<int>(subdomain.stiffness->rows()));
  return first;
}

/// K: the bodies' matrices along the diagonal. They are symmetric, so that their columns are rows.
UndecomposedSystem::Matrix blockDiagonal(const DecomposedProblem& problem, const std::vector<int>& first) {
  UndecomposedSystem::Matrix result(first.back(), first.back());
  Eigen::VectorXi rowLengths(first.back());
  for (std::size_t s = 0; s < problem.subdomains.size(); ++s)
    for (int row = 0; row < problem.subdomains[s].stiffness->cols(); ++row)
      rowLengths[first[s] + row] = static_cast<int>(problem.subdomains[s].stiffness->col(row).nonZeros());
  result.reserve(rowLengths);
  for (std::size_t s = 0; s < problem.subdomains.size(); ++s) {
    const decomposition::SparseMatrix& block = *problem.subdomains[s].stiffness;
    for (int row = 0; row < block.outerSize(); ++row)
      for (decomposition::SparseMatrix::InnerIterator entry(block, row); entry; ++entry)
        result.insert(first[s] + row, first[s] + entry.row()) = entry.value();
  }
  result.makeCompressed();
  return result;
}

UndecomposedSystem::Matrix rowsOf(const std::vector<Eigen::Triplet<double>>& entries, GlobalOrdinal numRows,
                                  int numUnknowns) {
  UndecomposedSystem::Matrix result(static_cast<int>(numRows), numUnknowns);
  result.setFromTriplets(entries.begin(), entries.end());
  return result;
}

/// B and T, whose rows stand between those of contact and of ties there.
void setRows(const DecomposedProblem& problem, const std::vector<int>& first, UndecomposedSystem& system) {
  std::vector<Eigen::Triplet<double>> normal, tangential;
  for (std::size_t s = 0; s < problem.subdomains.size(); ++s)
    for (const decomposition::ConstraintEntry& entry : problem.subdomains[s].constraint) {
      const int unknown = first[s] + entry.unknown;
      const auto row = static_cast<int>(problem.numberOf(entry.multiplier));
      if (problem.tangentOf(entry.multiplier) > 0)
        tangential.emplace_back(row - static_cast<int>(problem.numInequalities), unknown, entry.coefficient);
      else
        normal.emplace_back(row < problem.numInequalities ? row : row - static_cast<int>(problem.numFriction),
                            unknown, entry.coefficient);
    }
  system.constraint = rowsOf(normal, problem.numInequalities + problem.numTies, first.back());
  system.tangent = rowsOf(tangential, problem.numFriction, first.back());
}

/// c, s, and friction's law.
void setRowData(const DecomposedProblem& problem, const decomposition::ProblemData& data,
                UndecomposedSystem& system) {
  const auto all = data.gap().getData();
  const Eigen::Map<const Eigen::VectorXd> gap(all.getRawPtr(), all.size());
  system.numContacts = problem.numInequalities;
  system.gap.resize(problem.numInequalities + problem.numTies);
  system.gap << gap.head(problem.numInequalities), gap.tail(problem.numTies);
  system.tangentGap = gap.segment(problem.numInequalities, problem.numFriction);
  const std::vector<decomposition::FrictionNode>& nodes = problem.frictionNodes;
  system.friction.resize(std::ssize(nodes));
  system.frictionBound.resize(std::ssize(nodes));
  for (int i = 0; i < std::ssize(nodes); ++i) {
    system.frictionRow.push_back(static_cast<int>(problem.numberOf(nodes[i].contact)));
    system.frictionBound[i] = data.frictionBound(nodes[i], 0);
    system.friction[i] = data.frictionBound(nodes[i], 1) - system.frictionBound[i];
  }
}

/// Body, node, place and direction of the unknowns of one subdomain.
void locate(const Decomposition& decomposition, const Subdomain& subdomain, int first,
            UndecomposedSystem& system) {
  const mesh::Mesh& mesh = *decomposition.bodies[subdomain.body].mesh;
  const int components = decomposition.problem.components;
  std::vector<const Eigen::Matrix3d*> axes(subdomain.nodes.size(), nullptr);
  for (const decomposition::NodeFrame& frame : subdomain.frames)
    axes[frame.node] = &frame.axes;
  for (std::size_t i = 0; i < subdomain.unknownPosition.size(); ++i) {
    const std::size_t node = subdomain.unknownPosition[i] / components;
    const int component = subdomain.unknownPosition[i] % components;
    const std::size_t unknown = first + i;
    const Point point = mesh.point(subdomain.nodes[node]);
    system.body[unknown] = subdomain.body;
    system.node[unknown] = static_cast<int>(subdomain.nodes[node]);
    system.place.col(unknown) << point[0], point[1], point[2];
    if (axes[node] == nullptr)
      system.direction.col(unknown) = Eigen::Vector3d::Unit(component);
    else
      system.direction.col(unknown) = axes[node]->col(component);
  }
}

} // namespace

std::vector<Eigen::VectorXd> UndecomposedSystem::valuesOf(const Eigen::VectorXd& u) const {
  std::vector<Eigen::VectorXd> values = prescribed;
  for (Eigen::Index i = 0; i < u.size(); ++i) {
    values[body[i]].segment(node[i] * components, components) += u[i] * direction.col(i).head(components);
  }
  return values;
}

Eigen::VectorXd UndecomposedSystem::unknownsOf(const std::vector<Eigen::VectorXd>& values) const {
  Eigen::VectorXd u(load.size());
  for (Eigen::Index i = 0; i < u.size(); ++i) {
    const int of = body[i];
    const Eigen::Index position = node[i] * components;
    u[i] = direction.col(i)
               .head(components)
               .dot(values[of].segment(position, components) - prescribed[of].segment(position, components));
  }
  return u;
}

UndecomposedSystem undecomposedSystem(const scene::Scene& scene) {
  const Decomposition decomposition =
      model::decompose(inOnePieceEach(scene), rcp(new Teuchos::SerialComm<int>()));
  const DecomposedProblem& problem = decomposition.problem;
  // A body whose mesh is in two pieces stays so: nothing has to be glued.
  if (problem.numEqualities != problem.numTies)
    throw std::logic_error("undecomposedSystem: a body in one piece has rows of gluing");
  const std::vector<int> first = firstUnknowns(problem);

  UndecomposedSystem system;
  system.components = problem.components;
  for (const model::BodyLayout& body : decomposition.bodies)
    system.prescribed.emplace_back(
        Eigen::VectorXd::Zero(static_cast<Eigen::Index>(body.mesh->numNodes()) * problem.components));
  system.stiffness = blockDiagonal(problem, first);
  setRows(problem, first, system);
  setRowData(problem, decomposition.data, system);
  system.load.resize(first.back());
  system.body.resize(first.back());
  system.node.resize(system.body.size());
  system.place.resize(3, first.back());
  system.direction.resize(3, first.back());
  for (std::size_t s = 0; s < problem.subdomains.size(); ++s) {
    const Subdomain& subdomain = problem.subdomains[s];
    const decomposition::SubdomainData& data = decomposition.data.subdomains()[s];
    system.load.segment(first[s], data.load.size()) = data.rightHandSide();
    system.energyOffset += data.energyOffset();
    Eigen::VectorXd prescribed = data.prescribed;
    decomposition::toSpace(subdomain, prescribed);
    Eigen::VectorXd& all = system.prescribed[subdomain.body];
    for (std::size_t k = 0; k < subdomain.nodes.size(); ++k)
      all.segment(static_cast<Eigen::Index>(subdomain.nodes[k]) * problem.components, problem.components) =
          prescribed.segment(k * problem.components, problem.components);
    locate(decomposition, subdomain, first[s], system);
  }
  return system;
}

} // namespace epafi::drivers
