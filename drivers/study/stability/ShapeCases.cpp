/// Flat elements and flat subdomains, subdomains of very many elements, very many subdomains, and the ragged ones of METIS.

#include "ContactRun.hpp"
#include "Scenes.hpp"

#include <string>
#include <utility>

namespace epafi::drivers {
namespace {

void add(StabilityCases& cases, const std::string& name, const std::string& parameter, double value,
         const ContactTask& task, bool withPlain = true) {
  for (const char* variant : {"default", "plain"}) {
    const bool isPlain = std::string(variant) == "plain";
    if (isPlain && !withPlain)
      continue;
    ContactTask mine = task;
    if (isPlain)
      mine.solver = plainMethod();
    StabilityCase trial{"shapes", name, parameter, isPlain && value > 10 ? solvedOrStopped() : solved(), {}};
    trial.run = [mine](const RCP<const Comm>& comm) { return solveContact(mine, comm); };
    trial.value = value;
    trial.variant = variant;
    cases.push_back(std::move(trial));
  }
}

std::string ratio(int value) {
  return "1:" + std::to_string(value);
}

/// Unit squares in 2 × 2 square subdomains with elements `flat` times as long as high.
scene::Scene flatElements(int flat) {
  scene::Scene scene = membranes(true, 2, 2);
  for (scene::Body& body : scene.bodies)
    body.elements = {4, 4 * flat};
  return scene;
}

/// Unit squares cut into layers `flat` times as long as high, of square elements.
scene::Scene flatSubdomains(int flat, int elements) {
  scene::Scene scene = membranes(true, 1, elements);
  for (scene::Body& body : scene.bodies)
    body.decomposition = grid({1, flat, 1});
  return scene;
}

/// Bodies, subdomains and elements all as flat.
scene::Scene flatBodies(int flat) {
  scene::Scene scene = membranes(true, 4, 4);
  for (scene::Body& body : scene.bodies) {
    body.rectangle.y1 /= flat;
    for (scene::Load& load : body.loads) {
      load.box.y0 /= flat;
      load.box.y1 /= flat;
    }
  }
  return scene;
}

/// The pressed squares with elements `flat` times as long as high, or as high as long.
scene::Scene flatElasticElements(int flat, bool isHigh) {
  scene::Scene scene = pressedSquares(2, 2);
  for (scene::Body& body : scene.bodies)
    body.solid->mesh.elements =
        isHigh ? std::array<int, 3>{4 * flat, 4, 0} : std::array<int, 3>{4, 4 * flat, 0};
  return scene;
}

/// The pressed squares made into layers, with everything in them.
scene::Scene flatElasticBodies(int flat) {
  scene::Scene scene = pressedSquares(2, 4);
  const double height = 1.0 / flat;
  scene.bodies[0].solid->mesh.box = {{0, 0, 0}, {1, height, 0}};
  scene.bodies[1].solid->mesh.box = {{0, height, 0}, {1, 2 * height, 0}};
  return scene;
}

void addRatios(StabilityCases& cases, bool quick) {
  for (const int flat : {1, 10, 100}) {
    add(cases, "flat elements", ratio(flat), flat, {flatElements(flat)});
    add(cases, "flat bodies, subdomains and elements", ratio(flat), flat, {flatBodies(flat)});
    add(cases, "flat elastic bodies and elements", ratio(flat), flat, {flatElasticBodies(flat)});
    if (!quick || flat < 100) {
      add(cases, "flat elastic elements", ratio(flat), flat, {flatElasticElements(flat, false)});
      add(cases, "high elastic elements", ratio(flat), flat, {flatElasticElements(flat, true)});
      add(cases, "flat subdomains", ratio(flat), flat, {flatSubdomains(flat, flat < 100 ? 20 : 100)});
    }
  }
}

void addSizes(StabilityCases& cases, bool quick) {
  for (int elements = 4; elements <= (quick ? 16 : 128); elements *= 2) {
    ContactTask task{membranes(true, 2, elements)};
    task.hasReference = elements <= 32;
    add(cases, "H/h", std::to_string(elements), elements, task);
  }
  for (int subdomains = 2; subdomains <= (quick ? 8 : 32); subdomains *= 2) {
    ContactTask task{membranes(true, subdomains, 4)};
    task.hasReference = subdomains <= 16;
    add(cases, "1/H", std::to_string(subdomains), subdomains, task);
    task.scene = membranes(false, subdomains, 4);
    if (!quick || subdomains <= 4)
      add(cases, "1/H, floating", std::to_string(subdomains), subdomains, task, false);
  }
}

void addGraphParts(StabilityCases& cases, bool quick) {
  for (const int parts : {2, 3, 7, 13, 31}) {
    if (quick && parts > 13)
      continue;
    const std::string words = std::to_string(parts) + " parts";
    add(cases, "METIS, ragged", words, parts, {cut(membranes(true, 1, quick ? 8 : 24), metis(parts))}, false);
    add(cases, "METIS, ragged, floating", words, parts,
        {cut(membranes(false, 1, quick ? 8 : 24), metis(parts))}, false);
    add(cases, "METIS, elastic", words, parts, {cut(pressedSquares(1, quick ? 6 : 16), metis(parts))}, false);
    if (!quick || parts == 7)
      add(cases, "METIS, elastic in space", words, parts, {cut(pressedCubes(1, quick ? 4 : 6), metis(parts))},
          false);
  }
  scene::Scene thin = cut(membranes(true, 1, 8), metis(7)); // two elements high
  for (scene::Body& body : thin.bodies)
    body.elements = {32, 2};
  add(cases, "METIS, thin body", "7 parts of 32 x 2 elements", unknown, {thin}, false);
  add(cases, "METIS, subdomains of one element", "16 parts of 4 x 4", unknown,
      {cut(membranes(true, 1, 4), metis(16))}, false);
  add(cases, "METIS, subdomains of one or two", "11 parts of 4 x 4", unknown,
      {cut(membranes(false, 1, 4), metis(11))}, false);
  add(cases, "slabs in space", "4 x 1 x 1, two elements thick", unknown,
      {cut(pressedCubes(1, quick ? 4 : 8), grid({4, 1, 1}))}, false);
}

} // namespace

StabilityCases shapeCases(bool quick) {
  StabilityCases cases;
  addRatios(cases, quick);
  addSizes(cases, quick);
  addGraphParts(cases, quick);
  return cases;
}

} // namespace epafi::drivers
