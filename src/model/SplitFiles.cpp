#include "epafi/model/SplitFiles.hpp"

#include "epafi/base/Collective.hpp"
#include "epafi/base/Errors.hpp"
#include "epafi/base/Text.hpp"
#include "epafi/meshing/GmshFile.hpp"
#include "epafi/meshing/GmshReader.hpp"
#include "epafi/meshing/MeshFiles.hpp"
#include "epafi/model/BodyLayout.hpp"

#include <algorithm>
#include <filesystem>
#include <memory>
#include <set>
#include <utility>

namespace epafi::model {
namespace {

namespace fs = std::filesystem;

/// The files that a name with a * stands for, by the numbers in them. \throws InputError if there are none
std::vector<std::string> filesLike(const std::string& pattern) {
  const fs::path path(pattern);
  const std::string name = path.filename().string();
  const std::size_t star = name.find('*');
  const std::string before = name.substr(0, star), behind = name.substr(star + 1);
  std::vector<std::string> files;
  std::error_code error; // of a folder that is not there
  for (const auto& entry : fs::directory_iterator(path.has_parent_path() ? path.parent_path() : ".", error)) {
    const std::string found = entry.path().filename().string();
    if (found.size() > before.size() + behind.size() && found.starts_with(before) && found.ends_with(behind))
      files.push_back((path.parent_path() / found).string());
  }
  if (files.empty())
    throw InputError("There are no mesh files " + inQuotes(pattern) + "; check the name and the folder");
  std::sort(files.begin(), files.end(), [](const std::string& a, const std::string& b) {
    return a.size() != b.size() ? a.size() < b.size() : a < b;
  });
  return files;
}

/// Rank 0 looks. Collective.
std::vector<std::string> agreedFiles(const std::string& pattern, const Comm& comm) {
  std::string text;
  collectively(comm, [&] {
    if (comm.getRank() == 0)
      text = asLines(filesLike(pattern));
  });
  meshing::broadcastText(comm, text);
  return linesOf(text);
}

/// A body's share in a file.
struct FileShare {
  mesh::UnstructuredMesh mesh;
  std::shared_ptr<const meshing::Partition> partition;
};

/// What a rank reads of some bodies.
class SplitReader {
public:
  SplitReader(std::span<const scene::Body* const> bodies, std::vector<std::string> files)
      : bodies_(bodies), files_(std::move(files)), shares_(bodies.size()) {}

  void read(std::size_t number);                                             ///< one of the files
  [[nodiscard]] const meshing::FacetList& facets() const { return facets_; } ///< of all bodies
  /// What was read of a body, cut. Collective.
  meshing::LooseMesh take(std::size_t body, std::shared_ptr<const meshing::FacetList> facets,
                          const Comm& comm);

private:
  void requireAll(const meshing::GmshFile& file) const;
  [[nodiscard]] static mesh::UnstructuredMesh meshOf(const scene::Body& body, const meshing::GmshFile& file);
  void requireElements(const scene::Body& body, GlobalOrdinal all, const Comm& comm) const;
  void cut(std::size_t body, GlobalOrdinal before, GlobalOrdinal all);

  std::span<const scene::Body* const> bodies_;
  std::vector<std::string> files_;
  std::vector<std::vector<FileShare>> shares_; ///< of each body
  meshing::FacetList facets_;
  std::set<std::string> groups_; ///< of the files that were read
};

void SplitReader::read(std::size_t number) {
  const std::string& name = files_[number];
  const meshing::GmshFile file(meshing::readMsh(name, meshing::textOfMeshFile(name)));
  requireAll(file);
  const std::vector<std::string> groups = file.groupNames();
  groups_.insert(groups.begin(), groups.end());
  for (std::size_t b = 0; b < bodies_.size(); ++b)
    if (file.hasElements(bodies_[b]->mesh.group))
      shares_[b].push_back({meshOf(*bodies_[b], file), nullptr});
  file.visitFacets([&](const std::string& surface, std::span<const GlobalOrdinal> corners) {
    facets_.add(surface, corners);
  });
}

/// A file that is missing would be a hole in the body.
void SplitReader::requireAll(const meshing::GmshFile& file) const {
  const GlobalOrdinal number = file.numPartitions();
  if (number > 0 && number != std::ssize(files_))
    throw InputError("The mesh file " + inQuotes(file.file()) + " is one of " + std::to_string(number) +
                     ", but " + std::to_string(files_.size()) +
                     " files have such a name; complete them, or remove those of another mesh");
}

mesh::UnstructuredMesh SplitReader::meshOf(const scene::Body& body, const meshing::GmshFile& file) {
  mesh::UnstructuredMesh mesh = file.body(body.mesh.group, body.mesh.order, body.mesh.innerNodes);
  for (GlobalOrdinal node = 0; node < mesh.numNodes(); ++node)
    if (mesh.nodeTag(node) < 0)
      throw InputError(
          mesh.name() +
          " lacks nodes that its elements are to have, which no rank can number by itself; mesh in "
          "this order, with complete elements, before Gmsh cuts the mesh");
  return mesh;
}

/// \param before, all  elements of the body in the files before this rank's, and in all
void SplitReader::cut(std::size_t body, GlobalOrdinal before, GlobalOrdinal all) {
  const scene::Decomposition& how = bodies_[body]->decomposition;
  for (FileShare& share : shares_[body]) {
    const GlobalOrdinal here = share.mesh.numElements(), behind = before + here;
    const GlobalOrdinal parts = how.parts == 0 ? partsFor(*bodies_[body], share.mesh)
                                               : behind * how.parts / all - before * how.parts / all;
    share.partition = meshing::cutPieces(share.mesh, static_cast<int>(std::max<GlobalOrdinal>(parts, 1)),
                                         kindOfParts(*bodies_[body]));
    constexpr int single = 1; // neighbours follow each other, whatever run they fall into
    share.partition = std::make_shared<const meshing::GroupedPartition>(share.partition, share.mesh, single);
    before = behind;
  }
}

/// Collective.
void SplitReader::requireElements(const scene::Body& body, GlobalOrdinal all, const Comm& comm) const {
  if (all == 0) {
    std::string known;
    for (const std::string& group : meshing::allNames(groups_, comm))
      known += (known.empty() ? "'" : ", '") + group + "'";
    throw InputError("none of the files " + inQuotes(body.mesh.file) + " has elements of a physical group " +
                     inQuotes(body.mesh.group) + "; they have " + (known.empty() ? "no groups" : known));
  }
  if (body.decomposition.parts > all)
    throw InputError("it has " + std::to_string(all) + " elements and cannot be cut into " +
                     std::to_string(body.decomposition.parts) + " parts; choose between 1 and " +
                     std::to_string(all));
}

meshing::LooseMesh SplitReader::take(std::size_t body, std::shared_ptr<const meshing::FacetList> facets,
                                     const Comm& comm) {
  std::vector<FileShare>& own = shares_[body];
  GlobalOrdinal numElements = 0;
  for (const FileShare& share : own)
    numElements += share.mesh.numElements();
  const GlobalOrdinal before = sumBefore(comm, numElements), all = sumOverRanks(comm, numElements);
  requireElements(*bodies_[body], all, comm);
  collectively(comm, [&] { cut(body, before, all); });
  std::vector<meshing::MeshShare> shares;
  for (const FileShare& share : own)
    shares.push_back({&share.mesh, share.partition.get(),
                      [&mesh = share.mesh](GlobalOrdinal node) { return mesh.nodeTag(node); }});
  meshing::LooseMesh loose = looseMeshOf(shares, std::move(facets), comm);
  own.clear();
  return loose;
}

} // namespace

std::vector<meshing::LooseMesh> readSplitFiles(std::span<const scene::Body* const> bodies, const Comm& comm) {
  std::vector<std::string> files = agreedFiles(bodies.front()->mesh.file, comm);
  const std::size_t number = files.size(), rank = comm.getRank(), ranks = comm.getSize();
  SplitReader reader(bodies, std::move(files));
  collectively(comm, [&] {
    for (std::size_t f = rank * number / ranks; f < (rank + 1) * number / ranks; ++f)
      reader.read(f);
  });
  const auto facets = std::make_shared<const meshing::FacetList>(gathered(reader.facets(), comm));
  std::vector<meshing::LooseMesh> meshes;
  for (std::size_t b = 0; b < bodies.size(); ++b)
    try {
      meshes.push_back(reader.take(b, facets, comm));
    } catch (const InputError& error) { // the same on all ranks
      throw InputError("body '" + bodies[b]->name + "': " + error.what());
    }
  return meshes;
}

} // namespace epafi::model
