#include "epafi/decomposition/ElementMatrices.hpp"

#include "epafi/base/Errors.hpp"

#include <string>
#include <utility>

namespace epafi::decomposition {

void ElementMatrices::add(int subdomain, const ElementMatrix& element, int body) {
  const Eigen::Index n = element.unknowns.size();
  if (element.stiffness.rows() != n || element.stiffness.cols() != n || element.load.size() != n ||
      element.coordinates.rows() != n || element.coordinates.cols() != dimension_)
    throw InputError(
        "an element of subdomain " + std::to_string(subdomain) + " with " + std::to_string(n) +
        " unknowns has a stiffness of " + std::to_string(element.stiffness.rows()) + " x " +
        std::to_string(element.stiffness.cols()) + ", a load of " + std::to_string(element.load.size()) +
        " and coordinates of " + std::to_string(element.coordinates.rows()) + " x " +
        std::to_string(element.coordinates.cols()) + " numbers; all must have a row an unknown.");
  const auto [found, isNew] = sums_.try_emplace(subdomain);
  Sum& sum = found->second;
  if (isNew)
    sum.body = body;
  if (sum.body != body)
    throw InputError("subdomain " + std::to_string(subdomain) + " has elements of the bodies " +
                     std::to_string(sum.body) + " and " + std::to_string(body) +
                     "; a subdomain belongs to one body.");
  std::vector<int> place;
  for (Eigen::Index i = 0; i < n; ++i) {
    const GlobalOrdinal unknown = element.unknowns[i];
    const auto [entry, isFirst] = sum.place.try_emplace(unknown, static_cast<int>(sum.unknowns.size()));
    place.push_back(entry->second);
    if (isFirst) {
      sum.unknowns.push_back(unknown);
      sum.load.push_back(0);
      for (Eigen::Index c = 0; c < dimension_; ++c)
        sum.coordinates.push_back(element.coordinates(i, c));
    }
    sum.load[place.back()] += element.load[i];
  }
  for (Eigen::Index j = 0; j < n; ++j)
    for (Eigen::Index i = 0; i < n; ++i)
      sum.entries.emplace_back(place[i], place[j], element.stiffness(i, j));
}

std::vector<SubdomainMatrix> ElementMatrices::take() {
  std::vector<SubdomainMatrix> result;
  for (auto& [subdomain, sum] : sums_) {
    SubdomainMatrix& matrix = result.emplace_back();
    const Eigen::Index n = sum.unknowns.size();
    matrix.body = sum.body;
    matrix.unknowns = std::move(sum.unknowns);
    matrix.stiffness.resize(n, n);
    matrix.stiffness.setFromTriplets(sum.entries.begin(), sum.entries.end());
    matrix.load = Eigen::Map<const Eigen::VectorXd>(sum.load.data(), n);
    matrix.coordinates =
        Eigen::Map<const Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>>(
            sum.coordinates.data(), n, dimension_);
    std::vector<Eigen::Triplet<double>>().swap(sum.entries);
  }
  sums_.clear();
  return result;
}

} // namespace epafi::decomposition
