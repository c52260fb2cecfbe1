#include "epafi/meshing/MshReader.hpp"

#include "epafi/base/Errors.hpp"
#include "epafi/base/SortUnique.hpp"
#include "epafi/base/Text.hpp"
#include "epafi/meshing/MshSections.hpp"

#include <algorithm>
#include <numeric>
#include <set>
#include <sstream>

namespace epafi::meshing {
namespace {

constexpr int pointType = 15; ///< Gmsh's number

/// A kind of elements, by Gmsh's number: nodes, and the number of the kind of order 1.
struct Kind {
  int numNodes, linear;
};
/// 1: line, triangle, quadrilateral, tetrahedron, hexahedron, prism, pyramid; 8: the same of order 2; 15:
/// point; then quadrilateral, hexahedron, prism, pyramid of order 2 without nodes inside.
constexpr std::array<Kind, 20> kinds{{{0, 0},  {2, 1},  {3, 2}, {4, 3},  {4, 4},  {8, 5},  {6, 6},
                                      {5, 7},  {3, 1},  {6, 2}, {9, 3},  {10, 4}, {27, 5}, {18, 6},
                                      {14, 7}, {1, 15}, {8, 3}, {20, 5}, {15, 6}, {13, 7}}};

/// Reads the sections of a file in their order.
class Reader {
public:
  Reader(const std::string& name, std::string text) : file_(name, std::move(text)) {}

  MshRecords read();

private:
  void readSection(const std::string& section);
  void readFormat();
  void readKnown(const std::string& section);

  MshScanner file_;
  MshRecords records_;
  int format_ = 0; ///< 2 or 4 once it is known
  std::set<std::string> read_;
};

MshRecords Reader::read() {
  for (std::string line(file_.line()); !line.empty(); line = file_.line()) {
    if (!line.starts_with('$'))
      file_.refuse("here should be a section such as $Nodes, not \"" + shortened(line) +
                   (format_ == 0 ? "\"; this is no mesh file of Gmsh" : "\"; save the file anew"));
    readSection(line.substr(1));
  }
  if (format_ == 0)
    file_.refuse("the section $MeshFormat is missing; this is no mesh file of Gmsh");
  return std::move(records_);
}

void Reader::readSection(const std::string& section) {
  static const std::set<std::string> known{"MeshFormat", "PhysicalNames",   "Entities", "PartitionedEntities",
                                           "Nodes",      "ParametricNodes", "Elements"};
  if (section == "NOD" || section == "ELM")
    file_.refuse("the section $" + section +
                 " is of format 1, which is not read; save the file in format 4.1 or 2.2 (gmsh -format msh41 "
                 "-save)");
  const std::string end = "$End" + section;
  if (!known.contains(section)) {
    if (!file_.skipBehind('\n' + end))
      file_.refuse("the section $" + shortened(section) +
                   " has no end; the file is cut off, so save it anew");
    return;
  }
  if (!read_.insert(section).second)
    file_.refuse("there is a second section $" + section + "; save the file anew");
  if (section == "MeshFormat")
    readFormat();
  else if (format_ == 0)
    file_.refuse("the section $MeshFormat should come first; this is no mesh file of Gmsh");
  else
    readKnown(section);
  if (const std::string line(file_.line()); line != end)
    file_.refuse("here should be " + end + ", not " +
                 (line.empty() ? "the end of the file" : '"' + shortened(line) + '"') +
                 "; the file is damaged or cut off, so save it anew");
}

void Reader::readFormat() {
  std::istringstream words{std::string(file_.line())};
  std::string version, kind, bytes;
  words >> version >> kind >> bytes;
  if (version == "2.2" || version == "2.1" || version == "2.0" || version == "2")
    format_ = 2;
  else if (version == "4.1")
    format_ = 4;
  else
    file_.refuse("the format " + shortened(version) +
                 " is none that is read; save the file in format 4.1 or 2.2 (gmsh -format msh41 -save)");
  if ((kind != "0" && kind != "1") || bytes != "8")
    file_.refuse("behind the format should be 0 (text) or 1 (binary) and 8, not \"" +
                 shortened(kind + ' ' + bytes) + "\"; save the file anew");
  if (kind == "0")
    return;
  file_.setBinary(true);
  if (file_.integer() != 1)
    file_.refuse("the file was written on a machine with another order of bytes; save it as text");
}

void Reader::readKnown(const std::string& section) {
  if (section == "PhysicalNames")
    readPhysicalNames(file_, records_);
  else if (section == "Elements")
    format_ == 2 ? readElements2(file_, records_) : readElements4(file_, records_);
  else if (section.ends_with("Nodes") && format_ == 2)
    readNodes2(file_, records_, section == "ParametricNodes");
  else if (section == "Nodes")
    readNodes4(file_, records_);
  else if (section.ends_with("Entities") && format_ == 4)
    readEntities4(file_, records_, section == "PartitionedEntities");
  else
    file_.refuse("this format has no section $" + section + "; save the file anew");
}

/// What the rest of the house wants to know.
class Contents {
public:
  Contents(const std::string& name, MshRecords records) : records_(std::move(records)) {
    contents_.file = name;
  }

  GmshContents make();

private:
  void setNodes();
  [[nodiscard]] LocalOrdinal nodeOf(GlobalOrdinal tag) const;
  std::vector<GmshGroup> groupsOf(int dimension) const;
  std::vector<GmshBlock> blocksOf(int dimension);
  void addNodeSets(int dimension);

  MshRecords records_;
  GmshContents contents_;
};

GmshContents Contents::make() {
  const int d = contents_.dimension = records_.blocks[3].empty() ? 2 : 3;
  if (records_.blocks[d].empty())
    throw InputError("The mesh file " + inQuotes(contents_.file) +
                     " holds no elements of dimension 2 or 3; mesh its surfaces or volumes, and save all of "
                     "them or those in physical groups");
  contents_.numPartitions = records_.numPartitions;
  contents_.groups = groupsOf(d);
  contents_.surfaces = groupsOf(d - 1);
  setNodes();
  for (int lower = d - 2; lower >= 0; --lower)
    addNodeSets(lower);
  contents_.elements = blocksOf(d);
  std::set<int> named;
  for (const GmshGroup& surface : contents_.surfaces)
    named.insert(surface.entities.begin(), surface.entities.end());
  std::erase_if(records_.blocks[d - 1],
                [&](const MshBlock& made) { return !named.contains(made.block.entity); });
  contents_.facets = blocksOf(d - 1);
  return std::move(contents_);
}

/// In the order of their tags.
void Contents::setNodes() {
  const std::vector<GlobalOrdinal>& tags = records_.nodeTags;
  std::vector<std::size_t> order(tags.size());
  std::iota(order.begin(), order.end(), 0);
  std::sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) { return tags[a] < tags[b]; });
  for (const std::size_t i : order) {
    if (!contents_.nodeTags.empty() && contents_.nodeTags.back() == tags[i])
      throw InputError("The mesh file " + inQuotes(contents_.file) + " lists node " +
                       std::to_string(tags[i]) + " twice; number its nodes differently, or mesh anew");
    contents_.nodeTags.push_back(tags[i]);
    contents_.points.push_back(records_.points[i]);
    contents_.nodeEntities.push_back(records_.nodeEntities[i]);
  }
}

/// Index of the node with that tag, which is ≥ 0.
LocalOrdinal Contents::nodeOf(GlobalOrdinal tag) const {
  const std::vector<GlobalOrdinal>& tags = contents_.nodeTags;
  // Mostly numbers have no gaps, and there is nothing to search.
  if (!tags.empty() && tag >= tags.front()) {
    const std::size_t guess = tag - tags.front();
    if (guess < tags.size() && tags[guess] == tag)
      return static_cast<LocalOrdinal>(guess);
  }
  const auto found = std::lower_bound(tags.begin(), tags.end(), tag);
  if (found == tags.end() || *found != tag)
    throw InputError("The mesh file " + inQuotes(contents_.file) + " has an element with node " +
                     std::to_string(tag) + ", but no such node; mesh anew");
  return static_cast<LocalOrdinal>(found - tags.begin());
}

/// A group without a name is called by its number.
std::vector<GmshGroup> Contents::groupsOf(int dimension) const {
  std::vector<GmshGroup> groups;
  for (auto [number, entities] : records_.groupEntities[dimension]) {
    sortUnique(entities);
    const auto found = records_.groupNames.find({dimension, number});
    const bool hasName = found != records_.groupNames.end() && !found->second.empty();
    const std::string name = hasName ? found->second : std::to_string(number);
    if (std::any_of(groups.begin(), groups.end(), [&](const GmshGroup& other) { return other.name == name; }))
      throw InputError("The mesh file " + inQuotes(contents_.file) + " has two physical groups " +
                       inQuotes(name) + " of dimension " + std::to_string(dimension) +
                       "; give them different names");
    groups.push_back({name, std::move(entities)});
  }
  return groups;
}

std::vector<GmshBlock> Contents::blocksOf(int dimension) {
  std::vector<GmshBlock> blocks;
  for (MshBlock& made : records_.blocks[dimension]) {
    made.block.nodes.reserve(made.nodes.size());
    for (const GlobalOrdinal tag : made.nodes)
      made.block.nodes.push_back(nodeOf(tag));
    made.nodes = {};
    blocks.push_back(std::move(made.block));
  }
  return blocks;
}

/// Groups of one name and different dimensions are one set.
void Contents::addNodeSets(int dimension) {
  const std::vector<GmshBlock> blocks = blocksOf(dimension);
  for (const GmshGroup& group : groupsOf(dimension)) {
    auto set = std::find_if(contents_.nodeSets.begin(), contents_.nodeSets.end(),
                            [&](const mesh::NamedNodes& other) { return other.name == group.name; });
    if (set == contents_.nodeSets.end())
      set = contents_.nodeSets.insert(set, {group.name, {}});
    for (const GmshBlock& block : blocks)
      if (std::binary_search(group.entities.begin(), group.entities.end(), block.entity))
        set->nodes.insert(set->nodes.end(), block.nodes.begin(), block.nodes.end());
    sortUnique(set->nodes);
  }
}

} // namespace

int numNodesOfGmsh(int type) {
  return type > 0 && type < std::ssize(kinds) ? kinds[type].numNodes : 0;
}

int linearKindOfGmsh(int type) {
  return kinds[type].linear;
}

int dimensionOfGmsh(int type) {
  const int linear = linearKindOfGmsh(type);
  return linear == pointType ? 0 : linear == 1 ? 1 : linear < 4 ? 2 : 3;
}

std::string unknownKind(int type, GlobalOrdinal element) {
  return "element " + std::to_string(element) + " is of Gmsh's kind " + std::to_string(type) +
         ", of third or higher order or unknown; only elements of order 1 and 2 are allowed, so mesh with "
         "Mesh.ElementOrder = 2";
}

GmshContents readMsh(const std::string& name, std::string text) {
  return Contents(name, Reader(name, std::move(text)).read()).make();
}

} // namespace epafi::meshing
