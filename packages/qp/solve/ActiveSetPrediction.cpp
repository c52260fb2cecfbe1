#include "epafi/qp/solve/ActiveSetPrediction.hpp"

#include "epafi/base/Collective.hpp"
#include "epafi/qp/operators/LocalData.hpp"

#include <Tpetra_Map.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <utility>

namespace epafi::qp {
namespace {

constexpr int maxRounds = 20;
constexpr int maxWorseRounds = 6;      ///< in a row; with more a prediction is taken for one that cycles
constexpr int maxPredictionSteps = 30; ///< of CG in a face
constexpr double reduction = 0.1;      ///< of the gradient in a face
/// Multipliers as wrong as this share of the worst one come off their bounds.
constexpr double wrongShare = 0.1;
/// Less than this share of what a prediction has gained so far is no progress, but may be the last digits of
/// a cycle.
constexpr double progress = 0.1;
constexpr double leastCurvature = 1e-12; ///< pᵀAp beside ‖A‖ pᵀp
constexpr int mostDoublings = 6;         ///< of the pause after predictions that did not settle

/// A number that tells faces from each other, the same on all ranks. Collective, one message.
double fingerprintOf(const Vector& face) {
  constexpr std::uint64_t mask = (std::uint64_t{1} << 40) - 1; // sums over the ranks are exact
  const auto isFree = localData(face);
  std::uint64_t sum = 0;
  for (std::size_t i = 0; i < isFree.size(); ++i)
    if (isFree[i] != 0) { // splitmix64 of the entry's number
      auto bits = static_cast<std::uint64_t>(face.getMap()->getGlobalElement(static_cast<LocalOrdinal>(i))) +
                  0x9e3779b97f4a7c15U;
      bits = (bits ^ (bits >> 30)) * 0xbf58476d1ce4e5b9U;
      bits = (bits ^ (bits >> 27)) * 0x94d049bb133111ebU;
      sum += bits ^ (bits >> 31);
    }
  return sumOverRanks(*face.getMap()->getComm(), static_cast<double>(sum & mask));
}

} // namespace

ActiveSetPrediction::ActiveSetPrediction(ScaledObjective& objective, const ConvexSet& set,
                                         FacePreconditioner* preconditioner, const Interruption& interruption,
                                         StepCounts& counts)
    : objective_(objective), set_(set),
      preconditioner_(preconditioner != nullptr ? *preconditioner
                                                : identity_.emplace(Teuchos::null, objective.map(), counts)),
      interruption_(interruption), counts_(counts), walker_(objective.map()), face_(objective.map()),
      wrong_(objective.map()) {}

bool ActiveSetPrediction::isDue() const {
  return !isGivenUp_ && counts_.hessianMultiplications >= due_;
}

bool ActiveSetPrediction::improve(Iterate& iterate, double limit, bool leavesFace, double negligible,
                                  StepVectors& work) {
  copy(iterate.x, walker_.x);
  copy(iterate.g, walker_.g);
  double best = limit, target = 0;
  const int began = counts_.hessianMultiplications;
  bool isSettled = false;
  std::array<double, maxRounds> faces{};
  for (int round = 0, bestRound = 0; round < maxRounds && round - bestRound <= maxWorseRounds; ++round) {
    set_.freeIndicator(walker_.x, face_);
    if (round > 0) // only the worst of these: most others only follow what the projection did
      takeBoundsOff(negligible, wrongShare);
    else if (leavesFace)
      takeBoundsOff(negligible, 0);
    const auto known = faces.begin() + round;
    *known = fingerprintOf(face_);
    if (std::find(faces.begin(), known, *known) != known) // from there on it goes in circles
      break;
    if (!minimiseOnFace(target, work)) {
      isGivenUp_ = true;
      break;
    }
    copy(walker_.x, work.trial);
    set_.project(work.trial);
    objective_.multiply(work.trial, work.image);
    const Trial trial = objective_.evaluate(work.trial, work.image, walker_.x, work.p);
    std::swap(walker_.x, work.trial);
    objective_.gradient(work.image, walker_.g);
    if (trial.objective < best) {
      if (best - trial.objective > progress * (limit - best))
        bestRound = round;
      best = trial.objective;
      copy(walker_.x, iterate.x);
      copy(walker_.g, iterate.g);
    }
    isSettled = !(trial.squared > 0); // inside of the set
    if (isSettled || !std::isfinite(trial.objective) || objective_.isSpent())
      break;
  }
  const int now = counts_.hessianMultiplications;
  failures_ = best < limit ? 0 : failures_ + 1;
  due_ = isSettled ? now : now + ((now - began) << std::min(failures_, mostDoublings));
  if (best < limit) {
    iterate.f = best;
    iterate.isFresh = true;
    return true;
  }
  ++counts_.safeguards;
  return false;
}

/// Lets entries move whose multipliers are as wrong as a share of the worst one.
void ActiveSetPrediction::takeBoundsOff(double negligible, double share) {
  set_.choppedGradient(walker_.x, walker_.g, negligible, wrong_);
  const double atLeast = share > 0 ? share * wrong_.normInf() : 0.0;
  const auto wrong = localData(wrong_);
  const auto face = localDataNonConst(face_);
  for (std::size_t i = 0; i < face.size(); ++i)
    if (wrong[i] != 0 && std::abs(wrong[i]) >= atLeast)
      face[i] = 1;
}

/// CG in the face, from the walker with its gradient, until rᵀMr has fallen below `reduction`² times itself
/// or what it was in the first round, `target` (0: this is the first). False if it does not get there, or if
/// the run is to end.
bool ActiveSetPrediction::minimiseOnFace(double& target, StepVectors& work) {
  double curvature = 0, goal = 0;
  for (int k = 0;; ++k) {
    preconditioner_.applyInFace(face_, walker_.g);
    bool isToStop = interruption_.timeIsUp() || interruption_.isWanted();
    const FacePreconditioner::Products products = preconditioner_.products(work.image, isToStop);
    if (k == 0) {
      target = target > 0 ? target : products.energy;
      goal = reduction * reduction * std::min(products.energy, target);
    }
    if (!(products.energy > goal))
      return true;
    if (k == maxPredictionSteps || objective_.isSpent() || isToStop)
      return false;
    setConjugate(preconditioner_.z(), k == 0 ? 0.0 : objective_.scale() * products.timesImage / curvature,
                 work.p); // p = z − (zᵀAp/pᵀAp) p
    objective_.multiply(work.p, work.image);
    const StepSizes sizes =
        objective_.stepSizes(walker_.g, work.p, work.image, std::numeric_limits<double>::infinity());
    if (!(sizes.curvature > leastCurvature * objective_.norm() * sizes.squared))
      return false;
    curvature = sizes.curvature;
    const double length = sizes.slope / sizes.curvature;
    addScaled(-length, work.p, walker_.x);
    addScaled(-length * objective_.scale(), work.image, walker_.g);
  }
}

} // namespace epafi::qp
