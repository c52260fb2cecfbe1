#pragma once

/// Small lists that tests change in one place.

#include "epafi/scene/SceneReader.hpp"
#include "support/Arrays.hpp"
#include "support/Refusal.hpp"

#include <Teuchos_ParameterList.hpp>

#include <string>

namespace epafi::test {

/// Two unit squares of 4×4 elements, `left` supported on its left, in contact along x = 1.
inline Teuchos::ParameterList twoBodies() {
  Teuchos::ParameterList list("Epafi");
  double x = 0;
  for (const char* const name : {"left", "right"}) {
    auto& body = list.sublist("Bodies").sublist(name);
    body.set("Rectangle", numbers({x, x + 1, 0, 1})).set("Elements", counts({4, 4}));
    x += 1;
  }
  list.sublist("Bodies").sublist("left").sublist("Supports").sublist("wall").set("Edge", "left");
  auto& pair = list.sublist("Contact").sublist("interface");
  pair.set("First Body", "left").set("First Edge", "right");
  pair.set("Second Body", "right").set("Second Edge", "left");
  return list;
}

inline Teuchos::ParameterList& bodyOf(Teuchos::ParameterList& list, const std::string& name) {
  return list.sublist("Bodies").sublist(name);
}

inline Teuchos::ParameterList& pairOf(Teuchos::ParameterList& list) {
  return list.sublist("Contact").sublist("interface");
}

/// What readScene says against twoBodies() after `change`.
template <class Change>
std::string sceneRefusal(const Change& change) {
  Teuchos::ParameterList list = twoBodies();
  change(list);
  return refusal([&] { scene::readScene(list, "a.xml"); });
}

/// A cube of 2×2×2 elements on a rigid floor.
inline Teuchos::ParameterList cubeOnFloor() {
  Teuchos::ParameterList list("Epafi");
  Teuchos::ParameterList& cube = bodyOf(list, "cube");
  cube.set("Physics", "elasticity 3-D").set("Box", numbers({0, 1, 0, 1, 0, 1}));
  cube.set("Elements", counts({2, 2, 2})).set("Young's Modulus", 200.0).set("Poisson's Ratio", 0.3);
  list.sublist("Obstacles").sublist("floor").set("Kind", "plane").set("Point", numbers({0, 0, 0}));
  list.sublist("Obstacles").sublist("floor").set("Normal", numbers({0, 0, 2}));
  Teuchos::ParameterList& pair = list.sublist("Contact").sublist("rest");
  pair.set("First Body", "cube").set("First Surface", "bottom").set("Obstacle", "floor");
  return list;
}

/// What readScene says against cubeOnFloor() after a change.
template <class Change>
std::string solidRefusal(const Change& change) {
  Teuchos::ParameterList list = cubeOnFloor();
  change(list);
  return refusal([&] { scene::readScene(list, "scenes/a.xml"); });
}

/// … after a change of the cube's list.
template <class Value>
std::string cubeRefusal(const std::string& name, const Value& value) {
  return solidRefusal([&](Teuchos::ParameterList& list) { bodyOf(list, "cube").set(name, value); });
}

/// … of a new entry in one of the cube's lists.
template <class Change>
std::string entryRefusal(const std::string& kind, const Change& change) {
  return solidRefusal(
      [&](Teuchos::ParameterList& list) { change(bodyOf(list, "cube").sublist(kind).sublist("new")); });
}

inline scene::Body solidOf(const Teuchos::ParameterList& list) {
  return scene::readScene(list, "scenes/a.xml").bodies.at(0);
}

} // namespace epafi::test
