#include "epafi/accuracy/TractionModes.hpp"

#include "epafi/accuracy/ModeGroups.hpp"

#include <Eigen/LU>

#include <utility>

namespace epafi::accuracy {
namespace {

constexpr Eigen::Index most = ModeGroups::most;

class TractionModes {
public:
  TractionModes(const std::vector<std::unique_ptr<BoundCells>>& cells, const std::vector<BoundLoads>& loads,
                const RCP<const Comm>& comm)
      : cells_(cells), groups_(cells, loads, comm) {
    for (const auto& body : cells)
      bodies_.emplace_back(body->numOwn());
  }

  int relax(double difference, std::vector<Eigen::MatrixXd>& data) {
    Eigen::MatrixXd r = -integrate(data), x = Eigen::MatrixXd::Zero(r.rows(), r.cols()), z = precondition(r),
                    p = z, q;
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
    return steps;
  }

private:
  /// Energies of the modes; returns the derivative of the energy at the data, and makes the preconditioner.
  Eigen::MatrixXd integrate(const std::vector<Eigen::MatrixXd>& data) {
    Eigen::MatrixXd derivative = Eigen::MatrixXd::Zero(most, groups_.number());
    blocks_ = Eigen::MatrixXd::Zero(most * most, groups_.number());
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
        if (last == nullptr || &stress != last || its != moments) {
          moments = std::move(its);
          image.noalias() = moments.transpose() * stress.energy().topRows(stress.numTractions());
          energy = std::make_shared<const Eigen::MatrixXd>(image.leftCols(stress.numTractions()) * moments);
          last = own ? nullptr : &stress;
        } else {
          energy = bodies_[b][place - 1];
        }
        const Eigen::VectorXd slope = image * data[b].col(place);
        for (Eigen::Index g = 0; g < std::ssize(groups); ++g) {
          derivative.col(groups[g]) += slope.segment<most>(g * most);
          blocks_.col(groups[g]) += energy->block<most, most>(g * most, g * most).reshaped();
        }
      }
    }
    groups_.sum(derivative);
    groups_.sum(blocks_);
    for (Eigen::Index g = 0; g < blocks_.cols(); ++g) {
      Eigen::Matrix3d block = blocks_.col(g).reshaped(most, most);
      for (Eigen::Index m = 0; m < most; ++m)
        if (!groups_.has(g, m))
          block(m, m) = 1;
      blocks_.col(g) = Eigen::Matrix3d(block.inverse()).reshaped();
    }
    return derivative;
  }

  [[nodiscard]] static Eigen::VectorXd gathered(std::span<const std::size_t> groups,
                                                const Eigen::MatrixXd& x) {
    Eigen::VectorXd local(most * std::ssize(groups));
    for (Eigen::Index g = 0; g < std::ssize(groups); ++g)
      local.segment<most>(g * most) = x.col(groups[g]);
    return local;
  }

  [[nodiscard]] Eigen::MatrixXd product(const Eigen::MatrixXd& x) const {
    Eigen::MatrixXd y = Eigen::MatrixXd::Zero(most, x.cols());
    Eigen::VectorXd image;
    for (std::size_t b = 0; b < bodies_.size(); ++b)
      for (std::size_t place = 0; place < bodies_[b].size(); ++place) {
        const auto groups = groups_.of(b, place);
        image.noalias() = *bodies_[b][place] * gathered(groups, x);
        for (Eigen::Index g = 0; g < std::ssize(groups); ++g)
          y.col(groups[g]) += image.segment<most>(g * most);
      }
    groups_.sum(y);
    return y;
  }

  [[nodiscard]] Eigen::MatrixXd precondition(const Eigen::MatrixXd& r) const {
    Eigen::MatrixXd z(r.rows(), r.cols());
    for (Eigen::Index e = 0; e < r.cols(); ++e)
      z.col(e) = blocks_.col(e).reshaped(most, most) * r.col(e);
    return z;
  }

  void apply(const Eigen::MatrixXd& x, std::vector<Eigen::MatrixXd>& data) const {
    for (std::size_t b = 0; b < bodies_.size(); ++b)
      for (std::size_t place = 0; place < bodies_[b].size(); ++place) {
        const Eigen::MatrixXd moments = groups_.moments(b, place);
        data[b].col(place).head(moments.rows()) += moments * gathered(groups_.of(b, place), x);
      }
  }

  const std::vector<std::unique_ptr<BoundCells>>& cells_;
  ModeGroups groups_;
  /// Of the modes of each own cell of each body, group by group.
  std::vector<std::vector<std::shared_ptr<const Eigen::MatrixXd>>> bodies_;
  Eigen::MatrixXd blocks_; ///< inverses of those of a group alone
};

} // namespace

int relaxTractions(const std::vector<std::unique_ptr<BoundCells>>& cells,
                   const std::vector<BoundLoads>& loads, const RCP<const Comm>& comm, double difference,
                   std::vector<Eigen::MatrixXd>& data) {
  return TractionModes(cells, loads, comm).relax(difference, data);
}

} // namespace epafi::accuracy
