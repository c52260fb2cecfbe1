#include "support/DataChanges.hpp"
#include "support/DenseProblem.hpp"

#include "epafi/base/Collective.hpp"
#include "epafi/base/Errors.hpp"
#include "epafi/fetidp/equilibrium/Contradictions.hpp"
#include "epafi/fetidp/equilibrium/Solvability.hpp"
#include "epafi/fetidp/solve/DualProblem.hpp"

#include <Tpetra_Vector.hpp>
#include <gtest/gtest.h>

#include <functional>

namespace epafi::fetidp {
namespace {

enum class Verdict { solvable, noSolution, notUnique };

struct Judgement {
  Verdict verdict = Verdict::solvable;
  std::string text;
};

/// What a check says; ranks that differ fail the test.
Judgement judge(const std::function<void()>& check) {
  Judgement judgement;
  try {
    check();
  } catch (const SolvabilityError& error) {
    judgement.verdict =
        error.kind() == SolvabilityError::Kind::noSolution ? Verdict::noSolution : Verdict::notUnique;
    judgement.text = error.what();
  }
  std::vector<double> letters{static_cast<double>(judgement.verdict)};
  letters.insert(letters.end(), judgement.text.begin(), judgement.text.end());
  std::vector<double> all;
  for (int rank = 0; rank < world()->getSize(); ++rank)
    all.insert(all.end(), letters.begin(), letters.end());
  EXPECT_EQ(gatherOnAll(*world(), letters), all);
  return judgement;
}

Judgement judge(const DecomposedProblem& problem, const decomposition::ProblemData& data) {
  return judge([&] { requireUniqueSolution(problem, data, kernelConstraint(problem)); });
}

Judgement judge(const scene::Scene& scene) {
  const auto cut = decompose(scene, world());
  return judge(cut.problem, cut.data);
}

/// A scene whose bodies carry the given constant loads.
scene::Scene loaded(scene::Scene scene, const std::vector<double>& loads) {
  for (std::size_t b = 0; b < loads.size(); ++b)
    setLoad(scene.bodies[b], loads[b]);
  return scene;
}

/// Semicoercive membranes; the floating one carries the given load.
scene::Scene membranes(double load) {
  return loaded(twoMembranes(false, 4, grid(2, 1)), {1.0, load});
}

scene::Scene chain(double middle, double last) {
  return loaded(threeMembranes(true, 2, grid(1, 1)), {-1.0, middle, last});
}

bool mentions(const Judgement& judgement, const std::string& words) {
  return judgement.text.find(words) != std::string::npos;
}

TEST(SolvabilityTest, HeldBodiesAreAlwaysSolvable) {
  EXPECT_EQ(judge(twoMembranes(true, 4, grid(2, 2))).verdict, Verdict::solvable);
  EXPECT_EQ(judge(loaded(twoMembranes(true, 4, grid(2, 2)), {0.0, 0.0})).verdict, Verdict::solvable);
}

TEST(SolvabilityTest, ALoadOntoTheContactsIsSolvable) {
  EXPECT_EQ(judge(membranes(-1.0)).verdict, Verdict::solvable);
}

TEST(SolvabilityTest, ALoadOffTheContactsHasNoSolution) {
  const Judgement judgement = judge(membranes(1.0));
  EXPECT_EQ(judgement.verdict, Verdict::noSolution);
  EXPECT_TRUE(mentions(judgement, "'right'")) << judgement.text;
}

TEST(SolvabilityTest, ALoadWithoutResultantIsNotUnique) {
  scene::Scene balanced = membranes(0.0);
  setHalves(balanced.bodies[1], 1.0, -1.0);
  for (const scene::Scene& scene : {membranes(0.0), balanced}) {
    const Judgement judgement = judge(scene);
    EXPECT_EQ(judgement.verdict, Verdict::notUnique);
    EXPECT_TRUE(mentions(judgement, "'right'")) << judgement.text;
  }
}

TEST(SolvabilityTest, AFloatingBodyWithoutContactIsNamed) {
  for (const double load : {0.0, -1.0, 1.0}) {
    scene::Scene scene = membranes(load);
    scene.contacts.clear();
    const Judgement judgement = judge(scene);
    EXPECT_EQ(judgement.verdict, load == 0 ? Verdict::notUnique : Verdict::noSolution);
    EXPECT_TRUE(mentions(judgement, "'right'") && !mentions(judgement, "'left'")) << judgement.text;
  }
}

TEST(SolvabilityTest, SetupAsksForContactWhateverTheLoad) {
  const auto check = [](const scene::Scene& scene) {
    const auto decomposition = decompose(scene, world());
    return judge([&] {
      requireContactForEveryMotion(decomposition.problem, decomposition.data,
                                   kernelConstraint(decomposition.problem));
    });
  };
  EXPECT_EQ(check(membranes(1.0)).verdict, Verdict::solvable); // the load may change
  EXPECT_EQ(check(membranes(0.0)).verdict, Verdict::solvable);
  scene::Scene adrift = chain(0.0, 0.0);
  adrift.contacts.pop_back();
  EXPECT_EQ(check(adrift).verdict, Verdict::notUnique);
  EXPECT_TRUE(mentions(check(adrift), "'right'")) << check(adrift).text;
}

TEST(SolvabilityTest, ContactsOnBothSidesHoldAnyResultant) {
  for (const double load : {-1.0, 1.0, 1e-6, -1e-6})
    EXPECT_EQ(judge(loaded(threeMembranes(false, 3, grid(1, 1)), {-1.0, load, -1.0})).verdict,
              Verdict::solvable)
        << load;
}

TEST(SolvabilityTest, AFloatingBodyMayLeanOnAnother) {
  EXPECT_EQ(judge(chain(-1.0, -1.0)).verdict, Verdict::solvable);
  EXPECT_EQ(judge(chain(0.0, -1.0)).verdict, Verdict::solvable); // only the farther one is pushed
  EXPECT_EQ(judge(chain(0.5, -1.0)).verdict,
            Verdict::solvable); // the farther one presses the middle one down
}

TEST(SolvabilityTest, AChainBreaksWhereTheLoadPullsIt) {
  const Judgement last = judge(chain(-2.0, 1.0)); // the last one flies off
  EXPECT_EQ(last.verdict, Verdict::noSolution);
  EXPECT_TRUE(mentions(last, "'right'")) << last.text;
  const Judgement both = judge(chain(2.0, -1.0)); // the middle one takes the last one with it
  EXPECT_EQ(both.verdict, Verdict::noSolution);
  EXPECT_TRUE(mentions(both, "'middle', 'right'")) << both.text;
  EXPECT_EQ(judge(chain(-1.0, 0.0)).verdict, Verdict::notUnique); // the last one rests anywhere above
  EXPECT_EQ(judge(chain(1.0, -1.0)).verdict, Verdict::notUnique); // both together do
}

TEST(SolvabilityTest, DecisionsDoNotDependOnUnits) {
  const std::vector<std::pair<scene::Scene, Verdict>> cases{
      {membranes(-1.0), Verdict::solvable},     {membranes(1.0), Verdict::noSolution},
      {membranes(0.0), Verdict::notUnique},     {chain(0.5, -1.0), Verdict::solvable},
      {chain(2.0, -1.0), Verdict::noSolution},  {chain(1.0, -1.0), Verdict::notUnique},
      {chain(1e-3, -1e-4), Verdict::noSolution}};
  for (const double load : {1e-9, 1e9})
    for (const double conductivity : {1e-9, 1.0, 1e9})
      for (auto [scene, verdict] : cases) {
        for (scene::Body& body : scene.bodies) {
          body.material.conductivity *= conductivity;
          for (fem::SolidLoad& l : body.loads)
            l.value[0] *= load;
        }
        EXPECT_EQ(judge(scene).verdict, verdict) << load << ' ' << conductivity;
      }
}

TEST(SolvabilityTest, RoundOffInTheLoadsFlipsNoDecision) {
  for (const double change : {-1e-15, 1e-15}) {
    EXPECT_EQ(judge(membranes(-1.0 + change)).verdict, Verdict::solvable);
    EXPECT_EQ(judge(membranes(1.0 + change)).verdict, Verdict::noSolution);
    scene::Scene balanced = membranes(0.0);
    setHalves(balanced.bodies[1], 1.0, -1.0 + change);
    EXPECT_EQ(judge(balanced).verdict, Verdict::notUnique) << change;
    EXPECT_EQ(judge(chain(1.0, -1.0 + change)).verdict, Verdict::notUnique) << change;
  }
}

TEST(SolvabilityTest, TheLoadsOfNowDecide) {
  const auto cut = decompose(membranes(0.0), world());
  ASSERT_EQ(judge(cut.problem, cut.data).verdict, Verdict::notUnique);
  for (const double load : {-1.0, 1.0, -1e-12, -1e12}) {
    const auto data = withLoads(cut.data, [load](std::size_t, Eigen::VectorXd& f) { f.setConstant(load); });
    EXPECT_EQ(judge(cut.problem, data).verdict, load < 0 ? Verdict::solvable : Verdict::noSolution) << load;
  }
}

/// Both membranes held at the foot, at heights `first` and `second`.
Judgement judgeGaps(double gap, double first, double second) {
  scene::Scene scene = twoMembranes(true, 4, grid(2, 2));
  scene.contacts.front().gap = gap;
  scene.bodies[0].supports = {{"foot", "bottom", {first}}};
  scene.bodies[1].supports = {{"foot", "bottom", {second}}};
  const auto decomposition = decompose(scene, world());
  return judge([&] { requireFeasibleGaps(decomposition.problem, decomposition.data); });
}

TEST(SolvabilityTest, SupportsThatOverlapHaveNoSolution) {
  EXPECT_EQ(judgeGaps(0.0, 0.0, 0.0).verdict, Verdict::solvable);
  EXPECT_EQ(judgeGaps(0.5, 0.25, 0.0).verdict, Verdict::solvable);
  for (const double unit : {1e-9, 1.0, 1e9}) {
    const Judgement judgement = judgeGaps(0.5 * unit, 1.0 * unit, 0.0);
    EXPECT_EQ(judgement.verdict, Verdict::noSolution);
    EXPECT_TRUE(mentions(judgement, "contact row 0")) << judgement.text;
  }
}

TEST(SolvabilityTest, SupportsThatTouchUpToRoundOffAreFeasible) {
  ASSERT_LT(0.3 - 0.4 + 0.1, 0.0); // what the gap comes to in floating point
  EXPECT_EQ(judgeGaps(0.3, 0.4, 0.1).verdict, Verdict::solvable);
}

} // namespace
} // namespace epafi::fetidp
