#include "epafi/output/NodalStress.hpp"

#include "epafi/base/Collective.hpp"
#include "epafi/fem/ElementGeometry.hpp"
#include "epafi/fem/ElementIntegrals.hpp"
#include "epafi/output/ElementMaterials.hpp"
#include "epafi/output/Slab.hpp"

#include <Tpetra_Export.hpp>
#include <Tpetra_Map.hpp>
#include <Tpetra_MultiVector.hpp>

#include <algorithm>
#include <array>

namespace epafi::output {
namespace {

using decomposition::Subdomain;

constexpr int numStresses = 6;

/// Of the nodes of this rank's subdomains: Σ w σ (6 columns) and Σ w over the elements around them, w their measure.
struct StressSums {
  std::vector<GlobalOrdinal> nodes; ///< ascending
  Eigen::MatrixXd sums;             ///< nodes × 7
};

Eigen::Index placeOf(const std::vector<GlobalOrdinal>& ascending, GlobalOrdinal node) {
  return std::lower_bound(ascending.begin(), ascending.end(), node) - ascending.begin();
}

std::vector<GlobalOrdinal> nodesOfBody(const std::vector<Subdomain>& subdomains, int body) {
  std::vector<GlobalOrdinal> nodes;
  for (const Subdomain& subdomain : subdomains)
    if (subdomain.body == body)
      nodes.insert(nodes.end(), subdomain.nodes.begin(), subdomain.nodes.end());
  std::sort(nodes.begin(), nodes.end());
  nodes.erase(std::unique(nodes.begin(), nodes.end()), nodes.end());
  return nodes;
}

/// Adds the elements of one subdomain.
class StressAdder {
public:
  StressAdder(const SolvedScene& solved, int body)
      : solid_(*solved.elasticBody(body)),
        layout_(solved.decomposition.bodies[static_cast<std::size_t>(body)]),
        materials_(layout_.name, solid_, *layout_.mesh), components_(componentsOf(solid_.physics)) {}

  void add(const Subdomain& subdomain, const Eigen::VectorXd& displacement, StressSums& result) const {
    const fem::Mesh& mesh = *layout_.mesh;
    const auto corners = static_cast<std::size_t>(mesh.nodesPerElement());
    std::array<GlobalOrdinal, 8> nodes{};
    std::vector<fem::Point> points(corners);
    std::vector<double> u(corners * static_cast<std::size_t>(components_));
    for (const GlobalOrdinal element :
         layout_.partition->elementsOf(subdomain.number - layout_.firstSubdomain)) {
      mesh.elementNodes(element, std::span(nodes).first(corners));
      for (std::size_t i = 0; i < corners; ++i) {
        points[i] = mesh.point(nodes[i]);
        const Eigen::Index place = placeOf(subdomain.nodes, nodes[i]);
        for (int c = 0; c < components_; ++c)
          u[i * static_cast<std::size_t>(components_) + static_cast<std::size_t>(c)] =
              displacement[place * components_ + c];
      }
      const fem::SymmetricTensor stress =
          stressAtCentre(mesh.cellType(), points, solid_.physics, materials_.of(element), u);
      const double weight = measureOf(mesh.cellType(), points);
      for (std::size_t i = 0; i < corners; ++i) {
        auto row = result.sums.row(placeOf(result.nodes, nodes[i]));
        for (int k = 0; k < numStresses; ++k)
          row[k] += weight * stress[static_cast<std::size_t>(k)];
        row[numStresses] += weight;
      }
    }
  }

private:
  const scene::Solid& solid_;
  const decomposition::BodyLayout& layout_;
  ElementMaterials materials_;
  int components_;
};

StressSums sumStresses(const SolvedScene& solved, int body) {
  const auto& problem = solved.decomposition.problem;
  StressSums result;
  result.nodes = nodesOfBody(problem.subdomains, body);
  result.sums.setZero(static_cast<Eigen::Index>(result.nodes.size()), numStresses + 1);
  if (result.nodes.empty())
    return result;
  const StressAdder adder(solved, body);
  for (std::size_t s = 0; s < problem.subdomains.size(); ++s)
    if (problem.subdomains[s].body == body)
      adder.add(problem.subdomains[s], solved.solution.displacement[s], result);
  return result;
}

/// Sums over the ranks to the slabs of nodes. Collective.
MultiVector toSlab(const StressSums& sums, GlobalOrdinal numNodes, const RCP<const Comm>& comm) {
  const auto invalid = Teuchos::OrdinalTraits<Tpetra::global_size_t>::invalid();
  const auto source = rcp(new Map(invalid, Teuchos::arrayViewFromVector(sums.nodes), 0, comm));
  const auto target = rcp(new Map(static_cast<Tpetra::global_size_t>(numNodes),
                                  static_cast<std::size_t>(evenShare(numNodes, *comm).count), 0, comm));
  const auto columns = static_cast<std::size_t>(sums.sums.cols());
  MultiVector from(source, columns), to(target, columns);
  for (std::size_t column = 0; column < columns; ++column) {
    const auto data = from.getDataNonConst(column);
    const auto values = sums.sums.col(static_cast<Eigen::Index>(column));
    std::copy(values.begin(), values.end(), data.begin());
  }
  to.doExport(from, Export(source, target), Tpetra::ADD);
  return to;
}

} // namespace

std::vector<double> vonMisesAtNodes(const SolvedScene& solved, int body) {
  StressSums sums;
  collectively(solved.comm(), [&] { sums = sumStresses(solved, body); });
  const fem::Mesh& mesh = *solved.decomposition.bodies[static_cast<std::size_t>(body)].mesh;
  const MultiVector slab = toSlab(sums, mesh.numNodes(), solved.decomposition.problem.comm);
  std::vector<Teuchos::ArrayRCP<const double>> columns;
  for (std::size_t k = 0; k <= numStresses; ++k)
    columns.push_back(slab.getData(k));
  std::vector<double> result;
  result.reserve(slab.getLocalLength());
  for (Teuchos::Ordinal row = 0; row < columns[0].size(); ++row) {
    fem::SymmetricTensor stress{};
    for (std::size_t k = 0; k < stress.size(); ++k)
      stress[k] = columns[k][row] / columns[numStresses][row];
    result.push_back(fem::vonMisesOf(stress));
  }
  return result;
}

} // namespace epafi::output
