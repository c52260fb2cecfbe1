#include "epafi/fetidp/equilibrium/MotionWords.hpp"

#include "epafi/base/Text.hpp"

#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>
#include <functional>
#include <map>
#include <vector>

namespace epafi::fetidp {
namespace {

using decomposition::Body;
using decomposition::DecomposedProblem;
using Eigen::Vector3d;

/// Shares of a motion that are not worth a word.
constexpr double small = 1e-6, notWorthAWord = 1e-4; // of one, of a combination of several

/// Motions (columns) as lengths, body after body: displacement of its centre, then its rotation times its
/// size; of a body without known motions the modes' amplitudes.
Eigen::MatrixXd coordinatesOf(const DecomposedProblem& problem, const Eigen::MatrixXd& motions) {
  Eigen::MatrixXd coordinates(0, motions.cols());
  for (const Body& body : problem.bodies) {
    Eigen::MatrixXd own = motions.middleRows(body.kernelOffset, body.kernelDimension);
    if (body.motions) {
      own = (body.motions->twists * own).eval();
      own.bottomRows(3) *= body.motions->size;
    }
    coordinates.conservativeResize(coordinates.rows() + own.rows(), Eigen::NoChange);
    coordinates.bottomRows(own.rows()) = own;
  }
  return coordinates;
}

/// "(1, 2, 3)"; what is round-off beside `size` is 0.
std::string pointText(const Vector3d& point, double size, int components) {
  const Eigen::VectorXd rounded =
      (point.array().abs() > small * size).select(point.array(), 0.0).head(components);
  return text(rounded, 4);
}

/// "x" or "(0.6, 0.8, 0)".
std::string directionText(const Vector3d& direction, int components) {
  const Vector3d unit = direction.normalized();
  for (int axis = 0; axis < 3; ++axis)
    if (std::abs(unit[axis]) > 1 - 0.5 * small * small)
      return std::string(1, "xyz"[axis]);
  return pointText(unit, 1, components);
}

/// Slide, turn, or both; "move" where nobody knows.
std::string verbOf(const Body& body, const Eigen::VectorXd& coordinates, int components) {
  if (!body.motions)
    return "move";
  const double size = body.motions->size;
  const Vector3d slide = coordinates.head(3), turn = coordinates.tail(3) / size;
  if (turn.norm() * size <= small * slide.norm())
    return "slide along " + directionText(slide, components);
  const double squared = turn.squaredNorm();
  // From the centre to the axis: c + ω × v/|ω|².
  const Vector3d point = body.motions->centre + Vector3d(turn.cross(slide)) / squared;
  const std::string where = pointText(point, std::max(size, body.motions->centre.norm()), components);
  if (components == 2)
    return "turn about the point " + where;
  const double pitch = turn.dot(slide) / squared;
  return "turn about the axis through " + where + " along " + directionText(turn, 3) +
         (std::abs(pitch) > small * size ? " while it slides along it" : "");
}

struct Moves {
  std::vector<const Body*> bodies;          ///< in the order of the problem
  std::vector<std::string> verbs;           ///< of each
  std::vector<Eigen::VectorXd> coordinates; ///< likewise

  [[nodiscard]] bool areAlike() const {
    return std::adjacent_find(verbs.begin(), verbs.end(), std::not_equal_to<>()) == verbs.end();
  }
  [[nodiscard]] std::string verb() const { return areAlike() ? verbs.at(0) : "move together"; } ///< of all
};

/// Of the bodies that move by more than `share` of what moves most.
Moves movesOf(const DecomposedProblem& problem, const Eigen::VectorXd& coordinates, double share) {
  Moves moves;
  Eigen::Index first = 0;
  for (const Body& body : problem.bodies) {
    const Eigen::Index size = body.motions ? body.motions->twists.rows() : body.kernelDimension;
    const Eigen::VectorXd own = coordinates.segment(first, size);
    first += size;
    if (own.norm() > share * coordinates.norm()) {
      moves.bodies.push_back(&body);
      moves.verbs.push_back(verbOf(body, own, problem.components));
      moves.coordinates.push_back(own);
    }
  }
  return moves;
}

std::string namesOf(const std::vector<const Body*>& bodies) {
  std::string names;
  for (const Body* body : bodies)
    names += (names.empty() ? "'" : "', '") + body->name;
  return (bodies.size() > 1 ? "the floating bodies " : "the floating body ") + names + "'";
}

/// Gauss–Jordan: rows that span the same, each beginning with a 1 where all others have a 0.
Eigen::MatrixXd reduced(Eigen::MatrixXd rows, double accuracy) {
  Eigen::Index done = 0;
  for (Eigen::Index column = 0; column < rows.cols() && done < rows.rows(); ++column) {
    Eigen::Index pivot = 0;
    if (rows.col(column).tail(rows.rows() - done).cwiseAbs().maxCoeff(&pivot) <= std::max(accuracy, 1e-4))
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

/// The combinations with the fewest coordinates.
std::vector<Eigen::VectorXd> simplest(const DecomposedProblem& problem, const Eigen::MatrixXd& motions,
                                      double accuracy) {
  const Eigen::MatrixXd rows =
      reduced(coordinatesOf(problem, motions).colwise().normalized().transpose(), accuracy);
  std::vector<Eigen::VectorXd> all;
  for (const auto& row : rows.rowwise())
    all.emplace_back((row.array().abs() < accuracy * row.cwiseAbs().maxCoeff()).select(0.0, row.array()));
  return all;
}

} // namespace

MotionWords wordsOf(const DecomposedProblem& problem, const Eigen::VectorXd& motion) {
  const Moves moves = movesOf(problem, coordinatesOf(problem, motion), small);
  MotionWords words{namesOf(moves.bodies), ""};
  if (moves.areAlike()) {
    words.motion = moves.verbs.empty() || moves.verbs[0] == "move" ? "" : moves.verbs[0];
    return words;
  }
  for (std::size_t k = 0; k < moves.verbs.size(); ++k)
    words.motion += (k > 0 ? ", '" : "'") + moves.bodies[k]->name + "' to " + moves.verbs[k];
  return words;
}

std::string abilitiesOf(const DecomposedProblem& problem, const Eigen::MatrixXd& motions, double accuracy) {
  std::map<std::vector<const Body*>, std::vector<std::string>> verbs; // of the bodies that do it together
  for (const Eigen::VectorXd& motion : simplest(problem, motions, accuracy)) {
    const Moves moves = movesOf(problem, motion, notWorthAWord);
    verbs[moves.bodies].push_back(moves.verb());
  }
  std::string all;
  for (const auto& [who, what] : verbs)
    all += (all.empty() ? "" : "; ") + namesOf(who) + " can " + listed(what);
  return all;
}

std::vector<FreeMotion> freeMotionsOf(const DecomposedProblem& problem, const Eigen::MatrixXd& motions,
                                      double accuracy) {
  std::vector<FreeMotion> all;
  for (const Eigen::VectorXd& coordinates : simplest(problem, motions, accuracy)) {
    const Moves moves = movesOf(problem, coordinates, notWorthAWord);
    FreeMotion motion{{}, namesOf(moves.bodies) + " can " + moves.verb()};
    for (std::size_t k = 0; k < moves.bodies.size(); ++k)
      if (const auto& known = moves.bodies[k]->motions)
        motion.bodies.push_back({static_cast<int>(moves.bodies[k] - problem.bodies.data()), known->centre,
                                 moves.coordinates[k].head(3), moves.coordinates[k].tail(3) / known->size});
    all.push_back(std::move(motion));
  }
  return all;
}

} // namespace epafi::fetidp
