#include "epafi/accuracy/BoundCells.hpp"

#include "epafi/base/Errors.hpp"
#include "epafi/base/Maps.hpp"
#include "epafi/fem/ElementIntegrals.hpp"
#include "epafi/mesh/ElementMap.hpp"

#include <Tpetra_Import.hpp>
#include <Tpetra_Map.hpp>
#include <Tpetra_MultiVector.hpp>

#include <algorithm>
#include <limits>
#include <numeric>
#include <unordered_set>

namespace epafi::accuracy {

BoundCells::BoundCells(const scene::Body& body, const model::BodyLayout& layout,
                       const decomposition::DecomposedProblem& problem, int number)
    : body_(body), layout_(layout), model_(model::makeModel(body, *layout.mesh)),
      perElement_(layout.mesh->nodesPerElement()) {
  gather(problem, number);
  requireStraight();
  numberNodes();
  if (!fem::sharedShape(body, *layout.mesh).empty()) {
    kinds_.resize(elements_.size());
    model_->regions(elements_, kinds_);
    stresses_.resize(body.regions.size() + 1);
    stiffnesses_.resize(body.regions.size() + 1);
  }
}

/// Own elements, and those around them that other ranks have.
void BoundCells::gather(const decomposition::DecomposedProblem& problem, int number) {
  for (const decomposition::Subdomain& subdomain : problem.subdomains)
    if (subdomain.body == number) {
      const auto own = layout_.partition->elementsOf(subdomain.number - layout_.firstSubdomain);
      elements_.insert(elements_.end(), own.begin(), own.end());
    }
  numOwn_ = elements_.size();
  if (problem.comm->getSize() > 1) {
    std::unordered_set<GlobalOrdinal> known(elements_.begin(), elements_.end());
    std::vector<GlobalOrdinal> around;
    for (std::size_t place = 0; place < numOwn_; ++place)
      for (const GlobalOrdinal node : mesh::ElementNodes(mesh(), elements_[place])) {
        mesh().nodeElements(node, around);
        for (const GlobalOrdinal element : around)
          if (known.insert(element).second)
            elements_.push_back(element);
      }
  }
  nodes_.resize(elements_.size() * perElement_);
  for (std::size_t place = 0; place < elements_.size(); ++place)
    mesh().elementNodes(elements_[place], std::span(nodes_).subspan(place * perElement_, perElement_));
}

void BoundCells::numberNodes() {
  locals_.reserve(nodes_.size());
  for (const GlobalOrdinal node : nodes_) {
    if (locals_.size() == numOwn_ * perElement_)
      numOwnNodes_ = static_cast<int>(numbers_.size());
    const auto [entry, isNew] = localOf_.try_emplace(node, static_cast<int>(numbers_.size()));
    if (isNew)
      numbers_.push_back(node);
    locals_.push_back(entry->second);
  }
  if (numOwn_ == elements_.size())
    numOwnNodes_ = static_cast<int>(numbers_.size());
  firstAround_.assign(numbers_.size() + 1, 0);
  for (const int local : locals_)
    ++firstAround_[local + 1];
  std::partial_sum(firstAround_.begin(), firstAround_.end(), firstAround_.begin());
  around_.resize(locals_.size());
  std::vector<std::size_t> next(firstAround_.begin(), firstAround_.end() - 1);
  for (std::size_t i = 0; i < locals_.size(); ++i)
    around_[next[locals_[i]]++] = {i / perElement_, static_cast<int>(i % perElement_)};
}

namespace {

template <int dim>
bool isAffine(mesh::CellType type, std::span<const Point> points) {
  constexpr double roundOff = 1e-9;
  const mesh::Shape<dim>& shape = mesh::referenceShape<dim>(type);
  if (std::ssize(points) != shape.numNodes) // of meshes of several kinds
    return false;
  const auto corners = mesh::relativeCorners<dim>(points);
  const mesh::ElementMap<dim> map(corners, shape.centreSample());
  for (int a = 1; a < shape.numNodes; ++a)
    if ((corners.col(a) - map.jacobian() * (shape.node(a) - shape.node(0))).norm() >
        roundOff * map.jacobian().norm())
      return false;
  return true;
}

} // namespace

void BoundCells::requireStraight() const {
  using mesh::CellType;
  const CellType type = mesh().cellType(), linear = withOrder(type, 1);
  bool isCovered = dimensionOf(type) == 2 || linear == CellType::tetrahedron ||
                   (linear == CellType::hexahedron && !isSerendipity(type));
  std::vector<Point> points;
  for (std::size_t place = 0; isCovered && place < numOwn_; ++place) {
    mesh().elementPoints(elements_[place], points);
    isCovered = (dimensionOf(type) == 2 ? isAffine<2> : isAffine<3>)(type, points);
  }
  if (!isCovered)
    throw InputError("guaranteed bounds are there for triangles, parallelograms, tetrahedra and "
                     "parallelepipeds of 8 or 27 nodes, "
                     "with straight edges and all of one kind, and body '" +
                     body_.name + "' has others; leave out \"Bound\"");
}

FacetKey facetKey(mesh::CellType facet, std::span<const GlobalOrdinal> nodes) {
  std::array<GlobalOrdinal, mesh::mostFacetCorners> corners{};
  corners.fill(std::numeric_limits<GlobalOrdinal>::max());
  std::copy_n(nodes.begin(), numCornersOf(facet), corners.begin());
  std::sort(corners.begin(), corners.end());
  return {corners[0], corners[1], corners[2]};
}

FacetKey BoundCells::facetAt(std::size_t place, int facet) const {
  std::array<GlobalOrdinal, mesh::mostFacetNodes> nodes{};
  const mesh::Facet& its = facets()[facet];
  for (std::size_t i = 0; i < its.size(); ++i)
    nodes.at(i) = nodesAt(place)[its[i]];
  return facetKey(its.type, nodes);
}

const fem::CellStress& BoundCells::stressAt(std::size_t place, std::optional<fem::CellStress>& own) const {
  std::optional<fem::CellStress>& stress = kinds_.empty() ? own : stresses_[kinds_[place]];
  if (kinds_.empty() || !stress) {
    std::vector<Point> points;
    mesh().elementPoints(elements_[place], points);
    stress.emplace(mesh().cellType(), points, body_.physics, materialAt(place));
  }
  return *stress;
}

const Eigen::MatrixXd& BoundCells::stiffnessAt(std::size_t place, Eigen::MatrixXd& own) const {
  Eigen::MatrixXd& stiffness = kinds_.empty() ? own : stiffnesses_[kinds_[place]];
  if (kinds_.empty() || stiffness.size() == 0) {
    std::vector<Point> points;
    mesh().elementPoints(elements_[place], points);
    fem::elementStiffness(mesh().cellType(), points, body_.physics, materialAt(place), stiffness);
  }
  return stiffness;
}

std::vector<Eigen::MatrixXd> displacementsOf(const std::vector<std::unique_ptr<BoundCells>>& cells,
                                             const model::Decomposition& decomposition,
                                             std::span<const Eigen::VectorXd> displacement) {
  const decomposition::DecomposedProblem& problem = decomposition.problem;
  const Eigen::Index components = problem.components;
  std::vector<Eigen::MatrixXd> result;
  for (const auto& body : cells)
    result.emplace_back(body->mesh().nodesPerElement() * components, body->number());
  std::vector<std::size_t> next(cells.size(), 0);
  std::vector<std::vector<Eigen::Index>> places; // among a subdomain's nodes
  for (const auto& body : cells)
    places.emplace_back(body->numOwnNodes());
  for (std::size_t s = 0; s < problem.subdomains.size(); ++s) {
    const decomposition::Subdomain& subdomain = problem.subdomains[s];
    const std::size_t b = subdomain.body;
    const model::BodyLayout& layout = decomposition.bodies[b];
    for (std::size_t k = 0; k < subdomain.nodes.size(); ++k)
      places[b][cells[b]->localOf(subdomain.nodes[k])] = static_cast<Eigen::Index>(k);
    const std::size_t end =
        next[b] + layout.partition->elementsOf(subdomain.number - layout.firstSubdomain).size();
    for (; next[b] < end; ++next[b]) {
      const auto locals = cells[b]->localsAt(next[b]);
      for (std::size_t a = 0; a < locals.size(); ++a)
        result[b].col(next[b]).segment(a * components, components) =
            displacement[s].segment(places[b][locals[a]] * components, components);
    }
  }
  if (problem.comm->getSize() == 1)
    return result;
  for (std::size_t b = 0; b < cells.size(); ++b) {
    std::vector<GlobalOrdinal> own, all;
    for (std::size_t place = 0; place < cells[b]->number(); ++place)
      (place < cells[b]->numOwn() ? own : all).push_back(cells[b]->elementAt(place));
    const RCP<const Map> source = mapInOrder(own, problem.comm);
    const RCP<const Map> target = mapInOrder(all, problem.comm);
    const auto rows = static_cast<std::size_t>(result[b].rows());
    MultiVector mine(source, rows), around(target, rows);
    for (std::size_t row = 0; row < rows; ++row) {
      const auto data = mine.getDataNonConst(row);
      for (std::size_t e = 0; e < own.size(); ++e)
        data[static_cast<Teuchos::Ordinal>(e)] = result[b](row, e);
    }
    around.doImport(mine, Import(source, target), Tpetra::INSERT);
    for (std::size_t row = 0; row < rows; ++row) {
      const auto data = around.getData(row);
      for (std::size_t e = 0; e < all.size(); ++e)
        result[b](row, own.size() + e) = data[static_cast<Teuchos::Ordinal>(e)];
    }
  }
  return result;
}

} // namespace epafi::accuracy
