#pragma once

/// Where an error estimate knows little of the error: of meshes that lock, and of facets instead of smooth
/// surfaces.

#include "epafi/mesh/Mesh.hpp"
#include "epafi/model/Decompose.hpp"
#include "epafi/scene/Scene.hpp"

#include <string>
#include <vector>

namespace epafi::accuracy {

/// Whether linear elements of a body are so stiff, as ν is near 0.5 in a region or all over it, that an
/// estimate, which looks at how stresses jump, misses most of the error. Of plane stress and membranes never.
bool locks(const scene::Body& body);

/// How far straight facets deviate from a smooth surface through their nodes: the largest h θ/8 over
/// neighbours that turn by θ, at most by 40° (more is an edge of the body), h being the mean of their widths.
/// 0 for curved facets. Not collective.
double facetSag(const mesh::Mesh& mesh, const mesh::Surface& surface);

/// What the estimate does not know of a scene's error, in words for users; empty if nothing stands out:
/// bodies that lock, and contacts whose facets deviate from smooth surfaces by a quarter and more of what
/// they are pressed together. \param closing of each contact: the most by which a closed node has changed its
/// gap. Not collective.
std::string doubts(const scene::Scene& scene, const model::Decomposition& decomposition,
                   const std::vector<double>& closing);

} // namespace epafi::accuracy
