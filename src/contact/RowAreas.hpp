#pragma once

/// The areas of rows, facet by facet.

#include "epafi/contact/ContactLayout.hpp"
#include "epafi/contact/ContactTerms.hpp"

#include <algorithm>
#include <cstddef>
#include <vector>

namespace epafi::contact {

/// Sums for the nodes of a surface, with the thickness of facets, and what each of the united contacts has of
/// them.
class RowAreas {
public:
  /// Keeps a reference to the terms.
  RowAreas(const ContactTerms& terms, std::size_t numNodes) : terms_(terms), all_(numNodes, 0.0) {
    if (!terms.parts.empty())
      ofParts_.assign(1 + *std::max_element(terms.parts.begin(), terms.parts.end()), all_);
  }
  void add(std::size_t facet, std::size_t node, double area) {
    if (!terms_.thicknesses.empty())
      area *= terms_.thicknesses[facet];
    all_[node] += area;
    if (!ofParts_.empty())
      ofParts_[terms_.parts[facet]][node] += area;
  }
  [[nodiscard]] double of(std::size_t node) const { return all_[node]; }
  /// Enters those of a node as the layout's next row.
  void enter(std::size_t node, ContactLayout& layout) const {
    layout.areas.push_back(all_[node]);
    layout.areasOfParts.resize(ofParts_.size());
    for (std::size_t part = 0; part < ofParts_.size(); ++part)
      layout.areasOfParts[part].push_back(ofParts_[part][node]);
  }

private:
  const ContactTerms& terms_;
  std::vector<double> all_;
  std::vector<std::vector<double>> ofParts_;
};

} // namespace epafi::contact
