#include "epafi/assembly/Materials.hpp"

#include "epafi/base/Errors.hpp"
#include "epafi/base/Text.hpp"

#include <algorithm>

namespace epafi::assembly {

const std::vector<NamedMaterial>& materials() {
  static const std::vector<NamedMaterial> table{
      {"steel", 210000, 0.3, 12e-6},      {"stainless steel", 195000, 0.3, 16e-6},
      {"cast iron", 110000, 0.26, 11e-6}, {"aluminium", 70000, 0.33, 23.5e-6},
      {"titanium", 114000, 0.34, 8.6e-6}, {"copper", 120000, 0.34, 17e-6},
      {"brass", 100000, 0.35, 19e-6},     {"bronze", 110000, 0.34, 18e-6}};
  return table;
}

const NamedMaterial& materialOf(const std::string& name) {
  std::vector<std::string> names;
  for (const NamedMaterial& material : materials()) {
    if (material.name == name)
      return material;
    names.push_back(material.name);
  }
  const std::string near = nearestName(name, names);
  throw InputError("the material " + inQuotes(name) + " is unknown; there are " + listed(names, "\"") +
                   (near.empty() ? ", or give Young's Modulus and Poisson's Ratio"
                                 : "; did you mean " + inQuotes(near) + '?'));
}

} // namespace epafi::assembly
