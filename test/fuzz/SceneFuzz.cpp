/// Any bytes as the text of a scene file: parameter list, scene, and the models of small bodies. They are
/// read, or refused in a sentence; nothing else may happen.

#include "Refusals.hpp"

#include "epafi/fem/BodyModel.hpp"
#include "epafi/mesh/StructuredMesh.hpp"
#include "epafi/scene/ParameterFile.hpp"
#include "epafi/scene/SceneReader.hpp"

#include <cstdint>
#include <numeric>
#include <string>
#include <vector>

namespace {

using namespace epafi;

/// Larger bodies are no harder to read, only slower.
constexpr long long mostElements = 1000;

/// What assembly asks of a model.
void assemble(const fem::BodyModel& model) {
  std::vector<GlobalOrdinal> elements(model.mesh().numElements()), kinds = elements;
  std::iota(elements.begin(), elements.end(), GlobalOrdinal{0});
  model.kinds(elements, kinds);
  Eigen::MatrixXd stiffness, loads;
  model.stiffness(kinds.front(), stiffness);
  model.stiffness(kinds.back(), stiffness);
  model.loads(elements, loads);
  std::vector<GlobalOrdinal> nodes(model.mesh().numNodes());
  std::iota(nodes.begin(), nodes.end(), GlobalOrdinal{0});
  std::vector<fem::PrescribedValue> values;
  model.prescribed(nodes, values);
  for (int mode = 0; mode < model.kernelDimension(); ++mode)
    (void)model.kernelValue(nodes.back(), model.components() - 1, mode);
}

void model(const scene::Body& body) {
  const std::array<int, 3>& elements = body.mesh.elements;
  if (elements[0] == 0) // from a file
    return;
  long long number = 1;
  for (const int along : elements) {
    number *= std::max(along, 1);
    if (number > mostElements)
      return;
  }
  const mesh::StructuredMesh mesh(body.mesh.box, elements);
  assemble(fem::BodyModel(body, mesh));
}

} // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string text(reinterpret_cast<const char*>(data), size);
  fuzz::orRefused([&] {
    const scene::Scene scene = scene::readScene(scene::parseParameters(text, "scene.xml"), "scene.xml");
    for (const scene::Body& body : scene.bodies)
      fuzz::orRefused([&] { model(body); });
  });
  return 0;
}
