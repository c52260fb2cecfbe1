#pragma once

/// The elements of a body, subdomain by subdomain, with what they are made of and how they are displaced:
/// what everything that integrates over a solution walks along.

#include "epafi/fem/BodyModel.hpp"
#include "epafi/fem/FluxIntegrals.hpp"
#include "epafi/fem/LocalNumbering.hpp"
#include "epafi/fem/RecentlyUsed.hpp"
#include "epafi/fem/SolidBody.hpp"
#include "epafi/fem/SolidDomains.hpp"
#include "epafi/mesh/ElementGeometry.hpp"
#include "epafi/model/Decompose.hpp"

#include <Eigen/Core>

#include <memory>
#include <span>
#include <vector>

namespace epafi::accuracy {

/// The elements of one subdomain.
struct SubdomainElements {
  std::vector<GlobalOrdinal> elements; ///< as numbered in the body, ascending
  std::shared_ptr<const fem::LocalNumbering>
      numbering;                      ///< their corners as places among the subdomain's nodes
  std::vector<GlobalOrdinal> regions; ///< of each element; empty where the body has but one
  /// 0: what lies outside of all regions of the scene.
  [[nodiscard]] GlobalOrdinal regionOf(std::size_t element) const {
    return regions.empty() ? 0 : regions[element];
  }
};

/// One element; all spans end with the call that they are handed to.
struct ElementView {
  std::size_t number = 0; ///< place among the subdomain's elements
  GlobalOrdinal region = 0;
  std::span<const int> nodes; ///< places among the subdomain's nodes
  std::span<const Point> points;
  std::span<const double> displacements; ///< node by node, components in space
  fem::NodalState state;                 ///< empty of a body of which neither temperatures nor factors change
};

/// Where the points of an element view are.
enum class Points {
  /// Up to a shift, which is all that integrals need: no point is looked up where elements are congruent
  shape,
  inPlace ///< where they are
};

class BodyElements {
public:
  /// Keeps references to both.
  BodyElements(const scene::Body& body, const model::BodyLayout& layout);

  [[nodiscard]] fem::Physics physics() const { return physics_; }
  /// Of the largest elements.
  [[nodiscard]] mesh::CellType cellType() const { return layout_.mesh->cellType(); }
  [[nodiscard]] int order() const { return mesh::orderOf(cellType()); }
  /// Of one element.
  [[nodiscard]] mesh::CellType typeOf(const ElementView& element) const {
    return cellOf(cellType(), element.nodes.size());
  }
  [[nodiscard]] const mesh::Mesh& mesh() const { return *layout_.mesh; }
  /// What a region is made of.
  [[nodiscard]] const fem::Material& materialOf(GlobalOrdinal region) const { return materials_[region]; }
  [[nodiscard]] GlobalOrdinal numRegions() const { return static_cast<GlobalOrdinal>(materials_.size()); }

  /// Precondition: the subdomain is one of this body's.
  [[nodiscard]] SubdomainElements elementsOf(const decomposition::Subdomain& subdomain);

  /// Of each element a number of its region and of the last body force that acts on it, inside of which
  /// fluxes are smooth; empty where the body has but one.
  [[nodiscard]] std::vector<GlobalOrdinal> smoothParts(const SubdomainElements& elements) const;

  /// Elements of a structured mesh, region by region; null of another, and of bodies with a state.
  [[nodiscard]] const fem::CongruentFluxes* congruentFluxes(GlobalOrdinal region) const {
    return congruent_.empty() ? nullptr : &congruent_[region];
  }
  /// Area or volume of each element of a structured mesh.
  [[nodiscard]] double measure() const { return mesh::measureOf(cellType(), shape_); }
  /// Places of the elements of a region among the subdomain's.
  [[nodiscard]] static std::vector<std::size_t> inRegion(const SubdomainElements& elements,
                                                         GlobalOrdinal region);
  /// Displacements of some elements, a column each.
  [[nodiscard]] Eigen::MatrixXd gather(const SubdomainElements& elements, std::span<const std::size_t> which,
                                       const Eigen::VectorXd& displacement) const;

  /// action(ElementView) for each element. \param displacement  at all positions of the subdomain
  template <class Action>
  void visit(const decomposition::Subdomain& subdomain, const SubdomainElements& elements,
             const Eigen::VectorXd& displacement, Points where, Action&& action) const {
    const std::size_t components = fem::componentsOf(physics_);
    const std::size_t perElement = elements.numbering->nodesPerElement();
    const bool looksUp = shape_.empty() || where == Points::inPlace;
    std::vector<Point> points(shape_);
    points.resize(perElement);
    std::vector<double> values(perElement * components), change, factors;
    for (std::size_t e = 0; e < elements.elements.size(); ++e) {
      const std::span<const int> nodes = elements.numbering->elementNodes(e);
      for (std::size_t i = 0; i < nodes.size(); ++i) {
        const std::size_t node = nodes[i];
        if (looksUp)
          points[i] = layout_.mesh->point(subdomain.nodes[node]);
        for (std::size_t c = 0; c < components; ++c)
          values[i * components + c] = displacement[node * components + c];
      }
      if (hasState_) {
        model_->temperatureChange(elements.elements[e], change);
        model_->stiffnessFactors(elements.elements[e], factors);
      }
      action(ElementView{e,
                         elements.regionOf(e),
                         nodes,
                         std::span(points).first(nodes.size()),
                         std::span(values).first(nodes.size() * components),
                         {change, factors}});
    }
  }

private:
  const model::BodyLayout& layout_;
  fem::Physics physics_;
  std::vector<fem::Material> materials_; ///< of each region
  std::vector<Point>
      shape_; ///< corners of every element from the origin on, where all are congruent; else empty
  bool hasState_;
  std::vector<fem::CongruentFluxes>
      congruent_; ///< of each region; empty of others, and of bodies with a state
  fem::SolidBody solid_;
  std::vector<fem::SolidDomain> forces_;  ///< where body forces act
  std::unique_ptr<fem::BodyModel> model_; ///< knows regions and states; null where there are none
  fem::RecentlyUsed<fem::LocalNumbering> numberings_;
};

/// Those of all bodies of a scene. Keeps references to both.
std::vector<BodyElements> elementsOfBodies(const scene::Scene& scene,
                                           const model::Decomposition& decomposition);

} // namespace epafi::accuracy
