#include "epafi/fetidp/DualPreconditioner.hpp"

#include "epafi/base/Collective.hpp"
#include "epafi/base/Columns.hpp"

#include <algorithm>
#include <utility>

namespace epafi::fetidp {
namespace {

/// K on the interface (Δ, C), n_b × n_b.
Eigen::MatrixXd interfaceBlock(const decomposition::Subdomain& subdomain,
                               const SubdomainInterface& interface) {
  const auto size = static_cast<Eigen::Index>(interface.size());
  Eigen::MatrixXd block = Eigen::MatrixXd::Zero(size, size);
  for (Eigen::Index column = 0; column < subdomain.stiffness.cols(); ++column) {
    const int j = interface.positionOf[static_cast<std::size_t>(column)];
    if (j < 0)
      continue;
    for (decomposition::SparseMatrix::InnerIterator entry(subdomain.stiffness, column); entry; ++entry)
      if (const int i = interface.positionOf[static_cast<std::size_t>(entry.row())]; i >= 0)
        block(i, j) = entry.value();
  }
  return block;
}

} // namespace

DualPreconditioner::DualPreconditioner(const decomposition::DecomposedProblem& problem,
                                       std::shared_ptr<GeneralizedInverse> inverse,
                                       const PreconditionerParameters& parameters)
    : map_(problem.multiplierMap), inverse_(std::move(inverse)), input_(problem), output_(problem),
      result_(map_) {
  collectively(*problem.comm, [&] {
    const auto groups = std::as_const(*inverse_).groups();
    for (std::size_t g = 0; g < groups.size(); ++g) {
      const CondensedSubdomain& condensed = groups[g].condensed();
      const auto& first = problem.subdomains[groups[g].members().front()];
      const Eigen::MatrixXd matrix = parameters.type == PreconditionerParameters::Type::lumped
                                         ? interfaceBlock(first, condensed.interface())
                                         : condensed.interfaceStiffness();
      const auto numMembers = static_cast<Eigen::Index>(groups[g].members().size());
      const auto storage = parameters.isSingle ? direct::SymmetricBlock::Storage::single
                                               : direct::fasterStorage(static_cast<int>(matrix.rows()),
                                                                       static_cast<int>(numMembers));
      blocks_.push_back({g, direct::SymmetricBlock(matrix, storage), {}, {}, {}});
      blocks_.back().input.resize(matrix.rows(), numMembers);
      blocks_.back().output.resizeLike(blocks_.back().input);
    }
  });
  scale(problem, parameters.scaling);
}

/// The weights (b_i/δ_i) / Σ_k b_k²/δ_k. Collective.
void DualPreconditioner::scale(const decomposition::DecomposedProblem& problem,
                               PreconditionerParameters::Scaling scaling) {
  const auto stiffnessAt = [&](const decomposition::Subdomain& subdomain, int unknown) {
    return scaling == PreconditionerParameters::Scaling::stiffness
               ? subdomain.stiffness.coeff(unknown, unknown)
               : 1.0;
  };
  const std::span<double> sums = output_.values();
  std::fill(sums.begin(), sums.end(), 0.0);
  for (const auto& subdomain : problem.subdomains)
    for (const auto& entry : subdomain.constraint)
      sums[static_cast<std::size_t>(entry.multiplier)] +=
          entry.coefficient * entry.coefficient / stiffnessAt(subdomain, entry.unknown);
  output_.sumToOwners(result_);
  const auto total = result_.getData();
  for (Teuchos_Ordinal row = 0; row < total.size(); ++row)
    if (total[row] == 0)
      untouched_.push_back(static_cast<int>(row));

  const std::span<const double> totals = input_.toSubdomains(result_);
  for (Block& block : blocks_)
    for (const std::size_t member : std::as_const(*inverse_).groups()[block.group].members())
      for (const auto& entry : problem.subdomains[member].constraint)
        block.weights.push_back(entry.coefficient / stiffnessAt(problem.subdomains[member], entry.unknown) /
                                totals[static_cast<std::size_t>(entry.multiplier)]);
}

/// This rank's part of Σ B_D S_b B_Dᵀ λ, both on the ghost map.
void DualPreconditioner::multiply(std::span<const double> lambda, std::span<double> result) const {
  std::fill(result.begin(), result.end(), 0.0);
  for (Block& block : blocks_) {
    const SubdomainGroup& group = std::as_const(*inverse_).groups()[block.group];
    block.input.setZero();
    const double* weight = block.weights.data();
    for (std::size_t member = 0; member < group.members().size(); ++member)
      for (const InterfaceEntry& entry : group.entries(member))
        block.input(entry.position, static_cast<Eigen::Index>(member)) +=
            *weight++ * lambda[static_cast<std::size_t>(entry.multiplier)];
    block.stiffness.apply(block.input, block.output);
    weight = block.weights.data();
    for (std::size_t member = 0; member < group.members().size(); ++member)
      for (const InterfaceEntry& entry : group.entries(member))
        result[static_cast<std::size_t>(entry.multiplier)] +=
            *weight++ * block.output(entry.position, static_cast<Eigen::Index>(member));
  }
}

void DualPreconditioner::apply(const MultiVector& x, MultiVector& y, Teuchos::ETransp /*mode*/, double alpha,
                               double beta) const {
  forEachColumn(x, y, [&](const Vector& in, Vector& out) {
    multiply(input_.toSubdomains(in), output_.values());
    output_.sumToOwners(result_);
    if (!untouched_.empty()) {
      const auto result = result_.getDataNonConst();
      const auto given = in.getData();
      for (const int row : untouched_)
        result[row] = given[row];
    }
    out.update(alpha, result_, beta);
  });
}

std::size_t DualPreconditioner::bytes() const {
  std::size_t bytes = 0;
  for (const Block& block : blocks_)
    bytes += block.stiffness.bytes();
  return bytes;
}

} // namespace epafi::fetidp
