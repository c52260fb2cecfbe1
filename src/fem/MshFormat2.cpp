#include "epafi/fem/GmshContents.hpp"
#include "epafi/fem/MshRecords.hpp"

namespace epafi::fem {
namespace {

/// Finds the block of an element by what the file says of it.
class Blocks {
public:
  explicit Blocks(MshRecords& records) : records_(records) {}

  MshBlock& of(int type, int group, int entity) {
    const std::array<int, 3> key{type, group, entity};
    auto& blocks = records_.blocks[static_cast<std::size_t>(dimensionOfGmsh(type))];
    if (key != lastKey_) {
      const auto [found, isNew] = places_.try_emplace(key, blocks.size());
      if (isNew)
        blocks.push_back({entityOf(dimensionOfGmsh(type), group, entity), type, {}, {}});
      lastKey_ = key;
      last_ = found->second;
    }
    return blocks[last_];
  }

private:
  /// A number for group and entity, which no other pair has.
  int entityOf(int dimension, int group, int entity) {
    const auto [found, isNew] =
        entities_.try_emplace({dimension, group, entity}, static_cast<int>(entities_.size()) + 1);
    if (isNew && group != 0)
      records_.groupEntities[static_cast<std::size_t>(dimension)][group].push_back(found->second);
    return found->second;
  }

  MshRecords& records_;
  std::map<std::array<int, 3>, std::size_t> places_; ///< of each block among those of its dimension
  std::map<std::array<int, 3>, int> entities_;
  std::array<int, 3> lastKey_{}; ///< no element has the kind 0
  std::size_t last_ = 0;
};

/// What stands before an element, or in binary before several.
struct Header {
  int type = 0, numElements = 1, numTags = 0;
};

Header headerOf(MshScanner& file, LocalOrdinal numLeft) {
  Header header;
  header.type = file.integer();
  if (file.isBinary())
    header.numElements = file.integer();
  header.numTags = file.integer();
  if (header.numElements < 1 || header.numElements > numLeft)
    file.refuse("here " + std::to_string(header.numElements) + " elements should follow, but only " +
                std::to_string(numLeft) + " are left; the file is damaged, so save it anew");
  if (header.numTags < 0)
    file.refuse("an element has " + std::to_string(header.numTags) +
                " tags; the file is damaged, so save it anew");
  return header;
}

/// Tags and nodes of an element: its group, its entity, and partitions, which do not matter.
void readElement(MshScanner& file, const Header& header, int number, Blocks& blocks) {
  std::array<int, 2> tags{0, 0};
  for (int t = 0; t < header.numTags; ++t)
    if (const int tag = file.integer(); t < 2)
      tags[static_cast<std::size_t>(t)] = tag;
  const int numNodes = numNodesOfMsh(file, header.type, number);
  MshBlock& block = blocks.of(header.type, groupOfTag(file, tags[0]), tags[1]);
  block.tags.push_back(number);
  for (int i = 0; i < numNodes; ++i)
    block.nodes.push_back(checkedTag(file, file.integer()));
}

} // namespace

void readNodes2(MshScanner& file, MshRecords& records, bool isParametric) {
  const LocalOrdinal number = file.countInLine("nodes", 28, 4);
  for (LocalOrdinal n = 0; n < number; ++n) {
    records.nodeTags.push_back(checkedTag(file, file.integer()));
    for (double& coordinate : records.points.emplace_back())
      coordinate = file.real();
    records.nodeEntities.push_back({-1, 0});
    if (!isParametric)
      continue;
    const int dimension = file.integer(); // of the entity inside which it lies
    (void)file.integer();
    for (int i = 0; i < dimension && dimension < 3; ++i)
      (void)file.real(); // where on the curve or surface
  }
}

void readElements2(MshScanner& file, MshRecords& records) {
  const LocalOrdinal number = file.countInLine("elements", 8, 4);
  Blocks blocks(records);
  for (LocalOrdinal e = 0; e < number;) {
    if (!file.isBinary()) {
      const int tag = file.integer();
      readElement(file, headerOf(file, number - e), tag, blocks);
      ++e;
      continue;
    }
    const Header header = headerOf(file, number - e);
    for (int i = 0; i < header.numElements; ++i, ++e)
      readElement(file, header, file.integer(), blocks);
  }
}

} // namespace epafi::fem
