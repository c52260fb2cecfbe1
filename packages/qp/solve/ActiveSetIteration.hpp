#pragma once

/// The run of solveByActiveSets: `settle` goes from face to face (ActiveSetFaces.cpp) through points that
/// may lie outside of Ω (ActiveSets.cpp); where it finds no end, and no boundary is curved, `descend` goes
/// on through points of Ω (ActiveSetDescent.cpp).

#include "epafi/qp/solve/ActiveSets.hpp"
#include "epafi/qp/solve/ErrorTarget.hpp"
#include "epafi/qp/solve/FaceIteration.hpp"
#include "epafi/qp/solve/StoppingRule.hpp"

#include <optional>

namespace epafi::qp {

/// Keeps references to the program.
class ActiveSetIteration {
public:
  ActiveSetIteration(const QuadraticProgram& program, const Vector& start,
                     const ActiveSetParameters& parameters, const Tolerances& tolerances,
                     const MprgpParameters& limits);
  /// Collective.
  Status run(Observer* observer);
  void describe(SolveReport& report) const;
  [[nodiscard]] const Vector& solution() const { return on_.x; }

private:
  static constexpr int maxIdleFaces = 24;          ///< in a row with no smaller gradient, or objective
  static constexpr int mostIdleWithMovingSet = 12; ///< where there is no objective that falls
  static constexpr int maxFaceSteps = 200;         ///< of CG before a face is looked at again
  static constexpr double roundOffOfX = 1e-13;     ///< of x that leaves Ω by it
  static constexpr int mostLeft = 30;              ///< faces without a minimum, in a set that has one
  static constexpr double negligibleShare = 1e-12; ///< multipliers no larger, beside ‖Zg‖, release nothing

  Status settle();  ///< the loop of the paper
  Status descend(); ///< through points of Ω alone
  void chooseFirstFace(const QuadraticProgram& program);
  std::optional<Status> minimise(int maxSteps);
  [[nodiscard]] bool isEndless();
  bool leave();
  [[nodiscard]] bool isNearlySmall() const;
  bool chooseFace(bool isCautious);
  bool balance();
  bool startInside();
  void release(double share);
  double follow(const Vector& p, double most);
  [[nodiscard]] bool isSameFace() const;
  [[nodiscard]] bool hasMovingBoundary() const { return program_.setAt || set_->isCurved(); }
  void followSet(const Vector& gradient);
  bool isSolved();
  [[nodiscard]] bool isSmall(double gradient, double energy);
  [[nodiscard]] bool holdsEquality() const;
  void record(StepKind kind);
  [[nodiscard]] double enough() const { return tolerances_.gradientLimit() * objective_.scale(); }

  StepCounts counts_;
  const QuadraticProgram& program_;
  RCP<const ConvexSet> set_; ///< Ω, or Ω(x) as it was asked for last
  ScaledObjective objective_;
  Tolerances tolerances_;
  std::optional<ErrorWatch> watch_; ///< with an error's target
  Interruption interruption_;
  FaceIteration on_; ///< the face, with x and g
  Vector start_;
  Vector best_;   ///< the point with the least gradient on entering a face
  Vector inside_; ///< x projected
  Face next_;     ///< the next face
  Vector work_;
  Vector fixed_; ///< 1 where Ω(x) had one value alone when the face was chosen, else 0
  FusedReduction reduction_;
  double faceReduction_;
  double gradient_ = 0; ///< ‖Zg‖, of the solution ‖g^P‖; scaled
  long long numActive_ = 0;
  FaceIteration::Point point_ = FaceIteration::Point::elsewhere; ///< where the next face is entered
  int numLeft_ = 0; ///< how often x has left Ω along what has no curvature
};

} // namespace epafi::qp
