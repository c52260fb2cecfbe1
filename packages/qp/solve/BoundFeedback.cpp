#include "epafi/qp/solve/BoundFeedback.hpp"

#include "epafi/base/AccurateSum.hpp"
#include "epafi/base/Collective.hpp"
#include "epafi/qp/constraints/Face.hpp"
#include "epafi/qp/constraints/FaceEquality.hpp"
#include "epafi/qp/operators/LocalData.hpp"

#include <Tpetra_Map.hpp>
#include <Tpetra_Operator.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <utility>
#include <vector>

namespace epafi::qp {
namespace {

/// T′ on the face of a solution. Of a vector v = Sδ + Zy, S what follows, y is what makes
/// vᵀAv + yᵀKy least with Bv = 0.
class FaceResponse {
public:
  FaceResponse(const QuadraticProgram& program, const Vector& x, const Vector& gradient)
      : a_(*program.hessian), m_(program.preconditioner), face_(x.getMap()),
        equality_(Teuchos::rcp_dynamic_cast<const ReplicatedEquality>(program.equality, true), x.getMap()),
        moved_(x, Teuchos::Copy), image_(x.getMap()), r_(x.getMap()), z_(x.getMap()), p_(x.getMap()),
        work_(x.getMap()), bent_(x.getMap()) {
    const RCP<const ConvexSet> set = program.setAt(x);
    set->freeIndicator(x, face_.isFree);
    set->followBoundary(x, gradient, 0, nullptr, face_);
    face_.curve(gradient);
    equality_.setFace(face_);
  }

  /// Whether anything follows, on any rank. Collective.
  [[nodiscard]] bool follows() const {
    return holdsAnywhere(*moved_.getMap()->getComm(), !face_.followers.empty());
  }
  /// v ← T′v. \param share  by which rᵀMr falls, r the residual of the face
  void respond(double share) {
    constexpr int maxSteps = 30;
    begin();
    double first = 0, last = 0;
    for (int step = 0; step < maxSteps; ++step) {
      precondition();
      const double energy = accurateDot(r_, z_);
      first = step == 0 ? energy : first;
      if (!(energy > 0) || (step > 0 && energy <= share * first))
        break;
      setConjugate(z_, last > 0 ? -energy / last : 0.0, p_);
      last = energy;
      multiply(p_, work_);
      if (!advance(energy))
        break;
    }
  }
  /// v = what of x the face may move, with Bv = 0.
  void start(const Vector& x) {
    copy(x, moved_);
    equality_.project(moved_);
    multiply(moved_, image_);
  }
  [[nodiscard]] Vector& moved() { return moved_; } ///< v
  [[nodiscard]] Vector& image() { return image_; } ///< Av
  [[nodiscard]] int multiplications() const { return multiplications_; }

private:
  void multiply(const Vector& x, Vector& y) {
    a_.apply(x, y);
    ++multiplications_;
  }
  /// v = Sv + y, y the shortest with Bv = 0, Av, and r = −P_F (Av + Ky).
  void begin() {
    copy(moved_, p_);
    face_.addFollowers(moved_);
    addScaled(-1.0, p_, moved_); // Sv
    p_.putScalar(0.0);
    equality_.balance(moved_, p_);
    addScaled(1.0, p_, moved_);
    multiply(moved_, image_);
    copy(image_, r_);
    face_.addBending(p_, 1.0, r_);
    r_.scale(-1.0);
    equality_.project(r_);
  }
  /// z = P_F W M W r (Face::weigh).
  void precondition() {
    constexpr double overrated = 4; // A⁻¹ by M, as in FaceIteration
    if (m_.is_null()) {
      copy(r_, z_);
      return;
    }
    copy(r_, work_);
    if (stiffness_ > 0)
      face_.weigh(stiffness_, work_);
    m_->apply(work_, z_);
    if (const double energy = accurateDot(work_, z_); stiffness_ == 0 && energy > 0) {
      stiffness_ = overrated * accurateDot(work_, work_) / energy;
      face_.weigh(stiffness_, work_);
      m_->apply(work_, z_);
    }
    if (stiffness_ > 0)
      face_.weigh(stiffness_, z_);
    equality_.project(z_);
  }
  /// One step along p with Ap in work_. False if there is no curvature. \param energy  rᵀz
  bool advance(double energy) {
    copy(work_, bent_);
    face_.addBending(p_, 1.0, bent_);
    const double curvature = accurateDot(p_, bent_);
    if (!(curvature > 0))
      return false;
    const double length = energy / curvature;
    addScaled(length, p_, moved_);
    addScaled(length, work_, image_);
    equality_.project(bent_);
    addScaled(-length, bent_, r_);
    return true;
  }

  const Operator& a_;
  RCP<const Operator> m_;
  Face face_;
  FaceEquality equality_;
  Vector moved_, image_; ///< v, Av
  Vector r_, z_, p_, work_, bent_;
  double stiffness_ = 0; ///< see Face::weigh
  int multiplications_ = 0;
};

constexpr std::size_t mostVectors = 8;
using SmallMatrix = std::array<std::array<double, mostVectors>, mostVectors>;

/// ρ = lim ‖H^k‖^(1/k), k the powers of two.
double spectralRadius(SmallMatrix matrix) {
  constexpr int doublings = 30;
  double logarithm = 0;
  for (int k = 0; k < doublings; ++k) {
    double norm = 0;
    for (const auto& row : matrix)
      for (const double entry : row)
        norm = std::hypot(norm, entry);
    if (!(norm > 0))
      return norm; // 0, or NaN
    logarithm += std::ldexp(std::log(norm), -k);
    SmallMatrix square{};
    for (std::size_t i = 0; i < mostVectors; ++i)
      for (std::size_t j = 0; j < mostVectors; ++j)
        for (std::size_t l = 0; l < mostVectors; ++l)
          square[i][j] += matrix[i][l] / norm * (matrix[l][j] / norm);
    matrix = square;
  }
  return std::exp(logarithm);
}

/// ‖(I − H)⁻¹e₁‖, H the first rows and columns, by elimination; ∞ where there is no inverse.
double amplification(const SmallMatrix& matrix, std::size_t size) {
  SmallMatrix left{};
  std::array<double, mostVectors> right{1};
  for (std::size_t i = 0; i < size; ++i)
    for (std::size_t j = 0; j < size; ++j)
      left[i][j] = (i == j ? 1 : 0) - matrix[i][j];
  for (std::size_t k = 0; k < size; ++k) {
    std::size_t pivot = k;
    for (std::size_t i = k + 1; i < size; ++i)
      pivot = std::abs(left[i][k]) > std::abs(left[pivot][k]) ? i : pivot;
    std::swap(left[k], left[pivot]);
    std::swap(right[k], right[pivot]);
    for (std::size_t i = 0; i < size; ++i) {
      if (i == k)
        continue;
      const double share = left[i][k] / left[k][k];
      for (std::size_t j = k; j < size; ++j)
        left[i][j] -= share * left[k][j];
      right[i] -= share * right[k];
    }
  }
  double squared = 0;
  for (std::size_t k = 0; k < size; ++k)
    squared += std::pow(right[k] / left[k][k], 2);
  return std::isfinite(squared) ? std::sqrt(squared) : std::numeric_limits<double>::infinity();
}

/// From a direction.
/// \param share       see FaceResponse::respond
/// \param numVectors  at least  \param numSettled  estimates that hardly differ from those before, in the end
BoundFeedback arnoldi(FaceResponse& face, const Vector& direction, double share, std::size_t numVectors,
                      int numSettled, const std::function<bool()>& isToStop) {
  constexpr double hardly = 0.05, roundOff = 1e-20; // of 1 − q, of squares
  std::vector<Vector> basis, images;                // orthonormal in A
  SmallMatrix projected{};                          // T′
  BoundFeedback found{.factor = std::numeric_limits<double>::quiet_NaN()};
  int settled = 0;
  face.start(direction);
  for (std::size_t size = 0; size <= mostVectors; ++size) {
    const double whole = accurateDot(face.moved(), face.image());
    for (std::size_t k = 0; k < size; ++k) {
      const double part = projected[k][size - 1] = accurateDot(images[k], face.moved());
      addScaled(-part, basis[k], face.moved());
      addScaled(-part, images[k], face.image());
    }
    if (size > 0) {
      const double last = found.factor;
      found.factor = spectralRadius(projected);
      found.amplification = amplification(projected, size);
      settled = std::abs(found.factor - last) <= hardly * std::abs(1 - found.factor) ? settled + 1 : 0;
    }
    const double squared = accurateDot(face.moved(), face.image());
    if ((size >= numVectors && settled >= numSettled) || size == mostVectors ||
        !(squared > roundOff * whole) || !std::isfinite(squared))
      break;
    if (size > 0)
      projected[size][size - 1] = std::sqrt(squared);
    face.moved().scale(1 / std::sqrt(squared));
    face.image().scale(1 / std::sqrt(squared));
    if (isToStop()) {
      found.factor = std::numeric_limits<double>::quiet_NaN();
      break;
    }
    basis.emplace_back(face.moved(), Teuchos::Copy);
    images.emplace_back(face.image(), Teuchos::Copy);
    face.respond(share);
  }
  found.multiplications = face.multiplications();
  return found;
}

} // namespace

BoundFeedback boundFeedback(const QuadraticProgram& program, const Vector& x, const Vector& gradient,
                            const Vector& direction, const std::function<bool()>& isToStop) {
  constexpr double weak = 0.1, rough = 0.1, fine = 0.01;
  FaceResponse face(program, x, gradient);
  if (!face.follows())
    return {};
  const BoundFeedback found = arnoldi(face, direction, rough, 3, 0, isToStop);
  return found.factor >= weak ? arnoldi(face, direction, fine, 4, 2, isToStop) : found;
}

} // namespace epafi::qp
