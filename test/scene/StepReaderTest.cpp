#include "SceneLists.hpp"

#include "epafi/scene/SceneReader.hpp"
#include "epafi/scene/StepReader.hpp"

#include <string>
#include <vector>

namespace {

using namespace epafi;
using namespace epafi::test;
using Teuchos::ParameterList;

std::vector<scene::Step> stepsOf(const ParameterList& list) {
  return scene::readSteps(list, "a.xml", scene::readScene(list, "a.xml"));
}

/// Two bodies with a load on each and a support on the left one.
ParameterList loaded() {
  ParameterList list = twoBodies();
  for (const char* const body : {"left", "right"})
    bodyOf(list, body).sublist("Loads").sublist("push").set("Value", 2.0);
  bodyOf(list, "left").sublist("Supports").sublist("wall").set("Value", 0.5);
  return list;
}

std::string refusalOfStep(const std::string& parameter, const std::string& text) {
  ParameterList list = loaded();
  list.sublist("Steps").sublist("press").set(parameter, text);
  try {
    stepsOf(list);
  } catch (const InputError& error) {
    return error.what();
  }
  return "";
}

TEST(StepReaderTest, WhatAStepDoesNotNameStays) {
  ParameterList list = loaded();
  list.sublist("Steps")
      .sublist("press")
      .set("Loads", "left/push = 3, right/push=0")
      .set("Gaps", "interface=0.25");
  list.sublist("Steps").sublist("pull").set("Loads", "right/push=-1").set("Supports", "left/wall = 2");
  const scene::Scene whole = scene::readScene(list, "a.xml");
  const std::vector<scene::Step> steps = stepsOf(list);

  ASSERT_EQ(steps.size(), 2U);
  EXPECT_EQ(steps[0].name, "press");
  const scene::Scene first = scene::atStep(whole, steps, 0), second = scene::atStep(whole, steps, 1);
  EXPECT_EQ(first.bodies[0].loads[0].value[0], 6);
  EXPECT_EQ(first.bodies[1].loads[0].value[0], 0);
  EXPECT_EQ(first.bodies[0].supports[0].value, whole.bodies[0].supports[0].value);
  EXPECT_EQ(first.contacts[0].gap, 0.25);
  EXPECT_EQ(second.bodies[0].loads[0].value[0], 6);
  EXPECT_EQ(second.bodies[1].loads[0].value[0], -2);
  EXPECT_EQ(second.bodies[0].supports[0].value[0], 1);
  EXPECT_EQ(second.contacts[0].gap, 0.25);
}

TEST(StepReaderTest, WithoutTheListThereAreNoSteps) {
  EXPECT_TRUE(stepsOf(loaded()).empty());
}

TEST(StepReaderTest, ANumberMayHaveItsSign) {
  ParameterList list = loaded();
  list.sublist("Steps").sublist("press").set("Loads", "left/push = +3, right/push = -2.5,");
  const scene::Step step = stepsOf(list).at(0);
  EXPECT_EQ(step.loads.at({0, 0}), 3);
  EXPECT_EQ(step.loads.at({1, 0}), -2.5);
}

TEST(StepReaderTest, CoefficientsOfFrictionChangeWhereThereIsFriction) {
  const scene::Scene scene = [] {
    scene::Scene made;
    made.contacts.resize(1);
    made.contacts[0].friction = 0.25;
    return made;
  }();
  scene::Step step;
  step.friction[0] = 0.5;
  EXPECT_EQ(scene::atStep(scene, {step}, 0).contacts[0].friction, 0.5);
  expectSays(refusalOfStep("Friction", "interface = 0.5"),
             {"\"Friction\"", "\"interface\"", "greater than 0"});
}

TEST(StepReaderTest, SupportsAndContactsComeAndGo) {
  ParameterList list = loaded();
  list.sublist("Steps").sublist("free").set("Supports", "left/wall = off").set("Contacts", "interface = off");
  list.sublist("Steps")
      .sublist("hold")
      .set("Supports", "left/wall = fixed")
      .set("Contacts", "interface = on");
  list.sublist("Steps").sublist("move").set("Supports", "left/wall = 2");
  const scene::Scene whole = scene::readScene(list, "a.xml");
  const std::vector<scene::Step> steps = stepsOf(list);
  const scene::Scene free = scene::atStep(whole, steps, 0), hold = scene::atStep(whole, steps, 1),
                     move = scene::atStep(whole, steps, 2);
  EXPECT_EQ(free.bodies[0].supports.size() + 1, whole.bodies[0].supports.size());
  EXPECT_FALSE(free.contacts[0].isOn);
  EXPECT_TRUE(hold.contacts[0].isOn);
  EXPECT_TRUE(hold.bodies[0].supports[0].displacements.has_value());
  EXPECT_FALSE(move.bodies[0].supports[0].displacements.has_value());
  EXPECT_EQ(move.bodies[0].supports[0].value[0], 1);
  expectSays(refusalOfStep("Supports", "left/wall = fixed"), {"\"Supports\"", "left/wall", "no step"});
  expectSays(refusalOfStep("Contacts", "interface = gone"), {"\"Contacts\"", "name = off"});
  expectSays(refusalOfStep("Preload", "interface = locked"), {"\"Preload\"", "has no Preload"});
}

TEST(StepReaderTest, RefusesWhatIsNotThere) {
  expectSays(refusalOfStep("Loads", "left/psuh=1"),
             {"a.xml: ", "\"Loads\"", "\"Steps/press\"", "left/psuh", "did you mean \"left/push\"?"});
  expectSays(refusalOfStep("Supports", "right/x=1"), {"\"Supports\"", "right/x", "\"left/wall\""});
  expectSays(refusalOfStep("Gaps", "contact=1"), {"\"Gaps\"", "contact", "\"interface\""});
  for (const char* const text :
       {"left/push", "left/push=", "left/push=two", "left/push=1e999", "left/push=1 2", "left/push=+-1"})
    expectSays(refusalOfStep("Loads", text), {"\"Loads\"", "name = number"});
  expectSays(refusalOfStep("Loads", "="), {"\"Loads\"", "name = value"});
  expectSays(refusalOfStep("Loads", "left/push = 1, left/push = 0"),
             {"\"Loads\"", "\"left/push\" is named twice"});
}

} // namespace
