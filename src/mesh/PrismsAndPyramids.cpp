#include "epafi/mesh/PrismsAndPyramids.hpp"

#include <array>

namespace epafi::mesh {
namespace {

/// A function in space: its value, and below it its gradient.
using Jet = Eigen::Vector4d;

Jet product(const Jet& a, const Jet& b) {
  Jet result = a[0] * b + b[0] * a;
  result[0] = a[0] * b[0];
  return result;
}

/// Σ N_a e_aᵀ of a prism: L_i (1 ± ζ)/2, less what the middles of edges have.
NodalColumns<4> prismJets(CellType type, const Coordinates<3>& xi) {
  const std::array<Jet, 3> l{Jet(1 - xi[0] - xi[1], -1, -1, 0), Jet(xi[0], 1, 0, 0), Jet(xi[1], 0, 1, 0)};
  const std::array<Jet, 2> along{Jet(0.5 * (1 - xi[2]), 0, 0, -0.5), Jet(0.5 * (1 + xi[2]), 0, 0, 0.5)};
  NodalColumns<4> jets(4, numNodesOf(type));
  for (int a = 0; a < 6; ++a)
    jets.col(a) = product(l[a % 3], along[a / 3]);
  const auto ends = edgesOf(type);
  for (int e = 0; 6 + e < jets.cols(); ++e) {
    const int a = ends[2 * e], b = ends[2 * e + 1];
    jets.col(6 + e) = 4 * product(jets.col(a), a % 3 == b % 3 ? along[1] : l[b % 3]);
  }
  for (int e = 0; 6 + e < jets.cols(); ++e)
    for (const int end : ends.subspan(2 * e, 2))
      jets.col(end) -= 0.5 * jets.col(6 + e);
  return jets;
}

/// Of a pyramid: with r = 1 − ζ, of order 1 (r + ξ_aξ)(r + η_aη)/4r and ζ. At the top, where the gradient
/// depends on where one comes from, that along the axis.
NodalColumns<4> pyramidJets(CellType type, const NodalColumns<3>& nodes, const Coordinates<3>& xi) {
  const double r = 1 - xi[2], x = r > 0 ? xi[0] / r : 0, y = r > 0 ? xi[1] / r : 0;
  const Jet top(xi[2], 0, 0, 1);
  NodalColumns<4> jets(4, nodes.cols());
  for (int a = 0; a < 4; ++a) {
    const double alongX = 1 + nodes(0, a) * x, alongY = 1 + nodes(1, a) * y;
    jets.col(a) = 0.25 * Jet(r * alongX * alongY, nodes(0, a) * alongY, nodes(1, a) * alongX,
                             (alongX - 1) * (alongY - 1) - 1);
  }
  jets.col(4) = top;
  const auto ends = edgesOf(type);
  for (int e = 0; 5 + e < jets.cols(); ++e) {
    const int a = ends[2 * e], b = ends[2 * e + 1];
    const Coordinates<3> half = 0.5 * (nodes.col(b) - nodes.col(a));
    jets.col(5 + e) = b == 4 ? Jet(4 * product(jets.col(a), top))
                             : Jet(2 * product(jets.col(a), {r + half.dot(xi), half[0], half[1], -1}));
  }
  for (int e = 0; 5 + e < jets.cols(); ++e)
    for (const int end : ends.subspan(2 * e, 2))
      jets.col(end) -= 0.5 * jets.col(5 + e);
  return jets;
}

/// Points and weights on [−1, 1], as many as `order` + 1.
constexpr std::array<std::array<double, 2>, 3> gaussOf(int order) {
  if (order == 1)
    return {{{-0.57735026918962576, 1}, {0.57735026918962576, 1}, {0, 0}}};
  return {{{-0.7745966692414834, 5.0 / 9}, {0, 8.0 / 9}, {0.7745966692414834, 5.0 / 9}}};
}

} // namespace

NodalColumns<4> jetsOf(CellType type, const NodalColumns<3>& nodes, const Coordinates<3>& xi) {
  return numCornersOf(type) == 5 ? pyramidJets(type, nodes, xi) : prismJets(type, xi);
}

Rule<3> prismRule(int order, const Rule<2>& triangle) {
  Rule<3> rule;
  for (int k = 0; k <= order; ++k)
    for (const auto& [xi, weight] : triangle) {
      const auto [at, share] = gaussOf(order)[k];
      rule.push_back({{xi[0], xi[1], at}, weight * share});
    }
  return rule;
}

Rule<3> pyramidRule(int order) {
  constexpr std::array<std::array<std::array<double, 2>, 3>, 2> heights{
      // of ∫ … r² dr on [0, 1], r = 1 − ζ
      {{{{0.4558481559887747112, 0.1007858820798254306},
         {0.8774851773445586221, 0.2325474512535079027},
         {0, 0}}},
       {{{0.2949977901115016169, 0.02995070300858069801},
         {0.6529962339616481153, 0.146246269259866022},
         {0.9270059759268502678, 0.1571363610648866133}}}}};
  Rule<3> rule;
  for (int k = 0; k <= order; ++k)
    for (int j = 0; j <= order; ++j)
      for (int i = 0; i <= order; ++i) {
        const auto [r, share] = heights[order - 1][k];
        const auto [x, ofX] = gaussOf(order)[i];
        const auto [y, ofY] = gaussOf(order)[j];
        rule.push_back({{r * x, r * y, 1 - r}, share * ofX * ofY});
      }
  return rule;
}

} // namespace epafi::mesh
