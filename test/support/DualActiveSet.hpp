#pragma once

/// The iteration of Goldfarb and Idnani with its state, in extended precision: from the unconstrained
/// minimiser on, constraints that are violated become active one after the other, and multipliers keep their
/// signs.

#include "DenseProgram.hpp"

#include <vector>

namespace epafi::test {

class DualActiveSet {
public:
  /// \param hessian, linear  A, positive definite, and b, in place of those of `program`; kept, not copied
  DualActiveSet(const DenseProgram& program, const RealMatrix& hessian, const RealVector& linear);

  /// Returns false if the constraints contradict each other.
  bool run();

  [[nodiscard]] const RealVector& solution() const { return x_; }
  /// μ of Bx = c: 0 for rows that are redundant.
  [[nodiscard]] RealVector multiplier() const;
  /// −1 for entries held at their lower bound, 1 at their upper one, 0 for free ones.
  [[nodiscard]] Eigen::VectorXi held() const;
  [[nodiscard]] std::vector<Eigen::Index> activeRows() const;
  /// After `run` said false: y with yᵀ(Bx − c) ≠ 0, of one sign, for all x in the box.
  [[nodiscard]] const Eigen::VectorXd& certificate() const { return certificate_; }
  [[nodiscard]] int iterations() const { return iterations_; }

private:
  enum class Kind { row, fixed, lower, upper };
  /// nᵀx ≥ s, or nᵀx = s for a row (of length 1) and a fixed entry.
  struct Constraint {
    Kind kind;
    Eigen::Index index;
    [[nodiscard]] bool isEquality() const { return kind == Kind::row || kind == Kind::fixed; }
  };

  bool enforce(Constraint constraint);
  void refine();
  /// Its slack; 0 if no bound is violated.
  Real mostViolated(Constraint& constraint) const;
  [[nodiscard]] Real slack(Constraint constraint) const;
  [[nodiscard]] RealVector transformedNormal(Constraint constraint) const;
  void add(Constraint constraint, Real multiplier, RealVector d);
  void drop(Eigen::Index position);
  [[nodiscard]] Real rightHandSide(Constraint constraint) const;
  [[nodiscard]] bool contradicts(Constraint constraint, const RealVector& r) const;
  void certify(Constraint constraint, const RealVector& r);

  const DenseProgram& program_;
  const RealMatrix& hessian_;
  const RealVector& linear_;
  RealVector lower_, upper_; ///< moved a little outwards
  RealMatrix rows_;          ///< of length 1; zero rows stay
  RealVector values_;
  RealVector rowScale_;
  RealMatrix j_, r_; ///< JᵀN = R for the active normals N, JJᵀ = A⁻¹
  RealVector x_;
  std::vector<Constraint> active_;
  std::vector<Real> multipliers_;
  std::vector<bool> isActive_; ///< bounds, by entry
  Eigen::VectorXd certificate_;
  int iterations_ = 0;
};

} // namespace epafi::test
