#pragma once

/// The block that the examples press and change.

#include "epafi/scene/Scene.hpp"

/// A block that is held below, with a rigid floor on its top; the steps shape the floor by its gaps.
inline epafi::scene::Scene block(int elements, int subdomains) {
  using namespace epafi::scene;
  Body body;
  body.name = "block";
  body.physics = epafi::fem::Physics::elasticity3d;
  body.material.youngsModulus = 200;
  body.mesh.box = {{0, 0, 0}, {2, 2, 1}};
  body.mesh.elements = {2 * elements, 2 * elements, elements};
  body.supports = {{"floor", "bottom", {0.0, 0.0, 0.0}, {}}};
  body.decomposition.method = Decomposition::Method::metis;
  body.decomposition.parts = subdomains;
  SurfaceContact contact;
  contact.name = "punch";
  contact.first = 0;
  contact.firstSurface = "top";
  contact.obstacle.point = {0, 0, 1};
  contact.obstacle.normal = {0, 0, -1};
  Scene scene;
  scene.bodies = {body};
  scene.contacts = {contact};
  return scene;
}
