#include "epafi/accuracy/ContactPressure.hpp"

#include "epafi/base/Errors.hpp"

#include <Eigen/LU>

#include <algorithm>
#include <cmath>
#include <map>
#include <set>
#include <unordered_map>

namespace epafi::accuracy {
namespace {

using contact::ContactLayout;

[[noreturn]] void refuse(const ContactLayout& contact, const std::string& why) {
  throw InputError("guaranteed bounds are not there for " + why + ", as contact '" + contact.name +
                   "' has; leave out \"Bound\"");
}

void requireCovered(const scene::SurfaceContact& terms, const ContactLayout& contact) {
  if (terms.coversBody())
    refuse(contact, "obstacles under membranes");
  if (terms.hasFriction())
    refuse(contact, "friction");
  if (terms.stiffness > 0)
    refuse(contact, "surfaces that give way");
  const auto isPair = [](const auto& nodes) { return nodes.size() == 1 && nodes[0].weight == 1; };
  if (!contact.firstShares.empty() || !contact.secondLevers.empty() || !contact.combinations.empty() ||
      (contact.secondBody >= 0 &&
       !std::all_of(contact.secondNodes.begin(), contact.secondNodes.end(), isPair)))
    refuse(contact, "surfaces that are coupled otherwise than node by node");
}

/// ∫ B_i B_j of Bernstein's polynomials over [0, 1], in the order of an edge's nodes.
Eigen::MatrixXd bernsteinProducts(std::size_t numNodes) {
  Eigen::MatrixXd products(numNodes, numNodes);
  if (numNodes == 2)
    products << 1.0 / 3, 1.0 / 6, 1.0 / 6, 1.0 / 3;
  else
    products << 1.0 / 5, 1.0 / 30, 1.0 / 10, 1.0 / 30, 1.0 / 5, 1.0 / 10, 1.0 / 10, 1.0 / 10, 2.0 / 15;
  return products;
}

/// T with B = Tᵀ N: values of B_k at node a.
Eigen::MatrixXd bernsteinAtNodes(std::size_t numNodes) {
  Eigen::MatrixXd values = Eigen::MatrixXd::Identity(numNodes, numNodes);
  if (numNodes == 3)
    values.row(2) << 0.25, 0.25, 0.5;
  return values;
}

} // namespace

ContactPressure::ContactPressure(const scene::Scene& scene, const model::Decomposition& decomposition)
    : gaps_(decomposition.problem.numInequalities, 0.0) {
  constexpr double alike = 1e-9;
  if (!decomposition.ties.empty() || !decomposition.equations.empty() || !scene.equations.empty())
    throw InputError("guaranteed bounds are not there for tied joints, equations and springs; leave out "
                     "\"Bound\"");
  for (const ContactLayout& contact : decomposition.contacts) {
    requireCovered(scene.contacts[contact.number], contact);
    if (!contact.hasOwnRows)
      continue;
    std::unordered_map<GlobalOrdinal, std::size_t> rowAt;
    for (std::size_t row = 0; row < contact.firstNodes.size(); ++row) {
      rowAt.emplace(contact.firstNodes[row], row);
      gaps_[contact.firstRow + row] = contact.gaps[row];
    }
    std::set<EdgeKey> facing;
    for (const std::string& name :
         contact.secondBody < 0 ? std::vector<std::string>() : contact.secondSurfaces) {
      const mesh::Surface surface = decomposition.bodies[contact.secondBody].mesh->surface(name);
      for (std::size_t f = 0; f < surface.numFacets(); ++f) {
        const auto nodes = surface.facet(f);
        facing.insert({std::min(nodes[0], nodes[1]), std::max(nodes[0], nodes[1])});
      }
    }
    const mesh::Mesh& mesh = *decomposition.bodies[contact.firstBody].mesh;
    std::vector<Point> points;
    for (const std::string& name : contact.firstSurfaces) {
      const mesh::Surface surface = mesh.surface(name);
      for (std::size_t f = 0; f < surface.numFacets(); ++f) {
        const auto nodes = surface.facet(f);
        if (!std::all_of(nodes.begin(), nodes.end(), [&](GlobalOrdinal n) { return rowAt.contains(n); }))
          continue;
        ContactEdge edge{
            contact.firstBody, contact.secondBody, {}, {nodes.begin(), nodes.end()}, {}, {}, 0, {}};
        for (const GlobalOrdinal node : nodes) {
          const std::size_t row = rowAt.at(node);
          const Eigen::VectorXd direction =
              contact.directionAt(row).head(static_cast<Eigen::Index>(contact.numComponents()));
          if (edge.rows.empty())
            edge.direction = direction;
          else if ((direction - edge.direction).norm() > alike)
            refuse(contact, "surfaces that are bent");
          edge.rows.push_back(contact.firstRow + static_cast<GlobalOrdinal>(row));
          if (contact.secondBody >= 0)
            edge.facing.push_back(contact.secondNodes[row][0].node);
        }
        if (contact.secondBody >= 0 && !facing.contains({std::min(edge.facing[0], edge.facing[1]),
                                                         std::max(edge.facing[0], edge.facing[1])}))
          continue;
        mesh.pointsAt(nodes, points);
        edge.length = std::hypot(points[1][0] - points[0][0], points[1][1] - points[0][1]);
        edge.pressure = Eigen::VectorXd::Zero(std::ssize(nodes));
        edges_.push_back(std::move(edge));
      }
    }
  }
}

/// Continuous, with the least ½∫p² − Σ λ p, coefficients ≥ 0: projected Gauss-Seidel. What forces it amounts
/// to need not be λ.
std::vector<double> ContactPressure::fit(std::span<const double> forces) {
  constexpr int sweeps = 100;
  std::vector<double> wanted(forces.size(), 0.0), diagonal(forces.size(), 0.0), p(forces.size(), 0.0);
  std::vector<char> isIn(forces.size(), 0);
  std::vector<std::map<GlobalOrdinal, double>> rows(forces.size());
  std::map<GlobalOrdinal, double> ofMiddle; // share of a middle's force that its corners take
  for (const ContactEdge& edge : edges_) {
    const Eigen::MatrixXd products = edge.length * bernsteinProducts(edge.rows.size());
    for (std::size_t i = 0; i < edge.rows.size(); ++i) {
      isIn[edge.rows[i]] = 1;
      for (std::size_t j = 0; j < edge.rows.size(); ++j)
        rows[edge.rows[i]][edge.rows[j]] += products(i, j);
    }
    if (edge.rows.size() == 3) {
      for (std::size_t i = 0; i < 2; ++i)
        wanted[edge.rows[i]] += 0.25 * forces[edge.rows[2]];
      wanted[edge.rows[2]] -= 0.5 * forces[edge.rows[2]];
    }
  }
  for (std::size_t row = 0; row < forces.size(); ++row)
    if (isIn[row] != 0)
      wanted[row] += forces[row];
  for (int sweep = 0; sweep < sweeps; ++sweep)
    for (std::size_t row = 0; row < forces.size(); ++row) {
      if (isIn[row] == 0)
        continue;
      double rest = wanted[row], own = 0;
      for (const auto& [column, value] : rows[row]) {
        rest -= value * p[column];
        if (column == static_cast<GlobalOrdinal>(row))
          own = value;
      }
      p[row] = std::max(0.0, p[row] + rest / own);
    }
  std::vector<double> result(forces.size(), 0.0);
  for (ContactEdge& edge : edges_) {
    for (std::size_t i = 0; i < edge.rows.size(); ++i)
      edge.pressure[static_cast<Eigen::Index>(i)] = p[edge.rows[i]];
    const Eigen::VectorXd moments = momentsOf(edge);
    for (std::size_t i = 0; i < edge.rows.size(); ++i)
      result[edge.rows[i]] += moments[static_cast<Eigen::Index>(i)];
  }
  return result;
}

/// ∫ p N_a
Eigen::VectorXd ContactPressure::momentsOf(const ContactEdge& edge) {
  const Eigen::MatrixXd at = bernsteinAtNodes(edge.rows.size());
  // ∫ p B = Tᵀ ∫ p N
  return at.transpose().lu().solve(edge.length * bernsteinProducts(edge.rows.size()) * edge.pressure);
}

void ContactPressure::addTo(std::vector<BoundLoads>& loads) const {
  for (const ContactEdge& edge : edges_) {
    const Eigen::MatrixXd forces = edge.direction * momentsOf(edge).transpose();
    addForces(loads[edge.first].edges, edge.nodes, -forces);
    if (edge.second >= 0)
      addForces(loads[edge.second].edges, edge.facing, forces);
  }
}

double ContactPressure::work(std::span<const double> slack) const {
  double sum = 0;
  for (const ContactEdge& edge : edges_) {
    const Eigen::VectorXd moments = momentsOf(edge);
    for (std::size_t i = 0; i < edge.rows.size(); ++i)
      sum += moments[static_cast<Eigen::Index>(i)] * slack[edge.rows[i]];
  }
  return sum;
}

/// At corners what they penetrate by. A quadratic is nowhere negative if its middle is no less than
/// ¼(√a − √b)², a and b its ends.
std::vector<double> ContactPressure::lacking(std::span<const double> slack) const {
  std::vector<double> lack(slack.size(), 0.0);
  for (const ContactEdge& edge : edges_)
    for (std::size_t i = 0; i < 2; ++i)
      lack[edge.rows[i]] = std::max(0.0, -slack[edge.rows[i]]);
  for (const ContactEdge& edge : edges_)
    if (edge.rows.size() == 3) {
      const auto end = [&](std::size_t i) { return std::sqrt(slack[edge.rows[i]] + lack[edge.rows[i]]); };
      const double least = 0.25 * (end(0) - end(1)) * (end(0) - end(1));
      lack[edge.rows[2]] = std::max(0.0, least - slack[edge.rows[2]]);
    }
  return lack;
}

} // namespace epafi::accuracy
