#pragma once

/// (B_F B_Fᵀ)⁺ of the rows of an equality constraint on a face, which may depend on each other there.

#include "epafi/base/Types.hpp"
#include "epafi/qp/constraints/Face.hpp"

#include <span>

namespace epafi::qp {

/// A generalised inverse N⁻ of N = B_F B_Fᵀ, B_F = BZ (Face.hpp): N N⁻ N = N, symmetric. B_FᵀN⁻B_F does not
/// depend on the choice.
class FaceInverse {
public:
  virtual ~FaceInverse() = default;
  /// From now on this is the face. Collective.
  virtual void setFace(const Face& face) = 0;
  /// μ = N⁻ b; motions that the face leaves free are at rest where it says. Collective.
  virtual void apply(std::span<const double> b, std::span<double> mu) const = 0;
};

} // namespace epafi::qp
