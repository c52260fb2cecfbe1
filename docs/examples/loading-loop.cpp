// A rigid paraboloid is pressed into a block and moves along it in fifty steps: set up once, then every step
// starts from where the last three point. Prints a line a step and what all steps cost together beside the
// first one.
#include "Block.hpp"

#include "epafi/ContactSolver.hpp"
#include "epafi/model/Decompose.hpp"

#include <Teuchos_Time.hpp>
#include <Tpetra_Core.hpp>
#include <Tpetra_Map.hpp>
#include <Tpetra_Vector.hpp>

#include <algorithm>
#include <cstdio>
#include <deque>

using epafi::RCP;
using epafi::Vector;

constexpr int numSteps = 50;
constexpr double depth = 0.02, curvature = 0.25; // of the paraboloid: a length, and 1 / length
constexpr double from = 0.9, to = 1.1; // where its lowest point is in the first step and in the last

/// The paraboloid's lowest point at x = `middle`, y = 1.
void setGaps(epafi::model::Decomposition& cut, double middle) {
  const epafi::contact::ContactLayout& contact = cut.contacts.front();
  const RCP<Vector> gaps = cut.data.contactGaps(cut.problem);
  for (std::size_t k = 0; k < contact.firstNodes.size(); ++k) {
    const auto row = contact.firstRow + static_cast<epafi::GlobalOrdinal>(k);
    const epafi::Point point = cut.bodies.front().mesh->point(contact.firstNodes[k]);
    const double x = point[0] - middle, y = point[1] - 1;
    if (gaps->getMap()->isNodeGlobalElement(row))
      gaps->replaceGlobalValue(row, 0.5 * curvature * (x * x + y * y) - depth);
  }
  cut.data.setGaps(*gaps);
}

/// λ of a step from those of the last ones, the latest first, at most three: between changes of the contact
/// zone λ is a polynomial in the way, of degree 2 as the gaps are. Forces do not pull.
RCP<Vector> predicted(const std::deque<RCP<Vector>>& last, epafi::GlobalOrdinal numInequalities) {
  constexpr double weights[3][3] = {{1, 0, 0}, {2, -1, 0}, {3, -3, 1}};
  if (last.empty())
    return Teuchos::null;
  const RCP<Vector> lambda = Teuchos::rcp(new Vector(last.front()->getMap()));
  for (std::size_t k = 0; k < last.size(); ++k)
    lambda->update(weights[last.size() - 1][k], *last[k], 1.0);
  const auto values = lambda->getDataNonConst();
  for (Teuchos_Ordinal i = 0; i < values.size(); ++i)
    if (lambda->getMap()->getGlobalElement(static_cast<int>(i)) < numInequalities)
      values[i] = std::max(values[i], 0.0);
  return lambda;
}

int main(int argc, char** argv) {
  Tpetra::ScopeGuard scope(&argc, &argv);
  const auto comm = Tpetra::getDefaultComm();
  const int elements = argc > 1 ? std::stoi(argv[1]) : 8;
  epafi::model::Decomposition cut = epafi::model::decompose(block(elements, elements), comm);
  epafi::ContactSolver solver{Teuchos::ParameterList("Solver")};

  double firstTime = 0, allTime = 0;
  int firstProducts = 0, allProducts = 0, numFailures = 0;
  std::deque<RCP<Vector>> last;
  for (int step = 1; step <= numSteps; ++step) {
    const double start = Teuchos::Time::wallTime();
    setGaps(cut, from + (to - from) * (step - 1) / (numSteps - 1));
    if (step == 1)
      solver.setup(cut.problem, cut.data);
    const epafi::fetidp::ContactSolution solution =
        solver.solve(cut.data, predicted(last, cut.problem.numInequalities).get());
    last.push_front(solution.multiplier);
    last.resize(std::min<std::size_t>(last.size(), 3));

    const int products = solver.report().counts.hessianMultiplications;
    const double time = Teuchos::Time::wallTime() - start;
    numFailures += solver.report().status == epafi::qp::Status::converged ? 0 : 1;
    firstProducts = step == 1 ? products : firstProducts;
    firstTime = step == 1 ? time : firstTime;
    allProducts += products;
    allTime += time;
    if (comm->getRank() == 0)
      std::printf("step %d: force %.6g, %lld closed nodes, %d products\n", step, solution.contactForce,
                  static_cast<long long>(solution.activeContactNodes), products);
  }
  if (comm->getRank() == 0)
    std::printf("all steps: %d products, %.2f times the first step's; %.3g s, %.2f times the first step's\n",
                allProducts, static_cast<double>(allProducts) / firstProducts, allTime, allTime / firstTime);
  return numFailures == 0 ? 0 : 1;
}
