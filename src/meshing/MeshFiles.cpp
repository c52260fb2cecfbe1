#include "epafi/meshing/MeshFiles.hpp"

#include "epafi/base/Collective.hpp"

#include <Teuchos_CommHelpers.hpp>

#include <algorithm>
#include <optional>
#include <utility>

namespace epafi::meshing {

/// In messages whose length an int counts.
void broadcastText(const Comm& comm, std::string& text) {
  long long size = text.size();
  Teuchos::broadcast(comm, 0, 1, &size);
  collectively(comm, [&] { text.resize(size); });
  constexpr long long longest = 1 << 30;
  for (long long first = 0; first < size; first += longest)
    Teuchos::broadcast(comm, 0, static_cast<int>(std::min(longest, size - first)), text.data() + first);
}

std::string textOnAllRanks(const std::function<std::string()>& makeText, const Comm& comm) {
  std::string text;
  collectively(comm, [&] {
    if (comm.getRank() == 0)
      text = makeText();
  });
  broadcastText(comm, text);
  return text;
}

GmshFile meshOnAllRanks(const std::string& file, const std::function<std::string()>& makeText,
                        const Comm& comm) {
  std::string text = textOnAllRanks(makeText, comm);
  std::optional<GmshFile> mesh;
  collectively(comm, [&] { mesh.emplace(meshing::readMsh(file, std::move(text))); });
  return std::move(*mesh);
}

} // namespace epafi::meshing
