#pragma once

/// Rigid motions in words, for errors: which bodies take part, and how each moves.

#include "epafi/decomposition/DecomposedProblem.hpp"

#include <Eigen/Core>

#include <string>
#include <vector>

namespace epafi::fetidp {

struct MotionWords {
  std::string bodies; ///< that take part: "the floating body 'plate'"
  /// What they do, such as "slide along x" or "turn about the axis through (0, 1, 0) along z"; of several
  /// bodies each with its name. Empty where the problem does not say what the modes are.
  std::string motion;
};

/// Of a rigid motion α.
MotionWords wordsOf(const decomposition::DecomposedProblem& problem, const Eigen::VectorXd& motion);

/// All that bodies can do by combinations of some motions (columns), in the simplest ones: "the floating body
/// 'cube' can slide along x, slide along y, turn about …".
/// \param accuracy  shares of a motion below this are 0
std::string abilitiesOf(const decomposition::DecomposedProblem& problem, const Eigen::MatrixXd& motions,
                        double accuracy = 0);

/// One of those simplest motions.
struct FreeMotion {
  struct OfBody {
    int body;                            ///< index into DecomposedProblem::bodies
    Eigen::Vector3d centre, slide, turn; ///< a point x moves by slide + turn × (x − centre)
  };
  std::vector<OfBody> bodies; ///< that take part; none where a body's modes are not known as motions
  std::string words;          ///< "the floating body 'cube' can slide along x"
};

/// All that abilitiesOf() speaks of, in as many motions as there are columns.
std::vector<FreeMotion> freeMotionsOf(const decomposition::DecomposedProblem& problem,
                                      const Eigen::MatrixXd& motions, double accuracy = 0);

/// That of motions along surfaces with facets.
inline constexpr double facetNoise = 0.05;

} // namespace epafi::fetidp
