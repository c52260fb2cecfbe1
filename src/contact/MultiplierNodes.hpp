#pragma once

/// Which nodes of a surface have multipliers, where another surface covers only a part of it.

#include "epafi/contact/MortarIntegrals.hpp"
#include "epafi/contact/SurfaceNodes.hpp"

#include <Eigen/Core>

#include <cstddef>
#include <functional>
#include <limits>
#include <map>
#include <vector>

namespace epafi::contact {

class MultiplierNodes {
public:
  static constexpr std::size_t none = std::numeric_limits<std::size_t>::max();

  /// Keeps references. \param bases dualBases() of the surface \param facets what of the surface is covered
  MultiplierNodes(const SurfaceNodes& nodes, const std::map<std::size_t, Eigen::MatrixXd>& bases,
                  const std::vector<MortarFacet>& facets);

  /// The place of the node whose multiplier each node's N̂ belongs to: itself, if the other surface reaches
  /// it, or the nearest one in steps from facet to facet; `none` where nothing is covered. Where less than a
  /// facet is covered, so that no node is reached, the node that is covered most has one.
  /// \param isHeld  whether a place may have no multiplier
  /// \param holdTurns  whether they must hinder all turns of the surfaces, as ties do: where those with
  /// multipliers would lie in one point, or in space on one line, all that are covered enough have some,
  /// those that are held, too, where the others do not do
  [[nodiscard]] std::vector<std::size_t> representatives(const std::function<bool(std::size_t)>& isHeld,
                                                         bool holdTurns) const;

private:
  void spread(std::vector<std::size_t>& representative) const;
  [[nodiscard]] std::vector<std::vector<std::size_t>> patches() const;
  [[nodiscard]] double width(const std::vector<std::size_t>& places) const;

  const SurfaceNodes& nodes_;
  const std::vector<MortarFacet>& facets_;
  std::vector<double> coverage_; ///< of each node's N̂, the covered share
};

} // namespace epafi::contact
