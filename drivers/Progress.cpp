#include "Progress.hpp"

#include <Teuchos_Time.hpp>

#include <iomanip>

namespace epafi::drivers {

Progress::Progress(std::ostream& out, double interval)
    : out_(out), interval_(interval), last_(Teuchos::Time::wallTime()) {}

void Progress::step(const qp::StepRecord& record) {
  const double now = Teuchos::Time::wallTime();
  if (now - last_ < interval_)
    return;
  last_ = now;
  out_ << "  step " << record.iteration << " (" << static_cast<char>(record.kind) << "): projected gradient "
       << std::scientific << std::setprecision(2) << record.projectedGradient << ", " << record.activeBounds
       << " at bounds, " << record.hessianMultiplications << " products\n"
       << std::flush;
}

} // namespace epafi::drivers
