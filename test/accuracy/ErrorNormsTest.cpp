// Errors against closed forms and finer meshes.

#include "epafi/accuracy/ErrorNorms.hpp"

#include "Samples.hpp"

#include "epafi/accuracy/Refinement.hpp"
#include "epafi/fem/HookesLaw.hpp"

namespace epafi::accuracy {
namespace {

using test::Field;
using ErrorNormsTest = test::AccuracyTest;

TEST_F(ErrorNormsTest, OfAQuadraticFieldAreTheIntegralsOfTheTextbook) {
  // u = x² on (0, 2) × (0, 1) against 0: ∫|∇u|² = ∫4x² = 32/3, ∫u² = 32/5. Interpolated by elements of length
  // h the field has ∫|u'|² less by Σ h³/3 · … = 2h²/3, which the error against x² is.
  const int elements = 8;
  const double h = 1.0 / elements;
  const scene::Scene scene = test::membrane(elements, 2);
  const auto decomposition = model::decompose(scene, comm);
  const auto u = displacement(decomposition, [](const Point& x) {
    return std::array<double, 3>{x[0] * x[0], 0, 0};
  });
  const ExactField square = [](int /*body*/, const Point& x) {
    fem::FieldValue field;
    field.displacement = {x[0] * x[0]};
    field.flux = {2 * x[0]};
    return field;
  };
  const double error = errorNorms(scene, decomposition, u, square).energy;
  EXPECT_NEAR(error * error, 2 * h * h / 3, 1e-13); // ∫ (2x − (a + b))² = h³/3 an element
  const ErrorNorms whole = errorNorms(scene, decomposition, u, {});
  EXPECT_NEAR(whole.energy * whole.energy, 32.0 / 3 - 2 * h * h / 3, 1e-12);
}

TEST_F(ErrorNormsTest, OfALinearDisplacementAreExactOnAllElements) {
  const Field field = [](const Point& x) {
    return std::array<double, 3>{0.1 * x[0] - 0.2 * x[1], 0.3 * x[0] + 0.4 * x[1] - 0.1 * x[2], 0.2 * x[2]};
  };
  Eigen::Matrix3d gradient;
  gradient << 0.1, -0.2, 0, 0.3, 0.4, -0.1, 0, 0, 0.2;
  for (const test::Kind& kind : test::kinds()) {
    const scene::Scene scene = test::stackedBlocks(kind, 3, 1, directory, *comm);
    const auto decomposition = model::decompose(scene, comm);
    const auto u = displacement(decomposition, field);
    const bool isPlane = mesh::dimensionOf(kind.cell) == 2;
    Eigen::Matrix3d inPlane = gradient;
    if (isPlane) {
      inPlane.row(2).setZero();
      inPlane.col(2).setZero();
    }
    const ExactField exact = [&](int body, const Point& x) {
      const auto& solid = scene.bodies[body];
      return fem::FieldValue{field(x), fem::stressOf(inPlane, solid.physics, solid.material)};
    };
    const ErrorNorms error = errorNorms(scene, decomposition, u, exact),
                     whole = errorNorms(scene, decomposition, u, {});
    EXPECT_GT(whole.energy, 1);
    EXPECT_GT(whole.l2, 0.1);
    EXPECT_LE(error.energy, 1e-12 * whole.energy) << toString(kind.physics);
    EXPECT_LE(error.l2, 1e-12 * whole.l2);
  }
}

TEST_F(ErrorNormsTest, AgainstAFinerMeshIsTheDifferenceOfTheEnergies) {
  // The interpolant of a quadratic on a coarse mesh and on a finer one: Galerkin-orthogonal, as interpolants
  // in one dimension are, so that squares of errors subtract.
  const Field field = [](const Point& x) { return std::array<double, 3>{x[0] * x[0], 0, 0}; };
  const scene::Scene scene = test::membrane(4, 2), finer = refined(refined(scene));
  const auto coarse = model::decompose(scene, comm), fine = model::decompose(finer, comm);
  const auto u = displacement(coarse, field), reference = displacement(fine, field);
  const double error = errorAgainst(finer, fine, reference, coarse, u).energy;
  const double h = 1.0 / 4, small = 1.0 / 16;
  EXPECT_NEAR(error * error, 2 * (h * h - small * small) / 3, 1e-12);
}

} // namespace
} // namespace epafi::accuracy
