#include "Multigrid.hpp"

#include "epafi/base/Compatibility.hpp"

#include <MueLu_CreateTpetraPreconditioner.hpp>
#include <Teuchos_ParameterList.hpp>
#include <Tpetra_CrsMatrix.hpp>
#include <Tpetra_Import.hpp>
#include <Tpetra_Vector.hpp>

#include <string>
#include <vector>

namespace epafi::drivers {
namespace {

/// Chebyshev smoothing: symmetric and, unlike Gauss–Seidel, the same on any number of ranks. It amplifies
/// what lies above its bound of the largest eigenvalue, and the cycle would then be indefinite: 20 steps of
/// the power method, which come from below, and 20 % more are safe on all benchmarks.
void useChebyshev(Teuchos::ParameterList& list, const std::string& level, int degree, double ratio) {
  list.set(level + ": type", "CHEBYSHEV");
  Teuchos::ParameterList& parameters = list.sublist(level + ": params");
  parameters.set("chebyshev: degree", degree);
  parameters.set("chebyshev: ratio eigenvalue", ratio);
  parameters.set("chebyshev: eigenvalue max iterations", 20);
  parameters.set("chebyshev: boost factor", 1.2);
}

/// Chosen on the benchmarks of `epafi-study qp`. Couplings below 5 % of the diagonal are not aggregated
/// along: the journal bearing's elements are three times as high as wide. The coarsest problem is solved by
/// Chebyshev too: Amesos2's KLU2, the default, is wrong on more than one rank (Trilinos 13.2), and the cycle
/// unsymmetric.
Teuchos::ParameterList multigridParameters() {
  Teuchos::ParameterList list;
  list.set("verbosity", "none");
  list.set("problem: symmetric", true);
  list.set("aggregation: drop tol", 0.05);
  list.set("coarse: max size", 100);
  useChebyshev(list, "smoother", 4, 30);
  useChebyshev(list, "coarse", 10, 50);
  return list;
}

} // namespace

RCP<const Operator> makeMultigrid(const RCP<CrsMatrix>& a) {
  Teuchos::ParameterList list = multigridParameters();
  return MueLu::CreateTpetraPreconditioner<Scalar, LocalOrdinal, GlobalOrdinal, Vector::node_type>(a, list);
}

RCP<CrsMatrix> restrictedToFace(const CrsMatrix& a, const Vector& freeIndicator) {
  const RCP<const Map> rows = a.getRowMap(), columns = a.getColMap();
  RCP<const Vector> freeColumns = Teuchos::rcpFromRef(freeIndicator);
  if (const RCP<const Import> toColumns = a.getGraph()->getImporter(); !toColumns.is_null()) {
    const RCP<Vector> imported = rcp(new Vector(columns));
    imported->doImport(freeIndicator, *toColumns, Tpetra::INSERT);
    freeColumns = imported;
  }
  const auto freeRow = freeIndicator.getData();
  const auto freeColumn = freeColumns->getData();
  const RCP<CrsMatrix> face = rcp(new CrsMatrix(rows, columns, a.getGlobalMaxNumRowEntries()));
  std::vector<LocalOrdinal> kept;
  std::vector<Scalar> values;
  CrsMatrix::local_inds_host_view_type indices;
  CrsMatrix::values_host_view_type entries;
  for (LocalOrdinal row = 0; row < static_cast<LocalOrdinal>(numLocal(*rows)); ++row) {
    const LocalOrdinal diagonal = columns->getLocalElement(rows->getGlobalElement(row));
    a.getLocalRowView(row, indices, entries);
    kept.clear();
    values.clear();
    for (std::size_t k = 0; k < indices.extent(0); ++k)
      if (indices[k] == diagonal || (freeRow[row] != 0 && freeColumn[indices[k]] != 0)) {
        kept.push_back(indices[k]);
        values.push_back(entries[k]);
      }
    face->insertLocalValues(row, static_cast<LocalOrdinal>(kept.size()), values.data(), kept.data());
  }
  face->fillComplete(a.getDomainMap(), a.getRangeMap());
  return face;
}

RCP<const Operator> makeFaceMultigrid(const RCP<CrsMatrix>& a, const Vector& freeIndicator) {
  if (freeIndicator.normInf() == 0)
    return Teuchos::null;
  return makeMultigrid(restrictedToFace(*a, freeIndicator));
}

} // namespace epafi::drivers
