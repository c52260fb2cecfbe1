#pragma once

/// The fields of one body, each rank holding a contiguous slab of its nodes and of its cells.

#include "epafi/base/Slab.hpp"
#include "epafi/mesh/Cell.hpp"
#include "epafi/simulation/SolvedScene.hpp"

#include <vector>

namespace epafi::output {

/// Tables are stored row by row; n nodes, n_e cells, m crosspoints in the whole body.
struct BodyFields {
  GlobalOrdinal numNodes = 0; ///< n
  RowRange nodes;             ///< this rank's nodes
  std::vector<double> points; ///< n × 3
  std::vector<double> u;      ///< n × components

  GlobalOrdinal numCells = 0;                              ///< n_e
  mesh::CellType cellType = mesh::CellType::quadrilateral; ///< of the largest cells
  RowRange cells;                                          ///< this rank's cells
  std::vector<long long> corners;                          ///< n_e rows (Cell.hpp) of node numbers
  std::vector<int> subdomain;                              ///< n_e, numbered over the whole problem

  GlobalOrdinal numCrosspoints = 0;     ///< m
  RowRange crosspoints;                 ///< this rank's crosspoints
  std::vector<double> crosspointPoints; ///< m × 3
};

/// Brings the fields of body `body` from the subdomains to the slabs. Each node's u is that of the
/// lowest-numbered subdomain that holds it (copies agree up to the solver's tolerance). Crosspoints are the
/// nodes with crosspoint unknowns, and, among the nodes without any unknown (supported), those that would be:
/// shared by three parts, or by two on the body's boundary (in the plane only); nodes whose unknowns stand
/// for averages along edges are none. Collective. \throws Error (the same on all ranks) if the solution does
/// not fit the decomposition.
BodyFields gatherBodyFields(const simulation::SolvedScene& solved, int body);

} // namespace epafi::output
