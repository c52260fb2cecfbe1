#include "LinearSamples.hpp"

#include "epafi/base/Collective.hpp"
#include "epafi/base/Compatibility.hpp"

#include <Tpetra_Vector.hpp>

#include <algorithm>

namespace epafi::linear {
namespace {

/// The numbers of a map on every rank, ascending. Collective.
std::vector<GlobalOrdinal> numbersOf(const Map& map) {
  const auto mine = localIndices(map);
  const std::vector<double> all = gatherOnAll(*map.getComm(), std::vector<double>(mine.begin(), mine.end()));
  std::vector<GlobalOrdinal> numbers;
  for (const double number : all)
    numbers.push_back(static_cast<GlobalOrdinal>(number));
  std::sort(numbers.begin(), numbers.end());
  return numbers;
}

Eigen::Index placeOf(const std::vector<GlobalOrdinal>& numbers, GlobalOrdinal number) {
  return std::lower_bound(numbers.begin(), numbers.end(), number) - numbers.begin();
}

} // namespace

Eigen::MatrixXd denseOf(const MultiVector& x) {
  const std::vector<GlobalOrdinal> numbers = numbersOf(*x.getMap());
  Eigen::MatrixXd dense = Eigen::MatrixXd::Zero(static_cast<Eigen::Index>(numbers.size()),
                                                static_cast<Eigen::Index>(x.getNumVectors()));
  for (Eigen::Index j = 0; j < dense.cols(); ++j) {
    const auto values = x.getData(static_cast<std::size_t>(j));
    for (Teuchos_Ordinal i = 0; i < values.size(); ++i)
      dense(placeOf(numbers, x.getMap()->getGlobalElement(static_cast<LocalOrdinal>(i))), j) = values[i];
  }
  sumOverRanks(*x.getMap()->getComm(), {dense.data(), static_cast<std::size_t>(dense.size())});
  return dense;
}

RCP<MultiVector> spreadOn(const RCP<const Map>& map, const Eigen::MatrixXd& values) {
  const std::vector<GlobalOrdinal> numbers = numbersOf(*map);
  const RCP<MultiVector> x = rcp(new MultiVector(map, static_cast<std::size_t>(values.cols())));
  for (Eigen::Index j = 0; j < values.cols(); ++j) {
    const auto local = x->getDataNonConst(static_cast<std::size_t>(j));
    for (Teuchos_Ordinal i = 0; i < local.size(); ++i)
      local[i] = values(placeOf(numbers, map->getGlobalElement(static_cast<LocalOrdinal>(i))), j);
  }
  return x;
}

Eigen::MatrixXd denseOf(const Operator& a) {
  const Eigen::Index n = a.getDomainMap()->getGlobalNumElements();
  MultiVector image(a.getRangeMap(), static_cast<std::size_t>(n));
  a.apply(*spreadOn(a.getDomainMap(), Eigen::MatrixXd::Identity(n, n)), image);
  return denseOf(image);
}

} // namespace epafi::linear
