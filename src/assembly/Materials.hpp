#pragma once

/// Materials by name, in MPa and per degree: of metals as handbooks have them, for first answers.

#include <string>
#include <vector>

namespace epafi::assembly {

struct NamedMaterial {
  std::string name;
  double youngsModulus, poissonsRatio, expansion;
};

const std::vector<NamedMaterial>& materials();

/// \throws InputError that lists the names
const NamedMaterial& materialOf(const std::string& name);

} // namespace epafi::assembly
