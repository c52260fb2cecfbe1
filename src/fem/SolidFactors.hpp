#pragma once

/// By what the stiffness of a body is multiplied, from node to node.

#include "epafi/fem/SolidBody.hpp"

#include <map>
#include <vector>

namespace epafi::fem {

class SolidFactors {
public:
  /// \throws InputError if a factor names a surface or set of nodes that is not there, the body is a
  /// membrane, or the factors at the nodes of one element differ by so much that they are not positive in
  /// between.
  explicit SolidFactors(const SolidBody& body);

  /// At the nodes of an element; empty of a body without factors.
  void of(const mesh::Mesh& mesh, GlobalOrdinal element, std::vector<double>& factors) const;

private:
  bool hasAny_;
  std::map<GlobalOrdinal, double> factors_; ///< where they are not 1
};

} // namespace epafi::fem
