#include "epafi/assembly/PairSearch.hpp"

#include "epafi/meshing/GmshSession.hpp"

#include <Eigen/Core>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <optional>
#include <utility>

namespace epafi::assembly {
namespace {

using meshing::GmshSession;
using FacePoint = GmshSession::FacePoint;
constexpr double infinity = std::numeric_limits<double>::infinity();

Eigen::Map<const Eigen::Vector3d> vectorOf(const Vector3& values) {
  return Eigen::Map<const Eigen::Vector3d>(values.data());
}

/// Points of a face at even distances of its parameters.
struct Samples {
  std::vector<double> parameters;
  std::vector<FacePoint> points;
  double sum = 0;        ///< of their stretches
  double du = 0, dv = 0; ///< distances
};

Samples samplesOf(const GmshSession& session, int face) {
  constexpr int perAxis = 24;
  const auto [u0, v0, u1, v1] = session.boundsOf(face);
  Samples samples{{}, {}, 0, (u1 - u0) / perAxis, (v1 - v0) / perAxis};
  for (int i = 0; i < perAxis; ++i)
    for (int j = 0; j < perAxis; ++j) {
      const double u = u0 + (i + 0.5) * samples.du, v = v0 + (j + 0.5) * samples.dv;
      if (session.isInside(face, u, v))
        samples.parameters.insert(samples.parameters.end(), {u, v});
    }
  samples.points = session.pointsOf(face, samples.parameters);
  for (const FacePoint& point : samples.points)
    samples.sum += point.stretch;
  return samples;
}

/// Whether boxes are at most so far apart along each axis.
bool areNear(const mesh::Box& a, const mesh::Box& b, double distance) {
  for (std::size_t d = 0; d < 3; ++d)
    if (a.lower[d] > b.upper[d] + distance || b.lower[d] > a.upper[d] + distance)
      return false;
  return true;
}

class FaceSearch {
public:
  FaceSearch(const GmshSession& session, const PairSearch& search, const Assembly& assembly)
      : session_(session), assembly_(assembly), distance_(search.distanceIn(assembly)),
        opposed_(-std::cos(search.angle * std::numbers::pi / 180)), samples_(assembly.faces.size()),
        boxes_(assembly.faces.size()) {
    for (std::size_t f = 0; f < boxes_.size(); ++f)
      boxes_[f] = session.boxOf(2, assembly.faces[f].number);
  }

  /// Adds the pair to one of the assembly's lists if the faces are near.
  void look(int a, int b, Assembly& result);

private:
  [[nodiscard]] double reach() const { return nearMissFactor * distance_; }
  /// Gaps between points and what lies opposite on a face, negative where solids overlap; infinite if nothing
  /// does within reach.
  [[nodiscard]] std::vector<double> gapsOf(const std::vector<FacePoint>& points, int face) const;
  /// Takes the gap of least magnitude, and its place, from a sample on in smaller and smaller steps.
  void descend(const FacePair& pair, std::size_t sample, double& gap, Point& place) const;

  const GmshSession& session_;
  const Assembly& assembly_;
  double distance_, opposed_;
  std::vector<std::optional<Samples>> samples_;
  std::vector<mesh::Box> boxes_;
};

std::vector<double> FaceSearch::gapsOf(const std::vector<FacePoint>& points, int face) const {
  std::vector<double> gaps(points.size(), infinity);
  std::vector<Point> places;
  for (const FacePoint& point : points)
    places.push_back(point.point);
  const int number = assembly_.faces[face].number;
  const std::vector<Point> closest = session_.closestOn(number, places);
  for (std::size_t i = 0; i < points.size(); ++i) {
    const Eigen::Vector3d way = vectorOf(closest[i]) - vectorOf(points[i].point);
    if (way.norm() > reach() || !areNear({closest[i], closest[i]}, boxes_[face], 1e-3 * distance_))
      continue; // Gmsh takes a millisecond to find no parameters
    const auto foot = session_.parametersOf(number, closest[i]);
    if (!foot)
      continue;
    const auto [u, v] = *foot;
    const auto normal = vectorOf(points[i].normal);
    if (normal.dot(vectorOf(session_.pointsOf(number, {u, v}).front().normal)) <= opposed_ &&
        session_.isInside(number, u, v))
      gaps[i] = std::copysign(way.norm(), way.dot(normal));
  }
  return gaps;
}

void FaceSearch::descend(const FacePair& pair, std::size_t sample, double& gap, Point& place) const {
  const int number = assembly_.faces[pair.first].number;
  const Samples& samples = *samples_[pair.first];
  double u = samples.parameters[2 * sample], v = samples.parameters[2 * sample + 1];
  constexpr int halvings = 12;
  const double rounding = 1e-9 * distance_;
  for (double step = 0.5; step > std::pow(0.5, halvings);) {
    const double lastU = u, lastV = v;
    for (int i = -1; i <= 1; ++i)
      for (int j = -1; j <= 1; ++j) {
        const double otherU = lastU + i * step * samples.du, otherV = lastV + j * step * samples.dv;
        if ((i == 0 && j == 0) || !session_.isInside(number, otherU, otherV))
          continue;
        const std::vector<FacePoint> point = session_.pointsOf(number, {otherU, otherV});
        const double other = gapsOf(point, pair.second).front();
        if (std::abs(other) < std::abs(gap) - rounding) {
          gap = other;
          place = point.front().point;
          u = otherU;
          v = otherV;
        }
      }
    if (u == lastU && v == lastV)
      step /= 2;
  }
}

void FaceSearch::look(int a, int b, Assembly& result) {
  if (!areNear(boxes_[a], boxes_[b], reach()))
    return;
  if (assembly_.faces[a].area > assembly_.faces[b].area)
    std::swap(a, b);
  if (!samples_[a]) // of those that any is near
    samples_[a] = samplesOf(session_, assembly_.faces[a].number);
  const Samples& samples = *samples_[a];
  std::vector<FacePoint> points;
  std::vector<std::size_t> places;
  for (std::size_t i = 0; i < samples.points.size(); ++i)
    if (const FacePoint& point = samples.points[i]; areNear({point.point, point.point}, boxes_[b], reach())) {
      points.push_back(point);
      places.push_back(i);
    }
  FacePair pair{a, b, 0, infinity, -infinity, {}};
  const std::vector<double> gaps = gapsOf(points, b);
  double least = infinity, largest = 0;
  std::size_t closest = 0;
  for (std::size_t i = 0; i < gaps.size(); ++i) {
    if (std::isinf(gaps[i]))
      continue;
    largest = std::max(largest, std::abs(gaps[i]));
    if (std::abs(gaps[i]) < std::abs(least)) {
      least = gaps[i];
      closest = places[i];
    }
    if (std::abs(gaps[i]) > distance_)
      continue;
    pair.area += points[i].stretch / samples.sum * assembly_.faces[a].area;
    pair.leastGap = std::min(pair.leastGap, gaps[i]);
    pair.largestGap = std::max(pair.largestGap, gaps[i]);
  }
  if (std::isinf(least))
    return;
  pair.closest = samples.points[closest].point;
  if (const double rounding = 1e-3 * distance_; largest - std::abs(least) > rounding)
    descend(pair, closest, least, pair.closest);
  pair.leastGap = std::min(pair.leastGap, least);
  pair.largestGap = std::max(pair.largestGap, least);
  (std::abs(least) <= distance_ ? result.pairs : result.nearMisses).push_back(pair);
}

} // namespace

double PairSearch::distanceIn(const Assembly& assembly) const {
  constexpr double share = 1e-3; // of the diagonal
  return distance > 0 ? distance : share * assembly.diagonal();
}

void findPairs(const GmshSession& session, const PairSearch& search, Assembly& assembly) {
  FaceSearch faces(session, search, assembly);
  for (int a = 0; a < std::ssize(assembly.faces); ++a)
    for (int b = a + 1; b < std::ssize(assembly.faces); ++b)
      if (assembly.faces[a].solid != assembly.faces[b].solid)
        faces.look(a, b, assembly);
}

} // namespace epafi::assembly
