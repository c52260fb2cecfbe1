#pragma once

/// What each element of a body is made of.

#include "epafi/fem/SolidModel.hpp"

#include <optional>
#include <string>

namespace epafi::output {

/// Looks at the mesh only if the body has regions of another material.
class ElementMaterials {
public:
  /// Keeps references to both.
  ElementMaterials(const std::string& name, const scene::Solid& solid, const fem::Mesh& mesh)
      : solid_(solid) {
    if (!solid.regions.empty())
      model_.emplace(name, solid, mesh);
  }
  [[nodiscard]] const scene::Material& of(GlobalOrdinal element) const {
    return model_ ? model_->materialOf(element) : solid_.material;
  }

private:
  const scene::Solid& solid_;
  std::optional<fem::SolidModel> model_;
};

} // namespace epafi::output
