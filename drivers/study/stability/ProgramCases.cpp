/// Quadratic programs taken alone: where solvers of this kind have failed their users, and what is degenerate about data.

#include "ProgramRun.hpp"

#include "epafi/base/Compatibility.hpp"

#include <Eigen/Dense>
#include <Teuchos_ArrayRCP.hpp>
#include <Teuchos_Comm.hpp>
#include <Tpetra_Operator.hpp>
#include <Tpetra_Vector.hpp>

#include <cmath>
#include <limits>
#include <random>
#include <sstream>
#include <string>
#include <utility>

namespace epafi::drivers {
namespace {

using benchmarks::DenseProgram;
using Eigen::MatrixXd;
using Eigen::VectorXd;

constexpr double infinity = std::numeric_limits<double>::infinity();
constexpr double nan = std::numeric_limits<double>::quiet_NaN();

using Run = std::function<CaseResult(const RCP<const Comm>&)>;

StabilityCase make(const std::string& name, const std::string& parameter, const Expectation& expected,
                   Run run) {
  return {"quadratic programs", name, parameter, expected, std::move(run)};
}

Run solving(const ProgramTask& task) {
  return [task](const RCP<const Comm>& comm) { return solveProgram(task, comm).result; };
}

std::string words(double value) {
  std::ostringstream text;
  text << value;
  return text.str();
}

/// n springs in a row, the first one held, under a load; x ≥ −0.2.
DenseProgram chain(int n, double load = -0.05) {
  DenseProgram program = DenseProgram::unconstrained(MatrixXd::Zero(n, n), VectorXd::Constant(n, load));
  for (int i = 0; i < n; ++i) {
    program.hessian(i, i) = i + 1 < n ? 2 : 1;
    if (i + 1 < n)
      program.hessian(i, i + 1) = program.hessian(i + 1, i) = -1;
  }
  program.lower.setConstant(-0.2);
  return program;
}

/// The same with the first spring away: the kernel is the constant.
DenseProgram floatingChain(int n, double load) {
  DenseProgram program = chain(n, load);
  program.hessian(0, 0) -= 1;
  return program;
}

void setRows(DenseProgram& program, const MatrixXd& rows, const VectorXd& values) {
  program.rows = rows;
  program.values = values;
}

/// The first row of the rows asks for Σx = −n/20, the others for the same, or nearly.
DenseProgram withRows(int copies, double change = 0) {
  DenseProgram program = chain(8);
  MatrixXd rows = MatrixXd::Ones(copies, 8);
  for (int i = 1; i < copies; ++i)
    rows(i, i) += change;
  setRows(program, rows, VectorXd::Constant(copies, -0.4));
  return program;
}

/// A problem on which primal–dual active sets alternate for ever: Curtis, Han, Robinson, *Comput. Optim. Appl.* 60 (2015)
/// 311–341, example of section 1: x ≤ 0.
DenseProgram alternating() {
  MatrixXd hessian(3, 3);
  hessian << 4, 5, -5, 5, 9, -5, -5, -5, 7;
  DenseProgram program = DenseProgram::unconstrained(hessian, Eigen::Vector3d(-2, -1, 3));
  program.upper.setZero();
  return program;
}

/// One step of primal–dual active sets from each of the 8 sets; whether some start never ends.
bool alternates(const DenseProgram& program) {
  for (int start = 0; start < 8; ++start) {
    int set = start, steps = 0;
    for (; steps < 16; ++steps) {
      MatrixXd a = program.hessian;
      VectorXd b = program.linear;
      for (int i = 0; i < 3; ++i)
        if ((set >> i & 1) != 0) {
          a.row(i) = VectorXd::Unit(3, i).transpose();
          b[i] = 0;
        }
      const VectorXd x = a.partialPivLu().solve(b), force = program.linear - program.hessian * x;
      int next = 0;
      for (int i = 0; i < 3; ++i)
        next |= ((set >> i & 1) != 0 ? force[i] >= 0 : x[i] > 0) ? 1 << i : 0;
      if (next == set)
        break;
      set = next;
    }
    if (steps == 16)
      return true;
  }
  return false;
}

CaseResult judged(CaseResult result, const std::string& wrong) {
  if (result.outcome == Outcome::solved && !wrong.empty()) {
    result.outcome = Outcome::wrongAnswer;
    result.reason = wrong;
  }
  return result;
}

/// The objective `factor` times as large has the same solution and multipliers `factor` times as large.
CaseResult scaled(double factor, const RCP<const Comm>& comm) {
  DenseProgram program = withRows(2);
  const ProgramAnswer one = solveProgram({program}, comm);
  program.hessian *= factor;
  program.linear *= factor;
  const ProgramAnswer other = solveProgram({program}, comm);
  std::ostringstream wrong;
  if (!((other.x - one.x).norm() <= 1e-6 * one.x.norm()))
    wrong << "x changes by " << (other.x - one.x).norm() << "; ";
  if (!((other.boundMultiplier / factor - one.boundMultiplier).norm() <= 1e-5 * one.boundMultiplier.norm()))
    wrong << "multipliers of bounds are not " << factor << " times as large; ";
  if (!((other.equalityMultiplier / factor - one.equalityMultiplier).norm() <=
        1e-5 * one.equalityMultiplier.norm()))
    wrong << "multipliers of rows are not " << factor << " times as large; ";
  return judged(other.result, wrong.str());
}

/// Without its redundant rows the program has the same solution, and their multipliers add up to that of the row left.
CaseResult rowsRemoved(const RCP<const Comm>& comm) {
  const ProgramAnswer many = solveProgram({withRows(3)}, comm), one = solveProgram({withRows(1)}, comm);
  std::ostringstream wrong;
  if (!((many.x - one.x).norm() <= 1e-6 * one.x.norm()))
    wrong << "x changes by " << (many.x - one.x).norm() << "; ";
  if (!(std::abs(many.equalityMultiplier.sum() - one.equalityMultiplier.sum()) <=
        1e-5 * std::abs(one.equalityMultiplier.sum())))
    wrong << "multipliers add up to " << many.equalityMultiplier.sum() << ", not "
          << one.equalityMultiplier.sum() << "; ";
  return judged(many.result, wrong.str());
}

/// Bounds and all other data must be as they were, and a second solve must do as the first one did.
CaseResult twice(const RCP<const Comm>& comm) {
  DenseProgram program = chain(12);
  program.upper.setConstant(-0.01);
  const qp::QuadraticProgram problem = toQuadraticProgram(program, comm);
  const RCP<const Map> map = problem.hessian->getDomainMap();
  Vector before(*problem.linearTerm, Teuchos::Copy), first(map), second(map);
  qp::QpSolver solver;
  solver.solve(problem, first);
  solver.solve(problem, second);
  first.update(-1.0, second, 1.0);
  before.update(-1.0, *problem.linearTerm, 1.0);
  CaseResult result = solveProgram({program}, comm).result;
  Vector projected(map);
  projected.putScalar(-1e6);
  problem.set->project(projected);
  std::ostringstream wrong;
  if (first.normInf() != 0)
    wrong << "the second solve differs by " << first.normInf() << "; ";
  if (before.normInf() != 0)
    wrong << "the linear term was changed; ";
  if (std::abs(projected.normInf() - 0.2) > 0)
    wrong << "the lower bound is now " << projected.normInf() << "; ";
  return judged(result, wrong.str());
}

void addBounds(StabilityCases& cases) {
  DenseProgram program = chain(8);
  program.lower[3] = program.upper[3] = -0.1;
  cases.push_back(make("lb = ub", "one entry", solved(), solving({program})));
  program.upper = program.lower;
  cases.push_back(make("lb = ub", "all entries", solved(), solving({program})));
  program.lower[2] = program.upper[2] + 1e-3;
  cases.push_back(make("lb > ub", "one entry", noSolution("Infeasible"), solving({program})));
  program = chain(8);
  for (const double bound : {0.0, 1e-9})
    for (const double start : {-1e12, 1e12}) {
      ProgramTask task{program};
      task.program.upper.setConstant(bound);
      task.start = VectorXd::Constant(8, start);
      cases.push_back(make("a start that was never projected",
                           "at " + words(start) + ", bounds -0.2 and " + words(bound), solved(),
                           solving(task)));
    }
  cases.push_back(make("bounds shifted in place by a solve", "solved twice", solved(), twice));
  cases.push_back(make("active sets that alternate for ever", "Curtis, Han, Robinson", solved(),
                       [](const RCP<const Comm>& comm) {
                         return judged(solveProgram({alternating()}, comm).result,
                                       alternates(alternating()) ? "" : "this problem shows nothing");
                       }));
}

void addRows(StabilityCases& cases) {
  cases.push_back(make("duplicate equality rows", "3 copies", solved(), solving({withRows(3)})));
  for (const double change : {1e-15, 1e-12})
    cases.push_back(make("a change of 1e-15 flips a null-pivot decision", "rows differ by " + words(change),
                         solved(), solving({withRows(3, change)})));
  DenseProgram program = withRows(2);
  program.values[1] = 0.4;
  cases.push_back(make("infeasible reported as success", "rows that contradict each other",
                       noSolution("Infeasible"), solving({program})));
  program = withRows(1);
  program.values[0] = -8; // Σx ≥ −1.6
  cases.push_back(make("infeasible reported as success", "a row out of the bounds' reach",
                       noSolution("Infeasible"), solving({program})));
  for (const double factor : {1e-6, 1e6})
    cases.push_back(make("multipliers wrong after scaling the objective", "by " + words(factor), solved(),
                         [=](const RCP<const Comm>& comm) { return scaled(factor, comm); }));
  cases.push_back(make("multipliers wrong after removing rows", "3 rows become 1", solved(), rowsRemoved));
}

void addHessians(StabilityCases& cases) {
  DenseProgram program = floatingChain(8, 0.05);
  cases.push_back(make("unbounded reported as success", "floating, pulled off its bounds",
                       noSolution("Unbounded"), solving({program})));
  program = floatingChain(8, -0.05);
  cases.push_back(
      make("semidefinite Hessian", "floating, pressed onto its bounds", solved(), solving({program})));
  program.lower.setConstant(-infinity);
  cases.push_back(make("semidefinite Hessian", "right-hand side not in its range", noSolution("Unbounded"),
                       solving({program})));
  program.linear.setZero();
  program.linear[0] = 1;
  program.linear[7] = -1;
  cases.push_back(make("semidefinite Hessian", "right-hand side in its range", solved(), solving({program})));
  // A null pivot, or one of 1e-15: with bounds the answer is the same, and none may be lost.
  for (const double change : {0.0, 1e-15, -1e-15}) {
    program = floatingChain(8, -0.05);
    program.hessian(0, 0) += change;
    cases.push_back(make("a change of 1e-15 flips a null-pivot decision",
                         "floating chain, diagonal " + words(change), solved(), solving({program})));
  }
  program = chain(8);
  program.hessian(4, 4) = -1;
  program.lower.setConstant(-infinity);
  cases.push_back(make("a quotient by pᵀAp that is zero or negative", "indefinite",
                       stopped("IndefiniteOperator"), solving({program})));
  program = DenseProgram::unconstrained(MatrixXd::Zero(4, 4), VectorXd::Ones(4));
  cases.push_back(make("a quotient by pᵀAp that is zero or negative", "A = 0, no bounds",
                       noSolution("Unbounded"), solving({program})));
  program.upper.setConstant(2);
  cases.push_back(make("a quotient by pᵀAp that is zero or negative", "A = 0, bounds in the way", solved(),
                       solving({program})));
}

/// The stopping reference ‖b‖ vanishes.
void addReferences(StabilityCases& cases) {
  DenseProgram program = chain(8, 0.0);
  cases.push_back(
      make("a stopping reference that vanishes", "b = 0, 0 inside the bounds", solved(), solving({program})));
  ProgramTask task{program};
  task.start = VectorXd::LinSpaced(8, 1, 8);
  cases.push_back(
      make("a stopping reference that vanishes", "b = 0, start elsewhere", solved(), solving(task)));
  program.lower.setConstant(0.1);
  cases.push_back(make("a stopping reference that vanishes", "b = 0, 0 outside the bounds", solved(),
                       solving({program})));
  program = withRows(1);
  program.linear.setZero();
  program.values.setZero();
  cases.push_back(make("a stopping reference that vanishes", "b = 0, c = 0", solved(), solving({program})));
  task = ProgramTask{chain(8)};
  task.program.lower.setConstant(-infinity);
  task.start = task.program.hessian.ldlt().solve(task.program.linear);
  cases.push_back(make("division by zero at the exact optimum", "started there", solved(), solving(task)));
  program = DenseProgram::unconstrained(MatrixXd::Identity(4, 4), VectorXd::Ones(4));
  program.lower.setZero();
  task = ProgramTask{program};
  task.start = VectorXd::Ones(4);
  cases.push_back(
      make("division by zero at the exact optimum", "gradient exactly 0", solved(), solving(task)));
}

/// A chain held at both ends whose loads change sign: some entries rest on their bounds, and the way there takes
/// expansions.
DenseProgram wavyChain() {
  DenseProgram program = chain(40);
  program.hessian(39, 39) = 2;
  for (int i = 0; i < 40; ++i)
    program.linear[i] = 0.05 * std::sin(0.9 * i) - 0.01 * std::cos(0.17 * i);
  program.lower.setConstant(-0.05);
  program.upper.setConstant(0.08);
  return program;
}

/// ‖A‖ is what the step of expansions is made of, for the fixed step above all.
void addNorms(StabilityCases& cases) {
  for (const double factor : {1e-3, 1e-2, 0.1, 0.5, 2.0, 10.0, 1e3}) {
    ProgramTask task{wavyChain()};
    task.parameters.set("Operator Norm", 4 * factor); // ‖A‖ < 4
    task.parameters.sublist("MPRGP").set("Expansion", "fixed step");
    StabilityCase trial =
        make("a norm estimate that is wrong", "‖A‖ times " + words(factor), solved(), solving(task));
    trial.value = factor;
    cases.push_back(std::move(trial));
  }
  for (const int products : {1, 2}) {
    ProgramTask task{wavyChain()};
    // The eigenvector of the largest eigenvalue is hardly in the start vector: one entry of it is 1e6 times as stiff.
    task.program.hessian(20, 20) += 1e6;
    task.parameters.sublist("Norm Estimate")
        .set("Method", "power")
        .set("Maximum Iterations", products)
        .set("Safety", 1.0);
    task.parameters.sublist("MPRGP").set("Expansion", "fixed step");
    cases.push_back(make("a power method that underestimates the norm",
                         std::to_string(products) + " products", solved(), solving(task)));
  }
}

void addNotFinite(StabilityCases& cases) {
  for (const double value : {nan, infinity}) {
    DenseProgram program = chain(8);
    program.linear[5] = value;
    cases.push_back(make("NaN or infinity", "linear term " + words(value), wrongInput("linear term"),
                         solving({program})));
    program = chain(8);
    program.hessian(5, 5) = value;
    cases.push_back(
        make("NaN or infinity", "Hessian " + words(value), stopped("NotFinite"), solving({program})));
    ProgramTask task{chain(8)};
    task.start = VectorXd::Constant(8, value);
    cases.push_back(make("NaN or infinity", "start " + words(value), wrongInput("start"), solving(task)));
    program = withRows(1);
    program.values[0] = value;
    cases.push_back(make("NaN or infinity", "right-hand side of a row " + words(value), wrongInput("finite"),
                         solving({program})));
  }
  DenseProgram program = chain(8);
  program.lower[2] = nan;
  cases.push_back(make("NaN or infinity", "bound nan", wrongInput("bound"), solving({program})));
}

} // namespace

StabilityCases programCases(bool) {
  StabilityCases cases;
  addBounds(cases);
  addRows(cases);
  addHessians(cases);
  addReferences(cases);
  addNorms(cases);
  addNotFinite(cases);
  return cases;
}

} // namespace epafi::drivers
