#include "epafi/fetidp/precondition/JointStiffness.hpp"

#include "epafi/base/EigenCompatibility.hpp"
#include "epafi/base/Errors.hpp"
#include "epafi/direct/DenseOrthogonal.hpp"
#include "epafi/direct/DenseSymmetric.hpp"

#include <algorithm>
#include <array>
#include <map>
#include <optional>

namespace epafi::fetidp {
namespace {

/// An entry of B_E: row of the joint, unknown and its place in Δ, value, and the value over δ.
struct Entry {
  Eigen::Index row, unknown, place;
  double coefficient, weighted;
};

std::vector<Entry> entriesOf(const decomposition::Subdomain& subdomain, const SubdomainInterface& interface,
                             std::span<const int> rows, PreconditionerParameters::Scaling scaling) {
  std::map<int, Eigen::Index> placeOf;
  for (std::size_t i = 0; i < rows.size(); ++i)
    placeOf[rows[i]] = i;
  std::vector<Entry> entries;
  for (const auto& entry : subdomain.constraint)
    if (const auto found = placeOf.find(entry.multiplier); found != placeOf.end()) {
      const double delta = scaling == PreconditionerParameters::Scaling::stiffness
                               ? subdomain.stiffness->coeff(entry.unknown, entry.unknown)
                               : 1.0;
      entries.push_back({found->second, entry.unknown, interface.positionOf[entry.unknown], entry.coefficient,
                         entry.coefficient / delta});
    }
  return entries;
}

template <class Values>
void put(std::vector<std::byte>& message, const Values& values) {
  const auto bytes = std::as_bytes(std::span(values.data(), values.size()));
  message.insert(message.end(), bytes.begin(), bytes.end());
}

/// As many values as there are in `values`.
template <class Values>
void take(std::span<const std::byte>& message, Values& values) {
  const auto bytes = std::as_writable_bytes(std::span(values.data(), values.size()));
  std::copy_n(message.begin(), bytes.size(), bytes.begin());
  message = message.subspan(bytes.size());
}

/// All of a part but its numbers.
template <class Part, class Action>
void forEachTable(Part& part, const Action& action) {
  action(part.crosspoints);
  action(part.flexibility);
  action(part.response);
  action(part.crosspointStiffness);
  action(part.crosspointDiagonal);
  action(part.weightedStiffness);
  action(part.weights);
  action(part.motions);
}

/// Far below what any threshold asks for, and above the round-off of S but where stiffness jumps by orders of
/// magnitude.
constexpr double leastSpring = 1e-12;

/// What the subdomains' crosspoints, merged, add to the flexibility: R Rᵀ = H C⁻¹ Hᵀ with H = Σ B_E Ψ_Δ L_c,
/// C = Σ L_cᵀ S L_c; motions without stiffness meet a spring.
Eigen::MatrixXd crosspointResponse(const std::vector<JointPart>& parts) {
  std::map<GlobalOrdinal, Eigen::Index> placeOf;
  for (const JointPart& part : parts)
    for (const decomposition::CoarseNumber crosspoint : part.crosspoints)
      placeOf.emplace(crosspoint, 0);
  Eigen::Index size = 0;
  for (auto& [crosspoint, place] : placeOf)
    place = size++;
  Eigen::MatrixXd stiffness = Eigen::MatrixXd::Zero(size, size);
  Eigen::MatrixXd response = Eigen::MatrixXd::Zero(parts.front().response.rows(), size);
  Eigen::VectorXd diagonal = Eigen::VectorXd::Zero(size);
  for (const JointPart& part : parts) {
    std::vector<Eigen::Index> places;
    for (const decomposition::CoarseNumber crosspoint : part.crosspoints)
      places.push_back(placeOf[crosspoint]);
    response(allOf, places) += part.response;
    stiffness(places, places) += part.crosspointStiffness;
    diagonal(places) += part.crosspointDiagonal;
  }
  if (size == 0)
    return response;
  const Eigen::VectorXd scale = diagonal.cwiseSqrt().cwiseInverse();
  const direct::SymmetricEigen eigen = direct::eigenOf(scale.asDiagonal() * stiffness * scale.asDiagonal());
  const double spring = std::max(leastSpring, -10 * eigen.values[0]); // what is negative is round-off
  return response * scale.asDiagonal() * eigen.vectors *
         eigen.values.cwiseMax(spring).cwiseSqrt().cwiseInverse().asDiagonal();
}

/// Orthonormal columns that span those of a matrix, whatever their lengths, but for round-off.
Eigen::MatrixXd spanOf(const Eigen::MatrixXd& columns) {
  return direct::pivotedColumns(columns.colwise().normalized(), 1e-8).basis;
}

} // namespace

JointPart::JointPart(int number, int ofCluster, Eigen::Index numRows, Eigen::Index numCrosspoints,
                     Eigen::Index numMotions)
    : subdomain(number), cluster(ofCluster), crosspoints(numCrosspoints),
      flexibility(Eigen::MatrixXd::Zero(numRows, numRows)),
      response(Eigen::MatrixXd::Zero(numRows, numCrosspoints)),
      crosspointStiffness(Eigen::MatrixXd::Zero(numCrosspoints, numCrosspoints)),
      crosspointDiagonal(Eigen::VectorXd::Zero(numCrosspoints)),
      weightedStiffness(Eigen::MatrixXd::Zero(numRows, numRows)), weights(Eigen::VectorXd::Zero(numRows)),
      motions(Eigen::MatrixXd::Zero(numRows, numMotions)) {}

JointPart partOf(const decomposition::Subdomain& subdomain, int cluster, const CondensedSubdomain& condensed,
                 const CondensedBoundary& boundary, std::span<const int> rows,
                 PreconditionerParameters::Scaling scaling) {
  JointPart part(subdomain.number, cluster, rows.size(), condensed.numCrosspoints(), subdomain.kernel.cols());
  part.crosspoints = subdomain.crosspointIndices;
  part.crosspointStiffness = condensed.schurComplement();
  part.crosspointDiagonal = subdomain.stiffness->diagonal()(subdomain.crosspointUnknowns);
  const std::vector<Entry> entries = entriesOf(subdomain, condensed.interface(), rows, scaling);
  for (const Entry& b : entries) {
    part.response.row(b.row) += b.coefficient * condensed.boundaryResponse().row(b.place);
    part.weights[b.row] += b.coefficient * b.weighted;
    part.motions.row(b.row) += b.coefficient * subdomain.kernel.row(b.unknown);
    for (const Entry& a : entries) {
      part.flexibility(a.row, b.row) +=
          a.coefficient * b.coefficient * boundary.flexibility(a.place, b.place);
      part.weightedStiffness(a.row, b.row) += a.weighted * b.weighted * boundary.stiffness(a.place, b.place);
    }
  }
  return part;
}

void pack(GlobalOrdinal firstRow, const JointPart& part, std::vector<std::byte>& message) {
  put(message, std::array<GlobalOrdinal, 6>{firstRow, part.subdomain, part.cluster, part.response.rows(),
                                            part.response.cols(), part.motions.cols()});
  forEachTable(part, [&](const auto& table) { put(message, table); });
}

std::pair<GlobalOrdinal, JointPart> unpack(std::span<const std::byte>& message) {
  std::array<GlobalOrdinal, 6> head{};
  take(message, head);
  JointPart part(static_cast<int>(head[1]), static_cast<int>(head[2]), head[3], head[4], head[5]);
  forEachTable(part, [&](auto& table) { take(message, table); });
  return {head[0], std::move(part)};
}

JointStiffness joined(const std::vector<JointPart>& parts) {
  const Eigen::Index size = parts.front().weights.size();
  JointStiffness joint{Eigen::MatrixXd::Zero(size, size), Eigen::MatrixXd::Zero(size, size),
                       crosspointResponse(parts)};
  Eigen::VectorXd weights = Eigen::VectorXd::Zero(size);
  for (const JointPart& part : parts) {
    joint.ofBoundaries += part.flexibility;
    joint.preconditioner += part.weightedStiffness;
    weights += part.weights;
  }
  const Eigen::VectorXd scale = weights.cwiseInverse();
  joint.preconditioner = (scale.asDiagonal() * joint.preconditioner * scale.asDiagonal()).eval();
  return joint;
}

Eigen::MatrixXd motionsOf(const std::vector<JointPart>& parts) {
  std::map<int, Eigen::MatrixXd> ofCluster;
  for (const JointPart& part : parts)
    if (const auto [motions, isNew] = ofCluster.try_emplace(part.cluster, part.motions); !isNew)
      motions->second += part.motions;
  Eigen::Index numMotions = 0;
  for (const auto& [cluster, motions] : ofCluster)
    numMotions += ofCluster.size() > 1 ? motions.cols() : 0;
  Eigen::MatrixXd all(parts.front().weights.size(), numMotions);
  Eigen::Index column = 0;
  for (const auto& [cluster, motions] : ofCluster)
    if (numMotions > 0) {
      all.middleCols(column, motions.cols()) = motions;
      column += motions.cols();
    }
  return all;
}

namespace {

/// L of M_E = LLᵀ; what jumps of the stiffness leave of its smallest eigenvalues may be round-off, and gets a
/// spring of that size.
Eigen::MatrixXd preconditionerFactor(const Eigen::MatrixXd& preconditioner) {
  for (const double spring : {0.0, 1e-13, 1e-11, 1e-9}) {
    Eigen::MatrixXd held = preconditioner;
    held.diagonal() *= 1 + spring;
    if (std::optional<Eigen::MatrixXd> lower = direct::choleskyFactor(held))
      return std::move(*lower);
  }
  throw Error(
      "the preconditioner of an interface is not positive definite: round-off has grown too large; avoid "
      "very flat elements and very large jumps of stiffness, or set Adaptive Constraints/Use to 'no'");
}

} // namespace

OverratedJumps overratedJumps(const JointStiffness& joint, double threshold, const Eigen::MatrixXd& motions) {
  const Eigen::MatrixXd lower = preconditionerFactor(joint.preconditioner);
  Eigen::MatrixXd basis = lower, held(lower.rows(), 0); // of u = L x, and of what it is orthogonal to
  if (motions.cols() > 0) {
    held = spanOf(motions);
    basis = lower * direct::orthogonalComplement(lower.transpose() *
                                                 held); // before springs come in, which are large there
  }
  Eigen::MatrixXd product =
      basis.transpose() * joint.ofBoundaries * basis; // LᵀF_E L x = ω x, y = F_E L x, M_E y = ω L x
  const Eigen::MatrixXd atCrosspoints = joint.response.transpose() * basis;
  product += atCrosspoints.transpose() * atCrosspoints;
  const Eigen::MatrixXd symmetric = 0.5 * (product + product.transpose());
  const Eigen::Index rows = basis.rows(), size = basis.cols();
  if (size == 0 || direct::choleskyFactor(threshold * Eigen::MatrixXd::Identity(size, size) - symmetric))
    return {Eigen::VectorXd(0), Eigen::MatrixXd(rows, 0), Eigen::MatrixXd(rows, 0)}; // all ω are below it
  const direct::SymmetricEigen eigen = direct::eigenOf(symmetric);
  const Eigen::Index number = size - eigen.numUpTo(threshold);
  Eigen::MatrixXd forces = basis * eigen.vectors.rightCols(number).rowwise().reverse();
  forces -= held * (held.transpose() * forces); // round-off of the basis
  const auto c = lower.triangularView<Eigen::Lower>();
  return {eigen.values.tail(number).reverse(), c.transpose().solve(c.solve(forces)), std::move(forces)};
}

} // namespace epafi::fetidp
