#include "epafi/accuracy/BodyElements.hpp"

#include "epafi/fem/SolidBody.hpp"
#include "epafi/fem/SolidDomains.hpp"

#include <optional>

namespace epafi::accuracy {
namespace {

/// Shapes of subdomains that are looked at in turn, and the numbers kept of them: some 4 MB.
constexpr std::size_t maxNumberings = 8, maxNumbers = 1U << 20U;

std::vector<fem::Material> materialsOf(const scene::Body& body) {
  std::vector<fem::Material> materials;
  for (std::size_t region = 0; region <= body.regions.size(); ++region)
    materials.push_back(fem::materialIn(body, region));
  return materials;
}

} // namespace

BodyElements::BodyElements(const scene::Body& body, const model::BodyLayout& layout)
    : layout_(layout), physics_(body.physics), materials_(materialsOf(body)),
      shape_(fem::sharedShape(body, *layout.mesh)),
      hasState_(fem::isHeated(body) || !body.stiffnessFactors.empty()), solid_(body, *layout.mesh),
      model_(materials_.size() > 1 || hasState_ ? model::makeModel(body, *layout.mesh) : nullptr),
      numberings_(maxNumberings, maxNumbers) {
  if (!shape_.empty() && !hasState_)
    for (const fem::Material& material : materials_)
      congruent_.emplace_back(cellType(), shape_, physics_, material);
  for (const fem::SolidLoad& load : body.loads)
    if (load.kind == fem::SolidLoad::Kind::body || load.kind == fem::SolidLoad::Kind::rotation)
      forces_.emplace_back(solid_, "load '" + load.name + "'", load.where, load.box, true);
}

SubdomainElements BodyElements::elementsOf(const decomposition::Subdomain& subdomain) {
  SubdomainElements result;
  result.elements = layout_.partition->elementsOf(subdomain.number - layout_.firstSubdomain);
  const int perElement = layout_.mesh->nodesPerElement();
  std::vector<GlobalOrdinal> corners(result.elements.size() * perElement);
  layout_.mesh->elementNodes(result.elements, corners);
  result.numbering = numberings_.find(
      [&](const fem::LocalNumbering& known) { return known.firstNodeIfShifted(corners).has_value(); });
  if (!result.numbering)
    result.numbering = numberings_.add(fem::LocalNumbering(corners, perElement), corners.size());
  if (materials_.size() > 1) {
    result.regions.resize(result.elements.size());
    model_->regions(result.elements, result.regions);
  }
  return result;
}

std::vector<GlobalOrdinal> BodyElements::smoothParts(const SubdomainElements& elements) const {
  if (forces_.empty())
    return elements.regions;
  std::vector<GlobalOrdinal> parts(elements.elements.size());
  for (std::size_t force = 0; force < forces_.size(); ++force)
    forces_[force].forEachIn(solid_, elements.elements,
                             [&](std::size_t e) { parts[e] = static_cast<GlobalOrdinal>(force) + 1; });
  for (std::size_t e = 0; e < parts.size(); ++e)
    parts[e] = parts[e] * numRegions() + elements.regionOf(e);
  return parts;
}

std::vector<std::size_t> BodyElements::inRegion(const SubdomainElements& elements, GlobalOrdinal region) {
  std::vector<std::size_t> which;
  for (std::size_t e = 0; e < elements.elements.size(); ++e)
    if (elements.regionOf(e) == region)
      which.push_back(e);
  return which;
}

Eigen::MatrixXd BodyElements::gather(const SubdomainElements& elements, std::span<const std::size_t> which,
                                     const Eigen::VectorXd& displacement) const {
  const Eigen::Index components = fem::componentsOf(physics_);
  const Eigen::Index perElement = elements.numbering->nodesPerElement();
  Eigen::MatrixXd gathered(perElement * components, which.size());
  double* value = gathered.data();
  for (const std::size_t element : which)
    for (const int node : elements.numbering->elementNodes(element)) {
      const double* first = displacement.data() + node * components;
      for (Eigen::Index c = 0; c < components; ++c)
        *value++ = first[c];
    }
  return gathered;
}

std::vector<BodyElements> elementsOfBodies(const scene::Scene& scene,
                                           const model::Decomposition& decomposition) {
  std::vector<BodyElements> bodies;
  bodies.reserve(scene.bodies.size());
  for (std::size_t b = 0; b < scene.bodies.size(); ++b)
    bodies.emplace_back(scene.bodies[b], decomposition.bodies[b]);
  return bodies;
}

} // namespace epafi::accuracy
