#pragma once

/// Scalar, ordinals, points and the Tpetra classes built on them, named once. Everything uses Tpetra's
/// default node.

#include <Teuchos_RCP.hpp>
#include <Tpetra_CrsMatrix_fwd.hpp>
#include <Tpetra_Details_DefaultTypes.hpp>
#include <Tpetra_Export_fwd.hpp>
#include <Tpetra_Import_fwd.hpp>
#include <Tpetra_Map_fwd.hpp>
#include <Tpetra_MultiVector_fwd.hpp>
#include <Tpetra_Operator_fwd.hpp>
#include <Tpetra_Vector_fwd.hpp>

#include <array>

namespace Teuchos {
template <typename Ordinal>
class Comm;
} // namespace Teuchos

namespace epafi {

using Scalar = double;
using LocalOrdinal = Tpetra::Details::DefaultTypes::local_ordinal_type;
using GlobalOrdinal = Tpetra::Details::DefaultTypes::global_ordinal_type;

using Comm = Teuchos::Comm<int>;
using Map = Tpetra::Map<>;
using Vector = Tpetra::Vector<Scalar>;
using MultiVector = Tpetra::MultiVector<Scalar>;
using Operator = Tpetra::Operator<Scalar>;
using CrsMatrix = Tpetra::CrsMatrix<Scalar>;
using Import = Tpetra::Import<>;
using Export = Tpetra::Export<>;

/// A point in the plane or in space; unused coordinates are 0.
using Point = std::array<double, 3>;
using Vector3 = std::array<double, 3>; ///< x, y, z of a direction, of a displacement or a force

using Teuchos::RCP;
using Teuchos::rcp;

} // namespace epafi
