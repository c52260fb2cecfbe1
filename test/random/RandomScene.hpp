#pragma once

/// Small scenes of elastic bodies, drawn from a seed: one to three blocks on top of each other, in the plane
/// or in space, between obstacles, with supports and loads as chance has them. And copies of a scene that
/// have the same answer.

#include <Eigen/Core>
#include <Teuchos_ParameterList.hpp>

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace epafi::test {

using Vector3 = Eigen::Vector3d;

struct DrawnSupport {
  std::string surface{};
  std::array<std::optional<double>, 3>
      value{}; ///< along the axes of the block; a part of them in blocks that are not turned
  std::optional<double> normal{};
};

struct DrawnLoad {
  std::string kind{};    ///< body, traction, pressure or point
  std::string surface{}; ///< of traction and pressure
  Vector3 point{0, 0, 0};
  Vector3 force{0, 0, 0}; ///< of pressure: its first entry
};

struct DrawnRegion {
  Vector3 lower, upper;
  double youngsModulus = 1;
};

struct DrawnCut {
  bool isGrid = false;
  std::array<int, 3> counts{1, 1, 1};
  int parts = 1, cluster = -1;
};

/// A block with its axes along those of the drawing; "up" is the last of them.
struct DrawnBody {
  Vector3 lower, upper;
  std::array<int, 3> elements{1, 1, 0};
  int order = 1;
  bool isSimplex = false, isFile = false;
  double youngsModulus = 1, poissonsRatio = 0.3;
  std::vector<DrawnRegion> regions{};
  std::vector<DrawnSupport> supports{};
  std::vector<DrawnLoad> loads{};
  DrawnCut cut{};
};

struct DrawnContact {
  int first = 0, second = -1; ///< −1: an obstacle
  std::string firstSurface{}, secondSurface{};
  bool isTied = false;
  std::string coupling = "auto", multipliers = "auto";
  double gap = 0;
  // Of an obstacle:
  Vector3 point{0, 0, 0}, normal{0, 0, 0};
  double radius = 0; ///< 0: a plane
};

struct DrawnScene {
  int dimension = 2;
  std::string physics{};
  std::vector<DrawnBody> bodies{};
  std::vector<DrawnContact> contacts{};
  Teuchos::ParameterList solver{"Solver"};
  Eigen::Matrix3d turn = Eigen::Matrix3d::Identity();
  Vector3 shift{0, 0, 0};
  int ranks = 1; ///< on which it is solved, at most

  /// Whether other axes mean the same: components of a support or boxes of a region would not turn.
  [[nodiscard]] bool canTurn() const;
};

DrawnScene drawnScene(std::uint64_t seed, int maxRanks);

/// The same scene in other units: lengths, stiffness and, where all is linear in them, loads, gaps and
/// prescribed displacements.
struct Units {
  double length = 1, stiffness = 1, load = 1;
};
DrawnScene inUnits(DrawnScene scene, const Units& units);

/// The same scene, turned by a further angle and moved by so many times its size. Precondition: it can turn.
DrawnScene movedTo(DrawnScene scene, double angle, double distance);

/// Cut by chance, and solved by an algorithm by chance.
void drawCuts(DrawnScene& scene, std::uint64_t seed);
void drawSolver(DrawnScene& scene, std::uint64_t seed);

/// What a file of the scene would hold, its meshes written to a folder: to be read as `folder`/scene.xml.
Teuchos::ParameterList listOf(const DrawnScene& scene, const std::string& folder);

} // namespace epafi::test
