#include "epafi/qp/constraints/FaceEquality.hpp"

#include <utility>

namespace epafi::qp {

FaceEquality::FaceEquality(RCP<const ReplicatedEquality> equality, const RCP<const Map>& map)
    : equality_(std::move(equality)), numRows_(equality_.is_null() ? 0 : equality_->size()),
      product_(static_cast<std::size_t>(numRows_)), multiplier_(product_.size()) {
  if (numRows_ > 0)
    inverse_ = equality_->faceInverse(map);
}

void FaceEquality::setFace(const Face& face) {
  face_ = &face;
  if (numRows_ > 0)
    inverse_->setFace(face);
}

void FaceEquality::project(Vector& x) {
  addTransposed(fit(x), -1.0, x);
}

std::span<const double> FaceEquality::fit(Vector& x) {
  addTransposed(multiplier_, 0.0, x); // 0 off the face
  if (numRows_ > 0)
    equality_->product(x, product_);
  multiplierOf(product_, multiplier_);
  return multiplier_;
}

void FaceEquality::balance(const Vector& p, Vector& y) {
  if (numRows_ == 0)
    return;
  equality_->product(p, product_);
  multiplierOf(product_, multiplier_);
  addTransposed(multiplier_, -1.0, y);
}

void FaceEquality::addLocalSums(const Vector& x, std::span<AccurateSum> sums) const {
  if (numRows_ > 0)
    equality_->addLocalProduct(x, sums);
}

void FaceEquality::finish(std::span<const AccurateSum> sums, std::span<double> bx) const {
  if (numRows_ > 0)
    ReplicatedEquality::finishProduct(sums, bx);
}

void FaceEquality::multiplierOf(std::span<const double> b, std::span<double> mu) const {
  if (numRows_ > 0)
    inverse_->apply(b, mu);
}

void FaceEquality::addTransposed(std::span<const double> mu, double factor, Vector& y) const {
  addWholeTransposed(mu, factor, y);
  face_->restrict(y, y);
}

void FaceEquality::addWholeTransposed(std::span<const double> mu, double factor, Vector& y) const {
  if (numRows_ > 0)
    equality_->addTransposedProduct(mu, factor, y);
}

void FaceEquality::residual(const Vector& x, std::span<double> r) const {
  if (numRows_ == 0)
    return;
  equality_->product(x, r);
  const auto c = equality_->rightHandSide();
  for (std::size_t i = 0; i < c.size(); ++i)
    r[i] -= c[i];
}

} // namespace epafi::qp
