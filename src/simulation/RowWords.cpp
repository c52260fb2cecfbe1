#include "epafi/simulation/RowWords.hpp"

#include "epafi/base/Text.hpp"

#include <algorithm>
#include <span>
#include <string>
#include <utility>
#include <vector>

namespace epafi::simulation {
namespace {

/// A row of a scene.
struct Origin {
  const contact::ContactLayout& layout;
  bool isTied;
  GlobalOrdinal node; ///< of the first body
};

Origin originOf(const model::Decomposition& decomposition, GlobalOrdinal row) {
  for (const auto* layouts : {&decomposition.contacts, &decomposition.ties}) {
    GlobalOrdinal numRows = 0;
    for (const contact::ContactLayout& layout : *layouts) {
      numRows = std::max(numRows, layout.firstRow + layout.numRows());
      const std::size_t place = row - layout.firstRow;
      if (row >= layout.firstRow && row < layout.firstRow + layout.numRows() && layout.portion(place) > 0)
        return {layout, layouts == &decomposition.ties, layout.firstNodes[place]};
    }
    row -= numRows;
  }
  throw Error("the scene has no row of contact or ties number " + std::to_string(row) + " behind its last");
}

std::string nameOf(const model::Decomposition& decomposition, const Origin& origin) {
  const auto body = [&](int number) { return '\'' + decomposition.bodies[number].name + '\''; };
  return (origin.isTied ? "the tied joint '" : "the contact '") + origin.layout.name + "' of " +
         body(origin.layout.firstBody) +
         (origin.layout.secondBody >= 0 ? " and " + body(origin.layout.secondBody) : " with an obstacle");
}

} // namespace

fetidp::ContradictionError inWordsOf(const model::Decomposition& decomposition,
                                     const fetidp::ContradictionError& error) {
  std::vector<std::string> names;
  for (const GlobalOrdinal row : error.rows())
    names.push_back(nameOf(decomposition, originOf(decomposition, row)));
  const Origin first = originOf(decomposition, error.rows().front());
  const mesh::Mesh& mesh = *decomposition.bodies[first.layout.firstBody].mesh;
  const Point point = mesh.point(first.node);
  const std::size_t dimension = mesh::dimensionOf(mesh.cellType());
  return {error.rows(), error.misfit(), std::move(names), text(std::span(point.data(), dimension))};
}

} // namespace epafi::simulation
