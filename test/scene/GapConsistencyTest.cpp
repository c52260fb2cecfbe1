#include "epafi/scene/GapConsistency.hpp"

#include "epafi/base/Errors.hpp"
#include "support/Refusal.hpp"

#include <gtest/gtest.h>

namespace epafi::scene {
namespace {

/// Four unit squares a, b, c, d around the point (1, 1), each resting on the one before: u_a ≤ u_b + g, u_b ≤
/// u_c, u_c ≤ u_d, u_d ≤ u_a.
Scene ring(double gap) {
  Scene scene;
  const mesh::Box places[] = {mesh::rectangle(0, 1, 0, 1), mesh::rectangle(1, 2, 0, 1),
                              mesh::rectangle(1, 2, 1, 2), mesh::rectangle(0, 1, 1, 2)};
  for (int b = 0; b < 4; ++b) {
    Body body;
    body.name = std::string(1, static_cast<char>('a' + b));
    body.mesh.box = places[b];
    scene.bodies.push_back(body);
  }
  scene.contacts = {{"ab", 0, "right", 1, "left", {}, gap},
                    {"bc", 1, "top", 2, "bottom", {}, 0},
                    {"cd", 2, "left", 3, "right", {}, 0},
                    {"da", 3, "bottom", 0, "top", {}, 0}};
  return scene;
}

TEST(GapConsistencyTest, ARingOfContactsMayNotOverlapInTotal) {
  test::expectSays(
      test::unsolvable(SolvabilityError::Kind::noSolution, [] { requireConsistentGaps(ring(-0.125)); }),
      {"'ab', 'bc', 'cd' and 'da'", "overlap by 0.125 at (1, 1)"});
}

TEST(GapConsistencyTest, ARingThatClosesHasRoom) {
  EXPECT_NO_THROW(requireConsistentGaps(ring(0)));
  EXPECT_NO_THROW(requireConsistentGaps(ring(0.1)));
  Scene balanced = ring(-0.3);
  balanced.contacts[1].gap = 0.1;
  balanced.contacts[2].gap = 0.2;
  EXPECT_NO_THROW(requireConsistentGaps(balanced)) << "0.1 + 0.2 − 0.3 is 5.6e-17";
}

TEST(GapConsistencyTest, AnOpenChainBetweenSupportsMayNotOverlapInTotal) {
  Scene scene = ring(-0.5);
  scene.contacts.pop_back(); // a under b under c under d
  EXPECT_NO_THROW(requireConsistentGaps(scene));
  scene.bodies[0].supports = {{"floor", "top", {1.0}}};
  EXPECT_NO_THROW(requireConsistentGaps(scene));
  scene.bodies[3].supports = {{"ceiling", "bottom", {1.5}}};
  EXPECT_NO_THROW(requireConsistentGaps(scene));
  scene.bodies[3].supports[0].value[0] = 1.25; // u_d ≥ u_a + 0.5
  test::expectSays(
      test::unsolvable(SolvabilityError::Kind::noSolution, [&] { requireConsistentGaps(scene); }),
      {"'ab', 'bc' and 'cd'", "supports of 'a' and 'd'", "overlap by 0.25 at (1, 1)"});
}

} // namespace
} // namespace epafi::scene
