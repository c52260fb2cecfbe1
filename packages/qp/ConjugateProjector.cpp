#include "epafi/qp/ConjugateProjector.hpp"

#include "epafi/base/AccurateSum.hpp"
#include "epafi/base/Columns.hpp"
#include "epafi/base/Errors.hpp"

#include <Teuchos_LAPACK.hpp>
#include <Tpetra_Map.hpp>

#include <utility>

namespace epafi::qp {
namespace {

class ProjectedHessian final : public Operator {
public:
  explicit ProjectedHessian(const ConjugateProjector& projector)
      : projector_(projector), product_(getRangeMap()) {}
  [[nodiscard]] RCP<const Map> getDomainMap() const override { return projector_.hessian()->getDomainMap(); }
  [[nodiscard]] RCP<const Map> getRangeMap() const override { return projector_.hessian()->getRangeMap(); }
  [[nodiscard]] bool hasTransposeApply() const override { return true; }
  void apply(const MultiVector& x, MultiVector& y, Teuchos::ETransp /*mode*/, double alpha,
             double beta) const override {
    forEachColumn(x, y, [&](const Vector& in, Vector& out) {
      projector_.apply(in, product_);
      out.update(alpha, product_, beta);
    });
  }

private:
  const ConjugateProjector& projector_;
  mutable Vector product_;
};

/// Columnᵀx for every column, in one message.
std::vector<double> products(const MultiVector& columns, const Vector& x) {
  const auto values = x.getData();
  std::vector<AccurateSum> sums(columns.getNumVectors());
  for (std::size_t k = 0; k < sums.size(); ++k) {
    const auto column = columns.getData(k);
    for (Teuchos_Ordinal i = 0; i < values.size(); ++i)
      sums[k].add(column[i] * values[i]);
  }
  sumOverRanks(*x.getMap()->getComm(), sums);
  std::vector<double> result;
  result.reserve(sums.size());
  for (const AccurateSum& sum : sums)
    result.push_back(sum.value());
  return result;
}

} // namespace

ConjugateProjector::ConjugateProjector(RCP<const Operator> a, RCP<const MultiVector> u)
    : a_(std::move(a)), u_(std::move(u)), au_(u_->getMap(), u_->getNumVectors()) {
  if (!u_->getMap()->isSameAs(*a_->getDomainMap()))
    throw InputError("the coarse space is not on the map of the unknowns");
  a_->apply(*u_, au_);
  const std::size_t k = u_->getNumVectors();
  for (std::size_t j = 0; j < k; ++j) {
    const std::vector<double> column = products(*u_, *au_.getVector(j));
    cholesky_.insert(cholesky_.end(), column.begin(), column.end());
  }
  int info = 0;
  const int n = static_cast<int>(k);
  Teuchos::LAPACK<int, double>().POTRF('L', n, cholesky_.data(), n, &info);
  if (info != 0)
    throw InputError(
        "the coarse space is not independent: UᵀAU is not positive definite; leave out columns that others "
        "combine, or that A maps to zero");
}

/// (UᵀAU)⁻¹ columnsᵀx.
std::vector<double> ConjugateProjector::coefficients(const MultiVector& columns, const Vector& x) const {
  std::vector<double> solution = products(columns, x);
  int info = 0;
  const int n = static_cast<int>(solution.size());
  Teuchos::LAPACK<int, double>().POTRS('L', n, 1, cholesky_.data(), n, solution.data(), n, &info);
  return solution;
}

void ConjugateProjector::subtract(const MultiVector& columns, const std::vector<double>& coefficients,
                                  double factor, Vector& x) {
  for (std::size_t k = 0; k < coefficients.size(); ++k)
    x.update(-factor * coefficients[k], *columns.getVector(k), 1.0);
}

RCP<const Operator> ConjugateProjector::projectedOperator() const {
  return rcp(new ProjectedHessian(*this));
}

void ConjugateProjector::apply(const Vector& x, Vector& y) const {
  a_->apply(x, y); // APx = Ax − AU(UᵀAU)⁻¹(AU)ᵀx
  subtract(au_, coefficients(au_, x), 1.0, y);
}

void ConjugateProjector::project(Vector& x) const {
  subtract(*u_, coefficients(au_, x), 1.0, x);
}

void ConjugateProjector::projectLinearTerm(const Vector& b, Vector& projected) const {
  projected.assign(b);
  subtract(au_, coefficients(*u_, b), 1.0, projected);
}

void ConjugateProjector::complete(const Vector& b, Vector& x) const {
  project(x);
  subtract(*u_, coefficients(*u_, b), -1.0, x);
}

} // namespace epafi::qp
