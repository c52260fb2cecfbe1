#include "epafi/mesh/ShapeFunctions.hpp"

#include "epafi/direct/DenseOrthogonal.hpp"
#include "epafi/mesh/PrismsAndPyramids.hpp"

#include <array>
#include <cmath>
#include <memory>

namespace epafi::mesh {
namespace {

/// L_0 … L_dim
template <int dim>
Eigen::Matrix<double, dim + 1, 1> barycentric(const Coordinates<dim>& xi) {
  Eigen::Matrix<double, dim + 1, 1> all;
  all << 1 - xi.sum(), xi;
  return all;
}

/// Their derivatives, a column each.
template <int dim>
Eigen::Matrix<double, dim, dim + 1> barycentricGradients() {
  Eigen::Matrix<double, dim, dim + 1> gradients;
  gradients << Coordinates<dim>::Constant(-1), Eigen::Matrix<double, dim, dim>::Identity();
  return gradients;
}

/// A rule that a simplex's symmetries do not change: the orbits of points with all barycentric coordinates
/// `a` but one, and (tetrahedra) of those with two of each value. Weights are shares of the reference
/// element's measure.
struct Orbit {
  double a, weight;
  bool isPaired = false; ///< a, a, ½ − a, ½ − a
};

template <int dim>
Rule<dim> ruleOf(double measure, std::initializer_list<Orbit> orbits) {
  Rule<dim> rule;
  const auto add = [&](const Eigen::Matrix<double, dim + 1, 1>& all, double weight) {
    rule.push_back({all.template tail<dim>(), weight * measure});
  };
  for (const Orbit& orbit : orbits)
    for (int i = 0; i <= dim; ++i) {
      Eigen::Matrix<double, dim + 1, 1> all;
      if (!orbit.isPaired) {
        all.setConstant(orbit.a);
        all[i] = 1 - dim * orbit.a;
        add(all, orbit.weight);
      }
      for (int j = 0; j < i && orbit.isPaired; ++j) {
        all.setConstant(0.5 - orbit.a);
        all[i] = all[j] = orbit.a;
        add(all, orbit.weight);
      }
    }
  return rule;
}

/// Degree 2 on triangles, 3 on tetrahedra (Walkington 2000); of an edge three Gauss points, degree 5.
template <int dim>
Rule<dim> lowDegree(double measure) {
  if constexpr (dim == 1) {
    const double away = 0.5 * std::sqrt(0.6);
    return {{Coordinates<1>(0.5 - away), 5.0 / 18},
            {Coordinates<1>(0.5), 8.0 / 18},
            {Coordinates<1>(0.5 + away), 5.0 / 18}};
  } else if constexpr (dim == 2) {
    return ruleOf<2>(measure, {{1.0 / 6, 1.0 / 3}});
  } else {
    return ruleOf<3>(measure, {{0.32805469671142664734, 6 * 0.02308799441864369039},
                               {0.10695227393293068277, 6 * 0.01857867224802297628}});
  }
}

/// Two Gauss points of an edge; nothing of triangles and tetrahedra, which have no axes.
template <int dim>
Rule<dim> reducedRule() {
  const double away = 0.5 / std::sqrt(3.0);
  if constexpr (dim == 1)
    return {{Coordinates<1>(0.5 - away), 0.5}, {Coordinates<1>(0.5 + away), 0.5}};
  else
    return {};
}

/// Degree 4 on triangles (Strang, Fix 1973), 5 on tetrahedra (Walkington 2000); all weights are positive.
/// None of an edge, where the other rule is as good.
template <int dim>
Rule<dim> highDegree(double measure) {
  if constexpr (dim == 1)
    return {};
  else if constexpr (dim == 2)
    return ruleOf<2>(
        measure, {{0.44594849091596489, 0.22338158967801147}, {0.091576213509770743, 0.10995174365532187}});
  else
    return ruleOf<3>(measure, {{0.31088591926330060980, 0.11268792571801585080},
                               {0.092735250310891226402, 0.073493043116361949544},
                               {0.045503704125649649492, 0.042546020777081466438, true}});
}

/// As many Gauss points along each axis as a brick has nodes there, 2 or 3.
/// \param nodes  all of them, a column each
template <int dim>
Rule<dim> productRule(const NodalColumns<dim>& nodes) {
  const bool isLinear = nodes.cols() == 1 << dim;
  const double away = isLinear ? 1 / std::sqrt(3.0) : std::sqrt(0.6);
  Rule<dim> rule;
  for (const Coordinates<dim> at : nodes.colwise()) {
    double weight = 1;
    for (int i = 0; i < dim && !isLinear; ++i)
      weight *= at[i] == 0 ? 8.0 / 9 : 5.0 / 9;
    rule.push_back({away * at, weight});
  }
  return rule;
}

/// The order's function that is 1 at −1, 0 or 1 (`place` = −1, 0, 1) and 0 at the other nodes, and its
/// derivative.
double along(int order, double place, double x) {
  if (order == 1)
    return 0.5 * (1 + place * x);
  return place == 0 ? (1 - x) * (1 + x) : 0.5 * x * (x + place);
}
double slope(int order, double place, double x) {
  if (order == 1)
    return 0.5 * place;
  return place == 0 ? -2 * x : x + 0.5 * place;
}

double measureOfReference(int dim, int corners) {
  constexpr std::array solids{1.0 / 6, 4.0 / 3, 1.0, 0.0, 8.0}; // of 4 to 8 corners
  return dim == 1 ? 1 : dim == 2 ? (corners == 3 ? 0.5 : 4) : solids[corners - 4];
}

template <int dim>
std::vector<ShapeSample<dim>> samplesOf(const Shape<dim>& shape, const Rule<dim>& rule) {
  std::vector<ShapeSample<dim>> samples;
  for (const auto& [xi, weight] : rule)
    samples.push_back(shape.sampleAt(xi, weight));
  return samples;
}

} // namespace

template <int dim>
Shape<dim>::Shape(CellType shapeType)
    : type(shapeType), isSimplex(numCornersOf(type) == dim + 1),
      isBrick(!isSimplex && numCornersOf(type) == 1 << dim), order(orderOf(type)), numNodes(numNodesOf(type)),
      measure(measureOfReference(dim, numCornersOf(type))) {
  placeNodes();
  findFollowers();
  Coordinates<dim> centre = Coordinates<dim>::Constant(isSimplex ? 1.0 / (dim + 1) : 0.0);
  if constexpr (dim == 3)
    if (!isSimplex && !isBrick)
      centre = numCornersOf(type) == 5 ? Coordinates<3>(0, 0, 0.25) : Coordinates<3>(1.0 / 3, 1.0 / 3, 0);
  centreSample_ = sampleAt(centre, measure);
  setSamples();
  for (int a = 0; a < numNodes; ++a)
    nodeSamples_.push_back(sampleAt(node(a)));
}

template <int dim>
void Shape<dim>::setSamples() {
  if (isBrick) {
    gaussSamples_ = samplesOf(*this, productRule<dim>(nodes_));
    if (order == 2)
      reducedSamples_ = samplesOf(*this, productRule<dim>(nodes_.leftCols(1 << dim)));
  } else if (isSimplex && order == 1) {
    gaussSamples_ = {centreSample_};
    revolvedSamples_ = samplesOf(*this, dim == 1 ? lowDegree<dim>(measure) : highDegree<dim>(measure));
  } else if (isSimplex) {
    gaussSamples_ = samplesOf(*this, lowDegree<dim>(measure));
    fineSamples_ = samplesOf(*this, highDegree<dim>(measure));
    reducedSamples_ = samplesOf(*this, reducedRule<dim>());
  } else if constexpr (dim == 3) {
    const Rule<2> centre{{Coordinates<2>::Constant(1.0 / 3), 0.5}}, low = lowDegree<2>(0.5);
    if (numCornersOf(type) == 5) {
      gaussSamples_ = samplesOf(*this, pyramidRule(order));
    } else {
      gaussSamples_ = samplesOf(*this, prismRule(order, order == 1 ? low : highDegree<2>(0.5)));
      reducedSamples_ = samplesOf(*this, prismRule(order, order == 1 ? centre : low));
    }
    if (order == 1)
      return;
    const Shape<3> linear(withOrder(type, 1));
    Eigen::MatrixXd atSamples(gaussSamples_.size(), linear.numNodes), atNodes(numNodes, linear.numNodes);
    for (Eigen::Index g = 0; g < atSamples.rows(); ++g)
      atSamples.row(g) = linear.values(gaussSamples_[g].xi).transpose();
    for (int a = 0; a < numNodes; ++a)
      atNodes.row(a) = linear.values(node(a)).transpose();
    fromGaussToNodes_ =
        atNodes *
        direct::leastSquares(atSamples, Eigen::MatrixXd::Identity(atSamples.rows(), atSamples.rows()));
  }
}

/// Corners, then the middles of edges, faces, and the whole: what lies between corners is half their sum.
template <int dim>
void Shape<dim>::placeNodes() {
  const int number = numNodesOf(withInnerNodes(type));
  nodes_.setZero(dim, number);
  const int corners = numCornersOf(type);
  for (int a = 0; a < corners; ++a)
    if (isSimplex) {
      if (a > 0)
        nodes_(a - 1, a) = 1;
    } else if (corners == 6) {
      if (a % 3 > 0)
        nodes_(a % 3 - 1, a) = 1;
      nodes_(dim - 1, a) = a < 3 ? -1 : 1;
    } else if (corners == 5 && a == 4) {
      nodes_(dim - 1, a) = 1;
    } else {
      const int around = a % 4; // counter-clockwise in the plane, then the same above
      nodes_(0, a) = around == 1 || around == 2 ? 1 : -1;
      nodes_(dim > 1 ? 1 : 0, a) = around >= 2 ? 1 : -1;
      if constexpr (dim == 3)
        nodes_(2, a) = corners == 5 ? 0 : a >= 4 ? 1 : -1;
    }
  if (order == 1)
    return;
  const auto ends = edgesOf(withOrder(type, 1));
  const int edges = static_cast<int>(ends.size()) / 2;
  for (int e = 0; e < edges; ++e)
    nodes_.col(corners + e) = 0.5 * (nodes_.col(ends[2 * e]) + nodes_.col(ends[2 * e + 1]));
  for (int face = 0; corners + edges + face < number && face < 6 && dim == 3; ++face)
    nodes_(face / 2, corners + edges + face) = face % 2 == 0 ? -1 : 1;
}

/// The middle of a face, or of the whole, follows the corners and edges around.
template <int dim>
void Shape<dim>::findFollowers() {
  followers_.setZero(numNodes, nodes_.cols() - numNodes);
  for (Eigen::Index inner = 0; inner < followers_.cols(); ++inner) {
    const Coordinates<dim> place = nodes_.col(numNodes + inner);
    const auto free = static_cast<int>((place.array() == 0).count()); // dimension of what it is the middle of
    for (int a = 0; a < numNodes; ++a)
      if (((nodes_.col(a) - place).array() * place.array() == 0).all())
        followers_(a, inner) = a < numCornersOf(type) ? cornerInMiddle : edgeInMiddle(free);
  }
}

template <int dim>
NodalValues Shape<dim>::values(const Coordinates<dim>& xi) const {
  NodalValues all = valuesOfAll(xi);
  if (followers_.cols() == 0)
    return all;
  return all.head(numNodes) + followers_.lazyProduct(all.tail(followers_.cols()));
}

template <int dim>
NodalColumns<dim> Shape<dim>::gradients(const Coordinates<dim>& xi) const {
  NodalColumns<dim> all = gradientsOfAll(xi);
  if (followers_.cols() == 0)
    return all;
  return all.leftCols(numNodes) + all.rightCols(followers_.cols()).lazyProduct(followers_.transpose());
}

/// Of inner nodes too that the shape has not.
template <int dim>
NodalValues Shape<dim>::valuesOfAll(const Coordinates<dim>& xi) const {
  NodalValues values(nodes_.cols());
  if constexpr (dim == 3)
    if (!isSimplex && !isBrick) {
      values = jetsOf(type, nodes_, xi).row(0).transpose();
      return values;
    }
  if (!isSimplex) {
    for (int a = 0; a < nodes_.cols(); ++a) {
      double product = 1;
      for (int i = 0; i < dim; ++i)
        product *= along(order, nodes_(i, a), xi[i]);
      values[a] = product;
    }
    return values;
  }
  const auto all = barycentric<dim>(xi);
  if (order == 1) {
    values = all;
    return values;
  }
  values.template head<dim + 1>() = (all.array() * (2 * all.array() - 1)).matrix();
  const auto ends = edgesOf(type);
  for (int e = 0; 2 * e < std::ssize(ends); ++e)
    values[dim + 1 + e] = 4 * all[ends[2 * e]] * all[ends[2 * e + 1]];
  return values;
}

template <int dim>
NodalColumns<dim> Shape<dim>::gradientsOfAll(const Coordinates<dim>& xi) const {
  NodalColumns<dim> gradients(dim, nodes_.cols());
  if constexpr (dim == 3)
    if (!isSimplex && !isBrick) {
      gradients = jetsOf(type, nodes_, xi).template bottomRows<3>();
      return gradients;
    }
  if (!isSimplex) {
    for (int a = 0; a < nodes_.cols(); ++a)
      for (int i = 0; i < dim; ++i) {
        double product = 1;
        for (int k = 0; k < dim; ++k)
          product *= k == i ? slope(order, nodes_(k, a), xi[k]) : along(order, nodes_(k, a), xi[k]);
        gradients(i, a) = product;
      }
    return gradients;
  }
  const auto ofAll = barycentricGradients<dim>();
  if (order == 1) {
    gradients = ofAll;
    return gradients;
  }
  const auto all = barycentric<dim>(xi);
  for (int a = 0; a <= dim; ++a)
    gradients.col(a) = (4 * all[a] - 1) * ofAll.col(a);
  const auto ends = edgesOf(type);
  for (int e = 0; 2 * e < std::ssize(ends); ++e) {
    const int a = ends[2 * e], b = ends[2 * e + 1];
    gradients.col(dim + 1 + e) = 4 * (all[a] * ofAll.col(b) + all[b] * ofAll.col(a));
  }
  return gradients;
}

template <int dim>
const Shape<dim>& referenceShape(CellType type) {
  static const auto shapes = [] {
    std::array<std::unique_ptr<const Shape<dim>>, static_cast<std::size_t>(CellType::hexahedron20) + 1> all;
    for (std::size_t number = 0; number < all.size(); ++number)
      if (const auto known = static_cast<CellType>(number); dimensionOf(known) == dim)
        all[number] = std::make_unique<const Shape<dim>>(known);
    return all;
  }();
  assert(dimensionOf(type) == dim);
  return *shapes[static_cast<std::size_t>(type)];
}

template class Shape<1>;
template class Shape<2>;
template class Shape<3>;
template const Shape<1>& referenceShape(CellType type);
template const Shape<2>& referenceShape(CellType type);
template const Shape<3>& referenceShape(CellType type);

} // namespace epafi::mesh
