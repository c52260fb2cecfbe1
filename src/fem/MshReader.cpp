#include "epafi/fem/MshReader.hpp"

#include "epafi/base/Errors.hpp"
#include "epafi/fem/MshRecords.hpp"

#include <algorithm>
#include <cstdlib>
#include <limits>
#include <set>
#include <sstream>

namespace epafi::fem {
namespace {

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
  void addGroups(int dimension, std::vector<GmshGroup>& list);
  void addBlocks(int dimension, std::vector<GmshBlock>& list);

  MshRecords records_;
  GmshContents contents_;
};

GmshContents Contents::make() {
  const int d = contents_.dimension = records_.blocks[3].empty() ? 2 : 3;
  if (records_.blocks[static_cast<std::size_t>(d)].empty())
    contents_.refuseNoElements();
  addGroups(d, contents_.groups);
  addGroups(d - 1, contents_.surfaces);
  for (int lower = d - 2; lower >= 0; --lower)
    addGroups(lower, contents_.lesser);
  for (GmshGroup& group : contents_.lesser)
    group.entities.clear();
  contents_.setNodes(records_.nodeTags, records_.points, records_.nodeEntities);
  addBlocks(d, contents_.elements);
  std::set<int> named;
  for (const GmshGroup& surface : contents_.surfaces)
    named.insert(surface.entities.begin(), surface.entities.end());
  std::erase_if(records_.blocks[static_cast<std::size_t>(d - 1)],
                [&](const MshBlock& block) { return !named.contains(block.entity); });
  addBlocks(d - 1, contents_.facets);
  return std::move(contents_);
}

void Contents::addGroups(int dimension, std::vector<GmshGroup>& list) {
  for (auto& [number, entities] : records_.groupEntities[static_cast<std::size_t>(dimension)]) {
    std::sort(entities.begin(), entities.end());
    entities.erase(std::unique(entities.begin(), entities.end()), entities.end());
    const auto name = records_.groupNames.find({dimension, number});
    contents_.addGroup(list, dimension, number,
                       {name == records_.groupNames.end() ? "" : name->second, entities});
  }
}

void Contents::addBlocks(int dimension, std::vector<GmshBlock>& list) {
  for (MshBlock& block : records_.blocks[static_cast<std::size_t>(dimension)]) {
    GmshBlock made{block.entity, block.type, std::move(block.tags), {}};
    made.nodes.reserve(block.nodes.size());
    for (const GlobalOrdinal tag : block.nodes)
      made.nodes.push_back(contents_.nodeOf(tag));
    block.nodes = {};
    list.push_back(std::move(made));
  }
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

int numNodesOfMsh(const MshScanner& file, int type, GlobalOrdinal element) {
  const int number = numNodesOfGmsh(type);
  if (number == 0)
    file.refuse(notLinear(type, element));
  return number;
}

GlobalOrdinal checkedTag(const MshScanner& file, GlobalOrdinal tag) {
  if (tag < 0)
    file.refuse("a node has the number " + std::to_string(tag) +
                ", but must not have a negative one; the file is damaged, so save it anew");
  return tag;
}

int groupOfTag(const MshScanner& file, int tag) {
  if (tag == std::numeric_limits<int>::min())
    file.refuse("a physical group has the number " + std::to_string(tag) +
                "; the file is damaged, so save it anew");
  return std::abs(tag);
}

GmshContents readMsh(const std::string& name, std::string text) {
  return Contents(name, Reader(name, std::move(text)).read()).make();
}

} // namespace epafi::fem
