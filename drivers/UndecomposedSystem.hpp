#pragma once

/// A scene as one system, for solvers that know nothing of subdomains:
/// min ½uᵀKu − fᵀu, Bu ≤ c, each body in one piece.

#include "epafi/scene/Scene.hpp"

#include <Eigen/Core>
#include <Eigen/SparseCore>

#include <vector>

namespace epafi::drivers {

/// n unknowns, free displacements of nodes, body by body and node by node; m conditions, those of contact
/// first and then those of tied joints.
struct UndecomposedSystem {
  using Matrix = Eigen::SparseMatrix<double, Eigen::RowMajor, int>;

  Matrix stiffness;             ///< K, n × n, both triangles
  Eigen::VectorXd load;         ///< f, n; prescribed displacements are in it
  Matrix constraint;            ///< B, m × n; a row without entries is a contact of supported nodes
  Eigen::VectorXd gap;          ///< c, m
  Eigen::Index numContacts = 0; ///< rows B u ≤ c; for those behind them B u = c
  double energyOffset = 0;      ///< energy that prescribed displacements alone contribute

  // Of nodes with friction. Solvers here leave it out.
  Matrix tangent;             ///< T, Tu − s is what slips: of each node as many rows as components less one
  Eigen::VectorXd tangentGap; ///< s
  std::vector<int> frictionRow;  ///< of each node its row of contact
  Eigen::VectorXd friction;      ///< of each Coulomb's coefficient
  Eigen::VectorXd frictionBound; ///< of each a force, Tresca's law

  // Where an unknown acts: the rigid motion u(x) = t + ω × x has the value u(place)ᵀdirection. A membrane's
  // unknowns have no direction in space; theirs is (1, 0, 0).
  std::vector<int> body;      ///< n: index into the scene's bodies
  std::vector<int> node;      ///< n: node of the body's mesh
  Eigen::Matrix3Xd place;     ///< 3 × n: coordinates of the node
  Eigen::Matrix3Xd direction; ///< 3 × n: of length 1

  int components = 1; ///< values a node
  /// What supports prescribe, of each body at all its nodes (nodes × components), in space; 0 elsewhere.
  std::vector<Eigen::VectorXd> prescribed;

  /// Values of each body at all its nodes, in space, from the unknowns u.
  [[nodiscard]] std::vector<Eigen::VectorXd> valuesOf(const Eigen::VectorXd& u) const;
  /// The unknowns from such values.
  [[nodiscard]] Eigen::VectorXd unknownsOf(const std::vector<Eigen::VectorXd>& values) const;
};

/// \throws InputError if the scene cannot be assembled. On one rank, the caller's alone.
UndecomposedSystem undecomposedSystem(const scene::Scene& scene);

} // namespace epafi::drivers
