#include "epafi/fem/SubdomainAssembly.hpp"

#include <algorithm>
#include <cmath>
#include <optional>

namespace epafi::fem {
namespace {

/// A grid that does not divide the mesh evenly has four shapes of subdomains in the plane, eight in space;
/// shapes and ways to lie on the body's surfaces make 16 and 64 combinations.
constexpr std::size_t maxNumberings = 8, maxPatterns = 64;
/// Numbers of all that is kept: some 10 MB.
constexpr std::size_t maxNumbers = 1U << 20U;

std::size_t square(std::size_t n) {
  return n * n;
}

void fillKernel(const BodyModel& model, AssembledSubdomain& subdomain) {
  const int components = model.components(), modes = model.kernelDimension();
  subdomain.kernel.resize(subdomain.unknownPosition.size(), modes);
  for (int mode = 0; mode < modes; ++mode)
    for (std::size_t i = 0; i < subdomain.unknownPosition.size(); ++i) {
      const int position = subdomain.unknownPosition[i];
      subdomain.kernel(i, mode) =
          model.kernelValue(subdomain.nodes[position / components], position % components, mode);
    }
}

} // namespace

SubdomainAssembler::SubdomainAssembler(const BodyModel& model)
    : model_(model), components_(model.components()), numberings_(maxNumberings, maxNumbers),
      patterns_(maxPatterns, maxNumbers) {}

void SubdomainAssembler::assemble(std::span<const GlobalOrdinal> elements, AssembledSubdomain& subdomain) {
  const std::shared_ptr<const LocalNumbering> numbering = number(elements, subdomain);
  findBorder(*numbering, subdomain);
  hold(subdomain);
  std::shared_ptr<const StiffnessPattern> pattern = patterns_.find(
      [&](const StiffnessPattern& known) { return known.fits(*numbering, subdomain.unknownOf); });
  if (!pattern)
    pattern = patterns_.add(StiffnessPattern(numbering, model_.components(), subdomain.unknownOf),
                            elements.size() * square(model_.unknowns().unknownsPerElement()));

  kinds_.resize(elements.size());
  model_.kinds(elements, kinds_);
  model_.loads(elements, loads_);
  addStiffness(*pattern, subdomain);
  addLoads(*numbering, subdomain);
  eliminate(*numbering, *pattern, subdomain);
  fillKernel(model_, subdomain);
}

/// Finds the nodes.
std::shared_ptr<const LocalNumbering> SubdomainAssembler::number(std::span<const GlobalOrdinal> elements,
                                                                 AssembledSubdomain& subdomain) {
  const int perElement = model_.unknowns().nodesPerElement();
  corners_.resize(elements.size() * perElement);
  model_.unknowns().elementNodes(elements, corners_);
  std::optional<GlobalOrdinal> firstNode;
  std::shared_ptr<const LocalNumbering> numbering = numberings_.find([&](const LocalNumbering& known) {
    firstNode = known.firstNodeIfShifted(corners_);
    return firstNode.has_value();
  });
  if (!numbering) {
    numbering = numberings_.add(LocalNumbering(corners_, perElement), corners_.size());
    firstNode = numbering->firstNodeIfShifted(corners_);
  }
  subdomain.nodes = numbering->nodes(firstNode.value_or(0));
  return numbering;
}

void SubdomainAssembler::findBorder(const LocalNumbering& numbering, AssembledSubdomain& subdomain) {
  numElementsAt_.resize(subdomain.nodes.size());
  model_.unknowns().numNodeElements(subdomain.nodes, numElementsAt_);
  subdomain.borderNodes.clear();
  for (std::size_t i = 0; i < numElementsAt_.size(); ++i)
    if (numElementsAt_[i] > numbering.numElementsAt()[i])
      subdomain.borderNodes.push_back(static_cast<int>(i));
}

/// Tells free positions from supported ones.
void SubdomainAssembler::hold(AssembledSubdomain& subdomain) {
  const std::size_t numPositions = subdomain.nodes.size() * components_;
  subdomain.unknownOf.assign(numPositions, 0);
  subdomain.data.prescribed.setZero(numPositions);
  model_.prescribed(subdomain.nodes, prescribed_);
  subdomain.held = {};
  for (const auto& [position, value, support] : prescribed_) {
    subdomain.unknownOf[position] = -1;
    subdomain.data.prescribed[position] = value;
    subdomain.held.positions.push_back(static_cast<int>(position));
    subdomain.held.supports.push_back(support);
  }
  subdomain.unknownPosition.clear();
  subdomain.unknownPosition.reserve(numPositions);
  for (std::size_t position = 0; position < numPositions; ++position)
    if (subdomain.unknownOf[position] == 0) {
      subdomain.unknownOf[position] = static_cast<int>(subdomain.unknownPosition.size());
      subdomain.unknownPosition.push_back(static_cast<int>(position));
    }
}

const Eigen::MatrixXd& SubdomainAssembler::stiffnessOf(GlobalOrdinal kind) {
  if (kind != kindAtHand_) {
    model_.stiffness(kind, stiffness_);
    if (const Eigen::Index size = model_.unknowns().unknownsPerElement(); stiffness_.rows() < size)
      stiffness_.conservativeResizeLike(Eigen::MatrixXd::Zero(size, size));
  }
  kindAtHand_ = kind;
  return stiffness_;
}

/// Both triangles add up in the order of the elements: symmetric to the last digit.
void SubdomainAssembler::addStiffness(const StiffnessPattern& pattern, AssembledSubdomain& subdomain) {
  pattern.shape(subdomain.stiffness);
  double* values = subdomain.stiffness.valuePtr();
  for (std::size_t e = 0; e < kinds_.size(); ++e) {
    const double* entry = stiffnessOf(kinds_[e]).data();
    for (const int place : pattern.places(e)) {
      if (place >= 0)
        values[place] += *entry;
      ++entry;
    }
  }
}

void SubdomainAssembler::addLoads(const LocalNumbering& numbering, AssembledSubdomain& subdomain) {
  subdomain.data.load.setZero(subdomain.unknownPosition.size());
  subdomain.data.heldLoad = 0;
  const double* load = loads_.data();
  for (const int node : numbering.corners())
    for (std::size_t c = 0; c < components_; ++c, ++load) {
      const int unknown = subdomain.unknownOf[node * components_ + c];
      if (unknown >= 0)
        subdomain.data.load[unknown] += *load;
      else
        subdomain.data.heldLoad += std::abs(*load);
    }
}

/// What the supports hold: reactions, energies, and K_p and f_p.
void SubdomainAssembler::eliminate(const LocalNumbering& numbering, const StiffnessPattern& pattern,
                                   AssembledSubdomain& subdomain) {
  decomposition::SubdomainData& data = subdomain.data;
  data.reaction.setZero(data.load.size());
  data.heldWork = data.heldEnergy = 0;
  const std::vector<int>& positions = subdomain.held.positions;
  data.heldForces.setZero(std::ssize(positions));
  entries_.clear();
  for (const std::size_t e : pattern.supportedElements()) {
    const std::span<const int> nodes = numbering.elementNodes(e);
    const auto positionOf = [&](Eigen::Index value) {
      const std::size_t v = value;
      return nodes[v / components_] * components_ + v % components_;
    };
    const auto heldAt = [&](std::size_t position) { return data.prescribed[position]; };
    const Eigen::MatrixXd& k = stiffnessOf(kinds_[e]);
    const Eigen::Index size = std::ssize(nodes) * static_cast<Eigen::Index>(components_);
    for (Eigen::Index i = 0; i < size; ++i) {
      if (subdomain.unknownOf[positionOf(i)] >= 0)
        continue;
      const auto row =
          std::lower_bound(positions.begin(), positions.end(), positionOf(i)) - positions.begin();
      data.heldForces[row] += loads_(i, e);
      for (Eigen::Index j = 0; j < size; ++j)
        entries_.emplace_back(static_cast<int>(row), static_cast<int>(positionOf(j)), k(i, j));
    }
    for (Eigen::Index j = 0; j < size; ++j) {
      const double held = heldAt(positionOf(j)); // 0 at the free positions
      if (held == 0)
        continue;
      data.heldWork += loads_(j, e) * held;
      for (Eigen::Index i = 0; i < size; ++i) {
        const std::size_t other = positionOf(i);
        if (subdomain.unknownOf[other] >= 0)
          data.reaction[subdomain.unknownOf[other]] += k(i, j) * held;
        else
          data.heldEnergy += 0.5 * k(i, j) * held * heldAt(other);
      }
    }
  }
  decomposition::SparseMatrix rows(std::ssize(positions), std::ssize(subdomain.unknownOf));
  rows.setFromTriplets(entries_.begin(), entries_.end());
  subdomain.held.stiffness = std::make_shared<const decomposition::SparseMatrix>(std::move(rows));
}

AssembledSubdomain assemble(const BodyModel& model, std::span<const GlobalOrdinal> elements) {
  AssembledSubdomain subdomain;
  SubdomainAssembler(model).assemble(elements, subdomain);
  return subdomain;
}

} // namespace epafi::fem
