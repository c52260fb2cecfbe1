/// Any bytes as a mesh file: what it says, its checks, and the meshes of its bodies. They are made, or
/// refused in a sentence; nothing else may happen.

#include "Refusals.hpp"

#include "epafi/meshing/GmshFile.hpp"
#include "epafi/meshing/MshReader.hpp"

#include <cstdint>
#include <string>

namespace {

using namespace epafi;

/// What a body is asked for.
void use(const mesh::UnstructuredMesh& mesh) {
  for (const std::string& surface : mesh.surfaceNames())
    (void)mesh.surface(surface);
  for (const std::string& group : mesh.groupNames())
    (void)mesh.group(group);
}

} // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  std::string text(reinterpret_cast<const char*>(data), size);
  fuzz::orRefused([&] {
    const meshing::GmshFile file(meshing::readMsh("mesh.msh", std::move(text)));
    fuzz::orRefused([&] { use(file.body("")); });
    fuzz::orRefused([&] { use(file.body("nobody")); });
    for (const std::string& group : file.groupNames())
      fuzz::orRefused([&] { use(file.body(group)); });
  });
  return 0;
}
