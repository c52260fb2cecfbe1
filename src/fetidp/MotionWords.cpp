#include "epafi/fetidp/MotionWords.hpp"

#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>
#include <map>
#include <sstream>
#include <vector>

namespace epafi::fetidp {
namespace {

using decomposition::Body;
using decomposition::DecomposedProblem;
using Eigen::Vector3d;

/// Shares of a motion that are not worth a word.
constexpr double small = 1e-6;

/// Displacement of a body's centre, then its rotation times its size, so that all six are lengths; of a body without known
/// motions the mode's amplitudes. Numbers, one block a body.
Eigen::MatrixXd coordinatesOf(const Body& body) {
  if (!body.motions)
    return Eigen::MatrixXd::Identity(body.kernelDimension, body.kernelDimension);
  Eigen::MatrixXd coordinates = body.motions->twists;
  coordinates.bottomRows(3) *= body.motions->size;
  return coordinates;
}

Eigen::VectorXd coordinates(const Body& body, const Eigen::VectorXd& motion) {
  return coordinatesOf(body) * motion.segment(body.kernelOffset, body.kernelDimension);
}

/// Places of the bodies that move.
std::vector<std::size_t> moving(const DecomposedProblem& problem, const Eigen::VectorXd& motion) {
  std::vector<double> sizes;
  for (const Body& body : problem.bodies)
    sizes.push_back(body.kernelDimension > 0 ? coordinates(body, motion).norm() : 0.0);
  const double largest = sizes.empty() ? 0.0 : *std::max_element(sizes.begin(), sizes.end());
  std::vector<std::size_t> places;
  for (std::size_t b = 0; b < sizes.size(); ++b)
    if (sizes[b] > small * largest)
      places.push_back(b);
  return places;
}

std::string named(const DecomposedProblem& problem, const std::vector<std::size_t>& places) {
  std::string names;
  for (const std::size_t b : places)
    names += (names.empty() ? "'" : "', '") + problem.bodies[b].name;
  return (places.size() > 1 ? "the floating bodies " : "the floating body ") + names + "'";
}

/// "(1, 2, 3)"; what is round-off beside `size` is 0.
std::string pointText(const Vector3d& point, double size, int components) {
  std::ostringstream text;
  text.precision(4);
  text << '(';
  for (int c = 0; c < components; ++c)
    text << (c > 0 ? ", " : "") << (std::abs(point[c]) > small * size ? point[c] : 0.0);
  text << ')';
  return text.str();
}

/// "x" or "(0.6, 0.8, 0)".
std::string directionText(const Vector3d& direction, int components) {
  const Vector3d unit = direction.normalized();
  for (int axis = 0; axis < 3; ++axis)
    if (std::abs(unit[axis]) > 1 - 0.5 * small * small)
      return std::string(1, "xyz"[axis]);
  return pointText(unit, 1, components);
}

/// Slide, turn, or both.
std::string verbOf(const Body& body, const Eigen::VectorXd& coordinates, int components) {
  if (!body.motions)
    return "move";
  const double size = body.motions->size;
  const Vector3d slide = coordinates.head(3), turn = coordinates.tail(3) / size;
  if (turn.norm() * size <= small * slide.norm())
    return "slide along " + directionText(slide, components);
  const double squared = turn.squaredNorm();
  const Vector3d arm = turn.cross(slide) / squared; // from the centre to the axis: c + ω × v/|ω|²
  const Vector3d point = body.motions->centre + arm;
  const double scale = std::max(size, body.motions->centre.norm());
  if (components == 2)
    return "turn about the point " + pointText(point, scale, 2);
  const double pitch = turn.dot(slide) / squared;
  const std::string along = directionText(turn, 3);
  return "turn about the axis through " + pointText(point, scale, 3) + " along " + along +
         (std::abs(pitch) > small * size ? " while it slides along it" : "");
}

/// "a, b and c".
std::string enumerated(const std::vector<std::string>& parts) {
  std::string text;
  for (std::size_t k = 0; k < parts.size(); ++k)
    text += (k == 0 ? "" : k + 1 < parts.size() ? ", " : " and ") + parts[k];
  return text;
}

/// Gauss–Jordan: rows that span the same, each beginning with a 1 where all others have a 0.
Eigen::MatrixXd reduced(Eigen::MatrixXd rows) {
  Eigen::Index done = 0;
  for (Eigen::Index column = 0; column < rows.cols() && done < rows.rows(); ++column) {
    Eigen::Index pivot = 0;
    if (rows.col(column).tail(rows.rows() - done).cwiseAbs().maxCoeff(&pivot) <= 1e-4)
      continue;
    rows.row(done).swap(rows.row(done + pivot));
    rows.row(done) /= rows(done, column);
    for (Eigen::Index other = 0; other < rows.rows(); ++other)
      if (other != done)
        rows.row(other) -= (rows(other, column) * rows.row(done)).eval();
    ++done;
  }
  return rows.topRows(done);
}

} // namespace

std::string bodiesOf(const DecomposedProblem& problem, const Eigen::VectorXd& motion) {
  return named(problem, moving(problem, motion));
}

std::string wordsOf(const DecomposedProblem& problem, const Eigen::VectorXd& motion) {
  const std::vector<std::size_t> places = moving(problem, motion);
  std::vector<std::string> verbs;
  for (const std::size_t b : places)
    verbs.push_back(verbOf(problem.bodies[b], coordinates(problem.bodies[b], motion), problem.components));
  if (std::all_of(verbs.begin(), verbs.end(), [&](const std::string& verb) { return verb == verbs[0]; }))
    return verbs.empty() ? "move" : verbs[0];
  std::string text;
  for (std::size_t k = 0; k < places.size(); ++k)
    text += (k > 0 ? ", '" : "'") + problem.bodies[places[k]].name + "' to " + verbs[k];
  return text;
}

std::string abilitiesOf(const DecomposedProblem& problem, const Eigen::MatrixXd& motions) {
  // In coordinates of all bodies, where the simplest combinations are those of fewest entries.
  Eigen::Index numCoordinates = 0;
  std::vector<Eigen::Index> offset;
  for (const Body& body : problem.bodies) {
    offset.push_back(numCoordinates);
    numCoordinates += body.kernelDimension > 0 ? coordinatesOf(body).rows() : 0;
  }
  Eigen::MatrixXd rows = Eigen::MatrixXd::Zero(motions.cols(), numCoordinates);
  for (std::size_t b = 0; b < problem.bodies.size(); ++b)
    for (Eigen::Index m = 0; m < motions.cols() && problem.bodies[b].kernelDimension > 0; ++m) {
      const Eigen::VectorXd own = coordinates(problem.bodies[b], motions.col(m));
      rows.row(m).segment(offset[b], own.size()) = own.transpose();
    }
  for (Eigen::Index m = 0; m < rows.rows(); ++m)
    rows.row(m).normalize();
  rows = reduced(rows);

  std::map<std::vector<std::size_t>, std::vector<std::string>> verbs; // of the bodies that do it together
  for (Eigen::Index m = 0; m < rows.rows(); ++m) {
    std::vector<std::size_t> who;
    std::vector<std::string> what;
    for (std::size_t b = 0; b < problem.bodies.size(); ++b) {
      const Body& body = problem.bodies[b];
      if (body.kernelDimension == 0)
        continue;
      const Eigen::VectorXd own = rows.row(m).segment(offset[b], coordinatesOf(body).rows()).transpose();
      if (own.norm() <= 1e-4 * rows.row(m).norm())
        continue;
      who.push_back(b);
      what.push_back(verbOf(body, own, problem.components));
    }
    std::string text = what.empty() ? "move" : what[0];
    if (std::any_of(what.begin(), what.end(), [&](const std::string& verb) { return verb != what[0]; }))
      text = "move together";
    verbs[who].push_back(text);
  }
  std::string all;
  for (const auto& [who, what] : verbs)
    all += (all.empty() ? "" : "; ") + named(problem, who) + " can " + enumerated(what);
  return all;
}

} // namespace epafi::fetidp
