#pragma once

/// The waist of the house: everything that FETI-DP ever sees of a contact problem but its loads, prescribed
/// values and gaps (ProblemData.hpp). It comes from `decompose` (a scene) or from an application's matrices
/// (UnassembledProblem.hpp); nothing in it knows the physics.
///
/// An application that enters B itself may use any rows, those of gluing of full rank: answers are the same,
/// and MPRGP and SMALBE converge with any of them. The preconditioner, though, is made for rows that are
/// orthogonal in D⁻¹, D the diagonals of the K^s: copies of a node glued each to the mean of those before it,
/// Σ δ_i u_i / Σ δ_i, δ = diag K^s (GluingRows.hpp), and contact acting on the mean of all copies
/// (ContactRows.hpp); P, between clusters, for rows that are equally long in D⁻¹. Where rows share copies
/// otherwise, as in chains u_1 = u_2 = u_3, or where contact acts on one of several copies, it is still
/// symmetric positive definite, but eigenvalues of MF below 1 appear and products with F grow in number (from
/// 20 to 36 in space, two blocks of 2 × 2 × 2 subdomains).

#include "epafi/base/Types.hpp"
#include "epafi/decomposition/ContactPlace.hpp"
#include "epafi/decomposition/Indices.hpp"
#include "epafi/decomposition/RigidMotions.hpp"

#include <Eigen/Core>
#include <Eigen/SparseCore>
#include <Tpetra_Map.hpp>

#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace epafi::decomposition {

/// Sparse symmetric matrix of one subdomain, both triangles stored.
using SparseMatrix = Eigen::SparseMatrix<double, Eigen::ColMajor, int>;

/// What a row of B asks for: that bodies do not penetrate, that they slip only where friction gives way, that
/// they stay together, or that copies of a value agree.
enum class RowKind { contact, friction, tied, gluing };

/// One entry of B in a subdomain: row, column, value.
struct ConstraintEntry {
  TouchedMultiplier multiplier;
  Unknown unknown;
  double coefficient = 0;
};

/// An unknown that is the average a of several values, and the others, which are deviations ũ_i from it:
/// u_i = ũ_i + a, u_carrier = a − Σ ũ_i (see EdgeAverages.hpp).
struct Average {
  Unknown carrier; ///< a
  std::vector<int> others;
  bool operator==(const Average& other) const = default;
};

/// A value on a face where an edge of a cluster ends at another one, and the edge's average, which follows
/// the mean of these (EdgeEnds.hpp).
struct EdgeEnd {
  Unknown unknown;
  CoarseNumber average;
  double share = 1; ///< of this value in that mean
};

/// A node whose unknowns are the components of its displacement along axes of its own, not those of space.
struct NodeFrame {
  NodePlace node;
  Eigen::Matrix3d axes; ///< a rotation; its columns are the axes. In the plane it turns about z
};

/// What supports hold of a subdomain: they act on it with K_p u + B_pᵀλ − f_p, f_p in SubdomainData.
struct HeldRows {
  /// One entry of B_p.
  struct ConstraintEntry {
    MultiplierNumber row;
    int held = 0; ///< place in `positions`
    double coefficient = 0;
  };
  std::vector<int> positions; ///< n_p, ascending; along the nodes' axes
  std::vector<int> supports;  ///< of each which of its body's supports holds it; −1: none that has a name
  std::shared_ptr<const SparseMatrix> stiffness; ///< K_p, n_p × all positions
  std::vector<ConstraintEntry> constraint;       ///< B_p, of a node that subdomains share in the lowest one
};

/// One subdomain Ω^s. Its *unknowns* are the free values v of its nodes (components a node, supported ones
/// left out), numbered 0 … n_s − 1 in the order of its nodes; some may stand for averages and deviations.
struct Subdomain {
  int body = 0; ///< index into DecomposedProblem::bodies
  SubdomainNumber number;
  std::vector<GlobalOrdinal> nodes; ///< all its nodes, as numbered in the body, ascending
  std::vector<int>
      unknownPosition; ///< n_s: position (node of `nodes` × components + component) of an unknown
  std::vector<int> remainderUnknowns;            ///< v_r: unknowns that are not crosspoint values, ascending
  std::vector<int> crosspointUnknowns;           ///< v_c: unknowns that are crosspoint values, ascending
  std::vector<CoarseNumber> crosspointIndices;   ///< L_c: coarse unknown of each v_c
  std::vector<Average> averages;                 ///< where unknowns are no values of nodes; most often none
  std::vector<EdgeEnd> edgeEnds;                 ///< where there are clusters; most often none
  std::vector<ConstraintEntry> constraint;       ///< B^s
  HeldRows held;                                 ///< empty where nobody asks for what supports hold
  std::vector<int> candidates;                   ///< unknowns that B may come to touch, most often none
  std::shared_ptr<const SparseMatrix> stiffness; ///< K^s, n_s × n_s; equal subdomains may share one
  std::vector<NodeFrame> frames; ///< where positions are not components in space; most often none
  Eigen::MatrixXd kernel;        ///< R^s, n_s × kernelDimension of its cluster
};

/// Turns unknowns ũ of a subdomain into values of its nodes, in place.
void toNodalValues(const Subdomain& subdomain, Eigen::Ref<Eigen::VectorXd> u);

/// Turns values at all positions of a subdomain (nodes × components) into components in space, in place.
void toSpace(const Subdomain& subdomain, Eigen::Ref<Eigen::VectorXd> values);

/// Values at all positions in space of unknowns ũ. \param all what supported positions have, along the nodes'
/// axes
Eigen::VectorXd atAllPositions(const Subdomain& subdomain, Eigen::VectorXd u, Eigen::VectorXd all);

/// The other way round: unknowns ũ of values at all positions in space; supported values are left out.
Eigen::VectorXd unknownsOf(const Subdomain& subdomain, Eigen::VectorXd values);

/// f^s of forces at all positions in space, such that f^sᵀũ is their work; those at supported values are left
/// out.
Eigen::VectorXd loadOf(const Subdomain& subdomain, Eigen::VectorXd forces);

/// The others: forces along the nodes' axes at all positions, 0 at the unknowns.
Eigen::VectorXd heldPart(const Subdomain& subdomain, Eigen::VectorXd forces);

/// A body, of which only its rigid motions count.
struct Body {
  std::string name;
  int kernelDimension = 0;     ///< rigid modes that its supports leave free; > 0 means that the body floats
  int kernelOffset = 0;        ///< number of its first mode among those of all bodies
  GlobalOrdinal firstNode = 0; ///< number of its node 0 among those of all bodies
  /// What the modes are in space, for errors that say how a body can move; most often there where a body with
  /// several unknowns a node floats. No number comes from it.
  std::optional<RigidMotions> motions = std::nullopt;
  bool isOfRevolution = false; ///< about the y-axis, along which alone it moves rigidly
};

/// Subdomains of one body that share crosspoints (Clusters.hpp): all of them, if nothing else is asked for.
struct Cluster {
  int body = 0;            ///< index into DecomposedProblem::bodies
  int kernelDimension = 0; ///< rigid modes that its own supports leave free
  int kernelOffset = 0;    ///< column of its first mode in R
  /// Its part of the body's modes, R_body = R X there: kernelDimension × kernelDimension of the body.
  Eigen::MatrixXd ofBody;
};

/// A node with friction; the rows of its tangents follow each other.
struct FrictionNode {
  OwnedMultiplier contact;      ///< its row of contact
  OwnedMultiplier firstTangent; ///< the first row of friction
};

/// Whether nodes are displaced, as those of elastic bodies are, or carry one value alone, as those of
/// membranes. \param components  unknowns a node
constexpr bool isElastic(int components) {
  return components > 1;
}

/// This rank's subdomains and the three maps that join them. Copies are deleted (it is large); moves are
/// cheap.
struct DecomposedProblem {
  DecomposedProblem() = default;
  DecomposedProblem(const DecomposedProblem&) = delete;
  DecomposedProblem& operator=(const DecomposedProblem&) = delete;
  DecomposedProblem(DecomposedProblem&&) noexcept = default;
  DecomposedProblem& operator=(DecomposedProblem&&) noexcept = default;
  ~DecomposedProblem() = default;

  RCP<const Comm> comm;
  int components = 1;            ///< unknowns a node: 1 membrane, 2 or 3 elasticity
  std::vector<Body> bodies;      ///< all bodies, on every rank
  std::vector<Cluster> clusters; ///< all clusters, on every rank
  std::vector<int> clusterOf; ///< index into clusters, of each subdomain of the whole problem, on every rank
  std::vector<Subdomain> subdomains; ///< those of this rank; may be none

  RCP<const Map> remainderMap;  ///< all v_r, each owned by its subdomain's rank
  RCP<const Map> crosspointMap; ///< all v_c^g, each owned by one rank
  RCP<const Map>
      multiplierMap; ///< λ = (λ_I, λ_F, λ_E): n_I rows of non-penetration, n_F of friction, then ties, gluing
  RCP<const Map> multiplierGhostMap; ///< multipliers that touch this rank's subdomains

  // Numbers of the whole problem.
  int numSubdomains = 0;
  int kernelDimension = 0;           ///< columns of R: of all clusters
  GlobalOrdinal numInequalities = 0; ///< n_I
  GlobalOrdinal numFriction = 0;     ///< n_F
  GlobalOrdinal numTies = 0;         ///< the first n_T of the equalities: joints of bodies
  GlobalOrdinal numEqualities = 0;   ///< n_E
  GlobalOrdinal primalDimension = 0; ///< every copy of every node × components, supported ones too
  GlobalOrdinal numCrosspoints = 0;  ///< crosspoint nodes, supported ones too; averages are not among them
  /// Of rows of contact that this rank owns, as far as anyone knows; no number comes from them, but refusals.
  std::vector<ContactPlace> places;
  std::vector<FrictionNode> frictionNodes; ///< whose rows this rank owns, ascending
  /// C, on multiplierMap: by what rows of contact and friction give way under a force of 1, ≥ 0. Null: none
  /// does.
  RCP<const Vector> compliance;
  /// Of a row of B.
  [[nodiscard]] RowKind kindOf(MultiplierNumber row) const {
    return row < numInequalities        ? RowKind::contact
           : row < firstTie()           ? RowKind::friction
           : row < firstTie() + numTies ? RowKind::tied
                                        : RowKind::gluing;
  }
  /// The same where this rank owns it.
  [[nodiscard]] RowKind kindOf(OwnedMultiplier row) const { return kindOf(numberOf(row)); }
  /// The same where this rank's subdomains touch it.
  [[nodiscard]] RowKind kindOf(TouchedMultiplier row) const { return kindOf(numberOf(row)); }
  /// 1 or 2 for a row of friction along the first or second tangent of its node, else 0.
  [[nodiscard]] std::size_t tangentOf(TouchedMultiplier row) const {
    const GlobalOrdinal place = numberOf(row) - numInequalities;
    return kindOf(row) == RowKind::friction ? 1 + place % (components - 1) : 0;
  }
  [[nodiscard]] MultiplierNumber numberOf(OwnedMultiplier row) const { ///< in the whole problem
    return multiplierMap->getGlobalElement(row);
  }
  [[nodiscard]] MultiplierNumber numberOf(TouchedMultiplier row) const { ///< likewise
    return multiplierGhostMap->getGlobalElement(row);
  }
  [[nodiscard]] Eigen::Index numPositions(const Subdomain& subdomain) const { ///< nodes × components
    return subdomain.nodes.size() * components;
  }
  [[nodiscard]] const Cluster& clusterAt(const Subdomain& subdomain) const { ///< that it is in
    return clusters[clusterOf[subdomain.number]];
  }
  /// Columns of R that a subdomain's kernel stands in: number of the first.
  [[nodiscard]] int kernelOffsetOf(const Subdomain& subdomain) const {
    return clusterAt(subdomain).kernelOffset;
  }
  /// Modes of all bodies.
  [[nodiscard]] int numRigidModes() const {
    return bodies.empty() ? 0 : bodies.back().kernelOffset + bodies.back().kernelDimension;
  }
  /// Number of the first row of ties.
  [[nodiscard]] GlobalOrdinal firstTie() const { return numInequalities + numFriction; }
  /// n_λ
  [[nodiscard]] GlobalOrdinal dualDimension() const { return firstTie() + numEqualities; }
};

} // namespace epafi::decomposition
