#include "epafi/meshing/MshSections.hpp"

#include "epafi/base/Errors.hpp"
#include "epafi/meshing/MshCopies.hpp"

#include <cstdlib>
#include <limits>
#include <sstream>
#include <utility>

namespace epafi::meshing {
namespace {

/// Number of the physical group that a tag names; a negative one means that group, too, seen from the other
/// side.
int groupOfTag(const MshScanner& file, int tag) {
  if (tag == std::numeric_limits<int>::min())
    file.refuse("a physical group has the number " + std::to_string(tag) +
                "; the file is damaged, so save it anew");
  return std::abs(tag);
}

/// A node's tag. Throws if it is negative.
GlobalOrdinal checkedTag(const MshScanner& file, GlobalOrdinal tag) {
  if (tag < 0)
    file.refuse("a node has the number " + std::to_string(tag) +
                ", but must not have a negative one; the file is damaged, so save it anew");
  return tag;
}

/// Takes in a node's tag and the entity inside which it lies.
void addNode(const MshScanner& file, GlobalOrdinal tag, const std::array<int, 2>& entity,
             MshRecords& records) {
  records.nodeTags.push_back(checkedTag(file, tag));
  records.nodeEntities.push_back(entity);
}

void addPoint(MshScanner& file, MshRecords& records) {
  for (double& coordinate : records.points.emplace_back())
    coordinate = file.real();
}

/// Nodes of an element of that kind. Throws if it is of a kind that is not known.
int numNodesOf(const MshScanner& file, int type, GlobalOrdinal element) {
  const int number = numNodesOfGmsh(type);
  if (number == 0)
    file.refuse(unknownKind(type, element));
  return number;
}

void skipIntegers(MshScanner& file, GlobalOrdinal number) {
  for (GlobalOrdinal i = 0; i < number; ++i)
    (void)file.integer();
}

void skipReals(MshScanner& file, int number) {
  for (int i = 0; i < number; ++i)
    (void)file.real();
}

/// What stands before an element of format 2.2, or in binary before several.
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

/// The block of a kind and group in format 2.2; `places` says where those before are among the blocks of
/// their dimension.
MshBlock& blockOf(int type, int group, std::map<std::pair<int, int>, std::size_t>& places,
                  MshRecords& records) {
  const std::size_t dimension = dimensionOfGmsh(type);
  std::vector<MshBlock>& blocks = records.blocks[dimension];
  const auto [found, isNew] = places.try_emplace({type, group}, blocks.size());
  if (isNew) {
    const auto entity = static_cast<int>(places.size());
    blocks.push_back({{entity, type, {}, {}}, {}});
    if (group != 0)
      records.groupEntities[dimension][group].push_back(entity);
  }
  return blocks[found->second];
}

/// Totals that a section of format 4.1 begins with.
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

/// Number, perhaps parent and partitions, extent, groups and, but for points, boundary. Where partitions
/// touch, entities of lower dimension than their parent have the numbers of its groups, in which they are
/// not.
void readEntity(MshScanner& file, MshRecords& records, std::size_t dimension, bool isPartitioned) {
  const int entity = file.integer();
  bool isInGroups = true;
  if (isPartitioned) {
    isInGroups = std::cmp_equal(file.integer(), dimension);
    skipIntegers(file, 1);
    skipIntegers(file, file.count("partitions", 4, 1));
  }
  skipReals(file, dimension == 0 ? 3 : 6);
  const LocalOrdinal numGroups = file.count("physical groups", 4, 1);
  for (LocalOrdinal g = 0; g < numGroups; ++g)
    if (const int group = groupOfTag(file, file.integer()); isInGroups)
      records.groupEntities[dimension][group].push_back(entity);
  if (dimension > 0)
    skipIntegers(file, file.count("boundary entities", 4, 1));
}

} // namespace

void readPhysicalNames(MshScanner& file, MshRecords& records) {
  const LocalOrdinal number = file.countInLine("names", 6, 3);
  for (LocalOrdinal i = 0; i < number; ++i) {
    const std::string line(file.line());
    std::istringstream words(line);
    int dimension = -1, group = 0;
    words >> dimension >> group;
    const std::size_t first = line.find('"'), last = line.rfind('"');
    if (!words || dimension < 0 || dimension > 3 || first == last)
      file.refuse("here should be a physical group such as 2 1 \"name\", not \"" + shortened(line) +
                  "\"; the file is damaged or cut off, so save it anew");
    const std::string name = line.substr(first + 1, last - first - 1);
    if (shortened(name) != name)
      file.refuse("the name of a physical group, \"" + shortened(name) +
                  "\", must have at most 200 letters and no control characters among them");
    records.groupNames[{dimension, groupOfTag(file, group)}] = name;
  }
}

void readNodes2(MshScanner& file, MshRecords& records, bool isParametric) {
  const LocalOrdinal number = file.countInLine("nodes", 28, 4);
  for (LocalOrdinal n = 0; n < number; ++n) {
    addNode(file, file.tag(), {-1, 0}, records);
    addPoint(file, records);
    if (!isParametric)
      continue;
    const int dimension = file.integer(); // of the entity inside which it lies
    (void)file.integer();
    skipReals(file, dimension < 3 ? dimension : 0); // where on the curve or surface
  }
}

void readElements2(MshScanner& file, MshRecords& records) {
  const LocalOrdinal number = file.countInLine("elements", 8, 4);
  std::map<std::pair<int, int>, std::size_t> places;
  for (LocalOrdinal e = 0; e < number;) {
    GlobalOrdinal tag = file.isBinary() ? 0 : file.tag(); // in binary it stands behind the header
    const Header header = headerOf(file, number - e);
    for (int i = 0; i < header.numElements; ++i, ++e) {
      if (file.isBinary())
        tag = file.tag();
      const int group = header.numTags > 0 ? file.integer() : 0;
      skipIntegers(file, header.numTags - 1); // entity and partitions
      const int numNodes = numNodesOf(file, header.type, tag);
      MshBlock& block = blockOf(header.type, groupOfTag(file, group), places, records);
      block.block.tags.push_back(tag);
      for (int node = 0; node < numNodes; ++node)
        block.nodes.push_back(checkedTag(file, file.tag()));
    }
  }
  auto numEntities = static_cast<int>(places.size());
  for (const std::size_t dimension : {2, 3})
    joinCopies(records.blocks[dimension], records.groupEntities[dimension], numEntities);
}

void readEntities4(MshScanner& file, MshRecords& records, bool isPartitioned) {
  if (isPartitioned) {
    records.numPartitions = file.whole();
    skipIntegers(file, 2 * GlobalOrdinal{file.count("ghost entities", 8, 2)});
  }
  std::array<LocalOrdinal, 4> numbers{};
  for (LocalOrdinal& number : numbers)
    number = file.count("entities", 36, 5);
  for (std::size_t dimension = 0; dimension < 4; ++dimension)
    for (LocalOrdinal i = 0; i < numbers[dimension]; ++i)
      readEntity(file, records, dimension, isPartitioned);
}

void readNodes4(MshScanner& file, MshRecords& records) {
  const Totals totals = totalsOf(file, "nodes", 32, 4);
  for (LocalOrdinal block = 0; block < totals.blocks; ++block) {
    const int dimension = dimensionIn(file), entity = file.integer();
    const int numParameters = file.integer() == 0 ? 0 : dimension; // where on the entity they lie
    const LocalOrdinal number = file.count("nodes", 32, 4);
    for (LocalOrdinal n = 0; n < number; ++n)
      addNode(file, file.whole(), {dimension, entity}, records);
    for (LocalOrdinal n = 0; n < number; ++n) {
      addPoint(file, records);
      skipReals(file, numParameters);
    }
  }
  requireTotal(file, "nodes", totals.things, records.nodeTags.size());
}

void readElements4(MshScanner& file, MshRecords& records) {
  const Totals totals = totalsOf(file, "elements", 16, 2);
  GlobalOrdinal found = 0;
  for (LocalOrdinal b = 0; b < totals.blocks; ++b) {
    const int dimension = dimensionIn(file);
    MshBlock made{{file.integer(), file.integer(), {}, {}}, {}};
    const int type = made.block.type;
    const LocalOrdinal number = file.count("elements", 16, 2);
    for (LocalOrdinal e = 0; e < number; ++e) {
      const GlobalOrdinal tag = made.block.tags.emplace_back(file.whole());
      const int numNodes = numNodesOf(file, type, tag);
      if (dimensionOfGmsh(type) != dimension)
        file.refuse("element " + std::to_string(tag) + " lies on an entity of dimension " +
                    std::to_string(dimension) + ", but its kind has " +
                    std::to_string(dimensionOfGmsh(type)) + "; the file is damaged, so save it anew");
      for (int i = 0; i < numNodes; ++i)
        made.nodes.push_back(checkedTag(file, file.whole()));
    }
    found += number;
    if (number > 0)
      records.blocks[dimension].push_back(std::move(made));
  }
  requireTotal(file, "elements", totals.things, found);
}

} // namespace epafi::meshing
