#include "epafi/fem/CompositeCell.hpp"

#include "epafi/direct/DenseOrthogonal.hpp"
#include "epafi/fem/HookesLaw.hpp"
#include "epafi/mesh/ElementMap.hpp"

#include <Eigen/LU>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <memory>
#include <utility>

namespace epafi::fem {

using mesh::CellType;

int placeInFlux(int i, int j, int components) {
  return components == 1 ? j : components == 3 ? placeInTensor.at(i).at(j) : i == j ? i : 2;
}

Eigen::MatrixXd throughFacet(const Eigen::VectorXd& normal, int components) {
  const int dimension = static_cast<int>(normal.size());
  Eigen::MatrixXd through =
      Eigen::MatrixXd::Zero(components, dimension * (components > 1 ? dimension + 1 : 2) / 2);
  for (int i = 0; i < components; ++i)
    for (int j = 0; j < dimension; ++j)
      through(i, placeInFlux(i, j, components)) += normal[j];
  return through;
}

namespace {

/// x of Cx = Gd: those of data d, and what is free besides, columns of orthonormal vectors.
struct Solutions {
  Eigen::MatrixXd ofData, free;
};

class Conditions {
public:
  Conditions(Eigen::Index unknowns, Eigen::Index data) : matrix_(0, unknowns), given_(0, data) {}
  /// Returns the first of `number` rows, in which there is nothing yet. Further ones stand ready: 0 = 0.
  Eigen::Index add(Eigen::Index number) {
    const Eigen::Index first = std::exchange(used_, used_ + number);
    if (used_ > matrix_.rows()) {
      const Eigen::Index rows = std::max<Eigen::Index>(used_, 2 * matrix_.rows());
      matrix_.conservativeResizeLike(Eigen::MatrixXd::Zero(rows, matrix_.cols()));
      given_.conservativeResizeLike(Eigen::MatrixXd::Zero(rows, given_.cols()));
    }
    return first;
  }
  Eigen::MatrixXd& matrix() { return matrix_; }
  Eigen::MatrixXd& given() { return given_; }
  [[nodiscard]] Solutions solved() const {
    constexpr double roundOff = 1e-10;
    const Eigen::MatrixXd basis = direct::pivotedColumns(matrix_.transpose(), roundOff).basis;
    return {basis * direct::leastSquares(matrix_ * basis, given_), direct::orthogonalComplement(basis)};
  }

private:
  Eigen::Index used_ = 0;
  Eigen::MatrixXd matrix_, given_;
};

/// All conditions on the stresses of a reference element: tractions on its facets, those between parts,
/// balance in each part. First of the parts over each facet alone, then between these.
template <int dim>
class Composition {
public:
  explicit Composition(CompositeCell& cell)
      : cell_(cell), shape_(mesh::referenceShape<dim>(cell.type)),
        part_(mesh::referenceShape<dim>(
            withOrder(dim == 2 ? CellType::triangle : CellType::tetrahedron, shape_.order))),
        facet_(mesh::referenceShape<dim - 1>(facetTypeOf(cell.type))),
        functions_(FacetFunctions::of(facet_.type)), perPart_(part_.numNodes * cell.numFluxes) {
    makeParts();
    solve();
    integrate();
    sampleFacets();
  }

private:
  using Local = mesh::Coordinates<dim>;
  /// The simplex between a piece of a facet and the centre.
  struct Part {
    int facet;
    std::array<int, dim + 1> vertices; ///< the last one is the centre
    Local origin;
    Eigen::Matrix<double, dim, dim> jacobian, inverse;
    [[nodiscard]] Local at(const Local& xi) const { return origin + jacobian * xi; }
    /// Of the face opposite to a vertex.
    [[nodiscard]] Local normal(int vertex) const {
      return inverse.transpose() * (vertex > 0 ? Local(Local::Unit(vertex - 1)) : Local(-Local::Ones()));
    }
  };
  static bool isOnFace(const Local& xi, int opposite) {
    return std::abs(opposite > 0 ? xi[opposite - 1] : 1 - xi.sum()) < 1e-9;
  }

  void makeParts() {
    const int corners = numCornersOf(cell_.type), centre = corners + cell_.numFacets;
    for (int k = 0; k < cell_.numFacets; ++k) {
      const mesh::Facet& facet = facetsOf(cell_.type)[k];
      for (const FacetFunctions::Piece& piece : functions_.pieces) {
        Part& part = parts_.emplace_back();
        part.facet = k;
        Eigen::Matrix<double, dim, dim + 1> at;
        for (int i = 0; i < dim; ++i) {
          const bool isMiddle = piece.corners[i] == numCornersOf(facet.type);
          part.vertices[i] = isMiddle ? corners + k : facet[piece.corners[i]];
          at.col(i).setZero();
          if (!isMiddle)
            at.col(i) = shape_.node(part.vertices[i]);
          else
            for (int c = 0; c < piece.corners[i]; ++c)
              at.col(i) += shape_.node(facet[c]) / piece.corners[i];
        }
        part.vertices[dim] = centre;
        at.col(dim) = shape_.centre();
        part.origin = at.col(0);
        part.jacobian = at.template rightCols<dim>().colwise() - part.origin;
        part.inverse = part.jacobian.inverse();
        cell_.parts.emplace_back(at);
      }
    }
  }

  /// Adds a factor times the flux at a node of a part through a face to some rows.
  void add(Eigen::MatrixXd& matrix, Eigen::Index row, std::size_t part, int node, const Local& normal,
           double factor) const {
    matrix.block(row, static_cast<Eigen::Index>(part) * perPart_ + node * cell_.numFluxes, cell_.components,
                 cell_.numFluxes) += factor * throughFacet(normal, cell_.components);
  }

  /// That fluxes through the face between two parts, opposite to a vertex of each, agree.
  void join(std::size_t p, int v, std::size_t q, int w, Conditions& conditions) const {
    const Local normal = parts_[p].normal(v);
    for (int i = 0; i < part_.numNodes; ++i) {
      if (!isOnFace(part_.node(i), v))
        continue;
      const Eigen::Index row = conditions.add(cell_.components);
      add(conditions.matrix(), row, p, i, normal, 1);
      for (int j = 0; j < part_.numNodes; ++j)
        if (isOnFace(part_.node(j), w) &&
            (parts_[q].at(part_.node(j)) - parts_[p].at(part_.node(i))).norm() < 1e-9)
          add(conditions.matrix(), row, q, j, normal, -1);
    }
  }

  /// The given tractions on a part's piece of the facet, and the load inside it.
  void balance(std::size_t p, const Eigen::MatrixXd& values, Conditions& conditions) const {
    const Part& part = parts_[p];
    const mesh::Facet& facet = facetsOf(cell_.type)[part.facet];
    mesh::NodalColumns<dim> corners(dim, facet.size());
    for (int i = 0; i < std::ssize(facet); ++i)
      corners.col(i) = shape_.node(facet[i]);
    const Local normal = mesh::facetNormal<dim - 1>(corners, facet_.centreSample());
    Eigen::Index onFacet = 0; // its nodes come in the order of the piece's
    for (int i = 0; i < part_.numNodes; ++i) {
      if (!isOnFace(part_.node(i), dim))
        continue;
      const Eigen::Index row = conditions.add(cell_.components);
      add(conditions.matrix(), row, p, i, normal, 1);
      for (Eigen::Index a = 0; a < cell_.perFacet; ++a)
        conditions.given()
            .block(row, (part.facet * cell_.perFacet + a) * cell_.components, cell_.components,
                   cell_.components)
            .diagonal()
            .setConstant(values(onFacet, a));
      ++onFacet;
    }
    const int inside = shape_.order == 1 ? 1 : dim + 1; // points of a divergence
    for (int at = 0; at < inside; ++at) {
      const Eigen::Index row = conditions.add(cell_.components);
      const mesh::NodalColumns<dim> slopes = part.inverse.transpose() * part_.gradients(part_.node(at));
      for (int j = 0; j < part_.numNodes; ++j)
        add(conditions.matrix(), row, p, j, slopes.col(j), 1);
      conditions.given()
          .block(row, cell_.numTractions(), cell_.components, cell_.components)
          .diagonal()
          .setConstant(-1);
    }
  }

  void solve() {
    const Eigen::Index number = perPart_ * std::ssize(parts_), data = cell_.numData();
    const std::size_t pieces = functions_.pieces.size();
    std::vector<Conditions> ofFacets(cell_.numFacets, Conditions(number, data));
    Conditions between(number, data);
    const Eigen::MatrixXd inverse = (functions_.moments * facet_.measure).inverse();
    for (std::size_t p = 0; p < parts_.size(); ++p)
      balance(p, functions_.pieces[p % pieces].values * inverse, ofFacets[parts_[p].facet]);
    std::map<std::vector<int>, std::pair<std::size_t, int>> open; // faces of which one side has been seen
    for (std::size_t p = 0; p < parts_.size(); ++p)
      for (int v = 0; v < dim; ++v) {
        std::vector<int> key(parts_[p].vertices.begin(), parts_[p].vertices.end());
        key.erase(key.begin() + v);
        std::sort(key.begin(), key.end());
        const auto [entry, isNew] = open.try_emplace(key, p, v);
        if (isNew)
          continue;
        const auto [q, w] = entry->second;
        join(p, v, q, w, parts_[p].facet == parts_[q].facet ? ofFacets[parts_[p].facet] : between);
      }
    const Eigen::Index perFacet = perPart_ * static_cast<Eigen::Index>(pieces);
    Solutions inside{Eigen::MatrixXd(number, data), Eigen::MatrixXd(number, 0)};
    for (int k = 0; k < cell_.numFacets; ++k) {
      Conditions own(perFacet, data);
      own.matrix() = ofFacets[k].matrix().middleCols(k * perFacet, perFacet);
      own.given() = ofFacets[k].given();
      const Solutions its = own.solved();
      inside.ofData.middleRows(k * perFacet, perFacet) = its.ofData;
      const Eigen::Index known = inside.free.cols();
      inside.free.conservativeResizeLike(Eigen::MatrixXd::Zero(number, known + its.free.cols()));
      inside.free.block(k * perFacet, known, perFacet, its.free.cols()) = its.free;
    }
    between.given() = -between.matrix() * inside.ofData;
    between.matrix() = (between.matrix() * inside.free).eval();
    const Solutions all = between.solved();
    cell_.stresses.resize(number, data + all.free.cols());
    cell_.stresses << inside.ofData + inside.free * all.ofData, inside.free * all.free;
  }

  void integrate() {
    cell_.shares = Eigen::VectorXd::Zero(shape_.numNodes);
    for (const auto& sample : shape_.fineSamples())
      cell_.shares += sample.weight * sample.values;
    Eigen::MatrixXd mass = Eigen::MatrixXd::Zero(part_.numNodes, part_.numNodes);
    for (const auto& sample : mesh::referenceShape<dim>(withOrder(part_.type, 2)).fineSamples()) {
      const mesh::NodalValues values = part_.values(sample.xi);
      mass += sample.weight * values * values.transpose();
    }
    const Eigen::Index nodes = part_.numNodes, number = nodes * std::ssize(parts_);
    std::vector<Eigen::MatrixXd> fluxes, weighted;
    fluxes.reserve(cell_.numFluxes);
    weighted.reserve(cell_.numFluxes);
    for (int k = 0; k < cell_.numFluxes; ++k) {
      using Stride = Eigen::Stride<Eigen::Dynamic, Eigen::Dynamic>;
      const Eigen::MatrixXd& flux = fluxes.emplace_back(Eigen::Map<const Eigen::MatrixXd, 0, Stride>(
          cell_.stresses.data() + k, number, cell_.stresses.cols(),
          Stride(cell_.stresses.rows(), cell_.numFluxes)));
      Eigen::MatrixXd& its = weighted.emplace_back(number, flux.cols());
      for (std::size_t p = 0; p < parts_.size(); ++p)
        its.middleRows(static_cast<Eigen::Index>(p) * nodes, nodes) =
            std::abs(parts_[p].jacobian.determinant()) * mass *
            flux.middleRows(static_cast<Eigen::Index>(p) * nodes, nodes);
    }
    for (int k = 0; k < cell_.numFluxes; ++k)
      for (int l = k; l < cell_.numFluxes; ++l) {
        const Eigen::MatrixXd product = fluxes[k].transpose() * weighted[l];
        cell_.products.push_back(k == l ? product : Eigen::MatrixXd(product + product.transpose()));
      }
  }

  void sampleFacets() {
    const auto& samples = facet_.fineSamples();
    const Eigen::Index number = std::ssize(samples);
    cell_.facetGradients.resize(dim * cell_.numFacets * number, shape_.numNodes);
    cell_.facetShares.resize(number, cell_.perFacet);
    Eigen::Index at = 0;
    for (const mesh::Facet& facet : facetsOf(cell_.type))
      for (Eigen::Index g = 0; g < number; ++g) {
        const auto& sample = samples[g];
        cell_.facetShares.row(g) = sample.weight * sample.values.transpose();
        Local point = Local::Zero();
        for (int i = 0; i < std::ssize(facet); ++i)
          point += sample.values[i] * shape_.node(facet[i]);
        cell_.facetGradients.template middleRows<dim>(dim * at++) = shape_.gradients(point);
      }
  }

  CompositeCell& cell_;
  const mesh::Shape<dim>& shape_;
  const mesh::Shape<dim>& part_;
  const mesh::Shape<dim - 1>& facet_;
  const FacetFunctions& functions_;
  Eigen::Index perPart_;
  std::vector<Part> parts_;
};

} // namespace

const CompositeCell& CompositeCell::of(CellType type, int components) {
  static std::map<std::pair<CellType, int>, std::unique_ptr<const CompositeCell>> made;
  auto& cell = made[{type, components}];
  if (!cell)
    cell.reset(new CompositeCell(type, components));
  return *cell;
}

CompositeCell::CompositeCell(CellType cellType, int numComponents)
    : type(cellType), components(numComponents), dimension(dimensionOf(cellType)),
      numFluxes(components == 1 ? dimension : dimension * (dimension + 1) / 2),
      numFacets(static_cast<int>(facetsOf(cellType).size())), perFacet(mesh::nodesPerFacet(cellType)) {
  if (dimension == 2)
    Composition<2>(*this);
  else
    Composition<3>(*this);
}

} // namespace epafi::fem
