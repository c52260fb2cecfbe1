#include "epafi/qp/constraints/Face.hpp"

#include "epafi/qp/operators/LocalData.hpp"

#include <algorithm>
#include <cmath>

namespace epafi::qp {

void Face::restrict(const Vector& x, Vector& y) const {
  const auto in = localData(x), free = localData(isFree);
  const auto out = localDataNonConst(y);
  for (std::size_t i = 0; i < out.size(); ++i)
    out[i] = free[i] * in[i];
  for (const CircleTangent& tangent : tangents) {
    const double component = tangent.component(out);
    out[tangent.first] = tangent.along[0] * component;
    out[tangent.second] = tangent.along[1] * component;
  }
}

void Face::addFollowers(Vector& y) const {
  const auto out = localDataNonConst(y);
  for (const Follower& follower : followers)
    out[follower.entry] += follower.share * out[follower.leader];
}

/// At the solution g = −κ(x − centre).
void Face::curve(const Vector& g) {
  const auto gradient = localData(g);
  for (CircleTangent& tangent : tangents)
    tangent.curvature = std::max(0.0, -tangent.outward(gradient)) / tangent.radius;
}

void Face::addBending(const Vector& p, double factor, Vector& y) const {
  const auto direction = localData(p);
  const auto out = localDataNonConst(y);
  for (const CircleTangent& tangent : tangents) {
    const double size = factor * tangent.curvature * tangent.component(direction);
    out[tangent.first] += tangent.along[0] * size;
    out[tangent.second] += tangent.along[1] * size;
  }
}

void Face::addBendingFromOrigin(const Vector& x, double factor, Vector& y) const {
  const auto values = localData(x);
  const auto out = localDataNonConst(y);
  for (const CircleTangent& tangent : tangents) {
    const double size = factor * tangent.curvature * (tangent.component(values) - tangent.origin);
    out[tangent.first] += tangent.along[0] * size;
    out[tangent.second] += tangent.along[1] * size;
  }
}

void Face::weigh(double stiffness, Vector& y) const {
  const auto out = localDataNonConst(y);
  for (const CircleTangent& tangent : tangents) {
    const double weight = 1 / std::sqrt(1 + tangent.curvature / stiffness);
    out[tangent.first] *= weight;
    out[tangent.second] *= weight;
  }
}

void copy(const Face& from, Face& to) {
  copy(from.isFree, to.isFree);
  to.tangents = from.tangents;
  to.followers = from.followers;
}

} // namespace epafi::qp
