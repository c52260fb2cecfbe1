#include "epafi/accuracy/Quantity.hpp"

#include "epafi/accuracy/PointLocation.hpp"
#include "epafi/base/AccurateSum.hpp"
#include "epafi/base/Collective.hpp"
#include "epafi/base/Errors.hpp"
#include "epafi/base/Text.hpp"
#include "epafi/mesh/ElementGeometry.hpp"

#include <algorithm>
#include <cmath>
#include <unordered_map>

namespace epafi::accuracy {
namespace {

/// How much of a node, as seen from an element, counts.
struct Weight {
  GlobalOrdinal element, node;
  double value;
};

std::vector<Weight> weightsOverSurface(const model::BodyLayout& body, const std::string& name,
                                       bool isOfRevolution) {
  const std::vector<std::string> names = body.mesh->surfaceNames();
  if (std::find(names.begin(), names.end(), name) == names.end())
    throw InputError("body '" + body.name + "' has no surface '" + name + "' to average a displacement over");
  const mesh::Surface surface = body.mesh->surface(name);
  std::vector<Weight> weights;
  std::vector<Point> points;
  std::vector<double> shares;
  double area = 0;
  for (std::size_t f = 0; f < surface.numFacets(); ++f) {
    const auto nodes = surface.facet(f);
    body.mesh->pointsAt(nodes, points);
    shares.resize(nodes.size());
    if (isOfRevolution)
      mesh::revolvedShares(surface.typeOf(f), points, shares);
    else
      mesh::nodalShares(surface.typeOf(f), points, shares);
    for (std::size_t a = 0; a < nodes.size(); ++a) {
      weights.push_back({surface.elements[f], nodes[a], shares[a]});
      area += shares[a];
    }
  }
  for (Weight& weight : weights)
    weight.value /= area;
  return weights;
}

/// Meshes of round bodies leave out points close to their border.
std::vector<Weight> weightsAtPoint(const model::BodyLayout& body, const Point& point) {
  const Location location = PointLocation(*body.mesh).find(point);
  const mesh::ElementNodes nodes(*body.mesh, location.element);
  std::vector<Point> points;
  body.mesh->elementPoints(location.element, points);
  std::vector<Weight> weights;
  Eigen::Vector3d found(0, 0, 0);
  for (std::size_t i = 0; i < nodes.size(); ++i) {
    weights.push_back({location.element, nodes[i], location.weights[i]});
    found += location.weights[i] * Eigen::Map<const Eigen::Vector3d>(points[i].data());
  }
  const auto [lower, upper] = mesh::boxOf(points);
  double size = 0;
  for (std::size_t d = 0; d < 3; ++d)
    size = std::max(size, upper[d] - lower[d]);
  constexpr double margin = 0.15; // a chord of an eighth of a circle leaves out 0.1 of its length
  if ((found - Eigen::Map<const Eigen::Vector3d>(point.data())).norm() > margin * size)
    throw InputError("the point " + text(point) + " of the quantity lies outside of body '" + body.name +
                     "'");
  return weights;
}

/// By how much more than recovered fluxes see of its error is estimated in an element.
double factorIn(const ErrorEstimate& estimate, std::size_t subdomain, std::size_t element) {
  const double seen = estimate.seen[subdomain][element];
  return seen > 0 ? std::sqrt(estimate.elements[subdomain][element] / seen) : 1;
}

/// Collective.
double largestOf(const Comm& comm, std::span<const Eigen::VectorXd> u) {
  double largest = 0;
  for (const Eigen::VectorXd& values : u)
    largest = values.size() > 0 ? std::max(largest, values.lpNorm<Eigen::Infinity>()) : largest;
  return maxOverRanks(comm, largest);
}

} // namespace

std::vector<Eigen::VectorXd> displacementWeights(const model::Decomposition& decomposition,
                                                 const DisplacementTerms& terms) {
  const model::BodyLayout& body = decomposition.bodies[terms.body];
  const std::vector<Weight> weights =
      terms.surface.empty()
          ? weightsAtPoint(body, terms.point)
          : weightsOverSurface(body, terms.surface, decomposition.problem.bodies[terms.body].isOfRevolution);
  const Eigen::Index components = decomposition.problem.components;
  const Eigen::VectorXd direction = components == 1
                                        ? Eigen::VectorXd::Ones(1)
                                        : Eigen::VectorXd(terms.direction.normalized().head(components));
  const auto& subdomains = decomposition.problem.subdomains;
  std::vector<Eigen::VectorXd> result;
  std::unordered_map<int, std::size_t> placeOf; // of this rank's parts of the body
  for (const decomposition::Subdomain& subdomain : subdomains) {
    if (subdomain.body == terms.body)
      placeOf.emplace(subdomain.number - body.firstSubdomain, result.size());
    result.emplace_back(Eigen::VectorXd::Zero(decomposition.problem.numPositions(subdomain)));
  }
  for (const Weight& weight : weights) {
    const auto found = placeOf.find(body.partition->partOf(weight.element));
    if (found == placeOf.end())
      continue;
    const std::vector<GlobalOrdinal>& nodes = subdomains[found->second].nodes;
    const auto place = std::lower_bound(nodes.begin(), nodes.end(), weight.node) - nodes.begin();
    result[found->second].segment(components * place, components) += weight.value * direction;
  }
  return result;
}

QuantityError quantityError(const Comm& comm, ErrorEstimator& estimator, const ErrorEstimate& ofSolution,
                            std::span<const Eigen::VectorXd> u, std::span<const Eigen::VectorXd> z) {
  QuantityError result;
  const double norm = ofSolution.energyNorm;
  result.dualNorm = estimator.normOf(z);
  double t = result.dualNorm > 0 && norm > 0 ? norm / result.dualNorm : 1.0;
  constexpr double most = 1e3; // where z is a rigid motion, without energy but for round-off
  const double largest[] = {largestOf(comm, u), largestOf(comm, z)};
  if (largest[0] > 0 && largest[1] > 0)
    t = std::min(t, most * largest[0] / largest[1]);
  const auto moved = [&](double factor) {
    std::vector<Eigen::VectorXd> sum;
    for (std::size_t s = 0; s < u.size(); ++s)
      sum.emplace_back(u[s] + factor * z[s]);
    return estimator(sum).seen;
  };
  const std::vector<std::vector<double>> up = moved(t), down = moved(-t);
  const bool isCorrected = estimator.correctsElements();
  const ErrorEstimate ofDual = isCorrected ? estimator(z) : ErrorEstimate();
  AccurateSum sums[2]; // e, |e|
  result.elements = up;
  for (std::size_t s = 0; s < up.size(); ++s)
    for (std::size_t e = 0; e < up[s].size(); ++e) {
      const double more = isCorrected ? factorIn(ofSolution, s, e) * factorIn(ofDual, s, e) : 1,
                   share = more * (up[s][e] - down[s][e]) / (4 * t);
      sums[0].add(share);
      sums[1].add(std::abs(share));
      result.elements[s][e] = std::abs(share);
    }
  sumOverRanks(comm, sums);
  result.error = sums[0].value();
  result.bar = sums[1].value();
  return result;
}

} // namespace epafi::accuracy
