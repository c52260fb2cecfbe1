#include "epafi/accuracy/PatchFlux.hpp"

#include "epafi/direct/DenseSymmetric.hpp"
#include "epafi/fem/FluxIntegrals.hpp"
#include "epafi/mesh/ShapeFunctions.hpp"

#include <algorithm>
#include <array>
#include <numeric>

namespace epafi::accuracy {
namespace {

using decomposition::Subdomain;

/// What a patch's polynomial is made of, the constant first.
class Monomials {
public:
  Monomials(int dimension, bool areProducts) {
    for (int code = 0; code < mesh::power(3, dimension); ++code) {
      const std::array<int, 3> powers{code % 3, code / 3 % 3, code / 9};
      if (areProducts || std::accumulate(powers.begin(), powers.end(), 0) <= 2)
        powers_.push_back(powers);
    }
  }
  [[nodiscard]] Eigen::Index size() const { return std::ssize(powers_); }
  [[nodiscard]] bool isBent(Eigen::Index k) const {
    return std::accumulate(powers_[k].begin(), powers_[k].end(), 0) > 1;
  }
  /// \param values  overwritten; as many as there are
  void at(const Eigen::Vector3d& x, Eigen::VectorXd& values) const {
    const std::array<Eigen::Vector3d, 3> to{Eigen::Vector3d::Ones(), x, x.cwiseAbs2()};
    for (Eigen::Index k = 0; k < size(); ++k)
      values[k] = to[powers_[k][0]][0] * to[powers_[k][1]][1] * to[powers_[k][2]][2];
  }

private:
  std::vector<std::array<int, 3>> powers_;
};

bool isOfBricks(const BodyElements& body) {
  const mesh::CellType type = mesh::withInnerNodes(body.cellType());
  return type == mesh::CellType::quadrilateral9 || type == mesh::CellType::hexahedron27;
}

Monomials monomialsOf(const BodyElements& body) {
  return {dimensionOf(body.cellType()), isOfBricks(body)};
}

Eigen::Index numMoments(Eigen::Index monomials) {
  return monomials * (monomials + 1) / 2;
}

/// From the first of some points to another one.
Eigen::Vector3d wayTo(std::span<const Point> points, std::size_t place, int dimension) {
  Eigen::Vector3d way(0, 0, 0);
  for (int i = 0; i < dimension; ++i)
    way[i] = points[place][i] - points[0][i];
  return way;
}

/// The polynomial of a patch, from its sums: a row a monomial. Monomials are scaled to the same size over the
/// patch; pivots tell how far each is from the others.
Eigen::MatrixXd fitted(const Monomials& monomials, const Eigen::Ref<const Eigen::VectorXd>& sums,
                       Eigen::Index numFluxes) {
  constexpr double least = 1e-3;
  const Eigen::Index n = monomials.size();
  Eigen::MatrixXd matrix(n, n);
  for (Eigen::Index j = 0, k = 0; j < n; ++j)
    for (Eigen::Index i = 0; i <= j; ++i, ++k)
      matrix(j, i) = matrix(i, j) = sums[k];
  const Eigen::VectorXd scale = matrix.diagonal().cwiseSqrt().cwiseInverse();
  matrix = (scale.asDiagonal() * matrix * scale.asDiagonal()).eval();
  Eigen::MatrixXd polynomial =
      scale.asDiagonal() * sums.segment(numMoments(n), n * numFluxes).reshaped(n, numFluxes);
  auto factor = direct::choleskyFactor(matrix);
  const auto soften = [&](bool areBent) {
    for (Eigen::Index k = 1; k < n; ++k)
      matrix(k, k) += monomials.isBent(k) == areBent ? least : 0;
    factor = direct::choleskyFactor(matrix);
  };
  if (!factor || factor->diagonal().cwiseAbs2().minCoeff() < least)
    soften(true);
  if (!factor) // flat elements, which do not tell what is linear either
    soften(false);
  factor->triangularView<Eigen::Lower>().solveInPlace(polynomial);
  factor->triangularView<Eigen::Lower>().transpose().solveInPlace(polynomial);
  return scale.asDiagonal() * polynomial;
}

} // namespace

std::size_t numPatchSums(const BodyElements& body, int numFluxes) {
  const Eigen::Index n = monomialsOf(body).size();
  return numMoments(n) + n * numFluxes;
}

FluxPatches sumPatches(const BodyElements& body, const Subdomain& subdomain,
                       const Eigen::VectorXd& displacement, const SubdomainFlux& flux, std::size_t rows) {
  const Monomials monomials = monomialsOf(body);
  const int dimension = dimensionOf(body.cellType()), numFluxes = fem::numFluxes(body.physics());
  const Eigen::Index n = monomials.size();
  const std::span<const int> slots = flux.cornerSlots();
  const std::size_t perElement = flux.elements.numbering->nodesPerElement();
  FluxPatches patches{{}, std::vector<int>(flux.values.cols(), -1)};
  int number = 0;
  const auto forEachCorner = [&](const ElementView& element, const auto& action) {
    for (int a = 0; a < numCornersOf(body.typeOf(element)); ++a)
      action(a, patches.ofSlot[slots[element.number * perElement + a]]);
  };
  body.visit(subdomain, flux.elements, displacement, Points::shape, [&](const ElementView& element) {
    forEachCorner(element, [&](int /*corner*/, int& patch) { patch = patch < 0 ? number++ : patch; });
  });
  patches.sums.setZero(rows, number);
  Eigen::VectorXd values(n);
  fem::InnerFluxes inner;
  body.visit(subdomain, flux.elements, displacement, Points::shape, [&](const ElementView& element) {
    fem::innerFluxes(body.typeOf(element), element.points, body.physics(), body.materialOf(element.region),
                     element.displacements, inner, element.state);
    forEachCorner(element, [&](int corner, int patch) {
      const Eigen::Vector3d way = wayTo(element.points, corner, dimension);
      auto sums = patches.sums.col(patch);
      for (Eigen::Index point = 0; point < inner.places.cols(); ++point) {
        monomials.at(inner.places.col(point) - way, values);
        for (Eigen::Index j = 0, k = 0; j < n; k += ++j)
          sums.segment(k, j + 1) += values[j] * values.head(j + 1);
        for (int q = 0; q < numFluxes; ++q)
          sums.segment(numMoments(n) + q * n, n) += inner.fluxes(q, point) * values;
      }
    });
  });
  return patches;
}

void fitPatches(const BodyElements& body, const Subdomain& subdomain, const Eigen::VectorXd& displacement,
                FluxPatches& patches, SubdomainFlux& flux) {
  const Monomials monomials = monomialsOf(body);
  const int dimension = dimensionOf(body.cellType()), numFluxes = fem::numFluxes(body.physics());
  const Eigen::Index n = monomials.size();
  for (Eigen::Index patch = 0; patch < patches.sums.cols(); ++patch)
    patches.sums.col(patch).segment(numMoments(n), n * numFluxes) =
        fitted(monomials, patches.sums.col(patch), numFluxes).reshaped();
  const std::span<const int> slots = flux.cornerSlots();
  const std::size_t perElement = flux.elements.numbering->nodesPerElement();
  flux.values.setZero();
  Eigen::VectorXd values(n);
  body.visit(subdomain, flux.elements, displacement, Points::shape, [&](const ElementView& element) {
    const int* const own = &slots[element.number * perElement];
    const Eigen::MatrixXd& shares = mesh::cornerShares(body.typeOf(element));
    for (std::size_t i = 0; i < element.nodes.size(); ++i) {
      auto value = flux.values.col(own[i]);
      if (value[numFluxes] != 0)
        continue;
      value[numFluxes] = 1;
      for (Eigen::Index a = 0; a < shares.cols(); ++a) {
        if (shares(i, a) == 0)
          continue;
        monomials.at(wayTo(element.points, i, dimension) - wayTo(element.points, a, dimension), values);
        const Eigen::Map<const Eigen::MatrixXd> polynomial(
            patches.sums.col(patches.ofSlot[own[a]]).data() + numMoments(n), n, numFluxes);
        value.head(numFluxes) += shares(i, a) * polynomial.transpose() * values;
      }
    }
  });
}

} // namespace epafi::accuracy
