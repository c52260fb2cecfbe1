#pragma once

/// Which elements of a body a region or a body force is about, and what each element is made of.

#include "epafi/fem/SolidBody.hpp"

#include <array>
#include <span>
#include <string>
#include <vector>

namespace epafi::fem {

/// Part of a body: the elements of a group of its mesh, or those whose centre lies in a box.
class SolidDomain {
public:
  /// \param user  who asks, such as "region 'core'"; \param group  if empty, the box counts
  /// \throws InputError if the mesh has no such group, or, unless that may be, no element has its centre in
  /// the box.
  SolidDomain(const SolidBody& body, const std::string& user, const std::string& group, const mesh::Box& box,
              bool mayBeEmpty);

  /// Calls action(e) for the place e of each of the elements that belongs to it.
  template <class Action>
  void forEachIn(const SolidBody& body, std::span<const GlobalOrdinal> elements, const Action& action) const;

private:
  [[nodiscard]] bool contains(const SolidBody& body, GlobalOrdinal element) const;

  bool isGroup_;
  std::vector<GlobalOrdinal> elements_; ///< of the group, ascending
  mesh::Box box_;
  /// Of a structured mesh: first and one after the last column, row and layer.
  std::array<std::array<GlobalOrdinal, 2>, 3> ranges_{};
};

/// The regions of a body: 0 is what lies outside of them all, r the r-th of the solid.
class SolidRegions {
public:
  /// \throws InputError like SolidDomain.
  explicit SolidRegions(const SolidBody& body);

  /// The last one of the solid that contains each element.
  void of(const SolidBody& body, std::span<const GlobalOrdinal> elements,
          std::span<GlobalOrdinal> regions) const;
  /// The same of one element.
  [[nodiscard]] std::size_t of(const SolidBody& body, GlobalOrdinal element) const;
  [[nodiscard]] std::size_t number() const { return domains_.size() + 1; }

private:
  std::vector<SolidDomain> domains_;
};

/// What a region is made of.
const Material& materialIn(const Solid& body, std::size_t region);

template <class Action>
void SolidDomain::forEachIn(const SolidBody& body, std::span<const GlobalOrdinal> elements,
                            const Action& action) const {
  if (const mesh::StructuredMesh* mesh = body.mesh.structured()) {
    mesh::GridWalk walk = mesh->elementWalk();
    for (std::size_t e = 0; e < elements.size(); ++e) {
      walk.to(elements[e]);
      const auto isWithin = [&](std::size_t d) {
        return ranges_[d][0] <= walk[d] && walk[d] < ranges_[d][1];
      };
      if (isWithin(0) && isWithin(1) && isWithin(2))
        action(e);
    }
    return;
  }
  for (std::size_t e = 0; e < elements.size(); ++e)
    if (contains(body, elements[e]))
      action(e);
}

} // namespace epafi::fem
