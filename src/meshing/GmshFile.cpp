#include "epafi/meshing/GmshFile.hpp"

#include "epafi/base/ArrayIndex.hpp"
#include "epafi/base/Errors.hpp"
#include "epafi/base/Text.hpp"
#include "epafi/meshing/GmshBody.hpp"
#include "epafi/meshing/GmshReader.hpp"

#include <algorithm>
#include <array>
#include <utility>

namespace epafi::meshing {
namespace {

/// Named surfaces must be surfaces of something.
void checkSurfaces(const GmshContents& file) {
  const auto nameOf = [&](int entity) {
    const auto found = std::find_if(file.surfaces.begin(), file.surfaces.end(),
                                    [&](const GmshGroup& surface) { return holds(surface, entity); });
    return found == file.surfaces.end() ? std::string() : found->name;
  };
  GmshBlocks all;
  for (const GmshBlock& block : file.elements)
    all.push_back(&block);
  const std::vector<bool> isIn = facetsIn(file, all);
  std::size_t facet = 0;
  for (const GmshBlock& block : file.facets)
    for (const GlobalOrdinal tag : block.tags)
      if (!isIn[facet++])
        throw InputError("Mesh file " + inQuotes(file.file) + ": the surface " +
                         inQuotes(nameOf(block.entity)) + " has a facet (element " + std::to_string(tag) +
                         ") that belongs to no element of dimension " + std::to_string(file.dimension) +
                         "; mesh and save surfaces and bodies together, or drop that physical group");
  std::vector<bool> isUsed(file.points.size(), false);
  for (const GmshBlock& block : file.elements)
    for (const LocalOrdinal node : block.nodes)
      isUsed[index(node)] = true;
  for (std::size_t n = 0; n < isUsed.size(); ++n) {
    const auto [dimension, entity] = file.nodeEntities[n];
    if (isUsed[n] || dimension != file.dimension - 1)
      continue;
    if (const std::string name = nameOf(entity); !name.empty())
      throw InputError("Mesh file " + inQuotes(file.file) + ": node " + std::to_string(file.nodeTags[n]) +
                       " is listed with the surface " + inQuotes(name) +
                       " but belongs to no element; remove it from the file, or mesh anew");
  }
}

} // namespace

GmshFile::GmshFile(const std::string& file) : GmshFile(readMsh(file, textOfMeshFile(file))) {}

GmshFile::GmshFile(GmshContents contents) : contents_(std::move(contents)) {
  checkSurfaces(contents_);
}

std::vector<std::string> GmshFile::groupNames() const {
  return namesOf(contents_.groups);
}

bool GmshFile::hasElements(const std::string& group) const {
  return std::any_of(contents_.elements.begin(), contents_.elements.end(), [&](const GmshBlock& block) {
    return group.empty() ||
           std::any_of(contents_.groups.begin(), contents_.groups.end(), [&](const GmshGroup& known) {
             return known.name == group && holds(known, block.entity);
           });
  });
}

mesh::UnstructuredMesh GmshFile::body(const std::string& group, int order, mesh::InnerNodes inner) const {
  mesh::MeshArrays arrays = arraysOfBody(contents_, group, inner);
  if (order == 0 || order == orderOf(arrays.cellType))
    return mesh::UnstructuredMesh(std::move(arrays));
  if (order == 1)
    return mesh::UnstructuredMesh(linearised(std::move(arrays)));
  const mesh::UnstructuredMesh sound(arrays); // what is wrong with it is said in terms of the file
  return mesh::UnstructuredMesh(completed(std::move(arrays), false, inner));
}

mesh::UnstructuredMesh GmshFile::body(const MeshSource& source, int order, mesh::InnerNodes inner) const {
  mesh::UnstructuredMesh mesh = body(source.group, order, inner);
  for (const std::string& words : source.pieces)
    mesh.namePiece(words);
  return mesh;
}

void GmshFile::visitFacets(
    const std::function<void(const std::string&, std::span<const GlobalOrdinal>)>& visit) const {
  std::vector<GlobalOrdinal> tags;
  for (const GmshGroup& surface : contents_.surfaces)
    for (const GmshBlock& block : contents_.facets) {
      if (!holds(surface, block.entity))
        continue;
      const auto count = index(numNodesOfGmsh(block.type));
      for (std::size_t i = 0; i < block.nodes.size(); i += count) {
        tags.clear();
        for (const LocalOrdinal node : std::span(block.nodes).subspan(i, numCornersOfGmsh(block.type)))
          tags.push_back(contents_.nodeTags[index(node)]);
        visit(surface.name, tags);
      }
    }
  for (const mesh::NamedNodes& set : contents_.nodeSets)
    for (const LocalOrdinal node : set.nodes)
      visit(set.name, std::array{contents_.nodeTags[index(node)]});
}

} // namespace epafi::meshing
