#include "epafi/fem/GmshReader.hpp"

#include "epafi/base/Errors.hpp"
#include "epafi/base/Text.hpp"
#include "epafi/fem/GmshLibrary.hpp"
#include "epafi/fem/MshReader.hpp"

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <string>
#include <utility>

namespace epafi::fem {
namespace {

constexpr int anyEntity = -1;

/// What Gmsh would take for an empty model, or read without a word.
void checkFile(const std::string& file) {
  const std::filesystem::path path(file);
  if (path.extension() != ".msh" && path.extension() != ".geo")
    throw InputError("The mesh file " + inQuotes(file) +
                     " is of an unknown kind; its name must end in .msh or .geo");
  if (!std::filesystem::is_regular_file(path))
    throw InputError("There is no mesh file " + inQuotes(file) + "; check its name and the folder");
  std::ifstream stream(path, std::ios::binary);
  if (!stream)
    throw InputError("The mesh file " + inQuotes(file) + " cannot be opened; check its permissions");
  if (path.extension() != ".geo")
    return;
  stream.seekg(-1, std::ios::end);
  if (stream.get() != '\n')
    throw InputError("The last line of the mesh file " + inQuotes(file) +
                     " has no end, so that Gmsh would pass over it; end it with a line break");
}

/// One reading of a geometry by Gmsh.
class Reader {
public:
  explicit Reader(const std::string& file) : session_(file), gmsh_(session_.gmsh()) { contents_.file = file; }

  GmshContents read(double meshSizeFactor, int refinements);

private:
  void mesh();
  void readGroups();
  void readNodes();
  std::vector<GmshGroup> groupsOf(int dimension) const;
  std::vector<int> entitiesOf(int dimension) const;
  bool hasElements(int dimension) const;
  void readElements(int dimension, int entity, std::vector<GmshBlock>& blocks) const;

  GmshSession session_;
  const GmshFunctions& gmsh_;
  GmshContents contents_;
};

GmshContents Reader::read(double meshSizeFactor, int refinements) {
  session_.call(gmsh_.setNumber, "Mesh.MeshSizeFactor", meshSizeFactor);
  session_.call(gmsh_.open, contents_.file.c_str());
  mesh();
  for (int i = 0; i < refinements; ++i)
    session_.call(gmsh_.refine);
  readGroups();
  readNodes();
  for (const int entity : entitiesOf(contents_.dimension))
    readElements(contents_.dimension, entity, contents_.elements);
  std::vector<int> named;
  for (const GmshGroup& surface : contents_.surfaces)
    named.insert(named.end(), surface.entities.begin(), surface.entities.end());
  std::sort(named.begin(), named.end());
  named.erase(std::unique(named.begin(), named.end()), named.end());
  for (const int entity : named)
    readElements(contents_.dimension - 1, entity, contents_.facets);
  return std::move(contents_);
}

bool Reader::hasElements(int dimension) const {
  GmshArray<int> types;
  session_.call(gmsh_.elementTypes, types.data(), types.size(), dimension, anyEntity);
  return !types.span().empty();
}

void Reader::mesh() {
  const int dimension = session_.call(gmsh_.dimension);
  if (dimension > 0 && !hasElements(dimension))
    session_.call(gmsh_.generate, dimension);
  contents_.dimension = hasElements(3) ? 3 : 2;
  if (!hasElements(contents_.dimension))
    contents_.refuseNoElements();
}

void Reader::readGroups() {
  contents_.groups = groupsOf(contents_.dimension);
  contents_.surfaces = groupsOf(contents_.dimension - 1);
  for (int lower = contents_.dimension - 2; lower >= 0; --lower)
    for (GmshGroup& group : groupsOf(lower))
      contents_.lesser.push_back({std::move(group.name), {}});
}

std::vector<GmshGroup> Reader::groupsOf(int dimension) const {
  GmshArray<int> dimTags;
  session_.call(gmsh_.physicalGroups, dimTags.data(), dimTags.size(), dimension);
  std::vector<GmshGroup> groups;
  for (std::size_t i = 1; i < dimTags.span().size(); i += 2) {
    const int tag = dimTags.span()[i];
    GmshArray<char> name;
    session_.call(gmsh_.physicalName, dimension, tag, name.data());
    GmshArray<int> entities;
    session_.call(gmsh_.entitiesOfGroup, dimension, tag, entities.data(), entities.size());
    contents_.addGroup(groups, dimension, tag,
                       {*name.data(), {entities.span().begin(), entities.span().end()}});
  }
  return groups;
}

std::vector<int> Reader::entitiesOf(int dimension) const {
  GmshArray<int> dimTags;
  session_.call(gmsh_.entities, dimTags.data(), dimTags.size(), dimension);
  std::vector<int> tags;
  for (std::size_t i = 1; i < dimTags.span().size(); i += 2)
    tags.push_back(dimTags.span()[i]);
  return tags;
}

void Reader::readNodes() {
  std::vector<GlobalOrdinal> tags;
  std::vector<Point> points;
  std::vector<std::array<int, 2>> places;
  for (int dimension = 0; dimension <= contents_.dimension; ++dimension)
    for (const int entity : entitiesOf(dimension)) {
      GmshArray<std::size_t> nodes;
      GmshArray<double> coordinates, parameters;
      constexpr int includeBoundary = 0, returnParameters = 0;
      session_.call(gmsh_.nodes, nodes.data(), nodes.size(), coordinates.data(), coordinates.size(),
                    parameters.data(), parameters.size(), dimension, entity, includeBoundary,
                    returnParameters);
      for (std::size_t i = 0; i < nodes.span().size(); ++i) {
        const double* xyz = &coordinates.span()[3 * i];
        tags.push_back(static_cast<GlobalOrdinal>(nodes.span()[i]));
        points.push_back({xyz[0], xyz[1], xyz[2]});
        places.push_back({dimension, entity});
      }
    }
  contents_.setNodes(tags, points, places);
}

void Reader::readElements(int dimension, int entity, std::vector<GmshBlock>& blocks) const {
  GmshArray<int> types;
  session_.call(gmsh_.elementTypes, types.data(), types.size(), dimension, entity);
  for (const int type : types.span()) {
    GmshArray<std::size_t> tags, nodes;
    constexpr std::size_t task = 0, numTasks = 1;
    session_.call(gmsh_.elementsByType, type, tags.data(), tags.size(), nodes.data(), nodes.size(), entity,
                  task, numTasks);
    if (numNodesOfGmsh(type) == 0)
      throw InputError("The mesh file " + inQuotes(contents_.file) + ": " +
                       notLinear(type, static_cast<GlobalOrdinal>(tags.span().front())));
    GmshBlock block{entity, type, {tags.span().begin(), tags.span().end()}, {}};
    block.nodes.reserve(nodes.span().size());
    for (const std::size_t tag : nodes.span())
      block.nodes.push_back(contents_.nodeOf(static_cast<GlobalOrdinal>(tag)));
    blocks.push_back(std::move(block));
  }
}

} // namespace

GmshContents readGmshFile(const std::string& file, double meshSizeFactor, int refinements) {
  checkFile(file);
  if (file.ends_with(".geo"))
    return Reader(file).read(meshSizeFactor, refinements);
  std::string text(std::filesystem::file_size(file), '\0');
  std::ifstream stream(file, std::ios::binary);
  stream.read(text.data(), static_cast<std::streamsize>(text.size()));
  if (!stream)
    throw InputError("The mesh file " + inQuotes(file) + " could not be read to its end");
  GmshContents contents = readMsh(file, std::move(text));
  // A mesh is split by Gmsh's library, which is safe once the file is known to be sound.
  return refinements == 0 ? std::move(contents) : Reader(file).read(meshSizeFactor, refinements);
}

} // namespace epafi::fem
