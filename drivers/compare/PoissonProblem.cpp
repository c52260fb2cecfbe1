#include "PoissonProblem.hpp"

#include "epafi/base/AccurateSum.hpp"
#include "epafi/model/GlobalUnknowns.hpp"
#include "epafi/scene/EdgeContact.hpp"

#include <Tpetra_Map.hpp>
#include <Tpetra_Vector.hpp>

#include <cmath>
#include <numbers>

namespace epafi::drivers {
namespace {

scene::Scene squareMembrane(int elements, int subdomains) {
  scene::Body square;
  square.name = "square";
  square.mesh.box = mesh::rectangle(0, 1, 0, 1);
  square.mesh.elements = {elements, elements, 0};
  for (const char* edge : scene::edges)
    square.supports.push_back({edge, edge, {0.0}});
  square.loads = {fem::loadInside("all over", square.mesh.box, 1.0)};
  square.decomposition.counts = {subdomains, subdomains, 1};
  scene::Scene scene;
  scene.bodies = {square};
  return scene;
}

/// Those of the inner nodes follow each other.
linear::GlobalUnknowns numbersOf(const model::Decomposition& decomposition, int elements) {
  linear::GlobalUnknowns unknowns = model::globalUnknowns(decomposition); // one a node
  const GlobalOrdinal n = elements;
  for (auto& numbers : unknowns)
    for (GlobalOrdinal& number : numbers)
      number = number % (n + 1) - 1 + (number / (n + 1) - 1) * (n - 1);
  return unknowns;
}

} // namespace

PoissonProblem::PoissonProblem(int elements, int subdomains, const RCP<const Comm>& comm) {
  const auto cut = std::make_shared<const model::Decomposition>(
      model::decompose(squareMembrane(elements, subdomains), comm));
  decomposition = cut;
  k = rcp(new linear::UnassembledOperator({cut, &cut->problem}, numbersOf(*cut, elements)));
}

Eigen::MatrixXd solutionBySines(int elements) {
  const Eigen::Index size = elements - 1;
  const double h = 1.0 / elements;
  Eigen::MatrixXd sines(size, size); // orthonormal
  Eigen::VectorXd stiffness(size), mass(size);
  for (Eigen::Index k = 0; k < size; ++k) {
    const double angle = std::numbers::pi * static_cast<double>(k + 1) * h;
    stiffness[k] = (2 - 2 * std::cos(angle)) / h;
    mass[k] = (4 + 2 * std::cos(angle)) * h / 6;
    for (Eigen::Index i = 0; i < size; ++i)
      sines(i, k) = std::sqrt(2 * h) * std::sin(angle * static_cast<double>(i + 1));
  }
  const Eigen::VectorXd load = h * sines.colwise().sum().transpose(); // of f = 1, in one dimension
  Eigen::MatrixXd u = load * load.transpose();
  u.array() /= (stiffness * mass.transpose() + mass * stiffness.transpose()).array();
  return sines * u * sines.transpose();
}

double relativeError(const Vector& u, const Eigen::MatrixXd& exact) {
  Vector difference(u, Teuchos::Copy), reference(u.getMap());
  const auto values = reference.getDataNonConst();
  for (Teuchos_Ordinal i = 0; i < values.size(); ++i) {
    const GlobalOrdinal number = u.getMap()->getGlobalElement(static_cast<LocalOrdinal>(i));
    values[i] = exact.data()[number];
  }
  difference.update(-1.0, reference, 1.0);
  return accurateNorm(difference) / accurateNorm(reference);
}

} // namespace epafi::drivers
