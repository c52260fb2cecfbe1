#pragma once

/// A contact problem that an application hands over: subdomain matrices of its own, its own contact rows, and
/// afterwards its own loads, gaps and matrices anew.
///
///     UnassembledProblem problem(comm, 2, 2, {"ring", "shaft"});
///     problem.add(std::move(matrix));          // once a subdomain, each on one rank
///     problem.setContact({rows, gap});         // B_I u ≤ c
///     problem.complete();                      // crosspoints, gluing, floating bodies
///     ContactSolver solver(parameters);
///     solver.setup(problem.problem(), problem.data());
///     const Vector u = problem.unknowns(solver.solve(problem.data()));
///
/// Later problem.setLoad and setGap change its data alone; after setMatrix and setContact
/// solver.update(problem.data()) follows (ContactSolver.hpp says what each costs).

#include "epafi/decomposition/ContactRows.hpp"
#include "epafi/decomposition/Crosspoints.hpp"
#include "epafi/decomposition/FloatingBodies.hpp"
#include "epafi/decomposition/FrictionRows.hpp"
#include "epafi/decomposition/OwnSubdomain.hpp"
#include "epafi/decomposition/ProblemData.hpp"
#include "epafi/decomposition/SharedNodes.hpp"
#include "epafi/decomposition/SubdomainMatrix.hpp"
#include "epafi/decomposition/Substructures.hpp"

#include <Eigen/Core>

#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace epafi::decomposition {

/// Subdomains are numbered rank by rank in the order in which they were added. Results do not depend on how
/// subdomains go to ranks, as long as that order is the same. A rank may have none.
class UnassembledProblem {
public:
  /// \param dimension   of space, 2 or 3
  /// \param components  unknowns a node, 1 to 3
  /// \param bodies      names of the bodies, for messages; what is joined is one body, what is not is two
  /// \throws InputError for other numbers, or without bodies. Not collective.
  UnassembledProblem(RCP<const Comm> comm, int dimension, int components,
                     std::vector<std::string> bodies = {"body"});
  /// Of bodies whose kernels are known: all subdomains are in the order of their nodes.
  /// \param bodies  complete
  UnassembledProblem(RCP<const Comm> comm, int components, std::vector<Body> bodies, NodePlaces places);
  UnassembledProblem(const UnassembledProblem&) = delete;
  UnassembledProblem& operator=(const UnassembledProblem&) = delete;
  UnassembledProblem(UnassembledProblem&&) = delete;
  UnassembledProblem& operator=(UnassembledProblem&&) = delete;
  ~UnassembledProblem();

  /// Lets runs of so many subdomains of a body share crosspoints, no more (Clusters.hpp); 0, the default: all
  /// of it.
  /// \param sizes  of each body
  /// \throws InputError if one is negative, or if they are not as many as bodies. Precondition: not yet
  /// complete. Not collective; the same on all ranks.
  void setClusterSizes(std::vector<int> sizes);

  /// Takes one subdomain of this rank; what is wrong with it is said by `complete`. Not collective.
  /// Precondition: not yet complete.
  void add(SubdomainMatrix matrix);
  /// Takes one in the order of its nodes, which are numbered as in the body, with its kernel: what an
  /// assembly over a mesh has at hand. Not collective. Precondition: not yet complete, the bodies' kernels
  /// are known.
  /// \param subdomain  its body, nodes, unknowns, frames and kernel; the rest is found by `complete`
  /// \param data       of unknowns that are values of nodes
  void add(Subdomain subdomain, SubdomainData data, NodalSubdomain nodal);

  /// Names unknowns that rows of contact may come to touch. They count as part of their subdomains'
  /// interfaces from the start: where contact moves among them (setContact), every factor and dense block
  /// stays.
  /// \param unknowns  global numbers; naming each on one rank is enough
  /// What `complete` says of numbers that no subdomain has: InputError. Precondition: not yet complete. Not
  /// collective.
  void setCandidates(std::vector<GlobalOrdinal> unknowns);

  /// Takes B_I and c, both shared; without a call there is no contact. After `complete` the rows of B are
  /// made anew. Collective then. \throws InputError (see requireSound), the same on all ranks.
  void setContact(const ConstraintMatrix& contact);

  /// Takes rows of friction, shared; their bounds are data (ProblemData::setFrictionBounds), 0 at first.
  /// Collective after `complete`, and \throws InputError as above, for one component a node, and for rows
  /// that do not suit those of contact.
  void setFriction(const FrictionRows& friction);

  /// Takes C, shared: by what rows of contact and friction give way under a force of 1; a penalty that is
  /// none in K. Where rows are made anew it is gone. Collective. Precondition: complete.
  /// \param compliance  on problem().multiplierMap, 0 for other rows; or null, on all ranks
  /// \throws InputError, the same on all ranks, for another map, entries that are negative or not finite
  void setCompliance(const RCP<const Vector>& compliance);

  /// Takes B_T and c of tied joints, B_T u = c, both shared; rows as those of contact. Collective after
  /// `complete`, and
  /// \throws InputError likewise.
  void setTies(const ConstraintMatrix& ties);

  /// Finds shared nodes, motions that supports leave free, and crosspoints, and makes the rows of B.
  /// Collective.
  /// \throws InputError, the same on all ranks: what requireSound says of a subdomain or of contact, bodies
  /// that are not in one piece each, or subdomains that disagree about the unknowns of a node.
  void complete();

  /// What the solver takes; lives as long as this object. Precondition: complete.
  [[nodiscard]] const DecomposedProblem& problem() const { return problem_; }
  /// Loads, prescribed values and gaps as set last; a copy is a load case of its own. Precondition: complete.
  [[nodiscard]] const ProblemData& data() const { return data_; }
  /// The problem alone, for those who change no matrix any more; leaves none here. Precondition: complete.
  [[nodiscard]] DecomposedProblem take() { return std::move(problem_); }
  /// Unknowns of all subdomains, prescribed ones too, each on one rank. Precondition: complete.
  [[nodiscard]] const RCP<const Map>& unknownMap() const { return unknownMap_; }
  /// Subdomains of this rank.
  [[nodiscard]] std::size_t numSubdomains() const { return own_.size(); }
  /// Global unknown at every position (nodes × components) of a subdomain, as in
  /// ContactSolution::displacement; −1 where the application has none. Precondition: complete.
  [[nodiscard]] std::vector<GlobalOrdinal> globalUnknowns(std::size_t subdomain) const;

  // All of these: precondition: complete; not collective but for setContact. \throws InputError for wrong
  // sizes.

  /// f^s in the order of SubdomainMatrix::unknowns.
  void setLoad(std::size_t subdomain, const Eigen::VectorXd& load);
  /// K^s with the pattern it had, in the order of SubdomainMatrix::unknowns. Supports must leave the same
  /// motions free. The weights of gluing rows stay those of the old matrices until setContact.
  void setMatrix(std::size_t subdomain, const SparseMatrix& stiffness);
  /// c on the row map of the contact matrix.
  void setGap(const Vector& gap);

  /// u of a subdomain in the order of SubdomainMatrix::unknowns, of ContactSolution::displacement. Not
  /// collective.
  [[nodiscard]] Eigen::VectorXd unknowns(std::size_t subdomain,
                                         std::span<const Eigen::VectorXd> displacement) const;
  /// u on unknownMap(), of shared ones the mean of their copies, which differ by the feasibility reached.
  /// Collective.
  [[nodiscard]] RCP<Vector> unknowns(std::span<const Eigen::VectorXd> displacement) const;
  /// λ_I on the row map of the contact matrix: the forces of contact, ≥ 0, in the unit of the loads over that
  /// of B_I.
  /// \param multiplier  ContactSolution::multiplier
  /// Collective.
  [[nodiscard]] RCP<Vector> contactForces(const Vector& multiplier) const;

private:
  [[nodiscard]] Substructures view() const;
  int firstNumber();
  void takeAdded(int first);
  void mapUnknowns();
  [[nodiscard]] RCP<const Map> ownUnknowns() const;
  std::vector<Motions> findBodies();
  void formClusters(std::vector<Motions> near);
  void split();
  void nameCandidates();
  void requireSoundFriction() const;
  void placeFriction();
  void attach();
  RCP<const Vector> enter(const ConstraintMatrix& matrix, GlobalOrdinal firstRow,
                          std::vector<GlobalOrdinal>& owned, std::vector<std::vector<RowEntry>>& rows);
  void refreshData(std::size_t subdomain);
  void requireComplete() const;

  RCP<const Comm> comm_;
  NodePlaces places_;
  std::vector<int> clusterSizes_;         ///< of each body
  std::vector<SubdomainMatrix> added_;    ///< until complete
  std::vector<GlobalOrdinal> candidates_; ///< likewise, of this rank
  std::optional<ConstraintMatrix> contact_, ties_;
  std::optional<FrictionRows> friction_;
  std::vector<OwnSubdomain> own_; ///< of those that applications added
  std::vector<NodalSubdomain> nodal_;
  SharedNodes shared_;
  std::optional<Crosspoints> crosspoints_; ///< once complete
  DecomposedProblem problem_;
  ProblemData data_;
  RCP<const Map> unknownMap_;
  RCP<const Vector> copies_; ///< of each unknown, on unknownMap_
};

} // namespace epafi::decomposition
