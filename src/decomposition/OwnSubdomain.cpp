#include "epafi/decomposition/OwnSubdomain.hpp"

#include "epafi/base/SortUnique.hpp"

#include <algorithm>
#include <cmath>

namespace epafi::decomposition {
namespace {

Eigen::Index numFreeOf(const OwnSubdomain& own) {
  return own.row.size() - std::count(own.row.begin(), own.row.end(), -1);
}

} // namespace

OwnSubdomain takeSubdomain(SubdomainMatrix& matrix, int components, Subdomain& subdomain, SubdomainData& data,
                           NodalSubdomain& nodal) {
  OwnSubdomain own;
  subdomain.body = matrix.body;
  for (const GlobalOrdinal unknown : matrix.unknowns)
    subdomain.nodes.push_back(unknown / components);
  sortUnique(subdomain.nodes);

  const Eigen::Index n = matrix.unknowns.size();
  const Eigen::Index numPositions = subdomain.nodes.size() * components;
  std::vector<int> unknownAt(numPositions, -1); // of the application
  own.unknowns = matrix.unknowns;
  for (int i = 0; i < std::ssize(own.unknowns); ++i) {
    const auto node =
        std::lower_bound(subdomain.nodes.begin(), subdomain.nodes.end(), own.unknowns[i] / components) -
        subdomain.nodes.begin();
    own.position.push_back(static_cast<int>(node * components + own.unknowns[i] % components));
    unknownAt[own.position.back()] = i;
  }
  own.prescribed = Eigen::VectorXd::Zero(n);
  std::vector<char> isFree(own.unknowns.size(), 1);
  for (const auto& [unknown, value] : matrix.prescribed) {
    const std::size_t i = std::find(own.unknowns.begin(), own.unknowns.end(), unknown) - own.unknowns.begin();
    isFree[i] = 0;
    own.prescribed[i] = value;
  }
  own.row.assign(own.unknowns.size(), -1);
  nodal.unknownOf.assign(numPositions, -1);
  data.prescribed = Eigen::VectorXd::Zero(numPositions);
  for (int position = 0; position < numPositions; ++position) {
    const int i = unknownAt[position];
    if (i < 0)
      continue;
    if (isFree[i] == 0) {
      data.prescribed[position] = own.prescribed[i];
      continue;
    }
    own.row[i] = static_cast<int>(subdomain.unknownPosition.size());
    nodal.unknownOf[position] = own.row[i];
    subdomain.unknownPosition.push_back(position);
  }
  own.load = std::move(matrix.load);
  own.heldForce = matrix.stiffness * own.prescribed;
  refresh(own, data);
  return own;
}

SparseMatrix freeStiffness(const SparseMatrix& stiffness, const OwnSubdomain& own) {
  std::vector<Eigen::Triplet<double>> entries;
  entries.reserve(stiffness.nonZeros());
  for (int column = 0; column < stiffness.outerSize(); ++column)
    for (SparseMatrix::InnerIterator entry(stiffness, column); entry; ++entry) {
      const int i = own.row[entry.row()], j = own.row[column];
      if (i >= 0 && j >= 0) { // the mean of both triangles: symmetric to the last digit
        entries.emplace_back(i, j, 0.5 * entry.value());
        entries.emplace_back(j, i, 0.5 * entry.value());
      }
    }
  const Eigen::Index numFree = numFreeOf(own);
  SparseMatrix result(numFree, numFree);
  result.setFromTriplets(entries.begin(), entries.end());
  return result;
}

void refresh(const OwnSubdomain& own, SubdomainData& data) {
  const Eigen::Index numFree = numFreeOf(own);
  data.load.resize(numFree);
  data.reaction.resize(numFree);
  data.heldLoad = 0;
  for (std::size_t i = 0; i < own.row.size(); ++i)
    if (own.row[i] >= 0) {
      data.load[own.row[i]] = own.load[i];
      data.reaction[own.row[i]] = own.heldForce[i];
    } else {
      data.heldLoad += std::abs(own.load[i]);
    }
  data.heldWork = own.load.dot(own.prescribed);
  data.heldEnergy = 0.5 * own.heldForce.dot(own.prescribed);
}

} // namespace epafi::decomposition
