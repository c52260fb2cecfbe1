#include "QpProblems.hpp"

#include "epafi/qp/solve/CsvHistory.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <sstream>
#include <string>
#include <vector>

/// What the solver says of itself: residuals, history, descriptions.
namespace {

using namespace epafi;
using namespace epafi::test;
using qp::Status;
using qp::StepKind;

std::vector<std::string> split(const std::string& line) {
  std::vector<std::string> fields;
  std::istringstream stream(line);
  for (std::string field; std::getline(stream, field, ',');)
    fields.push_back(field);
  return fields;
}

class QpReportTest : public testing::TestWithParam<int> {
protected:
  static DenseProgram program() {
    return GetParam() == 0 ? mixedProgram(20, 100, 167) : mixedProgramWithRows(20, 3, 100, 167);
  }
  static QpCall call(double tolerance) {
    QpCall result{withTolerance(tolerance)};
    result.parameters.set("Maximum Dense Rows", GetParam() == 2 ? 0 : 300);
    return result;
  }
};

TEST_P(QpReportTest, TheCsvTableHoldsTheHistory) {
  std::ostringstream stream;
  qp::CsvHistory csv(&stream);
  QpCall observed = call(1e-8);
  observed.observer = &csv;

  const QpAnswer answer = solveQp(program(), observed);

  std::istringstream table(stream.str());
  std::string line;
  std::getline(table, line);
  const std::vector<std::string> header = split(line);
  ASSERT_EQ(header.size(), 8);
  EXPECT_EQ(header[3], "projected_gradient");
  for (const auto& record : answer.report.history) {
    ASSERT_TRUE(static_cast<bool>(std::getline(table, line)));
    const std::vector<std::string> fields = split(line);
    ASSERT_EQ(fields.size(), header.size()) << line;
    EXPECT_EQ(std::stoi(fields[0]), record.iteration);
    EXPECT_EQ(std::stoi(fields[1]), record.outer);
    EXPECT_EQ(fields[2], std::string(1, static_cast<char>(record.kind)));
    EXPECT_NEAR(std::stod(fields[3]), record.projectedGradient, 1e-15 * record.projectedGradient);
    EXPECT_NEAR(std::stod(fields[4]), record.constraintResidual, 1e-15 * record.constraintResidual);
    EXPECT_NEAR(std::stod(fields[5]), record.objective, 1e-15 * std::abs(record.objective));
    EXPECT_EQ(std::stoll(fields[6]), record.activeBounds);
    EXPECT_EQ(std::stoi(fields[7]), record.hessianMultiplications);
  }
  EXPECT_FALSE(static_cast<bool>(std::getline(table, line))) << line;
}

TEST_P(QpReportTest, ResidualsAreThoseOfTheDenseData) {
  for (const double tolerance : {1e-2, 1e-5, 1e-10}) {
    const QpAnswer answer = solveQp(program(), call(tolerance));

    EXPECT_EQ(whyNoSolution(program(), answer, tolerance), "");
    const DenseResiduals found =
        residuals(program(), answer.x.cast<Real>(), answer.equalityMultiplier.cast<Real>());
    const double load = program().linear.norm();
    EXPECT_NEAR(answer.report.kkt.stationarity, found.stationarity / load, 1e-13);
    EXPECT_NEAR(answer.report.kkt.dualFeasibility, found.dualFeasibility / load, 1e-13);
    EXPECT_NEAR(answer.report.relativeProjectedGradient, found.projectedGradient() / load, 1e-13);
    EXPECT_EQ(answer.report.kkt.feasibility, 0);
    if (GetParam() > 0) {
      const double size = program().rows.norm() * answer.x.norm() + program().values.norm();
      EXPECT_LE(answer.report.kkt.equality, 10 * tolerance);
      EXPECT_LE(found.equality, 1.01 * answer.report.kkt.equality * size + 1e-14 * size);
    }
    EXPECT_NEAR(answer.report.objective, static_cast<double>(program().objective(answer.x.cast<Real>())),
                GetParam() == 0 ? 1e-13 : 10 * tolerance);
  }
}

TEST_P(QpReportTest, ComplementarityIsTheLargestGradientThatHasRoomBeforeItsBound) {
  const QpAnswer answer = solveQp(program(), call(1e-3));

  const Eigen::VectorXd g =
      program().gradient(answer.x.cast<Real>(), answer.equalityMultiplier.cast<Real>()).cast<double>();
  double largest = 0, scale = 1; // ‖A‖ = 1, but for its over-estimate
  for (Eigen::Index i = 0; i < g.size(); ++i) {
    const double room = g[i] > 0 ? answer.x[i] - program().lower[i] : program().upper[i] - answer.x[i];
    largest = std::max(largest, std::min(std::abs(g[i]), scale * room));
  }
  const double reported = answer.report.kkt.complementarity * program().linear.norm();
  EXPECT_GE(reported, (1 - 1e-6) * largest);
  EXPECT_LE(reported, 1.2 * largest + 1e-14);
}

TEST_P(QpReportTest, TheHistoryEndsAtWhatIsReported) {
  const QpAnswer answer = solveQp(program(), call(1e-8));

  const auto& last = answer.report.history.back();
  EXPECT_LE(last.projectedGradient, 1.00001e-8);
  EXPECT_NEAR(last.projectedGradient, answer.report.relativeProjectedGradient, 1e-8);
  EXPECT_NEAR(last.constraintResidual, answer.report.relativeConstraintResidual, 1e-15);
  EXPECT_LE(last.constraintResidual, 1e-8);
}

TEST_P(QpReportTest, TheHistoryHoldsTheConstraintResidualOfItsOwnIterate) {
  if (GetParam() == 0)
    return;
  const QpAnswer answer = solveQp(program(), call(1e-8));

  // Between two records without a product in between x has not moved.
  const auto& history = answer.report.history;
  int compared = 0;
  for (std::size_t k = 1; k < history.size(); ++k)
    if (history[k].kind == StepKind::start &&
        history[k].hessianMultiplications == history[k - 1].hessianMultiplications) {
      EXPECT_NEAR(history[k].constraintResidual, history[k - 1].constraintResidual,
                  1e-9 * history[k].constraintResidual)
          << "record " << k;
      ++compared;
    }
  EXPECT_GT(compared, 0);
}

TEST_P(QpReportTest, TheFirstRecordIsThatOfTheStart) {
  QpCall warm = call(1e-8);
  warm.start = Eigen::VectorXd::Constant(20, 2).cwiseMax(program().lower).cwiseMin(program().upper);

  const QpAnswer answer = solveQp(program(), warm);

  const auto& first = answer.report.history.front();
  EXPECT_EQ(first.kind, StepKind::start);
  EXPECT_EQ(first.iteration, 0);
  EXPECT_EQ(first.hessianMultiplications, 1);
  if (GetParam() == 0) {
    const double projected = residuals(program(), warm.start.cast<Real>(), RealVector()).projectedGradient() /
                             program().linear.norm();
    EXPECT_NEAR(first.projectedGradient, projected, 1e-12);
  }
}

INSTANTIATE_TEST_SUITE_P(Problems, QpReportTest, testing::Values(0, 1, 2), [](const auto& instance) {
  return instance.param == 0 ? "bounds" : instance.param == 1 ? "rows" : "scaledRows";
});

TEST(QpReportTest, ANullStreamWritesNothing) {
  qp::CsvHistory csv(nullptr);

  csv.step(qp::StepRecord{});
}

TEST(QpReportTest, TheDescriptionNamesToleranceStatusAndProducts) {
  const DenseProgram program = mixedProgram(20, 100, 173);
  const qp::QuadraticProgram problem = toQuadraticProgram(program);
  Vector x(problem.hessian->getDomainMap());
  Teuchos::ParameterList parameters;
  parameters.set("Tolerance", 1e-5);
  qp::QpSolver solver(parameters);
  EXPECT_NE(solver.description().find("not run yet"), std::string::npos) << solver.description();

  const qp::QpSolution solution = solver.solve(problem, x);

  const std::string text = solver.description();
  EXPECT_NE(text.find("QpSolver"), std::string::npos) << text;
  EXPECT_NE(text.find("1e-05"), std::string::npos) << text;
  EXPECT_NE(text.find("Converged"), std::string::npos) << text;
  EXPECT_NE(text.find(std::to_string(solution.report.counts.hessianMultiplications)), std::string::npos)
      << text;
}

TEST(QpReportTest, EveryStatusHasANameAndASentence) {
  for (const Status status : {Status::converged, Status::maxIterations, Status::timeLimit, Status::stagnated,
                              Status::indefiniteOperator, Status::indefinitePreconditioner,
                              Status::infeasible, Status::unbounded, Status::notUnique, Status::notFinite}) {
    EXPECT_NE(toString(status), "Unknown");
    EXPECT_GT(explain(status).size(), 10) << toString(status);
  }
}

TEST(QpReportTest, AllRanksGetTheSameReport) {
  const DenseProgram program = mixedProgramWithRows(20, 3, 100, 179);
  const QpAnswer answer = solveQp(program, {withTolerance(1e-8)});
  const auto comm = Tpetra::getDefaultComm();
  double mine[2] = {answer.report.objective, answer.report.kkt.stationarity}, root[2] = {mine[0], mine[1]};

  Teuchos::broadcast(*comm, 0, 2, root);

  EXPECT_EQ(mine[0], root[0]);
  EXPECT_EQ(mine[1], root[1]);
}

} // namespace
