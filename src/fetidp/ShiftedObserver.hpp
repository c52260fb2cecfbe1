#pragma once

/// Shows λ where the iteration has μ = λ − λ̃.

#include "epafi/base/Types.hpp"
#include "epafi/qp/SolveReport.hpp"

#include <Tpetra_Vector.hpp>

namespace epafi::fetidp {

class ShiftedObserver final : public qp::Observer {
public:
  /// \param shift  λ̃
  ShiftedObserver(qp::Observer& next, const Vector& shift)
      : next_(next), shift_(shift), sum_(shift.getMap()) {}
  void step(const qp::StepRecord& record) override { next_.step(record); }
  [[nodiscard]] bool wantsToStop() override { return next_.wantsToStop(); }
  [[nodiscard]] bool wantsToLook() override { return next_.wantsToLook(); }
  void look(const Vector& mu) override {
    sum_.update(1.0, mu, 1.0, shift_, 0.0);
    next_.look(sum_);
  }

private:
  qp::Observer& next_;
  const Vector& shift_;
  Vector sum_;
};

} // namespace epafi::fetidp
