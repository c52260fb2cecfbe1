#include "epafi/simulation/SectionForces.hpp"

#include "epafi/accuracy/BodyElements.hpp"
#include "epafi/base/AccurateSum.hpp"
#include "epafi/base/Collective.hpp"
#include "epafi/fem/DistributedTraction.hpp"
#include "epafi/fem/ElementIntegrals.hpp"

#include <Eigen/Geometry>

#include <algorithm>
#include <map>
#include <optional>
#include <set>
#include <vector>

namespace epafi::simulation {
namespace {

using Eigen::Vector3d;
using NodesOfElements = std::map<GlobalOrdinal, std::set<GlobalOrdinal>>;
using LoadKind = fem::SolidLoad::Kind;

bool isOnSurface(const fem::SolidLoad& load) {
  return load.kind == LoadKind::traction || load.kind == LoadKind::pressure ||
         load.kind == LoadKind::distributed;
}

/// The body with the loads that elements have inside.
scene::Body withInnerLoads(const scene::Body& body) {
  scene::Body rest(body);
  std::erase_if(rest.loads,
                [](const fem::SolidLoad& load) { return load.kind == LoadKind::point || isOnSurface(load); });
  return rest;
}

/// Forces at nodes of loads on facets, but those of the section itself, whose nodes are all in it.
std::map<GlobalOrdinal, std::map<GlobalOrdinal, Vector3d>>
loadsBeside(const scene::Body& body, const mesh::Mesh& mesh, const NodesOfElements& wanted) {
  std::map<GlobalOrdinal, std::map<GlobalOrdinal, Vector3d>> result;
  std::vector<Point> points;
  Eigen::VectorXd values;
  for (const fem::SolidLoad& load : body.loads) {
    if (!isOnSurface(load))
      continue;
    const mesh::Surface surface = mesh.surface(load.where);
    std::optional<fem::DistributedTraction> distributed;
    if (load.kind == LoadKind::distributed)
      distributed.emplace(fem::SolidBody(body, mesh), surface, load,
                          [&](std::size_t) -> const fem::Material& { return body.material; });
    for (std::size_t f = 0; f < surface.numFacets(); ++f) {
      const auto found = wanted.find(surface.elements[f]);
      const std::span<const GlobalOrdinal> nodes = surface.facet(f);
      if (found == wanted.end() || std::all_of(nodes.begin(), nodes.end(), [&](GlobalOrdinal node) {
            return found->second.contains(node);
          }))
        continue;
      mesh.pointsAt(nodes, points);
      const auto integration = fem::integrationOf(body);
      if (distributed)
        distributed->of(surface.typeOf(f), points, body.material, values);
      else if (load.kind == LoadKind::pressure)
        fem::pressureLoad(surface.typeOf(f), points, body.physics, body.material, load.value[0], values,
                          integration);
      else
        fem::tractionLoad(surface.typeOf(f), points, body.physics, body.material, load.value, values,
                          integration);
      for (std::size_t i = 0; i < nodes.size(); ++i)
        result[found->first].try_emplace(nodes[i], Vector3d::Zero()).first->second +=
            values.segment<3>(static_cast<Eigen::Index>(3 * i));
    }
  }
  return result;
}

/// Adds what the elements of a body here have of it.
void addForces(const SolvedScene& solved, int body, const NodesOfElements& wanted,
               std::array<AccurateSum, 6>& sums) {
  const scene::Body rest = withInnerLoads(solved.scene.bodies[body]);
  const model::BodyLayout& layout = solved.decomposition.bodies[body];
  const auto beside = loadsBeside(solved.scene.bodies[body], *layout.mesh, wanted);
  const auto model = model::makeModel(rest, *layout.mesh);
  accuracy::BodyElements elements(solved.scene.bodies[body], layout);
  Eigen::MatrixXd stiffness;
  Eigen::VectorXd load;
  const auto& subdomains = solved.decomposition.problem.subdomains;
  for (std::size_t s = 0; s < subdomains.size(); ++s) {
    if (subdomains[s].body != body)
      continue;
    const accuracy::SubdomainElements those = elements.elementsOf(subdomains[s]);
    elements.visit(subdomains[s], those, solved.solution.displacement[s], accuracy::Points::inPlace,
                   [&](const accuracy::ElementView& element) {
                     const auto found = wanted.find(those.elements[element.number]);
                     if (found == wanted.end())
                       return;
                     Eigen::VectorXd u = Eigen::Map<const Eigen::VectorXd>(element.displacements.data(),
                                                                           element.displacements.size());
                     const auto frameOf = [&](std::size_t i) {
                       return model->frame(subdomains[s].nodes[element.nodes[i]]);
                     };
                     for (std::size_t i = 0; i < element.nodes.size(); ++i)
                       if (const Eigen::Matrix3d* frame = frameOf(i))
                         u.segment<3>(3 * i) = (frame->transpose() * u.segment<3>(3 * i)).eval();
                     model->element(found->first, stiffness, load);
                     const Eigen::VectorXd forces = stiffness * u - load;
                     for (std::size_t i = 0; i < element.nodes.size(); ++i) {
                       if (!found->second.contains(subdomains[s].nodes[element.nodes[i]]))
                         continue;
                       const Eigen::Matrix3d* frame = frameOf(i);
                       Vector3d force = forces.segment<3>(3 * i);
                       if (frame != nullptr)
                         force = (*frame * force).eval();
                       if (const auto own = beside.find(found->first); own != beside.end())
                         if (const auto at = own->second.find(subdomains[s].nodes[element.nodes[i]]);
                             at != own->second.end())
                           force -= at->second;
                       const Vector3d moment = Vector3d::Map(element.points[i].data()).cross(force);
                       for (std::size_t d = 0; d < 3; ++d) {
                         sums[d].add(force[d]);
                         sums[3 + d].add(moment[d]);
                       }
                     }
                   });
  }
}

} // namespace

SectionForce sectionForce(const SolvedScene& solved, std::span<const SectionShare> shares) {
  std::map<int, NodesOfElements> wanted; // by body
  for (const SectionShare& share : shares)
    wanted[share.body][share.element].insert(share.node);
  std::array<AccurateSum, 6> sums;
  collectively(solved.comm(), [&] {
    for (const auto& [body, elements] : wanted)
      addForces(solved, body, elements, sums);
  });
  sumOverRanks(solved.comm(), std::span<AccurateSum>(sums));
  SectionForce result;
  for (std::size_t d = 0; d < 3; ++d) {
    result.force[d] = sums[d].value();
    result.moment[d] = sums[3 + d].value();
  }
  return result;
}

} // namespace epafi::simulation
