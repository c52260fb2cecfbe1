#include "epafi/fetidp/equilibrium/GramInverse.hpp"

#include "epafi/base/Collective.hpp"
#include "epafi/base/Errors.hpp"
#include "epafi/base/PointToPoint.hpp"
#include "epafi/fetidp/equilibrium/KernelGram.hpp"

#include <Eigen/SparseCore>
#include <Teuchos_Comm.hpp>

#include <algorithm>
#include <cmath>
#include <exception>
#include <map>
#include <utility>

namespace epafi::fetidp {
namespace {

constexpr double gatheringBytes = 1.5e5; ///< that are read while a small gathering passes: 15 µs at 10 GB/s

using Triplets = std::vector<Eigen::Triplet<double>>;

Triplets entriesOf(const Eigen::SparseMatrix<double>& matrix) {
  Triplets entries;
  for (int column = 0; column < matrix.outerSize(); ++column)
    for (Eigen::SparseMatrix<double>::InnerIterator entry(matrix, column); entry; ++entry)
      entries.emplace_back(static_cast<int>(entry.row()), column, entry.value());
  return entries;
}

/// What the leader of a group makes for each of its ranks, one after the other; nothing more from the one on
/// that fails, which all are told of. Collective over `comm`.
template <class Value, class Make>
std::vector<Value> ofLeader(const Comm& comm, const RankGroups& groups, const Make& make) {
  const Comm& group = *groups.group();
  std::exception_ptr failure;
  const auto made = [&](int rank) -> std::vector<Value> {
    try {
      return failure ? std::vector<Value>() : make(rank);
    } catch (const std::exception&) {
      failure = std::current_exception();
      return {};
    }
  };
  std::vector<Value> mine;
  if (groups.leads()) {
    mine = made(0);
    for (int rank = 1; rank < group.getSize(); ++rank)
      exchange(group, std::map<int, std::vector<Value>>{{rank, made(rank)}}, {});
  } else {
    mine = std::move(exchange(group, std::map<int, std::vector<Value>>(), {0}).at(0));
  }
  collectively(comm, [&] {
    if (failure)
      std::rethrow_exception(failure);
  });
  return mine;
}

/// How many of P ranks have N and its factor while rows are made: √P, or one of sixteen if these are more, so
/// that none makes more than 16 ranks' rows.
int numLeaders(int ranks) {
  return std::max(static_cast<int>(std::ceil(std::sqrt(ranks))), ranks / 16);
}

} // namespace

GramInverse::GramInverse(const decomposition::DecomposedProblem& problem,
                         const std::vector<KernelEntry>& entries, Form form)
    : comm_(problem.comm), size_(problem.kernelDimension), shares_(comm_, size_) {
  if (form == Form::automatic && (comm_->getSize() == 1 || problem.clusters.size() <= problem.bodies.size()))
    form = Form::sparse;
  const int ranks = comm_->getSize();
  const RankGroups groups(comm_, form == Form::sparse ? ranks : numLeaders(ranks));
  gram_ = kernelGram(problem, entries, groups);
  collectively(*comm_, [&] {
    if (!groups.leads())
      return;
    factor_.emplace(gram_);
    if (factor_->info() != Eigen::Success)
      throw Error("the rows of G are linearly dependent: some rigid motion of the floating bodies meets no "
                  "contact");
  });
  if (form == Form::spread || (form == Form::automatic && rowsTakeLess()))
    spread(groups);
  else
    share(groups);
}

/// By the bytes that a product reads and its message. Collective.
bool GramInverse::rowsTakeLess() const {
  const double k = size_, ofRows = sizeof(double) * k * k / comm_->getSize() + gatheringBytes;
  return ofRows < 2 * maxOverRanks(*comm_, static_cast<double>(factorBytes())); // down and up
}

/// Leaves this rank its columns of N and N⁻¹. Collective.
void GramInverse::spread(const RankGroups& groups) {
  Eigen::SparseMatrix<double> all;
  if (groups.leads())
    all = gram_.selfadjointView<Eigen::Lower>();
  const int here = comm_->getRank();
  const auto columnsOf = [&](int rank) { // of the group
    return std::pair(shares_.first(here + rank), shares_.size(here + rank));
  };
  const Triplets mine = ofLeader<Eigen::Triplet<double>>(*comm_, groups, [&](int rank) {
    const auto [first, number] = columnsOf(rank);
    return entriesOf(all.middleCols(first, number));
  });
  const std::vector<double> rows = ofLeader<double>(*comm_, groups, [&](int rank) {
    const auto [first, number] = columnsOf(rank);
    std::vector<double> columns(std::ptrdiff_t{size_} * number);
    for (int j = 0; j < number; ++j)
      Eigen::Map<Eigen::VectorXd>(columns.data() + std::ptrdiff_t{j} * size_, size_) =
          factor_->solve(Eigen::VectorXd::Unit(size_, first + j));
    return columns;
  });
  gram_.resize(size_, shares_.size());
  gram_.setFromTriplets(mine.begin(), mine.end());
  rows_ = Eigen::Map<const Eigen::MatrixXd>(rows.data(), size_, shares_.size());
  factor_.reset();
}

/// Gives N and its factor to the ranks that have them not. Collective.
void GramInverse::share(const RankGroups& groups) {
  if (groups.number() == comm_->getSize())
    return;
  const Triplets entries =
      ofLeader<Eigen::Triplet<double>>(*comm_, groups, [this](int /*rank*/) { return entriesOf(gram_); });
  collectively(*comm_, [&] {
    if (factor_)
      return;
    gram_.setFromTriplets(entries.begin(), entries.end());
    factor_.emplace(gram_);
  });
}

void GramInverse::apply(std::span<const double> b, std::span<double> alpha) const {
  const Eigen::Map<const Eigen::VectorXd> given(b.data(), size_);
  if (isSpread()) {
    work_.noalias() = rows_.transpose() * given;
    shares_.gather(std::span(work_.data(), work_.size()), alpha);
    return;
  }
  work_.noalias() = factor_->permutationP() * given;
  factor_->matrixL().solveInPlace(work_);
  factor_->matrixU().solveInPlace(work_);
  Eigen::Map<Eigen::VectorXd>(alpha.data(), size_).noalias() = factor_->permutationPinv() * work_;
}

void GramInverse::multiply(std::span<const double> alpha, std::span<double> b) const {
  const Eigen::Map<const Eigen::VectorXd> given(alpha.data(), size_);
  if (isSpread()) {
    work_.noalias() = gram_.transpose() * given;
    shares_.gather(std::span(work_.data(), work_.size()), b);
  } else {
    Eigen::Map<Eigen::VectorXd>(b.data(), size_).noalias() = gram_.selfadjointView<Eigen::Lower>() * given;
  }
}

std::size_t GramInverse::bytes() const {
  return isSpread() ? rows_.size() * sizeof(double) : factorBytes();
}

/// 0 where another rank has it.
std::size_t GramInverse::factorBytes() const {
  return factor_ ? factor_->matrixL().nestedExpression().nonZeros() * (sizeof(double) + sizeof(int)) : 0;
}

} // namespace epafi::fetidp
