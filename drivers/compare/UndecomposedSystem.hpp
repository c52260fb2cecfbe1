#pragma once

/// A scene of elastic bodies as one system, for solvers that know nothing of subdomains:
/// min ½uᵀKu − fᵀu, Bu ≤ c, each body in one piece.

#include "epafi/scene/Scene.hpp"

#include <Eigen/Core>
#include <Eigen/SparseCore>

#include <vector>

namespace epafi::drivers {

/// n unknowns, free displacements of nodes, body by body and node by node; m contact conditions.
struct UndecomposedSystem {
  using Matrix = Eigen::SparseMatrix<double, Eigen::RowMajor, int>;

  Matrix stiffness;        ///< K, n × n, both triangles
  Eigen::VectorXd load;    ///< f, n; prescribed displacements are in it
  Matrix constraint;       ///< B, m × n; a row without entries is a contact of supported nodes
  Eigen::VectorXd gap;     ///< c, m
  double energyOffset = 0; ///< energy that prescribed displacements alone contribute

  // Where an unknown acts: the rigid motion u(x) = t + ω × x has the value u(place)ᵀdirection.
  std::vector<int> body;      ///< n: index into the scene's bodies
  std::vector<int> node;      ///< n: node of the body's mesh
  Eigen::Matrix3Xd place;     ///< 3 × n: coordinates of the node
  Eigen::Matrix3Xd direction; ///< 3 × n: of length 1
};

/// \throws InputError if the scene is one of membranes or cannot be assembled. On one rank, the caller's alone.
UndecomposedSystem undecomposedSystem(const scene::Scene& scene);

} // namespace epafi::drivers
