#include "epafi/fetidp/equilibrium/SlippingMotions.hpp"

#include "epafi/base/Collective.hpp"
#include "epafi/direct/DenseOrthogonal.hpp"
#include "epafi/direct/DenseSymmetric.hpp"

#include <Eigen/Geometry>
#include <Tpetra_Map.hpp>

#include <array>
#include <cmath>
#include <optional>
#include <span>
#include <utility>
#include <vector>

namespace epafi::fetidp {
namespace {

using decomposition::Body;
using decomposition::DecomposedProblem;
using Eigen::MatrixXd;
using Eigen::VectorXd;

/// Bounds of δ are times this, and no normal is known better than that.
constexpr double safety = 1.5, roundOff = 1e-6;
/// A place that sees a motion by more than this times its noise is no noise.
constexpr double clearly = 3;

/// Whose normals count. Where one body's surface slides along itself, it does so against whatever faces it:
/// the other one's normals are then no matter. The mean is for motions that are such at some places by one
/// side, at others by the other: it is off by no more than half the angle between the two.
enum class Sides { first, second, mean };

/// A normal divided by its noise.
Eigen::Vector3d normalByNoise(const decomposition::ContactPlace& place, Sides sides) {
  const auto scaled = [](const Eigen::Vector3d& normal, double uncertainty) -> Eigen::Vector3d {
    return normal / (safety * uncertainty + roundOff);
  };
  if (sides != Sides::mean) {
    const auto& side = sides == Sides::first ? place.first : place.second;
    return scaled(side.normal, side.uncertainty);
  }
  const Eigen::Vector3d &a = place.first.normal, &b = place.second.normal;
  const double apart = std::atan2(a.cross(b).norm(), a.dot(b));
  return scaled((a + b).normalized(), 0.5 * (apart + place.first.uncertainty + place.second.uncertainty));
}

/// How the bodies' modes move the sides of a place against each other, and what it sees of that in units of
/// its noise.
class Sight {
public:
  /// Nothing if a body floats in modes that nobody knows.
  static std::optional<Sight> of(const DecomposedProblem& problem, const decomposition::ContactPlace& place,
                                 const VectorXd& units, Sides sides) {
    Sight sight;
    sight.normal_ = normalByNoise(place, sides);
    for (const auto& [side, sign] : {std::pair(&place.first, 1.0), std::pair(&place.second, -1.0)}) {
      if (side->body < 0)
        continue;
      const Body& body = problem.bodies[side->body];
      if (body.kernelDimension == 0)
        continue;
      if (!body.motions)
        return std::nullopt;
      const Eigen::Vector3d arm = side->place - body.motions->centre;
      Eigen::Matrix<double, 3, 6> displacement = decltype(displacement)::Zero(); // t + ω × arm
      displacement.leftCols<3>().setIdentity();
      displacement.rightCols<3>() << 0, arm[2], -arm[1], -arm[2], 0, arm[0], arm[1], -arm[0], 0;
      sight.parts_.emplace_back(
          body.kernelOffset,
          sign * displacement * body.motions->twists *
              units.segment(body.kernelOffset, body.kernelDimension).cwiseInverse().asDiagonal());
    }
    return sight;
  }

  /// v of some motions, 3 × as many.
  [[nodiscard]] Eigen::Matrix3Xd moves(const MatrixXd& motions) const {
    Eigen::Matrix3Xd sum = Eigen::Matrix3Xd::Zero(3, motions.cols());
    for (const auto& [offset, part] : parts_)
      sum += part * motions.middleRows(offset, part.cols());
    return sum;
  }
  [[nodiscard]] const Eigen::Vector3d& normal() const { return normal_; } ///< n/δ

  /// Adds (nᵀv/δ)² and |v|².
  void addTo(MatrixXd& seen, MatrixXd& moved) const {
    for (const auto& [i, a] : parts_)
      for (const auto& [j, b] : parts_) {
        seen.block(i, j, a.cols(), b.cols()) += (a.transpose() * normal_) * (normal_.transpose() * b);
        moved.block(i, j, a.cols(), b.cols()) += a.transpose() * b;
      }
  }

private:
  Eigen::Vector3d normal_;
  std::vector<std::pair<int, Eigen::Matrix3Xd>> parts_; ///< of each body that floats, from its first mode on
};

/// All places and rows of this rank that count.
class Slippage {
public:
  Slippage(const DecomposedProblem& problem, const std::map<int, VectorXd>& rows, const VectorXd& units,
           const std::function<bool(int)>& counts, Sides sides)
      : comm_(*problem.comm) {
    std::map<int, VectorXd> others = rows;
    for (const decomposition::ContactPlace& place : problem.places) {
      const int row = problem.multiplierMap->getLocalElement(place.row);
      if (rows.count(row) == 0 || !counts(row))
        continue;
      if (std::optional<Sight> sight = Sight::of(problem, place, units, sides)) {
        sights_.push_back(std::move(*sight));
        others.erase(row);
      }
    }
    for (const auto& [row, vector] : others)
      if (counts(row) && vector.norm() > 0)
        others_.emplace_back(vector.normalized());
  }

  [[nodiscard]] bool knowsAnything() const { return holdsAnywhere(comm_, !sights_.empty()); }

  /// Motions that noise alone hinders in the mean, ∑|v|² = 1 of each. Collective.
  [[nodiscard]] MatrixXd slippingInTheMean(Eigen::Index k) const {
    MatrixXd both = MatrixXd::Zero(k, 2 * k);
    MatrixXd seen = MatrixXd::Zero(k, k), moved = seen;
    for (const Sight& sight : sights_)
      sight.addTo(seen, moved);
    for (const VectorXd& row : others_)
      seen += row * row.transpose() / (roundOff * roundOff);
    both << seen, moved;
    sumOverRanks(comm_, std::span(both.data(), both.size()));
    moved = both.rightCols(k);
    moved.diagonal().array() += 1e-10 * moved.trace(); // of bodies that have no place
    const MatrixXd factor = direct::choleskyFactor(moved).value();
    const auto lower = factor.triangularView<Eigen::Lower>();
    const MatrixXd half = lower.solve(both.leftCols(k));
    const direct::SymmetricEigen spectrum = direct::eigenOf(lower.solve(half.transpose()));
    return lower.transpose().solve(spectrum.vectors.leftCols(spectrum.numUpTo(1)));
  }

  /// What the place or row that sees some motions best sees of them, if it does so clearly. Collective.
  [[nodiscard]] std::optional<VectorXd> clearest(const MatrixXd& motions) const {
    VectorXd mine = VectorXd::Zero(motions.cols() + 1); // how clearly, and what
    const auto note = [&](double clarity, const VectorXd& what) {
      if (clarity > mine[0])
        mine << clarity, what;
    };
    for (const Sight& sight : sights_) {
      const Eigen::Matrix3Xd moves = sight.moves(motions);
      const VectorXd seen = moves.transpose() * sight.normal();
      note(seen.norm() / (clearly * moves.norm()), seen);
    }
    for (const VectorXd& row : others_) {
      const VectorXd seen = motions.transpose() * row;
      note(seen.norm() / (clearly * roundOff * motions.norm()), seen);
    }
    const std::vector<double> all = gatherOnAll(comm_, std::span(mine.data(), mine.size()));
    const Eigen::Map<const MatrixXd> found(all.data(), mine.size(), std::ssize(all) / mine.size());
    Eigen::Index best = 0;
    if (!(found.row(0).maxCoeff(&best) > 1))
      return std::nullopt;
    return found.col(best).tail(motions.cols());
  }

private:
  const Comm& comm_;
  std::vector<Sight> sights_;
  std::vector<VectorXd> others_;
};

/// Those in which one side's normals, or the mean ones, see nothing but noise. Collective.
MatrixXd slippingFor(const Slippage& slippage, Eigen::Index k) {
  MatrixXd motions = slippage.slippingInTheMean(k);
  while (motions.cols() > 0) {
    const std::optional<VectorXd> seen = slippage.clearest(motions);
    if (!seen)
      break;
    motions = (motions * direct::orthogonalComplement(*seen)).eval();
  }
  return motions.cols() == 0 ? motions : direct::orthonormalBasis(motions);
}

} // namespace

MatrixXd slippingMotions(const DecomposedProblem& problem, const std::map<int, VectorXd>& rows,
                         const VectorXd& units, const std::function<bool(int row)>& counts) {
  const Eigen::Index k = units.size();
  if (!holdsAnywhere(*problem.comm, !problem.places.empty()))
    return MatrixXd(k, 0);
  MatrixXd squares = MatrixXd::Zero(k, k);
  for (const Sides sides : {Sides::first, Sides::second, Sides::mean}) {
    if (sides == Sides::mean && squares.trace() > 0)
      break; // what one side knows is sharper
    if (const Slippage slippage(problem, rows, units, counts, sides); slippage.knowsAnything()) {
      const MatrixXd motions = slippingFor(slippage, k);
      squares += motions * motions.transpose();
    }
  }
  constexpr double same = 0.1; // motions that differ by less than noise are one
  const direct::SymmetricEigen spectrum = direct::eigenOf(squares);
  return spectrum.vectors.rightCols(k - spectrum.numUpTo(same));
}

} // namespace epafi::fetidp
