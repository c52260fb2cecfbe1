#pragma once

/// Mesh after mesh until an error is small enough: the loop, whoever meshes and solves.
///
///     class MyProblem : public accuracy::RefinableProblem { … };
///     MyProblem problem(…);
///     const accuracy::LoopResult result = accuracy::refineToTarget(problem, {.target = 0.01});
///     if (!result.isMet)
///       std::cerr << result.reason;

#include "epafi/accuracy/LocalOrders.hpp"
#include "epafi/accuracy/WantedSizes.hpp"
#include "epafi/base/Types.hpp"

#include <functional>
#include <limits>
#include <optional>
#include <string>
#include <vector>

namespace epafi::accuracy {

/// What is known of one mesh once it is solved on; the same on all ranks.
struct MeshResult {
  int order = 1;              ///< of the elements
  GlobalOrdinal unknowns = 0; ///< primal dimension
  int multiplications = 0;    ///< products with F
  double energyNorm = 0;      ///< of the solution
  /// Estimated error in the energy norm, of the mesh. The loop corrects it by the effectivity.
  double discretisation = 0;
  double algebraic = 0; ///< and of the iteration
  double seconds = 0;   ///< all that this mesh took, its making included
  double bytes = 0;     ///< most that all ranks together held so far; 0: not known
  /// A number that is asked for in place of the energy norm, and how far it may be off: by the mesh (the loop
  /// corrects it by the square of the effectivity), and by the iteration.
  struct Quantity {
    double value = 0, discretisation = 0, algebraic = 0;
    double width =
        0; ///< of what it looks at, where that shrinks with the mesh; 0: it looks at the same on all
  };
  std::optional<Quantity> quantity;
  double change = 0;      ///< ‖u − u of the last mesh‖ in the energy norm; 0: not known
  double effectivity = 1; ///< estimate by error, as the loop takes it to be
  std::string failure;    ///< why the mesh has no error to go by; empty if it has
  /// Of all bodies, their shares of the quantity's error for η²; the loop finds their orders, and keeps those
  /// of the last mesh alone
  ElementErrors elements;

  /// Both errors, relative to the energy norm of the exact solution, or to the quantity; infinite if this is
  /// 0.
  [[nodiscard]] double relative() const;
};

/// What can be solved, and refined.
class RefinableProblem {
public:
  virtual ~RefinableProblem() = default;
  [[nodiscard]] virtual int dimension() const = 0; ///< 2 or 3
  /// On the mesh as it is, with elements of an order, from the last solution if there is one. Collective.
  virtual MeshResult solve(int order) = 0;
  /// Estimate by error, as far as known beforehand, of elements of an order.
  [[nodiscard]] virtual double effectivity(int /*order*/) const { return 1; }
  /// What refine() is to do. Not collective.
  [[nodiscard]] virtual WantedSizes plan(const MeshResult& result, const RefinementGoal& goal) const {
    return wantedSizes(result.elements.squared, result.elements.orders, goal);
  }
  /// Makes the next mesh: elements in the order of `MeshResult::elements`, parts of a halving rounded as
  /// suits. Returns for each new element the old one that it, or its centre, lies in; nothing if sizes are
  /// the same everywhere. Collective.
  virtual std::vector<LocalOrdinal> refine(const WantedSizes& wanted) = 0;
};

/// Where to stop.
struct LoopGoal {
  double target = 0.01; ///< relative error in the energy norm, or of the quantity, > 0
  int maxMeshes = 20;
  double maxUnknowns = std::numeric_limits<double>::infinity();
  double maxSeconds = std::numeric_limits<double>::infinity(); ///< no mesh is begun that would be ready later
  double maxBytes = std::numeric_limits<double>::infinity();   ///< likewise, of memory
  int order = 0; ///< of the elements, 1 or 2; 0: whichever reaches the target with fewer unknowns
};

/// What came of it.
struct LoopResult {
  std::vector<MeshResult> meshes;
  bool isMet = false;
  bool isEndless = false; ///< whether a quantity was given up because it grows with every mesh
  std::string reason;     ///< if not: why no finer mesh was made
  std::string choice;     ///< why this order; empty if it was given
};

/// Solves and refines until the estimate is at most the target, or a limit is in the way. Each mesh tells how
/// good the estimates are: with errors e_k = η_k/θ and e_{k−1}² = e_k² + ‖u_k − u_{k−1}‖² (what refinement
/// adds is orthogonal to what is left, but for what contact changes), θ² = (η_{k−1}² − η_k²) / ‖u_k −
/// u_{k−1}‖²; estimates are divided by it, those of a quantity by θ², and these are no less than what its
/// last changes let expect, so that it takes two meshes of one order. A quantity that looks at less and less
/// is given up if it grows by the same power of that from mesh to mesh: it has no limit. With `order` = 0 the
/// first mesh is solved on with elements of order 1: if these meet the target there, or are expected to with
/// no more unknowns than order 2 has on the same mesh, they stay; else order 2 starts from their solution.
/// Collective.
/// \param tell  is told of every mesh; may be empty
/// \throws what the problem throws.
LoopResult refineToTarget(RefinableProblem& problem, const LoopGoal& goal,
                          const std::function<void(const MeshResult&)>& tell = {});

} // namespace epafi::accuracy
