#pragma once

/// What is asked of a contact between two surfaces, or of a surface and an obstacle.

#include "epafi/base/Errors.hpp"
#include "epafi/base/Types.hpp"

#include <Eigen/Core>

#include <functional>
#include <limits>
#include <string>
#include <vector>

namespace epafi::contact {

/// What a contact is to be, and its names for messages.
struct ContactTerms {
  std::string name;         ///< of the contact
  std::string firstSurface; ///< name of the first body's surface
  int dimension = 3;        ///< of space
  int components = 3; ///< unknowns a node; a single one is a deflection: gaps do not follow from geometry
  double gap = 0;     ///< added to that of geometry
  double distance = std::numeric_limits<double>::infinity(); ///< nodes farther from the other side get no row
  bool coincide = false; ///< the surfaces do, and their nodes meet in order
  /// Of the thinner one of the bodies along a direction: overlaps are not deeper, what lies there is a far
  /// side. Empty: any depth.
  std::function<double(const Eigen::Vector3d& direction)> thickness{};
  /// Of each facet of the first surface the thickness of plane bodies that areas count; empty: 1.
  std::vector<double> thicknesses{};
  /// Of each facet of the first surface to which of the united contacts it belongs; empty: there is one.
  std::vector<std::size_t> parts{};
  bool isOfRevolution = false; ///< about the y-axis: areas are those of the whole circumference
  bool givesWay = false;       ///< rows are springs by their areas, of which there is none without area
  double sense = 1;            ///< of a deflection: −1 if it is the second body that must stay below
  /// Gaps of geometry up to this, overlaps too, count as none: surfaces that are meant to touch there.
  double adjust = -std::numeric_limits<double>::infinity();
  /// Whether that of a node of the first surface does, whatever it is; empty: of none.
  std::function<bool(GlobalOrdinal node)> isAdjusted{};

  /// c of a row of a node that is so far from the other side.
  [[nodiscard]] double gapOf(GlobalOrdinal node, double apart) const {
    return (apart <= adjust || (isAdjusted && isAdjusted(node)) ? 0 : apart) + gap;
  }
};

/// What is wrong with a contact, by its name.
inline InputError refusal(const ContactTerms& contact, const std::string& what) {
  return InputError("contact '" + contact.name + "': " + what);
}

} // namespace epafi::contact
