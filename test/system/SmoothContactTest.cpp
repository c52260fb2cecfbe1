// Round bodies that only their facets hold are refused, whatever the mesh; bodies that really hold each other
// are solved.

#include "support/MeshFiles.hpp"
#include "support/SolidScenes.hpp"

#include <cmath>
#include <functional>
#include <numbers>
#include <random>
#include <sstream>

namespace epafi {
namespace {

using namespace test;

using Radius = std::function<double(double angle)>;

Radius circle(double radius) {
  return [radius](double) { return radius; };
}

/// About radius · (1 + ovality cos(lobes · angle)).
Radius lobed(double radius, double ovality, int lobes) {
  return [=](double angle) { return radius * (1 + ovality * std::cos(lobes * angle)); };
}

/// A ring between two radii: `around` elements along it, two across, with nodes off their even places and all
/// of it turned by an angle; of a height it is as many layers of bricks.
struct Ring {
  Radius inner, outer;
  int around = 24;
  double unevenness = 0.2;
  unsigned seed = 1;
  int layers = 0;
  double centre = 0; ///< y
};

/// A mesh file with the surfaces "inner", "outer" and, in space, "end" at z = 0.
std::string meshOfRing(const Ring& ring) {
  constexpr int numAcross = 2;
  std::mt19937 engine(ring.seed);
  std::uniform_real_distribution<double> random(-1, 1);
  const double size = 2 * std::numbers::pi / ring.around, turn = random(engine);
  const bool isInSpace = ring.layers > 0;
  std::ostringstream nodes, elements;
  int numNodes = 0, numElements = 0;
  nodes.precision(17);
  const auto number = [&](int layer, int across, int i) {
    return 1 + (layer * (numAcross + 1) + across) * ring.around + i % ring.around;
  };
  for (int layer = 0; layer <= ring.layers; ++layer)
    for (int across = 0; across <= numAcross; ++across)
      for (int i = 0; i < ring.around; ++i) {
        const double angle = turn + size * (i + ring.unevenness * random(engine)),
                     share = static_cast<double>(across) / numAcross,
                     r = (1 - share) * ring.inner(angle) + share * ring.outer(angle);
        const bool isRim = layer == 0 || layer == ring.layers;
        const double z = layer + (isRim ? 0 : ring.unevenness * random(engine));
        nodes << ++numNodes << ' ' << r * std::cos(angle) << ' ' << ring.centre + r * std::sin(angle) << ' '
              << 0.25 * z << '\n';
      }
  const auto add = [&](int type, int group, const std::vector<int>& list) {
    elements << ++numElements << ' ' << type << " 2 " << group << ' ' << group;
    for (const int node : list)
      elements << ' ' << node;
    elements << '\n';
  };
  for (int layer = 0; layer < std::max(ring.layers, 1); ++layer)
    for (int i = 0; i < ring.around; ++i)
      for (int across = 0; across < numAcross; ++across) {
        std::vector<int> below{number(layer, across, i), number(layer, across + 1, i),
                               number(layer, across + 1, i + 1), number(layer, across, i + 1)},
            brick = below;
        for (const int node : below)
          brick.push_back(node + (numAcross + 1) * ring.around);
        add(isInSpace ? 5 : 3, 1, isInSpace ? brick : below);
        if (isInSpace && layer == 0)
          add(3, 4, below);
        if (isInSpace && across == 0)
          add(3, 2, {brick[0], brick[3], brick[7], brick[4]});
        if (isInSpace && across + 1 == numAcross)
          add(3, 3, {brick[1], brick[2], brick[6], brick[5]});
        if (!isInSpace && across == 0)
          add(1, 2, {below[3], below[0]});
        if (!isInSpace && across + 1 == numAcross)
          add(1, 3, {below[1], below[2]});
      }
  std::ostringstream file;
  const int dimension = isInSpace ? 3 : 2;
  file << "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$PhysicalNames\n"
       << (isInSpace ? 4 : 3) << '\n'
       << dimension << " 1 \"ring\"\n"
       << dimension - 1 << " 2 \"inner\"\n"
       << dimension - 1 << " 3 \"outer\"\n"
       << (isInSpace ? "2 4 \"end\"\n" : "") << "$EndPhysicalNames\n$Nodes\n"
       << numNodes << '\n'
       << nodes.str() << "$EndNodes\n$Elements\n"
       << numElements << '\n'
       << elements.str() << "$EndElements\n";
  return file.str();
}

class SmoothContactTest : public testing::Test {
protected:
  scene::Body body(const std::string& name, const Ring& ring, int order = 1) {
    scene::Body made;
    made.name = name;
    made.physics = ring.layers > 0 ? Physics::elasticity3d : Physics::planeStrain;
    made.mesh.file = folder_.write(name + std::to_string(count_++) + ".msh", meshOfRing(ring));
    made.mesh.order = order;
    made.material.youngsModulus = 200;
    made.decomposition = cutByMetis(2);
    return made;
  }

  /// A pin in a bore that is held outside; the pin is pressed down.
  scene::Scene pinInBore(const Ring& pin, const Ring& bore, int order = 1) {
    scene::Scene scene;
    scene.bodies = {body("pin", pin, order), body("bore", bore, order)};
    scene.bodies[0].loads = {weight({0, -1, 0})};
    scene.bodies[1].supports = {{"held", "outer", {0.0, 0.0, 0.0}}};
    if (pin.layers == 0)
      scene.bodies[1].supports[0].value[2].reset();
    scene.contacts = {between("fit", 0, "outer", 1, "inner")};
    return scene;
  }

  /// The other side has the multipliers.
  static scene::Scene swapped(scene::Scene scene) {
    scene.contacts[0].multipliers = scene::SurfaceContact::Side::second;
    return scene;
  }

private:
  epafi::test::MeshFolder folder_;
  int count_ = 0;
};

TEST_F(SmoothContactTest, APinTurnsInItsBoreWhateverTheMesh) {
  unsigned seed = 0;
  for (const int around : {8, 12, 25, 60})
    for (const double clearance : {0.0, 0.01})
      for (const double unevenness : {0.0, 0.2}) {
        const Ring pin{circle(0.5), circle(1), around, unevenness, ++seed},
            bore{circle(1 + clearance), circle(2), around + 2, unevenness, ++seed};
        SCOPED_TRACE(testing::Message() << around << ' ' << clearance << ' ' << unevenness);
        const scene::Scene scene = pinInBore(pin, bore);
        expectNotUnique(scene, {"'pin'", "turn about the point"});
        expectNotUnique(swapped(scene), {"'pin'", "turn about the point"});
      }
}

TEST_F(SmoothContactTest, SoDoesOneOfOrderTwo) {
  const scene::Scene scene =
      pinInBore({circle(0.5), circle(1), 16, 0.2, 3}, {circle(1.01), circle(2), 20, 0.2, 4}, 2);
  expectNotUnique(scene, {"'pin'", "turn about the point"});
  expectNotUnique(swapped(scene), {"'pin'", "turn about the point"});
}

TEST_F(SmoothContactTest, APinInSpaceSlidesAndTurns) {
  for (const int around : {12, 24}) {
    const scene::Scene scene = pinInBore({circle(0.5), circle(1), around, 0.2, 5, 2},
                                         {circle(1.01), circle(2), around + 1, 0.2, 6, 3});
    expectNotUnique(scene, {"'pin'", "slide along z", "turn about the axis through", "along z"});
    expectNotUnique(swapped(scene), {"'pin'", "slide along z", "turn about the axis through", "along z"});
  }
}

TEST_F(SmoothContactTest, APinThatIsNotRoundHolds) {
  for (const int around : {16, 40})
    for (const int lobes : {2, 3}) {
      const Ring pin{circle(0.5), lobed(1, 0.1, lobes), around, 0.2, 7},
          bore{lobed(1.001, 0.1, lobes), circle(2), around + 3, 0.2, 8};
      const scene::Scene scene = pinInBore(pin, bore);
      EXPECT_FALSE(refusalOf(scene).kind) << around << ' ' << lobes << refusalOf(scene).text;
      EXPECT_FALSE(refusalOf(swapped(scene)).kind) << around << ' ' << lobes;
    }
}

TEST_F(SmoothContactTest, ARoundPinInABoreThatIsNotRoundTurns) {
  expectNotUnique(
      pinInBore({circle(0.5), circle(1), 40, 0.2, 9}, {lobed(1.06, 0.05, 2), circle(2), 44, 0.2, 10}),
      {"'pin'"});
}

TEST_F(SmoothContactTest, ADiscRollsOnAFloorAndOnABlock) {
  for (const int order : {1, 2})
    for (const int around : {12, 31}) {
      scene::Scene floor;
      floor.bodies = {body("disc", {circle(0.5), circle(1), around, 0.2, 11, 0, 1}, order)};
      floor.bodies[0].loads = {weight({0, -1, 0})};
      floor.contacts = {onPlane("floor", 0, "outer", {0, 0, 0}, {0, 1, 0})};
      expectNotUnique(floor, {"'disc'"});
      scene::Scene onBlock = floor;
      onBlock.bodies.push_back(block("block", {{-2, -1, 0}, {2, 0, 0}}, {11, 3, 0}, cutInGrid({1, 1, 1})));
      onBlock.bodies[1].mesh.order = order;
      onBlock.bodies[1].supports = {{"held", "bottom", {0.0, 0.0, {}}}};
      onBlock.contacts = {between("touch", 0, "outer", 1, "top")};
      expectNotUnique(onBlock, {"'disc'"});
      expectNotUnique(swapped(onBlock), {"'disc'"});
    }
}

} // namespace
} // namespace epafi
