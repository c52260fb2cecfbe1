#include "epafi/model/MeshFiles.hpp"

#include "epafi/base/Collective.hpp"

#include <Teuchos_CommHelpers.hpp>

#include <algorithm>
#include <cstring>
#include <set>
#include <type_traits>
#include <vector>

namespace epafi::model {
namespace {

/// Values as bytes, one after the other.
class Packer {
public:
  template <class T>
  void operator()(T& value) {
    static_assert(std::is_trivially_copyable_v<T>);
    const auto* first = reinterpret_cast<const char*>(&value);
    bytes.insert(bytes.end(), first, first + sizeof(T));
  }
  template <class T>
  void array(std::vector<T>& values) {
    static_assert(std::is_trivially_copyable_v<T>);
    std::size_t size = values.size();
    (*this)(size);
    const auto* first = reinterpret_cast<const char*>(values.data());
    bytes.insert(bytes.end(), first, first + size * sizeof(T));
  }
  void text(std::string& text) {
    std::vector<char> letters(text.begin(), text.end());
    array(letters);
  }
  template <class T>
  void resize(std::vector<T>& values) {
    std::size_t size = values.size();
    (*this)(size);
  }

  std::vector<char> bytes;
};

/// The same calls bring the values back.
class Unpacker {
public:
  explicit Unpacker(const std::vector<char>& bytes) : next_(bytes.data()) {}

  template <class T>
  void operator()(T& value) {
    std::memcpy(&value, next_, sizeof(T));
    next_ += sizeof(T);
  }
  template <class T>
  void array(std::vector<T>& values) {
    resize(values);
    if (!values.empty())
      std::memcpy(values.data(), next_, values.size() * sizeof(T));
    next_ += values.size() * sizeof(T);
  }
  void text(std::string& text) {
    std::vector<char> letters;
    array(letters);
    text.assign(letters.begin(), letters.end());
  }
  template <class T>
  void resize(std::vector<T>& values) {
    std::size_t size = 0;
    (*this)(size);
    values.resize(size);
  }

private:
  const char* next_;
};

template <class Archive>
void pass(Archive& archive, std::vector<fem::GmshBlock>& blocks) {
  archive.resize(blocks);
  for (fem::GmshBlock& block : blocks) {
    archive(block.entity);
    archive(block.type);
    archive.array(block.tags);
    archive.array(block.nodes);
  }
}

template <class Archive>
void pass(Archive& archive, std::vector<fem::GmshGroup>& groups) {
  archive.resize(groups);
  for (fem::GmshGroup& group : groups) {
    archive.text(group.name);
    archive.array(group.entities);
  }
}

template <class Archive>
void pass(Archive& archive, fem::GmshContents& contents) {
  archive.text(contents.file);
  archive(contents.dimension);
  archive.array(contents.points);
  archive.array(contents.nodeTags);
  archive.array(contents.nodeEntities);
  for (auto* blocks : {&contents.elements, &contents.facets})
    pass(archive, *blocks);
  for (auto* groups : {&contents.groups, &contents.surfaces, &contents.lesser})
    pass(archive, *groups);
}

/// Rank 0's bytes on all ranks, in messages whose length an int counts.
void broadcastBytes(const Comm& comm, std::vector<char>& bytes) {
  auto size = static_cast<long long>(bytes.size());
  Teuchos::broadcast(comm, 0, 1, &size);
  bytes.resize(static_cast<std::size_t>(size));
  constexpr long long longest = 1 << 30;
  for (long long first = 0; first < size; first += longest)
    Teuchos::broadcast(comm, 0, static_cast<int>(std::min(longest, size - first)), bytes.data() + first);
}

fem::GmshContents readOnFirstRank(const std::string& file, double meshSizeFactor, int refinements,
                                  const Comm& comm) {
  fem::GmshContents contents;
  collectively(comm, [&] {
    if (comm.getRank() == 0)
      contents = fem::readGmshFile(file, meshSizeFactor, refinements);
  });
  if (comm.getSize() == 1)
    return contents;
  Packer packer;
  if (comm.getRank() == 0)
    pass(packer, contents);
  broadcastBytes(comm, packer.bytes);
  if (comm.getRank() > 0) {
    Unpacker unpacker(packer.bytes);
    pass(unpacker, contents);
  }
  return contents;
}

} // namespace

MeshFiles::MeshFiles(const scene::Scene& scene, const Comm& comm) {
  std::set<Key> keys;
  for (const scene::Body& body : scene.bodies)
    if (!body.mesh.file.empty())
      keys.insert({body.mesh.file, body.mesh.sizeFactor, body.mesh.refinements});
  for (const Key& key : keys) {
    const auto& [file, factor, refinements] = key;
    files_.emplace(key, fem::GmshFile(readOnFirstRank(file, factor, refinements, comm)));
  }
}

const fem::GmshFile& MeshFiles::of(const scene::MeshSource& source) const {
  return files_.at({source.file, source.sizeFactor, source.refinements});
}

} // namespace epafi::model
