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
  std::string name;
  int body;
  GlobalOrdinal node; ///< of the body
};

std::string nameOf(const model::Decomposition& decomposition, const contact::ContactLayout& layout,
                   bool isTied) {
  const auto body = [&](int number) { return '\'' + decomposition.bodies[number].name + '\''; };
  return (isTied ? "the tied joint '" : "the contact '") + layout.name + "' of " + body(layout.firstBody) +
         (layout.secondBody >= 0 ? " and " + body(layout.secondBody) : " with an obstacle");
}

Origin originOf(const model::Decomposition& decomposition, GlobalOrdinal row) {
  for (const auto* layouts : {&decomposition.contacts, &decomposition.ties}) {
    GlobalOrdinal numRows = 0;
    for (const contact::ContactLayout& layout : *layouts) {
      numRows = std::max(numRows, layout.firstRow + layout.numRows());
      const std::size_t place = row - layout.firstRow;
      if (row >= layout.firstRow && row < layout.firstRow + layout.numRows() && layout.portion(place) > 0)
        return {nameOf(decomposition, layout, layouts == &decomposition.ties), layout.firstBody,
                layout.firstNodes[place]};
    }
    row -= numRows;
  }
  if (row < std::ssize(decomposition.equations)) {
    const contact::Equation& equation = decomposition.equations[row];
    return {"the equation '" + equation.name + "'", equation.terms.front().body, equation.terms.front().node};
  }
  throw Error("the scene has no row of contact, ties or equations number " + std::to_string(row) +
              " behind its last");
}

} // namespace

fetidp::ContradictionError inWordsOf(const model::Decomposition& decomposition,
                                     const fetidp::ContradictionError& error) {
  std::vector<std::string> names;
  for (const GlobalOrdinal row : error.rows())
    names.push_back(originOf(decomposition, row).name);
  const Origin first = originOf(decomposition, error.rows().front());
  const mesh::Mesh& mesh = *decomposition.bodies[first.body].mesh;
  const Point point = mesh.point(first.node);
  const std::size_t dimension = mesh::dimensionOf(mesh.cellType());
  return {error.rows(), error.misfit(), std::move(names), text(std::span(point.data(), dimension))};
}

} // namespace epafi::simulation
