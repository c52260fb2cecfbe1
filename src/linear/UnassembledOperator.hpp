#pragma once

/// K = Σ R^sᵀ K^s R^s, never assembled: what a Trilinos application takes for its matrix where FETI-DP is to
/// solve with it.

#include "epafi/base/SymmetricOperator.hpp"
#include "epafi/linear/GlobalUnknowns.hpp"
#include "epafi/linear/UnknownExchange.hpp"

#include <memory>
#include <vector>

namespace epafi::linear {

/// n × n, symmetric, positive definite unless a body floats. Contact, if the problem has any, does not enter.
/// Where the map has numbers that no unknown has, those of prescribed values in most applications, K is the
/// identity. A product takes all columns in one pass: a sparse product a subdomain, two messages to each
/// neighbour.
class UnassembledOperator final : public SymmetricOperator {
public:
  /// \param problem      shared; K follows its matrices, everything else but loads and gaps must stay
  /// \param atPositions  see GlobalUnknowns.hpp
  /// \param map          one-to-one, with the numbers of all unknowns; null: ownedUnknowns
  /// \throws InputError, the same on all ranks, if lists are too short or too long, if the map lacks a
  /// number, or if copies of a number are not joined by the problem's gluing rows and crosspoints, or those
  /// of different numbers are. Collective.
  UnassembledOperator(const std::shared_ptr<const decomposition::DecomposedProblem>& problem,
                      const GlobalUnknowns& atPositions, const RCP<const Map>& map = Teuchos::null)
      : UnassembledOperator(problem, atUnknowns(*problem, atPositions), map, Checked{}) {}

  [[nodiscard]] const decomposition::DecomposedProblem& problem() const { return *problem_; }
  [[nodiscard]] const std::shared_ptr<const decomposition::DecomposedProblem>& sharedProblem() const {
    return problem_;
  }
  [[nodiscard]] const UnknownExchange& exchange() const { return exchange_; }
  /// Of each subdomain's unknowns.
  [[nodiscard]] const GlobalUnknowns& unknowns() const { return unknowns_; }
  /// y ← x where K is the identity, on both of which the map is; other entries stay. Not collective.
  void copyIdentity(const MultiVector& x, MultiVector& y) const;
  /// Local indices, on the map, of the rows where K is the identity.
  [[nodiscard]] const std::vector<LocalOrdinal>& identityRows() const { return identityRows_; }
  /// b = Σ R^sᵀ (f^s − K_fp u_p); 0 where K is the identity. Collective.
  [[nodiscard]] RCP<Vector> load(const decomposition::ProblemData& data) const;

private:
  struct Checked {}; ///< of unknowns
  UnassembledOperator(const std::shared_ptr<const decomposition::DecomposedProblem>& problem,
                      GlobalUnknowns unknowns, const RCP<const Map>& map, Checked checked);
  void multiply(const MultiVector& x, MultiVector& y) const override;

  std::shared_ptr<const decomposition::DecomposedProblem> problem_;
  GlobalUnknowns unknowns_;
  UnknownExchange exchange_;
  std::vector<LocalOrdinal> identityRows_;
  mutable SubdomainVectors values_, forces_; ///< work
};

/// K assembled, for whoever needs its entries: on the same map, rows complete. Collective.
RCP<CrsMatrix> assembled(const UnassembledOperator& k);

} // namespace epafi::linear
