#include "epafi/model/MeshFiles.hpp"

#include "epafi/base/Collective.hpp"
#include "epafi/fem/GmshReader.hpp"

#include <Teuchos_CommHelpers.hpp>

#include <algorithm>
#include <set>
#include <utility>

namespace epafi::model {
namespace {

/// Rank 0's text on all ranks, in messages whose length an int counts. Collective.
void broadcastText(const Comm& comm, std::string& text) {
  auto size = static_cast<long long>(text.size());
  Teuchos::broadcast(comm, 0, 1, &size);
  collectively(comm, [&] { text.resize(static_cast<std::size_t>(size)); });
  constexpr long long longest = 1 << 30;
  for (long long first = 0; first < size; first += longest)
    Teuchos::broadcast(comm, 0, static_cast<int>(std::min(longest, size - first)), text.data() + first);
}

} // namespace

MeshFiles::MeshFiles(const scene::Scene& scene, const Comm& comm) {
  std::set<Key> keys;
  for (const scene::Body& body : scene.bodies)
    if (!body.mesh.file.empty())
      keys.insert({body.mesh.file, body.mesh.sizeFactor, body.mesh.refinements});
  for (const Key& key : keys) {
    const auto& [file, factor, refinements] = key;
    std::string text;
    collectively(comm, [&] {
      if (comm.getRank() == 0)
        text = fem::textOfMeshFile(file, factor, refinements);
    });
    broadcastText(comm, text);
    collectively(comm, [&] { files_.emplace(key, fem::readMsh(file, std::move(text))); });
  }
}

const fem::GmshFile& MeshFiles::of(const scene::MeshSource& source) const {
  return files_.at({source.file, source.sizeFactor, source.refinements});
}

} // namespace epafi::model
