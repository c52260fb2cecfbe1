#pragma once

/// The rows of contacts that are laid out as one: by pairs of nodes or by mortars, as their surfaces ask for.

#include "epafi/contact/ContactLayout.hpp"
#include "epafi/contact/ContactTerms.hpp"
#include "epafi/contact/UnitedSurface.hpp"
#include "epafi/model/BodyLayout.hpp"
#include "epafi/model/ContactGroups.hpp"
#include "epafi/model/SceneContacts.hpp"
#include "epafi/model/TiedNodes.hpp"
#include "epafi/scene/Scene.hpp"

#include <Eigen/Core>

#include <functional>
#include <optional>
#include <string>
#include <vector>

namespace epafi::model {

/// What the sides of some contacts are to be, and how they meet.
class Coupler {
public:
  /// Keeps references. \param tied  nodes of tied joints; null: there are none
  Coupler(const ContactGroup& group, const std::vector<BodyLayout>& bodies, int components,
          const SupportedNodes& supported, const TiedNodes* tied);

  /// The rows of all of them. \throws InputError as the searches of the contact room do.
  [[nodiscard]] contact::ContactLayout layout() const;

private:
  /// A side of the contacts.
  struct Side {
    int body;
    std::vector<std::string> surfaces;
    bool isTurnedOver = false; ///< seen from inside the body
  };

  [[nodiscard]] const BodyLayout& layoutOf(const Side& side) const { return bodies_[side.body]; }
  [[nodiscard]] int orderOf(const Side& side) const { return mesh::orderOf(layoutOf(side).mesh->cellType()); }
  [[nodiscard]] contact::UnitedSurface united(const Side& side) const {
    contact::UnitedSurface result = contact::unite(*layoutOf(side).mesh, side.surfaces);
    if (side.isTurnedOver)
      contact::turnOver(result.surface);
    return result;
  }
  /// Whether nodes of a side are tied to the other one; empty: none is, or this is a tie itself.
  [[nodiscard]] std::function<bool(GlobalOrdinal)> tiedNodes(const Side& side, const Side& other) const;
  [[nodiscard]] contact::UnitedSurface untied(const Side& side, const Side& other) const;
  [[nodiscard]] bool isHeld(const Side& side) const;
  [[nodiscard]] bool faceOneWay() const;
  [[nodiscard]] bool isTied() const { return terms_.kind == scene::SurfaceContact::Kind::tied; }
  [[nodiscard]] Eigen::Matrix3d axesOf(const Side& side, const mesh::Surface& surface) const {
    return supported_.axes ? supported_.axes(side.body, surface) : Eigen::Matrix3d::Identity();
  }

  [[nodiscard]] std::vector<double> thicknesses(const Side& first, const mesh::Surface& surface) const;
  [[nodiscard]] std::function<bool(GlobalOrdinal)> adjustedNodes(const Side& first) const;
  [[nodiscard]] contact::ContactTerms asked(const Side& first, const contact::UnitedSurface& surface) const;
  [[nodiscard]] contact::ContactLayout finish(contact::ContactLayout layout, const Side& first,
                                              const Side& second, std::string means) const;
  [[nodiscard]] std::optional<contact::ContactLayout> byPairs() const;
  [[nodiscard]] contact::ContactLayout byMortar() const;

  const scene::SurfaceContact& terms_;
  const std::vector<BodyLayout>& bodies_;
  int components_;
  const SupportedNodes& supported_;
  const TiedNodes* tied_;
  Side first_, second_;
  std::string name_;
};

} // namespace epafi::model
