#pragma once

/// Which elements of a solid a region or a body force is about, and what each element is made of.

#include "epafi/fem/SolidBody.hpp"

#include <string>
#include <vector>

namespace epafi::fem {

/// Part of a body: the elements of a group of its mesh, or those whose centre lies in a box.
class SolidDomain {
public:
  /// \param user  who asks, such as "region 'core'"; \param group  if empty, the box counts
  /// \throws InputError if the mesh has no such group, or no element has its centre in the box.
  SolidDomain(const SolidBody& body, const std::string& user, const std::string& group,
              const scene::Box& box);

  [[nodiscard]] bool contains(const SolidBody& body, GlobalOrdinal element) const;

private:
  bool isGroup_;
  std::vector<GlobalOrdinal> elements_; ///< of the group, ascending
  scene::Box box_;
};

/// The regions of a solid: 0 is what lies outside of them all, r the r-th of the scene.
class SolidRegions {
public:
  /// \throws InputError like SolidDomain.
  explicit SolidRegions(const SolidBody& body);

  /// The last one in the scene that contains the element.
  [[nodiscard]] std::size_t regionOf(const SolidBody& body, GlobalOrdinal element) const;
  [[nodiscard]] std::size_t number() const { return domains_.size() + 1; }

private:
  std::vector<SolidDomain> domains_;
};

/// What a region is made of.
const scene::Material& materialIn(const scene::Solid& solid, std::size_t region);

} // namespace epafi::fem
