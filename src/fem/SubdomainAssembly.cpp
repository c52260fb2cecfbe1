#include "epafi/fem/SubdomainAssembly.hpp"

#include <algorithm>

namespace epafi::fem {
namespace {

std::vector<GlobalOrdinal> nodesOf(const Mesh& mesh, std::span<const GlobalOrdinal> elements) {
  const auto perElement = static_cast<std::size_t>(mesh.nodesPerElement());
  std::vector<GlobalOrdinal> nodes(elements.size() * perElement);
  for (std::size_t e = 0; e < elements.size(); ++e)
    mesh.elementNodes(elements[e], std::span(nodes).subspan(e * perElement, perElement));
  std::sort(nodes.begin(), nodes.end());
  nodes.erase(std::unique(nodes.begin(), nodes.end()), nodes.end());
  return nodes;
}

/// Tells free positions from supported ones.
void number(const BodyModel& model, AssembledSubdomain& subdomain) {
  const int components = model.components();
  const std::size_t numPositions = subdomain.nodes.size() * static_cast<std::size_t>(components);
  subdomain.unknownOf.assign(numPositions, -1);
  subdomain.prescribed = Eigen::VectorXd::Zero(static_cast<Eigen::Index>(numPositions));
  for (std::size_t i = 0; i < subdomain.nodes.size(); ++i)
    for (int c = 0; c < components; ++c) {
      const std::size_t position = i * static_cast<std::size_t>(components) + static_cast<std::size_t>(c);
      if (const auto value = model.prescribed(subdomain.nodes[i], c)) {
        subdomain.prescribed[static_cast<Eigen::Index>(position)] = *value;
      } else {
        subdomain.unknownOf[position] = static_cast<int>(subdomain.unknownPosition.size());
        subdomain.unknownPosition.push_back(static_cast<int>(position));
      }
    }
}

void fillKernel(const BodyModel& model, AssembledSubdomain& subdomain) {
  const int components = model.components(), modes = model.kernelDimension();
  subdomain.kernel.resize(static_cast<Eigen::Index>(subdomain.unknownPosition.size()), modes);
  for (std::size_t i = 0; i < subdomain.unknownPosition.size(); ++i)
    for (int mode = 0; mode < modes; ++mode) {
      const int position = subdomain.unknownPosition[i];
      subdomain.kernel(static_cast<Eigen::Index>(i), mode) = model.kernelValue(
          subdomain.nodes[static_cast<std::size_t>(position / components)], position % components, mode);
    }
}

} // namespace

AssembledSubdomain assemble(const BodyModel& model, std::span<const GlobalOrdinal> elements) {
  AssembledSubdomain subdomain;
  const Mesh& mesh = model.mesh();
  subdomain.nodes = nodesOf(mesh, elements);
  number(model, subdomain);
  fillKernel(model, subdomain);

  const auto n = static_cast<Eigen::Index>(subdomain.unknownPosition.size());
  const auto components = static_cast<std::size_t>(model.components());
  const auto perElement = static_cast<std::size_t>(mesh.nodesPerElement());
  subdomain.load = Eigen::VectorXd::Zero(n);
  std::vector<Eigen::Triplet<double>> triplets;
  triplets.reserve(elements.size() * perElement * perElement * components * components);
  std::vector<GlobalOrdinal> nodes(perElement);
  std::vector<std::size_t> positions(perElement * components);
  Eigen::MatrixXd stiffness;
  Eigen::VectorXd load;
  for (const GlobalOrdinal element : elements) {
    mesh.elementNodes(element, nodes);
    for (std::size_t i = 0; i < perElement; ++i) {
      const auto found = std::lower_bound(subdomain.nodes.begin(), subdomain.nodes.end(), nodes[i]);
      for (std::size_t c = 0; c < components; ++c)
        positions[i * components + c] =
            static_cast<std::size_t>(found - subdomain.nodes.begin()) * components + c;
    }
    model.element(element, stiffness, load);
    for (std::size_t j = 0; j < positions.size(); ++j) {
      const auto column = static_cast<Eigen::Index>(j);
      const int unknown = subdomain.unknownOf[positions[j]];
      const double held = subdomain.prescribed[static_cast<Eigen::Index>(positions[j])];
      if (unknown >= 0)
        subdomain.load[unknown] += load[column];
      else
        subdomain.energyOffset -= load[column] * held; // −f_dᵀu_d
      for (std::size_t i = 0; i < positions.size(); ++i) {
        const auto row = static_cast<Eigen::Index>(i);
        const int other = subdomain.unknownOf[positions[i]];
        if (unknown >= 0 && other >= 0)
          triplets.emplace_back(other, unknown, stiffness(row, column));
        else if (other >= 0)
          subdomain.load[other] -= stiffness(row, column) * held; // f − K_fd u_d
        else if (unknown < 0)
          subdomain.energyOffset +=
              0.5 * stiffness(row, column) * held * subdomain.prescribed[static_cast<Eigen::Index>(positions[i])];
      }
    }
  }
  subdomain.stiffness.resize(n, n);
  subdomain.stiffness.setFromTriplets(triplets.begin(), triplets.end());
  return subdomain;
}

} // namespace epafi::fem
