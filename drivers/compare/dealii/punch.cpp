/// `punch DEGREE local|even SECONDS`: xml/punch.xml by deal.II, with elements Q1 or Q2, mesh after mesh: a
/// primal-dual active set on pairs of nodes that face each other, UMFPACK, and Kelly's estimate of the error,
/// by which three tenths of the cells are refined. Prints a line of JSON a mesh, seconds since the start; no
/// mesh is begun that would be ready later than SECONDS.

#include "ContactPairs.hpp"

#include <deal.II/base/function_lib.h>
#include <deal.II/base/multithread_info.h>
#include <deal.II/base/quadrature_lib.h>
#include <deal.II/base/timer.h>
#include <deal.II/dofs/dof_renumbering.h>
#include <deal.II/dofs/dof_tools.h>
#include <deal.II/fe/fe_q.h>
#include <deal.II/fe/fe_system.h>
#include <deal.II/fe/fe_values.h>
#include <deal.II/grid/grid_refinement.h>
#include <deal.II/grid/tria.h>
#include <deal.II/lac/affine_constraints.h>
#include <deal.II/lac/dynamic_sparsity_pattern.h>
#include <deal.II/lac/sparse_direct.h>
#include <deal.II/lac/sparse_matrix.h>
#include <deal.II/lac/vector.h>
#include <deal.II/numerics/error_estimator.h>
#include <deal.II/numerics/vector_tools.h>

#include <cmath>
#include <iomanip>
#include <iostream>
#include <string>

using namespace dealii;

namespace {

// As in xml/punch.xml: mm and MPa.
constexpr double edge = 5, blockSide = 20, punchHeight = 10, pressure = 200;
struct Material {
  double young, poisson;
  [[nodiscard]] double lambda() const { return young * poisson / ((1 + poisson) * (1 - 2 * poisson)); }
  [[nodiscard]] double mu() const { return young / (2 * (1 + poisson)); }
};
constexpr Material aluminium{70000, 0.33}, steel{210000, 0.3};
const Material& materialAt(double y) {
  return y < 0 ? aluminium : steel;
}

/// Weighs jumps of gradients as the energy does.
class RootOfYoung : public Function<2> {
public:
  RootOfYoung() : Function<2>(2) {}
  double value(const Point<2>& place, unsigned = 0) const override {
    return std::sqrt(materialAt(place(1)).young);
  }
};

class Punch {
public:
  explicit Punch(unsigned degree)
      : mesh_(Triangulation<2>::none), element_(FE_Q<2>(degree), 2), dofs_(mesh_) {
    makeMesh();
  }
  void solve();
  void refine(bool isLocal);
  [[nodiscard]] unsigned unknowns() const { return dofs_.n_dofs(); }
  [[nodiscard]] unsigned steps() const { return steps_; }
  [[nodiscard]] std::size_t closed() const { return closed_; }
  [[nodiscard]] double energy() const { return energy_; }

private:
  void makeMesh();
  void setUp();
  void assemble();
  void search();

  Triangulation<2> mesh_;
  FESystem<2> element_;
  DoFHandler<2> dofs_;
  AffineConstraints<double> constraints_; ///< supports and hanging nodes
  std::vector<ContactPair> pairs_;
  SparsityPattern pattern_;
  SparseMatrix<double> stiffness_;
  Vector<double> load_, solution_;
  unsigned steps_ = 0;
  std::size_t closed_ = 0;
  double energy_ = 0;
};

void Punch::makeMesh() {
  std::vector<Point<2>> points;
  std::vector<CellData<2>> cells;
  const auto addBody = [&](unsigned nx, unsigned ny, double bottom) {
    const unsigned first = points.size();
    for (unsigned j = 0; j <= ny; ++j)
      for (unsigned i = 0; i <= nx; ++i)
        points.emplace_back(edge * i, bottom + edge * j);
    for (unsigned j = 0; j < ny; ++j)
      for (unsigned i = 0; i < nx; ++i) {
        const unsigned corner = first + i + j * (nx + 1);
        cells.emplace_back();
        cells.back().vertices = {corner, corner + 1, corner + nx + 1, corner + nx + 2};
      }
  };
  addBody(static_cast<unsigned>(blockSide / edge), static_cast<unsigned>(blockSide / edge), -blockSide);
  addBody(1, static_cast<unsigned>(punchHeight / edge), 0);
  mesh_.create_triangulation(points, cells, SubCellData());
  for (const auto& cell : mesh_.active_cell_iterators())
    for (const auto& face : cell->face_iterators()) {
      if (!face->at_boundary())
        continue;
      const Point<2> place = face->center();
      const bool isInContact = place(1) == 0 && place(0) < edge;
      face->set_boundary_id(place(0) == 0             ? symmetry
                            : place(1) == -blockSide  ? floor_side
                            : place(1) == punchHeight ? pressed
                            : !isInContact            ? free_side
                            : cell->center()(1) < 0   ? block_face
                                                      : punch_face);
    }
}

void Punch::setUp() {
  dofs_.distribute_dofs(element_);
  constraints_.clear();
  DoFTools::make_hanging_node_constraints(dofs_, constraints_);
  for (const auto& [side, component] : {std::pair(symmetry, 0U), std::pair(floor_side, 1U)}) {
    ComponentMask held(2, false);
    held.set(component, true);
    VectorTools::interpolate_boundary_values(dofs_, side, Functions::ZeroFunction<2>(2), constraints_, held);
  }
  constraints_.close();
  pairs_ = contactPairs(dofs_);
  AffineConstraints<double> allClosed;
  for (const ContactPair& pair : pairs_) {
    allClosed.add_line(pair.punch);
    allClosed.add_entry(pair.punch, pair.block, 1);
  }
  allClosed.close();
  DynamicSparsityPattern pattern(dofs_.n_dofs());
  DoFTools::make_sparsity_pattern(dofs_, pattern, constraints_, false);
  allClosed.condense(pattern);
  pattern_.copy_from(pattern);
  stiffness_.reinit(pattern_);
  load_.reinit(dofs_.n_dofs());
  solution_.reinit(dofs_.n_dofs());
}

void Punch::assemble() {
  const QGauss<2> points(element_.degree + 1);
  const QGauss<1> facePoints(element_.degree + 1);
  FEValues<2> values(element_, points, update_gradients | update_JxW_values);
  FEFaceValues<2> faceValues(element_, facePoints, update_values | update_JxW_values);
  const unsigned n = element_.n_dofs_per_cell();
  const FEValuesExtractors::Vector displacement(0);
  FullMatrix<double> matrix(n, n);
  Vector<double> vector(n);
  std::vector<types::global_dof_index> indices(n);
  std::vector<SymmetricTensor<2, 2>> strains(n);
  for (const auto& cell : dofs_.active_cell_iterators()) {
    matrix = 0;
    vector = 0;
    values.reinit(cell);
    const Material& material = materialAt(cell->center()(1));
    for (unsigned q = 0; q < points.size(); ++q) {
      for (unsigned i = 0; i < n; ++i)
        strains[i] = values[displacement].symmetric_gradient(i, q);
      for (unsigned i = 0; i < n; ++i) {
        const SymmetricTensor<2, 2> stress =
            material.lambda() * trace(strains[i]) * unit_symmetric_tensor<2>() +
            2 * material.mu() * strains[i];
        for (unsigned j = 0; j <= i; ++j)
          matrix(i, j) += (stress * strains[j]) * values.JxW(q);
      }
    }
    for (unsigned i = 0; i < n; ++i)
      for (unsigned j = 0; j < i; ++j)
        matrix(j, i) = matrix(i, j);
    for (const unsigned f : cell->face_indices()) {
      if (!cell->face(f)->at_boundary() || cell->face(f)->boundary_id() != pressed)
        continue;
      faceValues.reinit(cell, f);
      for (unsigned q = 0; q < facePoints.size(); ++q)
        for (unsigned i = 0; i < n; ++i)
          vector(i) -= pressure * faceValues[displacement].value(i, q)[1] * faceValues.JxW(q);
    }
    cell->get_dof_indices(indices);
    constraints_.distribute_local_to_global(matrix, vector, indices, stiffness_, load_);
  }
}

/// Closes pairs that press or penetrate and opens the others, until the set of closed ones settles.
void Punch::search() {
  std::vector<bool> isClosed(pairs_.size(), true);
  SparseMatrix<double> matrix(pattern_);
  Vector<double> residual(load_.size());
  for (bool changes = true; changes; ++steps_) {
    AffineConstraints<double> contact;
    for (std::size_t k = 0; k < pairs_.size(); ++k)
      if (isClosed[k]) {
        contact.add_line(pairs_[k].punch);
        contact.add_entry(pairs_[k].punch, pairs_[k].block, 1);
      }
    contact.close();
    matrix.copy_from(stiffness_);
    solution_ = load_;
    contact.condense(matrix, solution_);
    SparseDirectUMFPACK factors;
    factors.solve(matrix, solution_);
    contact.distribute(solution_);
    stiffness_.vmult(residual, solution_);
    residual -= load_; // of a closed pair the force on the punch
    changes = false;
    for (std::size_t k = 0; k < pairs_.size(); ++k) {
      const auto [block, punch] = pairs_[k];
      const double penetration = solution_(block) - solution_(punch);
      const bool closes = residual(punch) + aluminium.young * penetration > 0;
      changes = changes || closes != isClosed[k];
      isClosed[k] = closes;
    }
  }
  closed_ = static_cast<std::size_t>(std::count(isClosed.begin(), isClosed.end(), true));
}

void Punch::solve() {
  steps_ = 0;
  setUp();
  assemble();
  search();
  energy_ = 0.5 * stiffness_.matrix_norm_square(solution_) - load_ * solution_;
  constraints_.distribute(solution_);
}

void Punch::refine(bool isLocal) {
  if (!isLocal) {
    mesh_.refine_global();
    return;
  }
  Vector<float> errors(mesh_.n_active_cells());
  const RootOfYoung weight;
  KellyErrorEstimator<2>::estimate(dofs_, QGauss<1>(element_.degree + 1), {}, solution_, errors, {}, &weight);
  GridRefinement::refine_and_coarsen_fixed_number(mesh_, errors, 0.3, 0);
  flagBothSides(mesh_);
  mesh_.execute_coarsening_and_refinement();
}

} // namespace

int main(int argc, char** argv) {
  if (argc != 4) {
    std::cerr << "Usage: punch DEGREE local|even SECONDS\n";
    return 2;
  }
  MultithreadInfo::set_thread_limit(1);
  const bool isLocal = std::string(argv[2]) == "local";
  const double limit = std::stod(argv[3]);
  const Timer timer;
  Punch punch(static_cast<unsigned>(std::stoul(argv[1])));
  for (double before = 0, last = 0; before + (isLocal ? 2 : 5) * last < limit;) {
    punch.solve();
    const double now = timer.wall_time();
    std::cout << std::setprecision(15) << R"({"unknowns": )" << punch.unknowns() << R"(, "seconds": )" << now
              << R"(, "mesh_seconds": )" << now - before << R"(, "energy": )" << punch.energy()
              << R"(, "iterations": )" << punch.steps() << R"(, "closed": )" << punch.closed() << "}"
              << std::endl;
    last = now - before;
    before = now;
    punch.refine(isLocal);
  }
}
