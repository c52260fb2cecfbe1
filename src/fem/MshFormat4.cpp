#include "epafi/fem/GmshContents.hpp"
#include "epafi/fem/MshRecords.hpp"

namespace epafi::fem {
namespace {

/// Totals that a section begins with; between blocks they are counted down.
struct Totals {
  LocalOrdinal blocks = 0;
  GlobalOrdinal things = 0;
};

Totals totalsOf(MshScanner& file, const std::string& things, std::size_t bytesEach, std::size_t numbersEach) {
  Totals totals;
  totals.blocks = file.count("blocks of " + things, 12, 3);
  totals.things = file.count(things, bytesEach, numbersEach);
  (void)file.whole(); // the least and the greatest of their numbers, which we find ourselves
  (void)file.whole();
  return totals;
}

void requireTotal(const MshScanner& file, const std::string& things, GlobalOrdinal total,
                  GlobalOrdinal found) {
  if (total != found)
    file.refuse("the blocks hold " + std::to_string(found) + ' ' + things + ", but should hold " +
                std::to_string(total) + "; the file is damaged, so save it anew");
}

int dimensionIn(MshScanner& file) {
  const int dimension = file.integer();
  if (dimension < 0 || dimension > 3)
    file.refuse("there is no dimension " + std::to_string(dimension) +
                "; the file is damaged, so save it anew");
  return dimension;
}

void skipIntegers(MshScanner& file, const std::string& things) {
  const LocalOrdinal number = file.count(things, 4, 1);
  for (LocalOrdinal i = 0; i < number; ++i)
    (void)file.integer();
}

/// Number, perhaps parent and partitions, extent, groups and, but for points, boundary.
void readEntity(MshScanner& file, MshRecords& records, int dimension, bool isPartitioned) {
  const int entity = file.integer();
  if (isPartitioned) {
    (void)file.integer();
    (void)file.integer();
    skipIntegers(file, "partitions");
  }
  for (int i = 0; i < (dimension == 0 ? 3 : 6); ++i)
    (void)file.real();
  const LocalOrdinal numGroups = file.count("physical groups", 4, 1);
  for (LocalOrdinal g = 0; g < numGroups; ++g)
    records.groupEntities[static_cast<std::size_t>(dimension)][groupOfTag(file, file.integer())].push_back(
        entity);
  if (dimension > 0)
    skipIntegers(file, "boundary entities");
}

} // namespace

void readEntities4(MshScanner& file, MshRecords& records, bool isPartitioned) {
  if (isPartitioned) {
    (void)file.whole();
    const LocalOrdinal numGhosts = file.count("ghost entities", 8, 2);
    for (LocalOrdinal i = 0; i < 2 * numGhosts; ++i)
      (void)file.integer();
  }
  std::array<LocalOrdinal, 4> numbers{};
  for (LocalOrdinal& number : numbers)
    number = file.count("entities", 36, 5);
  for (int dimension = 0; dimension < 4; ++dimension)
    for (LocalOrdinal i = 0; i < numbers[static_cast<std::size_t>(dimension)]; ++i)
      readEntity(file, records, dimension, isPartitioned);
}

void readNodes4(MshScanner& file, MshRecords& records) {
  const Totals totals = totalsOf(file, "nodes", 32, 4);
  for (LocalOrdinal block = 0; block < totals.blocks; ++block) {
    const int dimension = dimensionIn(file), entity = file.integer();
    const int numParameters = file.integer() == 0 ? 0 : dimension; // where on the entity they lie
    const LocalOrdinal number = file.count("nodes", 32, 4);
    for (LocalOrdinal n = 0; n < number; ++n) {
      records.nodeTags.push_back(checkedTag(file, file.whole()));
      records.nodeEntities.push_back({dimension, entity});
    }
    for (LocalOrdinal n = 0; n < number; ++n) {
      for (double& coordinate : records.points.emplace_back())
        coordinate = file.real();
      for (int i = 0; i < numParameters; ++i)
        (void)file.real();
    }
  }
  requireTotal(file, "nodes", totals.things, static_cast<GlobalOrdinal>(records.nodeTags.size()));
}

void readElements4(MshScanner& file, MshRecords& records) {
  const Totals totals = totalsOf(file, "elements", 16, 2);
  GlobalOrdinal found = 0;
  for (LocalOrdinal b = 0; b < totals.blocks; ++b) {
    const int dimension = dimensionIn(file);
    MshBlock block{file.integer(), file.integer(), {}, {}};
    const LocalOrdinal number = file.count("elements", 16, 2);
    for (LocalOrdinal e = 0; e < number; ++e) {
      block.tags.push_back(file.whole());
      const int numNodes = numNodesOfMsh(file, block.type, block.tags.back());
      if (dimensionOfGmsh(block.type) != dimension)
        file.refuse("element " + std::to_string(block.tags.back()) + " lies on an entity of dimension " +
                    std::to_string(dimension) + ", but its kind has " +
                    std::to_string(dimensionOfGmsh(block.type)) + "; the file is damaged, so save it anew");
      for (int i = 0; i < numNodes; ++i)
        block.nodes.push_back(checkedTag(file, file.whole()));
    }
    found += number;
    if (number > 0)
      records.blocks[static_cast<std::size_t>(dimension)].push_back(std::move(block));
  }
  requireTotal(file, "elements", totals.things, found);
}

} // namespace epafi::fem
