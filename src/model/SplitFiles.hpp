#pragma once

/// Meshes that Gmsh has cut into files, one a partition (`gmsh -part 64 -part_split`, option
/// Mesh.PartitionSplitMeshFiles): press_1.msh, press_2.msh … A scene names them as "press_*.msh". Each rank
/// reads some of them, checks them and cuts each by METIS, so that no rank has the whole mesh at any time,
/// and parts are the same on any number of ranks.

#include "epafi/meshing/LooseMesh.hpp"
#include "epafi/scene/Body.hpp"

#include <span>
#include <string>
#include <vector>

namespace epafi::model {

/// Of each of some bodies whose meshes lie in the same files, what the ranks read of it. All ranks must see
/// the files. What UnstructuredMesh checks is checked in each file by itself: nodes that hang, or lie at one
/// place, in two files are not found.
///
/// \param bodies  of one name (meshing::isSplit()); their Decomposition/Parts, or what is chosen for each, is
/// shared among the files by their elements of the body: one part a file at least
/// Collective. \throws InputError, the same on all ranks, if there are no such files, or not as many as the
/// mesh was cut into, readMsh() or UnstructuredMesh refuse one, their order is not the one that is asked for,
/// or no file has a body.
std::vector<meshing::LooseMesh> readSplitFiles(std::span<const scene::Body* const> bodies, const Comm& comm);

} // namespace epafi::model
