#pragma once

/// The two sides of the punch's contact, whose meshes are kept alike.

#include <deal.II/dofs/dof_handler.h>
#include <deal.II/fe/mapping_q1.h>

#include <vector>

enum Boundary : dealii::types::boundary_id {
  free_side,
  symmetry,
  floor_side,
  pressed,
  block_face,
  punch_face
};

struct ContactPair {
  dealii::types::global_dof_index block, punch; ///< vertical displacements of two nodes at one place
};

/// All pairs, from left to right.
std::vector<ContactPair> contactPairs(const dealii::DoFHandler<2>& dofs);

/// Flags the cells that face flagged ones, and what the mesh asks for besides, until nothing changes.
void flagBothSides(dealii::Triangulation<2>& mesh);
