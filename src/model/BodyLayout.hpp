#pragma once

/// The bodies of a scene: their meshes, the way they are cut, and their physics.

#include "epafi/fem/BodyModel.hpp"
#include "epafi/mesh/Mesh.hpp"
#include "epafi/meshing/Partition.hpp"
#include "epafi/scene/Scene.hpp"

#include <memory>
#include <string>
#include <vector>

namespace epafi::model {

/// A body of the scene with its mesh and the way it is cut.
struct BodyLayout {
  std::string name;
  std::unique_ptr<const mesh::Mesh> mesh;
  std::shared_ptr<const meshing::Partition> partition; ///< bodies that are meshed and cut alike share one
  int firstSubdomain = 0;                              ///< number of its part 0 in the whole problem
  int cluster = 0; ///< parts that a rank, or several, get together, and that share crosspoints; 0: all
};

/// How the meshes of files and geometries lie on several ranks; structured meshes are numbers alone.
enum class Meshes {
  whole, ///< all on each rank: for what looks at elements anywhere, as refinement does
  /// Rank 0 reads, checks and cuts them, or each rank some of several files (SplitFiles.hpp); all keep their
  /// own (MeshPieces.hpp).
  pieces
};

/// Meshes the bodies and cuts them: the same parts in both forms and on any number of ranks. Collective.
/// \throws InputError, the same on all ranks, if a body cannot be meshed or cut as the scene says, bodies
/// differ in the unknowns of a node, or, where meshes go out in pieces, makeModel() refuses one.
std::vector<BodyLayout> layoutBodies(const scene::Scene& scene, const Comm& comm,
                                     Meshes meshes = Meshes::whole);

/// Meshes the bodies whole, and cuts none. Collective. \throws InputError, the same on all ranks, if a body
/// cannot be meshed as the scene says. Precondition: no mesh is in several files.
std::vector<std::unique_ptr<const mesh::Mesh>> meshBodies(const scene::Scene& scene, const Comm& comm);

/// Cuts bodies that are meshed already, on all ranks alike. Collective. \throws InputError likewise.
/// \param partitions  of each body, or nothing; those not null are taken as they are
std::vector<BodyLayout> cutBodies(const scene::Scene& scene,
                                  std::vector<std::unique_ptr<const mesh::Mesh>> meshes, const Comm& comm,
                                  std::vector<std::shared_ptr<const meshing::Partition>> partitions = {});

/// The mesh of a body that has no file.
std::unique_ptr<const mesh::Mesh> structuredMesh(const meshing::MeshSource& source);

/// What the parts must be.
meshing::Parts kindOfParts(const scene::Body& body);

/// How many parts METIS makes of a mesh where the scene leaves it open.
int partsFor(const scene::Body& body, const mesh::Mesh& mesh);

/// How subdomains go to ranks: rank r of P has the numbers [rN/P, (r+1)N/P), but that it begins with a
/// cluster, where there are clusters, or shares one evenly with the others that would begin in it.
struct Share {
  int begin = 0, end = 0; ///< this rank's numbers
};
/// That of a rank among so many. Not collective.
Share shareOf(const std::vector<BodyLayout>& bodies, int rank, int ranks);
/// That of this rank. Not collective.
Share shareOf(const std::vector<BodyLayout>& bodies, const Comm& comm);

/// First number of each body's nodes in the whole problem, and the number of them all.
std::vector<GlobalOrdinal> firstNodes(const std::vector<BodyLayout>& bodies);

/// The lowest part that has a node; of a piece of a mesh among the held elements, numParts() if none of them
/// has it.
int lowestPartAt(const BodyLayout& body, GlobalOrdinal node);

/// The physics of a body; keeps references to both. \throws InputError if mesh and scene do not go together.
std::unique_ptr<fem::BodyModel> makeModel(const scene::Body& body, const mesh::Mesh& mesh);

} // namespace epafi::model
