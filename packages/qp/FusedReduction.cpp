#include "epafi/qp/FusedReduction.hpp"

#include <Teuchos_CommHelpers.hpp>

#include <algorithm>
#include <limits>
#include <utility>

namespace epafi::qp {
namespace {

/// Adds all entries but the last, of which it takes the smaller one. Ranks combine whole messages: they are a
/// few dozen bytes long, far below what an MPI library would cut into pieces.
class SumsAndMinimum final : public Teuchos::ValueTypeReductionOp<int, double> {
public:
  void reduce(const int count, const double in[], double inout[]) const override {
    for (int i = 0; i + 1 < count; ++i)
      inout[i] += in[i];
    inout[count - 1] = std::min(inout[count - 1], in[count - 1]);
  }
};

} // namespace

FusedReduction::FusedReduction(RCP<const Comm> comm, int numSums)
    : comm_(std::move(comm)), values_(static_cast<std::size_t>(numSums) + 1), mine_(values_.size()) {
  clear();
}

void FusedReduction::clear() {
  std::fill(values_.begin(), values_.end(), 0.0);
  values_.back() = std::numeric_limits<double>::infinity();
}

void FusedReduction::reduce() {
  if (comm_->getSize() == 1)
    return;
  mine_ = values_;
  const SumsAndMinimum operation;
  Teuchos::reduceAll<int, double>(*comm_, operation, static_cast<int>(values_.size()), mine_.data(),
                                  values_.data());
}

} // namespace epafi::qp
