#include "epafi/simulation/SupportResults.hpp"

#include "epafi/base/AccurateSum.hpp"
#include "epafi/base/Maps.hpp"
#include "epafi/base/Slab.hpp"

#include <Eigen/Geometry>
#include <Teuchos_Array.hpp>
#include <Tpetra_Export.hpp>
#include <Tpetra_Import.hpp>
#include <Tpetra_Map.hpp>
#include <Tpetra_MultiVector.hpp>
#include <Tpetra_Vector.hpp>

#include <algorithm>
#include <cmath>
#include <map>

namespace epafi::simulation {
namespace {

using decomposition::Subdomain;
using Eigen::Vector3d;

/// λ of the rows that touch what supports of this rank's subdomains hold. Collective.
RCP<const Vector> multipliersAtSupports(const SolvedScene& solved) {
  std::vector<GlobalOrdinal> rows;
  for (const Subdomain& subdomain : solved.decomposition.problem.subdomains)
    for (const auto& entry : subdomain.held.constraint)
      rows.push_back(entry.row);
  const Vector& multiplier = *solved.solution.multiplier;
  const RCP<const Map> map = makeMap(std::move(rows), multiplier.getMap()->getComm());
  const RCP<Vector> here = rcp(new Vector(map));
  here->doImport(multiplier, Import(multiplier.getMap(), map), Tpetra::INSERT);
  return here;
}

/// Components in space at all positions as components along the nodes' axes, in place.
void alongAxes(const Subdomain& subdomain, int components, Eigen::VectorXd& values) {
  for (const decomposition::NodeFrame& frame : subdomain.frames) {
    auto node = values.segment(static_cast<std::size_t>(frame.node) * components, components);
    node = (frame.axes.topLeftCorner(components, components).transpose() * node).eval();
  }
}

/// K_p u + B_pᵀλ − f_p.
Eigen::VectorXd heldForces(const SolvedScene& solved, std::size_t s, const Vector& multipliers) {
  const Subdomain& subdomain = solved.decomposition.problem.subdomains[s];
  Eigen::VectorXd u = solved.solution.displacement[s];
  alongAxes(subdomain, solved.decomposition.problem.components, u);
  Eigen::VectorXd forces =
      *subdomain.held.stiffness * u - solved.decomposition.data.subdomains()[s].heldForces;
  const auto values = multipliers.getData();
  for (const auto& [row, held, coefficient] : subdomain.held.constraint)
    forces[held] += coefficient * values[multipliers.getMap()->getLocalElement(row)];
  return forces;
}

/// The axis in space that a position goes along.
Vector3d axisOf(const Subdomain& subdomain, int position, int components) {
  if (components == 1)
    return Vector3d::UnitZ();
  const int node = position / components, component = position % components;
  const auto frame = std::lower_bound(
      subdomain.frames.begin(), subdomain.frames.end(), node,
      [](const decomposition::NodeFrame& one, int wanted) { return static_cast<int>(one.node) < wanted; });
  if (frame == subdomain.frames.end() || static_cast<int>(frame->node) != node)
    return Vector3d::Unit(component);
  return frame->axes.col(component);
}

} // namespace

std::vector<Vector3> supportForcesAtNodes(const SolvedScene& solved, int body) {
  const decomposition::DecomposedProblem& problem = solved.decomposition.problem;
  const RCP<const Vector> multipliers = multipliersAtSupports(solved);
  std::map<GlobalOrdinal, Vector3d> held;
  for (std::size_t s = 0; s < problem.subdomains.size(); ++s) {
    const Subdomain& subdomain = problem.subdomains[s];
    if (subdomain.body != body || subdomain.held.positions.empty())
      continue;
    const Eigen::VectorXd forces = heldForces(solved, s, *multipliers);
    for (std::size_t i = 0; i < subdomain.held.positions.size(); ++i) {
      const int position = subdomain.held.positions[i];
      held.try_emplace(subdomain.nodes[position / problem.components], Vector3d::Zero()).first->second +=
          forces[i] * axisOf(subdomain, position, problem.components);
    }
  }
  std::vector<GlobalOrdinal> nodes;
  for (const auto& [node, force] : held)
    nodes.push_back(node);
  MultiVector sums(makeMap(std::move(nodes), problem.comm), 3);
  for (const auto& [node, force] : held)
    for (std::size_t d = 0; d < 3; ++d)
      sums.replaceGlobalValue(node, d, force[d]);
  MultiVector slab(slabMap(solved.decomposition.bodies[body].mesh->numNodes(), problem.comm), 3);
  slab.doExport(sums, Export(sums.getMap(), slab.getMap()), Tpetra::ADD);
  Teuchos::Array<double> largest(3);
  slab.normInf(largest());
  const double none = 1e-12 * *std::max_element(largest.begin(), largest.end()); // round-off
  std::vector<Vector3> result(slab.getLocalLength());
  for (std::size_t d = 0; d < 3; ++d) {
    const auto column = slab.getData(d);
    for (std::size_t k = 0; k < result.size(); ++k)
      result[k][d] = std::abs(column[k]) > none ? column[k] : 0;
  }
  return result;
}

std::vector<SupportResult> supportResults(const SolvedScene& solved) {
  const decomposition::DecomposedProblem& problem = solved.decomposition.problem;
  std::vector<SupportResult> results;
  std::vector<std::size_t> firstOf;
  for (const scene::Body& body : solved.scene.bodies) {
    firstOf.push_back(results.size());
    for (const fem::SolidSupport& support : body.supports)
      results.push_back({body.name, support.name});
  }
  constexpr std::size_t each = 6;
  std::vector<AccurateSum> sums(each * results.size());
  const RCP<const Vector> multipliers = multipliersAtSupports(solved);
  for (std::size_t s = 0; s < problem.subdomains.size(); ++s) {
    const Subdomain& subdomain = problem.subdomains[s];
    if (subdomain.held.positions.empty())
      continue;
    const Eigen::VectorXd forces = heldForces(solved, s, *multipliers);
    const mesh::Mesh& mesh = *solved.decomposition.bodies[subdomain.body].mesh;
    for (std::size_t i = 0; i < subdomain.held.positions.size(); ++i) {
      if (subdomain.held.supports[i] < 0)
        continue;
      const int position = subdomain.held.positions[i];
      const Point point = mesh.point(subdomain.nodes[position / problem.components]);
      Vector3d force = forces[i] * axisOf(subdomain, position, problem.components),
               moment = Vector3d(point[0], point[1], point[2]).cross(force);
      if (solved.isOfRevolution()) { // what goes round balances itself
        force = {0, force[1], 0};
        moment.setZero();
      }
      AccurateSum* const own = &sums[each * (firstOf[subdomain.body] + subdomain.held.supports[i])];
      for (std::size_t d = 0; d < 3; ++d) {
        own[d].add(force[d]);
        own[3 + d].add(moment[d]);
      }
    }
  }
  sumOverRanks(solved.comm(), sums);
  for (std::size_t r = 0; r < results.size(); ++r)
    for (std::size_t d = 0; d < 3; ++d) {
      results[r].force[d] = sums[each * r + d].value();
      results[r].moment[d] = sums[each * r + 3 + d].value();
    }
  return results;
}

} // namespace epafi::simulation
