#include "RandomPrograms.hpp"

#include "epafi/direct/DenseSymmetric.hpp"

#include "support/Problems.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>
#include <sstream>

namespace epafi::test {
namespace {

/// Draws; numbers on a coarse binary grid make sums and products exact, so that redundant rows are redundant
/// to the bit.
class Draw {
public:
  explicit Draw(unsigned seed) : random_(seed) {}
  int integer(int from, int to) { return std::uniform_int_distribution<int>(from, to)(random_); }
  double real(double from, double to) { return std::uniform_real_distribution<double>(from, to)(random_); }
  bool chance(double probability) { return real(0, 1) < probability; }
  double normal() { return std::normal_distribution<double>()(random_); }
  double gridNormal() { return std::round(1024 * normal()) / 1024; }
  double powerOfTwo(int from, int to) { return std::ldexp(1.0, integer(from, to)); }
  double sign() { return chance(0.5) ? 1 : -1; }

private:
  std::mt19937 random_;
};

int drawSize(Draw& draw) {
  const double share = draw.real(0, 1);
  return share < 0.25   ? draw.integer(1, 5)
         : share < 0.7  ? draw.integer(2, 25)
         : share < 0.85 ? draw.integer(25, 60)
                        : draw.integer(50, 200);
}

/// QΛQᵀ with Q a product of reflections.
Eigen::MatrixXd withEigenvalues(const Eigen::VectorXd& eigenvalues, Draw& draw) {
  const Eigen::Index n = eigenvalues.size();
  Eigen::MatrixXd a = eigenvalues.asDiagonal();
  for (int reflection = 0; reflection < 4; ++reflection) {
    const Eigen::VectorXd v = Eigen::VectorXd::NullaryExpr(n, [&] { return draw.normal(); }).normalized();
    a -= 2 * v * (v.transpose() * a).eval();
    a -= 2 * (a * v).eval() * v.transpose();
  }
  return 0.5 * (a + a.transpose());
}

void drawDefinite(int n, double condition, RandomProgram& result, Draw& draw) {
  Eigen::VectorXd eigenvalues(n);
  const bool isClustered = draw.chance(0.3);
  for (int i = 0; i < n; ++i) {
    const double exponent = isClustered ? static_cast<double>(i % 2)
                            : n > 1     ? static_cast<double>(i) / (n - 1)
                                        : 0.0;
    eigenvalues[i] = std::pow(condition, -exponent);
  }
  result.program.hessian = withEigenvalues(eigenvalues, draw);
  result.smallestEigenvalue = eigenvalues.minCoeff() * (1 - 1e-5);
}

/// GᵀG with a G of small whole numbers and fewer rows than columns: semidefinite without round-off.
void drawSemidefinite(Eigen::MatrixXd g, RandomProgram& result) {
  result.program.hessian = g.transpose() * g / 64;
  result.isSingular = true;
  const Eigen::VectorXd eigenvalues = direct::eigenOf(result.program.hessian).values;
  result.smallestEigenvalue = eigenvalues.maxCoeff();
  for (const double value : eigenvalues)
    if (value > 1e-9 * eigenvalues.maxCoeff())
      result.smallestEigenvalue = std::min(result.smallestEigenvalue, value);
}

Eigen::MatrixXd wholeNumbers(Eigen::Index rows, Eigen::Index columns, Draw& draw) {
  return Eigen::MatrixXd::NullaryExpr(rows, columns,
                                      [&] { return static_cast<double>(draw.integer(-2, 2)); });
}

/// How many of the bounds hold the solution.
enum class Activity { some, degenerate, everywhere, nowhere, fixed, unbounded, count };

constexpr const char* activityNames[] = {"some bounds active", "degenerate",    "all bounds active",
                                         "no bound active",    "fixed entries", "no bounds"};

/// Bounds around x; returns the multipliers that hold it there.
Eigen::VectorXd drawBounds(Activity activity, const Eigen::VectorXd& x, DenseProgram& program, Draw& draw) {
  const Eigen::Index n = x.size();
  program.lower = Eigen::VectorXd::Constant(n, -unbounded);
  program.upper = Eigen::VectorXd::Constant(n, unbounded);
  Eigen::VectorXd multiplier = Eigen::VectorXd::Zero(n);
  if (activity == Activity::unbounded)
    return multiplier;
  const double activeShare = activity == Activity::everywhere ? 1
                             : activity == Activity::nowhere  ? 0
                                                              : draw.real(0.1, 0.9);
  const double fixedShare = activity == Activity::fixed     ? draw.real(0.1, 1.2)
                            : activity == Activity::nowhere ? 0
                                                            : 0.05;
  for (Eigen::Index i = 0; i < n; ++i) {
    const double gap = std::ldexp(draw.integer(1, 16), -3), strength = draw.real(0.1, 2);
    const bool holds = activity != Activity::degenerate || draw.chance(0.4);
    if (draw.chance(fixedShare)) {
      program.lower[i] = program.upper[i] = x[i];
      multiplier[i] = holds ? draw.sign() * strength : 0;
      continue;
    }
    const bool hasLower = draw.chance(0.6), hasUpper = draw.chance(0.6);
    if (draw.chance(activeShare)) {
      const bool isLower = draw.chance(0.5);
      (isLower ? program.lower : program.upper)[i] = x[i];
      if (isLower && hasUpper)
        program.upper[i] = x[i] + gap;
      if (!isLower && hasLower)
        program.lower[i] = x[i] - gap;
      multiplier[i] = !holds ? 0 : isLower ? strength : -strength;
    } else {
      if (hasLower)
        program.lower[i] = x[i] - gap;
      if (hasUpper)
        program.upper[i] = x[i] + gap;
    }
  }
  return multiplier;
}

/// Rows that x satisfies without round-off; returns what they are called.
std::string drawRows(const Eigen::VectorXd& x, DenseProgram& program, Draw& draw) {
  const auto n = static_cast<int>(x.size());
  program.rows.resize(0, n);
  program.values.resize(0);
  if (draw.chance(0.5))
    return "no rows";
  const int independent = draw.integer(1, std::max(1, std::min(n / 2, 12)));
  const int redundant = draw.chance(0.4) ? draw.integer(1, 5) : 0;
  const bool isSparse = draw.chance(0.5), isBadlyScaled = draw.chance(0.4);
  program.rows.setZero(independent + redundant, n);
  for (int i = 0; i < independent; ++i)
    for (int j = 0; j < n; ++j)
      if (!isSparse || draw.chance(std::max(0.1, 3.0 / n)))
        program.rows(i, j) = draw.integer(-16, 16) / 16.0;
  for (int i = independent; i < independent + redundant; ++i)
    for (int repeat = draw.integer(0, 2); repeat > 0; --repeat) // 0, a copy, or the sum of two
      program.rows.row(i) +=
          draw.sign() * draw.powerOfTwo(-1, 1) * program.rows.row(draw.integer(0, independent - 1));
  if (isBadlyScaled)
    for (int i = 0; i < program.rows.rows(); ++i)
      program.rows.row(i) *= draw.powerOfTwo(-20, 20);
  program.values = program.rows * x;
  return std::string(redundant > 0 ? "redundant" : "independent") + (isBadlyScaled ? ", badly scaled" : "") +
         " rows";
}

/// x becomes t x, the objective s times as large.
void changeUnits(RandomProgram& result, double t, double s) {
  DenseProgram& p = result.program;
  p.hessian *= s / (t * t);
  p.linear *= s / t;
  p.lower *= t;
  p.upper *= t;
  p.values *= t;
  result.smallestEigenvalue *= s / (t * t);
}

} // namespace

RandomProgram randomSolvableProgram(unsigned seed) {
  Draw draw(seed);
  RandomProgram result;
  DenseProgram& program = result.program;
  std::ostringstream kind;
  const bool isSingular = draw.chance(0.2);
  const bool isNoise = !isSingular && draw.chance(0.15), isZero = !isNoise && draw.chance(0.1);
  const int n = isSingular ? std::min(drawSize(draw), 60) : drawSize(draw);
  const double condition = std::pow(10.0, draw.integer(0, isNoise ? 5 : 10));
  if (isSingular)
    drawSemidefinite(wholeNumbers(draw.integer(n > 3 ? n / 2 : 0, n - 1), n, draw), result);
  else
    drawDefinite(n, condition, result, draw);
  const Eigen::VectorXd x = Eigen::VectorXd::NullaryExpr(n, [&] { return draw.gridNormal(); });
  const auto activity = static_cast<Activity>(draw.integer(0, static_cast<int>(Activity::count) - 1));
  result.isDegenerate = activity == Activity::degenerate;
  const Eigen::VectorXd multiplier = drawBounds(activity, x, program, draw);
  const std::string rows = drawRows(x, program, draw);
  if (isZero)
    program.linear = Eigen::VectorXd::Zero(n);
  else if (isNoise)
    program.linear = Eigen::VectorXd::NullaryExpr(n, [&] { return draw.normal(); });
  else {
    program.linear = program.hessian * x - multiplier;
    for (Eigen::Index i = 0; i < program.numRows(); ++i)
      if (const double length = program.rows.row(i).norm(); length > 0)
        program.linear += draw.normal() / length * program.rows.row(i).transpose();
  }
  kind << "n = " << n << ", " << (isSingular ? "semidefinite" : "condition ");
  if (!isSingular)
    kind << condition;
  kind << ", " << activityNames[static_cast<int>(activity)] << ", " << program.numRows() << " " << rows
       << (isZero    ? ", b = 0"
           : isNoise ? ", b of noise"
                     : "");
  if (draw.chance(0.4))
    changeUnits(result, draw.powerOfTwo(-20, 20), std::pow(10.0, draw.integer(-6, 6)));
  result.kind = kind.str();
  return result;
}

RandomProgram randomInfeasibleProgram(unsigned seed) {
  Draw draw(seed);
  RandomProgram result;
  DenseProgram& program = result.program;
  const int n = std::min(drawSize(draw), 80) + 1;
  drawDefinite(n, std::pow(10.0, draw.integer(0, 10)), result, draw);
  const Eigen::VectorXd x = Eigen::VectorXd::NullaryExpr(n, [&] { return draw.gridNormal(); });
  drawBounds(Activity::some, x, program, draw);
  program.linear = Eigen::VectorXd::NullaryExpr(n, [&] { return draw.normal(); });
  do
    result.kind = drawRows(x, program, draw);
  while (program.numRows() == 0);
  const Eigen::Index m = program.numRows();
  const double margin = std::pow(10.0, draw.real(-3, 1));
  program.rows.conservativeResize(m + 1, Eigen::NoChange);
  program.values.conservativeResize(m + 1);
  const int reason = draw.integer(0, 2);
  if (reason == 0) {
    const int i = draw.integer(0, n - 1);
    program.lower[i] = x[i] + 0.5 * margin;
    program.upper[i] = x[i] - 0.5 * margin;
    program.rows.row(m).setZero();
    program.values[m] = 0;
    result.kind += ", crossing bounds";
  } else if (reason == 1) { // a copy, a sum, or a row of zeros with another value
    program.rows.row(m).setZero();
    for (int repeat = draw.integer(0, 2); repeat > 0; --repeat)
      program.rows.row(m) += program.rows.row(draw.integer(0, static_cast<int>(m) - 1));
    program.values[m] =
        program.rows.row(m) * x + draw.sign() * margin * std::max(1.0, program.rows.row(m).norm());
    result.kind += ", contradicting rows";
  } else { // more than the box can give, in a row that is then mixed with another
    program.rows.row(m).setZero();
    double most = 0;
    for (int j = 0; j < n; ++j) {
      if (j == 0 && !std::isfinite(program.upper[j]) && !std::isfinite(program.lower[j]))
        program.upper[j] = x[j] + 1;
      const double size = draw.integer(1, 16) / 16.0;
      if (std::isfinite(program.upper[j]) && (j == 0 || draw.chance(0.5)))
        program.rows(m, j) = size;
      else if (std::isfinite(program.lower[j]) && (j == 0 || draw.chance(0.5)))
        program.rows(m, j) = -size;
      if (program.rows(m, j) != 0)
        most += program.rows(m, j) * (program.rows(m, j) > 0 ? program.upper[j] : program.lower[j]);
    }
    program.values[m] = most + margin * program.rows.row(m).norm();
    const double factor = draw.powerOfTwo(-1, 1) / std::max(1e-300, program.rows.row(0).norm());
    program.rows.row(m) += factor * program.rows.row(0);
    program.values[m] += factor * program.values[0];
    result.kind += ", bounds against rows";
  }
  std::ostringstream kind;
  kind << "n = " << n << ", " << result.kind << ", margin " << margin;
  result.kind = kind.str();
  return result;
}

RandomProgram randomUnboundedProgram(unsigned seed) {
  Draw draw(seed);
  RandomProgram result;
  DenseProgram& program = result.program;
  const int n = std::min(drawSize(draw), 60) + 1;
  const Eigen::VectorXd x = Eigen::VectorXd::NullaryExpr(n, [&] { return draw.gridNormal(); });
  Eigen::VectorXd d = Eigen::VectorXd::Zero(n); // the way down: of whole numbers, 1 or −1 in entry `pivot`
  const int pivot = draw.integer(0, n - 1);
  for (int repeat = draw.integer(0, std::min(5, n)); repeat > 0; --repeat)
    d[draw.integer(0, n - 1)] = draw.integer(-2, 2);
  d[pivot] = draw.sign();
  const auto makeOrthogonal = [&](Eigen::MatrixXd& rows) {
    for (Eigen::Index i = 0; i < rows.rows(); ++i) {
      rows(i, pivot) = 0;
      rows(i, pivot) = -rows.row(i).dot(d) / d[pivot];
    }
  };
  Eigen::MatrixXd g = wholeNumbers(draw.integer(0, n), n, draw);
  makeOrthogonal(g);
  drawSemidefinite(g, result);
  drawBounds(Activity::some, x, program, draw);
  for (int i = 0; i < n; ++i) {
    if (d[i] < 0)
      program.lower[i] = -unbounded;
    if (d[i] > 0)
      program.upper[i] = unbounded;
  }
  const int m = draw.chance(0.5) ? draw.integer(1, std::max(1, std::min(n / 2, 8))) : 0;
  program.rows = wholeNumbers(m, n, draw);
  makeOrthogonal(program.rows);
  program.values = program.rows * x;
  program.linear = program.hessian * Eigen::VectorXd::NullaryExpr(n, [&] { return draw.normal(); }) +
                   draw.real(0.05, 2) * d / d.norm();
  std::ostringstream kind;
  kind << "n = " << n << ", rank " << g.rows() << " at most, " << m << " rows";
  result.kind = kind.str();
  return result;
}

} // namespace epafi::test
