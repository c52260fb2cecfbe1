#include "epafi/fem/FacetFunctions.hpp"

#include <Eigen/LU>

#include <cmath>
#include <map>
#include <memory>
#include <numeric>

namespace epafi::fem {
namespace {

using mesh::CellType;

/// Bernstein's functions, a column each, at the nodes of an edge or triangle.
Eigen::MatrixXd bernsteinAtNodes(CellType simplex) {
  const Eigen::Index number = numNodesOf(simplex), corners = numCornersOf(simplex);
  Eigen::MatrixXd values = Eigen::MatrixXd::Identity(number, number);
  const auto ends = edgesOf(simplex);
  for (Eigen::Index middle = corners; middle < number; ++middle) {
    values(middle, middle) = 0.5;
    for (Eigen::Index end = 0; end < 2; ++end)
      values(middle, ends[2 * (middle - corners) + end]) = 0.25;
  }
  return values;
}

/// Coefficients of the functions of a quadrilateral in those of the triangle of its k-th edge and the middle.
Eigen::MatrixXd triangleCoefficients(CellType facet, Eigen::Index k) {
  const Eigen::Index next = (k + 1) % 4;
  if (orderOf(facet) == 1) {
    Eigen::MatrixXd rows = Eigen::MatrixXd::Zero(3, 4);
    rows(0, k) = rows(1, next) = 1;
    rows.row(2).setConstant(0.25);
    return rows;
  }
  Eigen::MatrixXd rows = Eigen::MatrixXd::Zero(6, 9);
  rows(0, k) = rows(1, next) = rows(3, 4 + k) = 1;
  rows.row(2) << 0.0625, 0.0625, 0.0625, 0.0625, 0.125, 0.125, 0.125, 0.125, 0.25;
  rows(4, 4 + k) = rows(4, 4 + next) = 0.5;
  rows(5, 4 + k) = rows(5, 4 + (k + 3) % 4) = 0.5;
  return rows;
}

/// Points of the unit simplex and weights, for degree 6.
template <int dim>
std::vector<std::pair<mesh::Coordinates<dim>, double>> simplexRule() {
  std::vector<std::pair<mesh::Coordinates<dim>, double>> rule;
  for (const auto& [x, a] : fourGauss) {
    if constexpr (dim == 1)
      rule.emplace_back(mesh::Coordinates<1>(x), a);
    else
      for (const auto& [y, b] : fourGauss)
        rule.emplace_back(mesh::Coordinates<2>(x, (1 - x) * y), a * b * (1 - x));
  }
  return rule;
}

template <int dim>
void integrate(CellType facet, FacetFunctions& functions) {
  const mesh::Shape<dim>& shape = mesh::referenceShape<dim>(facet);
  const mesh::Shape<dim>& part =
      mesh::referenceShape<dim>(withOrder(dim == 1 ? CellType::line : CellType::triangle, shape.order));
  functions.moments = Eigen::MatrixXd::Zero(shape.numNodes, shape.numNodes);
  for (const FacetFunctions::Piece& piece : functions.pieces) {
    const auto corner = [&](std::size_t i) -> mesh::Coordinates<dim> {
      if (piece.corners[i] == numCornersOf(facet))
        return shape.centre();
      return shape.node(piece.corners[i]);
    };
    Eigen::Matrix<double, dim, dim> jacobian;
    for (int i = 0; i < dim; ++i)
      jacobian.col(i) = corner(i + 1) - corner(0);
    for (const auto& [xi, weight] : simplexRule<dim>()) {
      const mesh::Coordinates<dim> at = corner(0) + jacobian * xi;
      const Eigen::VectorXd values = piece.values.transpose() * part.values(xi), nodal = shape.values(at);
      const double share = weight * std::abs(jacobian.determinant()) / shape.measure;
      functions.moments += share * nodal * values.transpose();
    }
  }
}

FacetFunctions made(CellType facet) {
  FacetFunctions functions;
  const int corners = numCornersOf(facet), order = orderOf(facet);
  functions.atNodes = Eigen::MatrixXd::Identity(numNodesOf(facet), numNodesOf(facet));
  if (corners < 4) {
    functions.atNodes = bernsteinAtNodes(facet);
    functions.pieces.push_back({std::vector<int>(corners), functions.atNodes});
    std::iota(functions.pieces[0].corners.begin(), functions.pieces[0].corners.end(), 0);
  } else {
    for (int k = 0; k < corners; ++k) {
      const Eigen::MatrixXd values =
          bernsteinAtNodes(withOrder(CellType::triangle, order)) * triangleCoefficients(facet, k);
      functions.pieces.push_back({{k, (k + 1) % corners, corners}, values});
      if (order == 2) {
        functions.atNodes.row(4 + k) = values.row(3);
        functions.atNodes.row(8) = values.row(2);
      }
    }
  }
  if (corners == 2)
    integrate<1>(facet, functions);
  else
    integrate<2>(facet, functions);
  return functions;
}

} // namespace

const FacetFunctions& FacetFunctions::of(CellType facet) {
  static std::map<CellType, FacetFunctions> all;
  const auto found = all.find(facet);
  return found != all.end() ? found->second : all.emplace(facet, made(facet)).first->second;
}

} // namespace epafi::fem
