#pragma once

/// The two surfaces of a scene's contact: which ones are meant, and which one is to carry multipliers if they
/// are meshed apart.

#include "epafi/mesh/Mesh.hpp"
#include "epafi/model/BodyLayout.hpp"
#include "epafi/scene/Scene.hpp"

#include <Eigen/Core>

#include <string>
#include <vector>

namespace epafi::model {

/// A surface of a body by its name. \throws InputError if there is none, with the names that there are. Not
/// collective.
mesh::Surface surfaceOf(const scene::SurfaceContact& contact, const BodyLayout& body,
                        const std::string& surface);

/// Mean distance of a surface's nodes.
double spacingOf(const mesh::Mesh& mesh, const mesh::Surface& surface);

/// ∫n over a surface.
Eigen::Vector3d areaVectorOf(const mesh::Mesh& mesh, const mesh::Surface& surface);

/// Decides which surface is to carry multipliers: one that no support holds, then one that no other contact
/// has, then one that is finer by half where they are near each other, then one of whose facets the other
/// covers more, then that of the softer body, then the finer, then the first. Returns why, as words behind
/// the body's name.
/// \param[in,out] terms  one of the scene's contacts, between two bodies
/// Not collective.
std::string chooseSide(const scene::Scene& scene, const std::vector<BodyLayout>& bodies,
                       scene::SurfaceContact& terms);

} // namespace epafi::model
