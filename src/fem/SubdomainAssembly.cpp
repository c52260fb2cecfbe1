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

/// One element's share of a subdomain: its matrix and load go to the free unknowns, what the supports hold
/// goes to the right-hand side and to the energy.
class ElementScatter {
public:
  ElementScatter(const BodyModel& model, std::size_t numElements, AssembledSubdomain& subdomain)
      : model_(model), subdomain_(subdomain), components_(static_cast<std::size_t>(model.components())),
        nodes_(static_cast<std::size_t>(model.mesh().nodesPerElement())),
        positions_(nodes_.size() * components_) {
    triplets_.reserve(numElements * positions_.size() * positions_.size());
  }

  void add(GlobalOrdinal element) {
    model_.mesh().elementNodes(element, nodes_);
    locate();
    model_.element(element, stiffness_, load_);
    for (std::size_t j = 0; j < positions_.size(); ++j) {
      const int unknown = subdomain_.unknownOf[positions_[j]];
      if (unknown >= 0)
        addFree(static_cast<Eigen::Index>(j), unknown);
      else
        addHeld(static_cast<Eigen::Index>(j));
    }
  }

  void finish() {
    const auto n = static_cast<Eigen::Index>(subdomain_.unknownPosition.size());
    subdomain_.stiffness.resize(n, n);
    // Both triangles add up their duplicates in the order of the elements: symmetric to the last digit.
    subdomain_.stiffness.setFromTriplets(triplets_.begin(), triplets_.end());
  }

private:
  void locate() {
    for (std::size_t i = 0; i < nodes_.size(); ++i) {
      const auto found = std::lower_bound(subdomain_.nodes.begin(), subdomain_.nodes.end(), nodes_[i]);
      const auto node = static_cast<std::size_t>(found - subdomain_.nodes.begin());
      for (std::size_t c = 0; c < components_; ++c)
        positions_[i * components_ + c] = node * components_ + c;
    }
  }

  void addFree(Eigen::Index column, int unknown) {
    subdomain_.load[unknown] += load_[column];
    for (std::size_t i = 0; i < positions_.size(); ++i) {
      const int other = subdomain_.unknownOf[positions_[i]];
      if (other >= 0)
        triplets_.emplace_back(other, unknown, stiffness_(static_cast<Eigen::Index>(i), column));
    }
  }

  void addHeld(Eigen::Index column) {
    const double held = heldValue(static_cast<std::size_t>(column));
    if (held == 0)
      return;
    subdomain_.energyOffset -= load_[column] * held; // −f_dᵀu_d
    for (std::size_t i = 0; i < positions_.size(); ++i) {
      const double entry = stiffness_(static_cast<Eigen::Index>(i), column) * held;
      const int other = subdomain_.unknownOf[positions_[i]];
      if (other >= 0)
        subdomain_.load[other] -= entry; // f_f − K_fd u_d
      else
        subdomain_.energyOffset += 0.5 * entry * heldValue(i); // ½ u_dᵀ K_dd u_d
    }
  }

  [[nodiscard]] double heldValue(std::size_t position) const {
    return subdomain_.prescribed[static_cast<Eigen::Index>(positions_[position])];
  }

  const BodyModel& model_;
  AssembledSubdomain& subdomain_;
  std::size_t components_;
  std::vector<GlobalOrdinal> nodes_;   ///< of the element at hand
  std::vector<std::size_t> positions_; ///< of its values in the subdomain
  Eigen::MatrixXd stiffness_;
  Eigen::VectorXd load_;
  std::vector<Eigen::Triplet<double>> triplets_;
};

} // namespace

AssembledSubdomain assemble(const BodyModel& model, std::span<const GlobalOrdinal> elements) {
  AssembledSubdomain subdomain;
  subdomain.nodes = nodesOf(model.mesh(), elements);
  number(model, subdomain);
  fillKernel(model, subdomain);
  subdomain.load = Eigen::VectorXd::Zero(static_cast<Eigen::Index>(subdomain.unknownPosition.size()));
  ElementScatter scatter(model, elements.size(), subdomain);
  for (const GlobalOrdinal element : elements)
    scatter.add(element);
  scatter.finish();
  return subdomain;
}

} // namespace epafi::fem
