#include "epafi/accuracy/TractionModes.hpp"

#include "epafi/accuracy/ModeGroups.hpp"
#include "epafi/base/AccurateSum.hpp"
#include "epafi/direct/DenseSymmetric.hpp"

#include <utility>

namespace epafi::accuracy {
namespace {

class TractionModes {
public:
  TractionModes(const std::vector<std::unique_ptr<BoundCells>>& cells, const std::vector<BoundLoads>& loads,
                const RCP<const Comm>& comm)
      : cells_(cells), groups_(cells, loads, comm), most_(groups_.most()) {
    for (const auto& body : cells) {
      bodies_.emplace_back(body->numOwn());
      slopes_.emplace_back(body->numOwn());
      squares_.emplace_back(body->numOwn());
    }
  }

  RelaxedEnergies relax(const std::vector<Eigen::MatrixXd>& displacements,
                        std::vector<Eigen::MatrixXd>& data) {
    double difference = 0; // ½‖τ − σ‖²
    Eigen::MatrixXd r = -integrate(displacements, data, difference),
                    x = Eigen::MatrixXd::Zero(r.rows(), r.cols()), z = precondition(r), p = z, q;
    double rz = groups_.dot(r, z);
    constexpr int maxSteps = 8;
    constexpr double enough = 0.05;
    int steps = 0;
    while (steps < maxSteps && rz > 0) {
      q = product(p);
      const double pq = groups_.dot(p, q);
      if (!(pq > 0))
        break;
      x += rz / pq * p;
      r -= rz / pq * q;
      ++steps;
      const double gain = 0.5 * rz * rz / pq;
      difference -= gain;
      if (gain <= enough * difference)
        break;
      z = precondition(r);
      const double next = groups_.dot(r, z);
      p = z + next / rz * p;
      rz = next;
    }
    apply(x, data);
    return {squares_, steps};
  }

private:
  /// Energies of the modes; returns the derivative of the energy at the data, and makes the preconditioner.
  Eigen::MatrixXd integrate(const std::vector<Eigen::MatrixXd>& displacements,
                            const std::vector<Eigen::MatrixXd>& data, double& difference) {
    AccurateSum sums[1];
    Eigen::MatrixXd ownStiffness;
    Eigen::MatrixXd derivative = Eigen::MatrixXd::Zero(most_, groups_.number());
    blocks_ = Eigen::MatrixXd::Zero(most_ * most_, groups_.number());
    constexpr double roundOff = 1e-12;
    std::optional<fem::CellStress> own;
    for (std::size_t b = 0; b < bodies_.size(); ++b) {
      const BoundCells& cells = *cells_[b];
      const fem::CellStress* last = nullptr; // of a congruent cell
      Eigen::MatrixXd moments, image;
      for (std::size_t place = 0; place < bodies_[b].size(); ++place) {
        auto& energy = bodies_[b][place];
        const auto groups = groups_.of(b, place);
        const fem::CellStress& stress = cells.stressAt(place, own);
        Eigen::MatrixXd its = groups_.moments(b, place);
        if (last == nullptr || &stress != last || !its.isApprox(moments, roundOff)) {
          moments = std::move(its);
          image.noalias() = moments.transpose() * stress.energy().topRows(stress.numTractions());
          energy = std::make_shared<const Eigen::MatrixXd>(image.leftCols(stress.numTractions()) * moments);
          last = own ? nullptr : &stress;
        } else {
          energy = bodies_[b][place - 1];
        }
        const Eigen::VectorXd slope = image * data[b].col(place);
        slopes_[b][place] = slope;
        const double square = data[b].col(place).dot(stress.energy() * data[b].col(place));
        squares_[b][static_cast<Eigen::Index>(place)] = square;
        sums[0].add(0.5 * stress.difference(square, data[b].col(place), displacements[b].col(place),
                                            cells.stiffnessAt(place, ownStiffness)));
        for (Eigen::Index g = 0; g < std::ssize(groups); ++g) {
          derivative.col(groups[g]) += slope.segment(g * most_, most_);
          blocks_.col(groups[g]) += energy->block(g * most_, g * most_, most_, most_).reshaped();
        }
      }
    }
    sumOverRanks(groups_.comm(), sums);
    difference = sums[0].value();
    groups_.sum(derivative);
    groups_.sum(blocks_);
    for (Eigen::Index g = 0; g < blocks_.cols(); ++g) {
      Eigen::MatrixXd block = blocks_.col(g).reshaped(most_, most_);
      for (Eigen::Index m = 0; m < most_; ++m)
        if (block(m, m) == 0) // not there
          block(m, m) = 1;
      blocks_.col(g) = direct::inverseOfSpd(std::move(block)).reshaped();
    }
    return derivative;
  }

  [[nodiscard]] Eigen::VectorXd gathered(std::span<const std::size_t> groups,
                                         const Eigen::MatrixXd& x) const {
    Eigen::VectorXd local(most_ * std::ssize(groups));
    for (Eigen::Index g = 0; g < std::ssize(groups); ++g)
      local.segment(g * most_, most_) = x.col(groups[g]);
    return local;
  }

  [[nodiscard]] Eigen::MatrixXd product(const Eigen::MatrixXd& x) const {
    Eigen::MatrixXd y = Eigen::MatrixXd::Zero(most_, x.cols());
    Eigen::VectorXd image;
    for (std::size_t b = 0; b < bodies_.size(); ++b)
      for (std::size_t place = 0; place < bodies_[b].size(); ++place) {
        const auto groups = groups_.of(b, place);
        image.noalias() = *bodies_[b][place] * gathered(groups, x);
        for (Eigen::Index g = 0; g < std::ssize(groups); ++g)
          y.col(groups[g]) += image.segment(g * most_, most_);
      }
    groups_.sum(y);
    return y;
  }

  [[nodiscard]] Eigen::MatrixXd precondition(const Eigen::MatrixXd& r) const {
    Eigen::MatrixXd z(r.rows(), r.cols());
    for (Eigen::Index e = 0; e < r.cols(); ++e)
      z.col(e) = blocks_.col(e).reshaped(most_, most_) * r.col(e);
    return z;
  }

  void apply(const Eigen::MatrixXd& x, std::vector<Eigen::MatrixXd>& data) {
    for (std::size_t b = 0; b < bodies_.size(); ++b)
      for (std::size_t place = 0; place < bodies_[b].size(); ++place) {
        const Eigen::MatrixXd moments = groups_.moments(b, place);
        const Eigen::VectorXd its = gathered(groups_.of(b, place), x);
        data[b].col(place).head(moments.rows()) += moments * its;
        squares_[b][static_cast<Eigen::Index>(place)] +=
            2 * slopes_[b][place].dot(its) + its.dot(*bodies_[b][place] * its);
      }
  }

  const std::vector<std::unique_ptr<BoundCells>>& cells_;
  ModeGroups groups_;
  Eigen::Index most_; ///< modes of a group
  /// Of the modes of each own cell of each body, group by group.
  std::vector<std::vector<std::shared_ptr<const Eigen::MatrixXd>>> bodies_;
  std::vector<std::vector<Eigen::VectorXd>> slopes_; ///< derivatives of ½‖τ‖² at the first data
  std::vector<Eigen::VectorXd> squares_;             ///< ‖τ‖² of each own cell of each body
  Eigen::MatrixXd blocks_;                           ///< inverses of those of a group alone
};

} // namespace

RelaxedEnergies relaxTractions(const std::vector<std::unique_ptr<BoundCells>>& cells,
                               const std::vector<BoundLoads>& loads, const RCP<const Comm>& comm,
                               const std::vector<Eigen::MatrixXd>& displacements,
                               std::vector<Eigen::MatrixXd>& data) {
  return TractionModes(cells, loads, comm).relax(displacements, data);
}

} // namespace epafi::accuracy
