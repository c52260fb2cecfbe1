#include "epafi/fetidp/JointStiffness.hpp"

#include "epafi/base/Errors.hpp"

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>

#include <algorithm>
#include <map>

namespace epafi::fetidp {
namespace {

/// An entry of B_E: row of the joint, place in Δ, value, and the value over δ.
struct Entry {
  Eigen::Index row, place;
  double coefficient, weighted;
};

std::vector<Entry> entriesOf(const decomposition::Subdomain& subdomain, const SubdomainInterface& interface,
                             std::span<const int> rows, PreconditionerParameters::Scaling scaling) {
  std::map<int, Eigen::Index> placeOf;
  for (std::size_t i = 0; i < rows.size(); ++i)
    placeOf[rows[i]] = static_cast<Eigen::Index>(i);
  std::vector<Entry> entries;
  for (const auto& entry : subdomain.constraint)
    if (const auto found = placeOf.find(entry.multiplier); found != placeOf.end()) {
      const double delta = scaling == PreconditionerParameters::Scaling::stiffness
                               ? subdomain.stiffness->coeff(entry.unknown, entry.unknown)
                               : 1.0;
      entries.push_back({found->second, interface.positionOf[static_cast<std::size_t>(entry.unknown)],
                         entry.coefficient, entry.coefficient / delta});
    }
  return entries;
}

void append(std::vector<double>& message, const Eigen::MatrixXd& matrix) {
  message.insert(message.end(), matrix.data(), matrix.data() + matrix.size());
}

Eigen::MatrixXd take(std::span<const double>& message, Eigen::Index rows, Eigen::Index columns) {
  const Eigen::MatrixXd matrix = Eigen::Map<const Eigen::MatrixXd>(message.data(), rows, columns);
  message = message.subspan(static_cast<std::size_t>(matrix.size()));
  return matrix;
}

/// Far below what any threshold asks for, and above the round-off of S but where stiffness jumps by orders of magnitude.
constexpr double leastSpring = 1e-12;

/// What the subdomains' crosspoints, merged, add to the flexibility: H C⁻¹ Hᵀ with H = Σ B_E Ψ_Δ L_c, C = Σ L_cᵀ S L_c; motions
/// without stiffness meet a spring.
Eigen::MatrixXd crosspointFlexibility(const std::vector<JointPart>& parts) {
  std::map<GlobalOrdinal, Eigen::Index> placeOf;
  for (const JointPart& part : parts)
    for (const GlobalOrdinal crosspoint : part.crosspoints)
      placeOf.emplace(crosspoint, 0);
  Eigen::Index size = 0;
  for (auto& [crosspoint, place] : placeOf)
    place = size++;
  Eigen::MatrixXd stiffness = Eigen::MatrixXd::Zero(size, size);
  Eigen::MatrixXd response = Eigen::MatrixXd::Zero(parts.front().response.rows(), size);
  Eigen::VectorXd diagonal = Eigen::VectorXd::Zero(size);
  for (const JointPart& part : parts) {
    std::vector<Eigen::Index> places;
    for (const GlobalOrdinal crosspoint : part.crosspoints)
      places.push_back(placeOf[crosspoint]);
    for (std::size_t j = 0; j < places.size(); ++j) {
      const auto column = static_cast<Eigen::Index>(j);
      response.col(places[j]) += part.response.col(column);
      for (std::size_t i = 0; i < places.size(); ++i)
        stiffness(places[i], places[j]) += part.crosspointStiffness(static_cast<Eigen::Index>(i), column);
      diagonal[places[j]] += part.crosspointDiagonal[column];
    }
  }
  if (size == 0)
    return Eigen::MatrixXd::Zero(response.rows(), response.rows());
  const Eigen::VectorXd scale = diagonal.cwiseSqrt().cwiseInverse();
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> solver(scale.asDiagonal() * stiffness *
                                                              scale.asDiagonal());
  const double spring = std::max(leastSpring, -10 * solver.eigenvalues()[0]); // what is negative is round-off
  const Eigen::MatrixXd modes = response * scale.asDiagonal() * solver.eigenvectors();
  return modes * solver.eigenvalues().cwiseMax(spring).cwiseInverse().asDiagonal() * modes.transpose();
}

} // namespace

JointPart partOf(const decomposition::Subdomain& subdomain, const CondensedSubdomain& condensed,
                 const CondensedBoundary& boundary, std::span<const int> rows,
                 PreconditionerParameters::Scaling scaling) {
  const auto size = static_cast<Eigen::Index>(rows.size());
  JointPart part;
  part.subdomain = subdomain.number;
  part.crosspoints = subdomain.crosspointIndices;
  part.flexibility = part.weightedStiffness = Eigen::MatrixXd::Zero(size, size);
  part.response = Eigen::MatrixXd::Zero(size, condensed.numCrosspoints());
  part.crosspointStiffness = condensed.schurComplement();
  part.crosspointDiagonal = subdomain.stiffness->diagonal()(subdomain.crosspointUnknowns);
  part.weights = Eigen::VectorXd::Zero(size);
  const std::vector<Entry> entries = entriesOf(subdomain, condensed.interface(), rows, scaling);
  for (const Entry& b : entries) {
    part.response.row(b.row) += b.coefficient * condensed.boundaryResponse().row(b.place);
    part.weights[b.row] += b.coefficient * b.weighted;
    for (const Entry& a : entries) {
      part.flexibility(a.row, b.row) +=
          a.coefficient * b.coefficient * boundary.flexibility(a.place, b.place);
      part.weightedStiffness(a.row, b.row) += a.weighted * b.weighted * boundary.stiffness(a.place, b.place);
    }
  }
  return part;
}

void pack(const JointPart& part, std::vector<double>& message) {
  message.insert(message.end(),
                 {static_cast<double>(part.subdomain), static_cast<double>(part.response.rows()),
                  static_cast<double>(part.response.cols())});
  message.insert(message.end(), part.crosspoints.begin(), part.crosspoints.end());
  append(message, part.flexibility);
  append(message, part.response);
  append(message, part.crosspointStiffness);
  append(message, part.crosspointDiagonal);
  append(message, part.weightedStiffness);
  append(message, part.weights);
}

JointPart unpack(std::span<const double>& message) {
  JointPart part;
  part.subdomain = static_cast<int>(message[0]);
  const auto size = static_cast<Eigen::Index>(message[1]),
             numCrosspoints = static_cast<Eigen::Index>(message[2]);
  message = message.subspan(3);
  for (const double crosspoint : message.first(static_cast<std::size_t>(numCrosspoints)))
    part.crosspoints.push_back(static_cast<GlobalOrdinal>(crosspoint));
  message = message.subspan(part.crosspoints.size());
  part.flexibility = take(message, size, size);
  part.response = take(message, size, numCrosspoints);
  part.crosspointStiffness = take(message, numCrosspoints, numCrosspoints);
  part.crosspointDiagonal = take(message, numCrosspoints, 1);
  part.weightedStiffness = take(message, size, size);
  part.weights = take(message, size, 1);
  return part;
}

JointStiffness joined(const std::vector<JointPart>& parts) {
  JointStiffness joint{crosspointFlexibility(parts),
                       Eigen::MatrixXd::Zero(parts.front().weights.size(), parts.front().weights.size())};
  Eigen::VectorXd weights = Eigen::VectorXd::Zero(parts.front().weights.size());
  for (const JointPart& part : parts) {
    joint.flexibility += part.flexibility;
    joint.preconditioner += part.weightedStiffness;
    weights += part.weights;
  }
  const Eigen::VectorXd scale = weights.cwiseInverse();
  joint.preconditioner = (scale.asDiagonal() * joint.preconditioner * scale.asDiagonal()).eval();
  return joint;
}

OverratedJumps overratedJumps(const JointStiffness& joint, double threshold) {
  const Eigen::LLT<Eigen::MatrixXd> factor(joint.preconditioner); // M_E = LLᵀ
  if (factor.info() != Eigen::Success)
    throw Error(
        "the preconditioner of an interface is not positive definite: round-off has grown too large; avoid "
        "very flat elements and very large jumps of stiffness, or set Adaptive Constraints/Use to 'no'");
  const Eigen::MatrixXd lower = factor.matrixL();
  Eigen::MatrixXd product =
      lower.transpose() * joint.flexibility * lower; // LᵀF_E L x = ω x, y = F_E L x, M_E y = ω L x
  product = (0.5 * (product + product.transpose())).eval();
  const Eigen::Index size = product.rows();
  if ((threshold * Eigen::MatrixXd::Identity(size, size) - product).llt().info() == Eigen::Success)
    return {Eigen::VectorXd(0), Eigen::MatrixXd(size, 0), Eigen::MatrixXd(size, 0)}; // all ω are below it
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> solver(product);
  Eigen::Index number = 0;
  while (number < size && solver.eigenvalues()[size - 1 - number] > threshold)
    ++number;
  const Eigen::MatrixXd x = solver.eigenvectors().rightCols(number).rowwise().reverse();
  return {solver.eigenvalues().tail(number).reverse(), factor.matrixU().solve(x), lower * x};
}

} // namespace epafi::fetidp
