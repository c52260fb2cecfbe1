#include "epafi/qp/Bounds.hpp"

#include "epafi/base/Collective.hpp"
#include "epafi/base/Errors.hpp"

#include <sstream>
#include <utility>

namespace epafi::qp {

Bounds::Bounds(RCP<const Vector> lower, RCP<const Vector> upper)
    : lower_(std::move(lower)), upper_(std::move(upper)) {}

Bounds::Local::Local(const Bounds& bounds) {
  if (!bounds.lower_.is_null())
    lower_ = localData(*bounds.lower_).data();
  if (!bounds.upper_.is_null())
    upper_ = localData(*bounds.upper_).data();
}

void Bounds::project(Vector& x) const {
  const Local bounds = local();
  const std::span<double> values = localDataNonConst(x);
  for (std::size_t i = 0; i < values.size(); ++i)
    values[i] = bounds[i].project(values[i]);
}

void Bounds::check(const Comm& comm) const {
  collectively(comm, [&] {
    const RCP<const Vector>& any = lower_.is_null() ? upper_ : lower_;
    if (any.is_null())
      return;
    const Local bounds = local();
    for (std::size_t i = 0; i < any->getLocalLength(); ++i) {
      const Interval interval = bounds[i];
      if (interval.lower <= interval.upper)
        continue;
      std::ostringstream text;
      text << "the bounds of entry " << any->getMap()->getGlobalElement(static_cast<LocalOrdinal>(i))
           << " leave no value: lower " << interval.lower << ", upper " << interval.upper;
      throw InputError(text.str());
    }
  });
}

} // namespace epafi::qp
