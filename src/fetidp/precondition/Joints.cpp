#include "epafi/fetidp/precondition/Joints.hpp"

#include "epafi/base/Collective.hpp"
#include "epafi/base/Compatibility.hpp"

#include <Tpetra_Import.hpp>
#include <Tpetra_Map.hpp>
#include <Tpetra_Vector.hpp>

#include <algorithm>
#include <limits>
#include <map>
#include <numeric>
#include <utility>

namespace epafi::fetidp {
namespace {

using decomposition::DecomposedProblem;
using decomposition::Subdomain;
using decomposition::SubdomainNumber;
using decomposition::Unknown;

using IntVector = Tpetra::Vector<int>;

/// values = the largest that any rank has at each row, everywhere; values ≥ 0. Collective.
void maximiseOverRanks(const Import& plan, IntVector& values) {
  IntVector owned(plan.getSourceMap());
  owned.doExport(values, plan, Tpetra::ABSMAX);
  values.doImport(owned, plan, Tpetra::INSERT);
}

/// Numbers of the subdomains that touch each row of this rank, ascending, and behind them `numSubdomains`
/// where one does at a crosspoint value: the largest first, then the largest of the others, until none is
/// left. Collective.
std::vector<std::vector<int>> subdomainsOfRows(const DecomposedProblem& problem, const Import& plan) {
  IntVector largest(plan.getTargetMap()); // number + 1; 0 where there is none
  std::vector<std::vector<int>> subdomains(largest.getLocalLength());
  bool isAnyLeft = true;
  while (holdsAnywhere(*problem.comm, isAnyLeft)) {
    {
      const auto values = largest.getDataNonConst();
      std::fill(values.begin(), values.end(), 0);
      for (const Subdomain& subdomain : problem.subdomains) {
        const auto& crosspoints = subdomain.crosspointUnknowns; // ascending
        for (const auto& entry : subdomain.constraint) {
          const auto& found = subdomains[entry.multiplier];
          const bool isAtCrosspoint =
              std::binary_search(crosspoints.begin(), crosspoints.end(), entry.unknown);
          for (const SubdomainNumber number :
               {subdomain.number, SubdomainNumber(isAtCrosspoint ? problem.numSubdomains : -1)})
            if (found.empty() || number < found.front())
              values[entry.multiplier] = std::max(values[entry.multiplier], number + 1);
        }
      }
    }
    maximiseOverRanks(plan, largest);
    const auto values = largest.getData();
    isAnyLeft = false;
    for (std::size_t row = 0; row < subdomains.size(); ++row)
      if (const int number = values[row]; number > 0) {
        subdomains[row].insert(subdomains[row].begin(), number - 1);
        isAnyLeft = true;
      }
  }
  return subdomains;
}

/// The diagonal of K^s as it is for the values of nodes, n_s. Where unknowns are an average a and deviations,
/// the value of one node alone is a = 1/n and deviations of −1/n, its own being 1 − 1/n.
Eigen::VectorXd nodalDiagonal(const Subdomain& subdomain) {
  Eigen::VectorXd diagonal = subdomain.stiffness->diagonal();
  for (const decomposition::Average& average : subdomain.averages) {
    std::vector<int> unknowns = average.others;
    unknowns.push_back(average.carrier);
    const Eigen::Index n = unknowns.size();
    Eigen::MatrixXd block(n, n);
    for (Eigen::Index j = 0; j < n; ++j)
      for (Eigen::Index i = 0; i < n; ++i)
        block(i, j) = subdomain.stiffness->coeff(unknowns[i], unknowns[j]);
    for (Eigen::Index node = 0; node < n; ++node) {
      const double share = 1.0 / static_cast<double>(n);
      Eigen::VectorXd value = Eigen::VectorXd::Constant(n, -share);
      value[n - 1] = share;
      if (node + 1 < n)
        value[node] += 1;
      diagonal[unknowns[node]] = value.dot(block * value);
    }
  }
  return diagonal;
}

/// The carrier of the average that each unknown deviates from, or the unknown itself, n_s.
std::vector<Unknown> carriersOf(const Subdomain& subdomain) {
  std::vector<Unknown> carriers(subdomain.stiffness->rows());
  std::iota(carriers.begin(), carriers.end(), 0);
  for (const decomposition::Average& average : subdomain.averages)
    for (const int other : average.others)
      carriers[other] = average.carrier;
  return carriers;
}

} // namespace

std::vector<Joint> jointsOf(const DecomposedProblem& problem, const Import& plan, RowKind kind) {
  const std::vector<std::vector<int>> subdomains = subdomainsOfRows(problem, plan);
  const Map& ghosts = *plan.getTargetMap();
  std::map<std::vector<int>, std::vector<int>> rowsOf;
  for (int row = 0; row < std::ssize(subdomains); ++row)
    if (problem.kindOf(decomposition::TouchedMultiplier(row)) == kind && !subdomains[row].empty() &&
        subdomains[row].back() < problem.numSubdomains)
      rowsOf[subdomains[row]].push_back(row);
  const auto before = [&ghosts](int a, int b) {
    return ghosts.getGlobalElement(a) < ghosts.getGlobalElement(b);
  };
  std::vector<Joint> joints;
  for (auto& [numbers, rows] : rowsOf) {
    std::sort(rows.begin(), rows.end(), before);
    joints.push_back({numbers, std::move(rows)});
  }
  std::sort(joints.begin(), joints.end(),
            [&before](const Joint& a, const Joint& b) { return before(a.rows.front(), b.rows.front()); });
  return joints;
}

std::vector<bool> bodiesOfVaryingStiffness(const DecomposedProblem& problem, double ratio) {
  const std::size_t numBodies = problem.bodies.size();
  std::vector<double> largest(numBodies, 0.0),
      largestInverse(numBodies, 0.0); // of the largest of each subdomain
  for (const Subdomain& subdomain : problem.subdomains) {
    double most = 0;
    const Eigen::VectorXd diagonal = nodalDiagonal(subdomain);
    for (const auto& entry : subdomain.constraint)
      most = std::max(most, diagonal[entry.unknown]);
    const std::size_t body = subdomain.body;
    if (most > 0) {
      largest[body] = std::max(largest[body], most);
      largestInverse[body] = std::max(largestInverse[body], 1 / most);
    }
  }
  std::vector<bool> varies;
  for (std::size_t body = 0; body < numBodies; ++body)
    varies.push_back(maxOverRanks(*problem.comm, largest[body]) *
                         maxOverRanks(*problem.comm, largestInverse[body]) >
                     ratio);
  return varies;
}

std::vector<bool> stiffnessVaries(const DecomposedProblem& problem, const Import& plan,
                                  const std::vector<Joint>& joints, double ratio,
                                  const std::vector<bool>& always) {
  std::vector<int> jointOf(numLocal(*plan.getTargetMap()), -1); // of each row
  for (int j = 0; j < std::ssize(joints); ++j)
    for (const int row : joints[j].rows)
      jointOf[row] = j;
  IntVector varies(plan.getTargetMap()); // at the joint's first row
  for (const Subdomain& subdomain : problem.subdomains) {
    const Eigen::VectorXd diagonal = nodalDiagonal(subdomain);
    const std::vector<Unknown> carriers = carriersOf(subdomain);
    std::map<int, std::pair<double, double>> rangeAt; // least and largest at each of its joints
    for (const auto& entry : subdomain.constraint)
      if (const int j = jointOf[entry.multiplier]; j >= 0)
        for (const Unknown unknown : {entry.unknown, carriers[entry.unknown]}) {
          auto& [least, largest] =
              rangeAt.try_emplace(j, std::numeric_limits<double>::infinity(), 0.0).first->second;
          least = std::min(least, diagonal[unknown]);
          largest = std::max(largest, diagonal[unknown]);
        }
    const auto values = varies.getDataNonConst();
    const bool isAlways = !always.empty() && always[subdomain.body];
    for (const auto& [j, range] : rangeAt)
      if (range.second > ratio * range.first || (isAlways && range.second > 0))
        values[joints[j].rows.front()] = 1;
  }
  maximiseOverRanks(plan, varies);
  const auto values = varies.getData();
  std::vector<bool> result;
  for (const Joint& joint : joints)
    result.push_back(values[joint.rows.front()] > 0);
  return result;
}

} // namespace epafi::fetidp
