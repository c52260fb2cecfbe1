#include "QpTraffic.hpp"

#include "epafi/base/Collective.hpp"
#include "epafi/qp/constraints/Box.hpp"
#include "epafi/qp/operators/LocalData.hpp"
#include "epafi/qp/solve/Mprgp.hpp"

#include <Teuchos_Comm.hpp>
#include <Teuchos_Time.hpp>
#include <Tpetra_Map.hpp>
#include <Tpetra_Vector.hpp>

#include <algorithm>
#include <limits>
#include <utility>
#include <vector>

namespace epafi::drivers {
namespace {

constexpr int steps = 100; ///< of which the shortest counts
/// Vectors that a CG step reads and writes, bounds among them.
constexpr double vectorsPerStep = 23 + 3;

/// diag(1, …, 1000) over and over, so that CG goes on; knows how long its products took.
class TimedDiagonal final : public Operator {
public:
  explicit TimedDiagonal(RCP<const Map> map) : map_(std::move(map)), diagonal_(map_) {
    const auto entries = qp::localDataNonConst(diagonal_);
    for (std::size_t i = 0; i < entries.size(); ++i)
      entries[i] = 1.0 + static_cast<double>(map_->getGlobalElement(static_cast<LocalOrdinal>(i)) % 1000);
  }
  [[nodiscard]] RCP<const Map> getDomainMap() const override { return map_; }
  [[nodiscard]] RCP<const Map> getRangeMap() const override { return map_; }
  void apply(const MultiVector& x, MultiVector& y, Teuchos::ETransp /*mode*/, double alpha,
             double beta) const override {
    const double begin = Teuchos::Time::wallTime();
    y.elementWiseMultiply(alpha, diagonal_, x, beta);
    seconds += Teuchos::Time::wallTime() - begin;
  }
  mutable double seconds = 0;

private:
  RCP<const Map> map_;
  Vector diagonal_;
};

/// The shortest conjugate gradient step, without its product: what another program on the machine disturbs
/// counts for nothing.
class StepClock final : public qp::Observer {
public:
  explicit StepClock(const TimedDiagonal& hessian) : hessian_(hessian) {}
  void step(const qp::StepRecord& record) override {
    const double now = Teuchos::Time::wallTime() - hessian_.seconds;
    if (record.kind == qp::StepKind::conjugateGradient)
      shortest = std::min(shortest, now - last_);
    last_ = now;
  }
  double shortest = std::numeric_limits<double>::infinity();

private:
  const TimedDiagonal& hessian_;
  double last_ = 0;
};

double secondsPerStep(const RCP<const Map>& map) {
  const RCP<Vector> lower = rcp(new Vector(map)), upper = rcp(new Vector(map)), b = rcp(new Vector(map));
  lower->putScalar(-std::numeric_limits<double>::infinity());
  upper->putScalar(std::numeric_limits<double>::infinity());
  b->putScalar(1.0);
  const RCP<const TimedDiagonal> hessian = rcp(new TimedDiagonal(map));
  qp::MprgpParameters parameters;
  parameters.maxMultiplications = steps;
  qp::Mprgp solver(hessian, rcp(new qp::Box(lower, upper)), parameters, 1000.0);
  solver.start(*b, Vector(map));
  qp::GradientRule never(0.0, 1.0);
  StepClock clock(*hessian);
  solver.run(never, &clock);
  return maxOverRanks(*map->getComm(), clock.shortest);
}

/// Bytes a second of a = b + s c on all ranks together, each with its share of the map; the best of many
/// runs.
double streamBandwidth(const RCP<const Map>& map) {
  Vector a(map), b(map), c(map);
  b.putScalar(1.0);
  c.putScalar(2.0);
  double best = std::numeric_limits<double>::infinity();
  for (int repetition = 0; repetition < steps; ++repetition) {
    map->getComm()->barrier();
    const double begin = Teuchos::Time::wallTime();
    const auto from = qp::localData(b), other = qp::localData(c);
    const auto to = qp::localDataNonConst(a);
    for (std::size_t i = 0; i < to.size(); ++i)
      to[i] = from[i] + 3.0 * other[i];
    best = std::min(best, maxOverRanks(*map->getComm(), Teuchos::Time::wallTime() - begin));
  }
  return 3 * sizeof(double) * static_cast<double>(map->getGlobalNumElements()) / best;
}

} // namespace

Table measureTraffic(bool quick, const RCP<const Comm>& comm) {
  Table table("size,bytes_per_step,step_seconds,stream_bytes_per_second,ratio");
  const std::vector<std::size_t> sizes =
      quick ? std::vector<std::size_t>{10000, 100000}
            : std::vector<std::size_t>{10000, 40000, 160000, 1000000, 4000000};
  for (const std::size_t size : sizes) {
    const RCP<const Map> map = rcp(new Map(size, 0, comm));
    const double bytes = vectorsPerStep * sizeof(double) * static_cast<double>(size);
    const double seconds = secondsPerStep(map), stream = streamBandwidth(map);
    table.rows.push_back({{"size", size},
                          {"bytes_per_step", bytes},
                          {"step_seconds", seconds},
                          {"stream_bytes_per_second", stream},
                          {"ratio", bytes / seconds / stream}});
  }
  return table;
}

} // namespace epafi::drivers
