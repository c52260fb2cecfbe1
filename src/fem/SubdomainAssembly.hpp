#pragma once

/// Stiffness, load and kernel of subdomains: a body's elements added up, supported values eliminated.

#include "epafi/decomposition/ProblemData.hpp"
#include "epafi/fem/BodyModel.hpp"
#include "epafi/fem/LocalNumbering.hpp"
#include "epafi/fem/RecentlyUsed.hpp"
#include "epafi/fem/StiffnessPattern.hpp"

#include <Eigen/Core>
#include <Eigen/SparseCore>

#include <memory>
#include <span>
#include <vector>

namespace epafi::fem {

/// What physics fills of decomposition::Subdomain and SubdomainData; see there for shapes. Eigen 3.4 copies a
/// sparse matrix where others move: fill it where it is to stay.
struct AssembledSubdomain {
  std::vector<GlobalOrdinal> nodes; ///< ascending
  std::vector<int> borderNodes;     ///< places in `nodes` of those that other elements touch too, ascending
  std::vector<int> unknownPosition; ///< n_s
  std::vector<int> unknownOf;       ///< unknown at each position, −1 where supported
  Eigen::SparseMatrix<double, Eigen::ColMajor, int> stiffness;
  decomposition::SubdomainData data;
  decomposition::HeldRows held; ///< but B_p
  Eigen::MatrixXd kernel;
};

/// Assembles the subdomains of one body. What depends on the connectivity and the supports alone is kept from
/// one subdomain to the next and used again where both prove equal; every value is added up anew, in the
/// order of the elements: subdomains that are equal in exact arithmetic are so to the last bit.
class SubdomainAssembler {
public:
  /// Keeps a reference.
  explicit SubdomainAssembler(const BodyModel& model);

  /// \param elements  of the subdomain, in any order, at least one; quickest if they ascend
  /// \param[out] subdomain  overwritten
  /// K is symmetric to the last digit. Not collective.
  void assemble(std::span<const GlobalOrdinal> elements, AssembledSubdomain& subdomain);

private:
  std::shared_ptr<const LocalNumbering> number(std::span<const GlobalOrdinal> elements,
                                               AssembledSubdomain& subdomain);
  void findBorder(const LocalNumbering& numbering, AssembledSubdomain& subdomain);
  void hold(AssembledSubdomain& subdomain);
  void addStiffness(const StiffnessPattern& pattern, AssembledSubdomain& subdomain);
  void addLoads(const LocalNumbering& numbering, AssembledSubdomain& subdomain);
  void eliminate(const LocalNumbering& numbering, const StiffnessPattern& pattern,
                 AssembledSubdomain& subdomain);
  const Eigen::MatrixXd& stiffnessOf(GlobalOrdinal kind);

  const BodyModel& model_;
  std::size_t components_;
  RecentlyUsed<LocalNumbering> numberings_;
  RecentlyUsed<StiffnessPattern> patterns_;

  // Of the subdomain at hand.
  std::vector<GlobalOrdinal> corners_, kinds_;
  std::vector<int> numElementsAt_;
  std::vector<PrescribedValue> prescribed_;
  Eigen::MatrixXd loads_;
  std::vector<Eigen::Triplet<double, int>> entries_;
  GlobalOrdinal kindAtHand_ = -1; ///< kind whose stiffness is at hand; −1 none
  Eigen::MatrixXd stiffness_;
};

/// One subdomain alone.
AssembledSubdomain assemble(const BodyModel& model, std::span<const GlobalOrdinal> elements);

} // namespace epafi::fem
