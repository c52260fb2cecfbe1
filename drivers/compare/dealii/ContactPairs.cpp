#include "ContactPairs.hpp"

#include <deal.II/dofs/dof_tools.h>
#include <deal.II/fe/fe.h>

#include <cmath>
#include <map>

using namespace dealii;

namespace {

/// Places along the contact to a fraction of the smallest cell, as keys.
long keyOf(double x) {
  return std::lround(x * (1L << 40));
}

std::map<long, types::global_dof_index> verticalDofs(const DoFHandler<2>& dofs, Boundary side,
                                                     const std::vector<Point<2>>& places) {
  ComponentMask vertical(2, false);
  vertical.set(1, true);
  std::map<long, types::global_dof_index> found;
  for (const auto dof : DoFTools::extract_boundary_dofs(dofs, vertical, {side}))
    found[keyOf(places[dof](0))] = dof;
  return found;
}

} // namespace

std::vector<ContactPair> contactPairs(const DoFHandler<2>& dofs) {
  std::vector<Point<2>> places(dofs.n_dofs());
  DoFTools::map_dofs_to_support_points(StaticMappingQ1<2>::mapping, dofs, places);
  const auto punch = verticalDofs(dofs, punch_face, places);
  std::vector<ContactPair> pairs;
  for (const auto& [place, dof] : verticalDofs(dofs, block_face, places))
    pairs.push_back({dof, punch.at(place)});
  return pairs;
}

void flagBothSides(Triangulation<2>& mesh) {
  for (bool changes = true; changes;) {
    mesh.prepare_coarsening_and_refinement();
    std::map<long, bool> isFlagged;
    const auto visit = [&](const auto& work) {
      for (const auto& cell : mesh.active_cell_iterators())
        for (const auto& face : cell->face_iterators())
          if (face->at_boundary() && (face->boundary_id() == block_face || face->boundary_id() == punch_face))
            work(cell, isFlagged[keyOf(face->center()(0))]);
    };
    visit([](const auto& cell, bool& flag) { flag = flag || cell->refine_flag_set(); });
    changes = false;
    visit([&](const auto& cell, bool flag) {
      if (flag && !cell->refine_flag_set()) {
        cell->set_refine_flag();
        changes = true;
      }
    });
  }
}
