#include "support/HandedOver.hpp"
#include "support/Reference.hpp"

#include <Tpetra_Vector.hpp>
#include <gtest/gtest.h>

#include <sys/resource.h>

namespace epafi::fetidp {
namespace {

using namespace decomposition;

/// The most memory that this process ever held.
double peakMemory() {
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  return static_cast<double>(usage.ru_maxrss);
}

TEST(CyclesTest, MemoryStaysFlatWhateverIsSetUpSolvedAndUpdated) {
  scene::Scene scene = twoMembranes(false, 24, grid(3, 3));
  setHalves(scene.bodies[0], 4.0, -5.0);
  setHalves(scene.bodies[1], -3.0, 2.0);
  const Decomposition cut = decompose(scene, world());
  const ConstraintMatrix contact = contactOf(scene, cut, Supports::prescribed);
  const std::vector<SubdomainMatrix> matrices = matricesOf(scene, Supports::prescribed);
  const auto handed = handOver(scene, matrices);
  handed->setContact(contact);
  handed->complete();
  ContactSolver solver(toleranceOf(1e-8));
  const auto cycle = [&](int number) {
    solver.setup(handed->problem(), handed->data());
    const ContactSolution first = solver.solve(handed->data());
    for (std::size_t s = 0; s < matrices.size(); ++s)
      handed->setMatrix(s, (1 + 0.01 * (number % 7)) * matrices[s].stiffness);
    handed->setContact(contact);
    solver.update(handed->data());
    const ContactSolution second = solver.solve(handed->data(), first.multiplier.get());
    EXPECT_EQ(solver.report().status, qp::Status::converged);
  };
  for (int number = 0; number < 20; ++number) // the allocator finds its size
    cycle(number);
  const double before = peakMemory();
  for (int number = 20; number < 220; ++number)
    cycle(number);
  EXPECT_LE(peakMemory(), 1.02 * before);
}

} // namespace
} // namespace epafi::fetidp
