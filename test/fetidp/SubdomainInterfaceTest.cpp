#include "support/Preconditioned.hpp"

#include "epafi/base/Collective.hpp"
#include "epafi/base/SortUnique.hpp"
#include "epafi/fetidp/operator/SubdomainInterface.hpp"

#include <Teuchos_Comm.hpp>
#include <Tpetra_Map.hpp>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>

namespace epafi::fetidp {
namespace {

using decomposition::Subdomain;

/// All subdomains on every rank.
model::Decomposition plate() {
  return decompose(decomposition::oneBody(30, 30, grid(5, 5), {{"wall", "left", {0.0}}}), thisRankOnly());
}

/// Index of the group that a subdomain is in.
std::size_t groupOf(const std::vector<IdenticalSubdomains>& groups, std::size_t subdomain) {
  for (std::size_t g = 0; g < groups.size(); ++g)
    if (std::count(groups[g].members.begin(), groups[g].members.end(), subdomain) > 0)
      return g;
  ADD_FAILURE() << "subdomain " << subdomain << " is in no group";
  return groups.size();
}

TEST(SubdomainInterfaceTest, HoldsTheUnknownsThatConstraintsTouchRemaindersFirst) {
  for (const ContactCase& c : contactCases()) {
    SCOPED_TRACE(c.name);
    const auto decomposition = decompose(c.scene, world());
    for (const Subdomain& s : decomposition.problem.subdomains) {
      const SubdomainInterface interface = interfaceOf(s);
      std::vector<int> found, touched; // unknowns
      for (const int i : interface.boundary)
        found.push_back(s.remainderUnknowns.at(i));
      for (const int i : interface.crosspoints)
        found.push_back(s.crosspointUnknowns.at(i));
      EXPECT_TRUE(std::is_sorted(interface.boundary.begin(), interface.boundary.end()));
      EXPECT_TRUE(std::is_sorted(interface.crosspoints.begin(), interface.crosspoints.end()));
      ASSERT_EQ(interface.positionOf.size(), static_cast<std::size_t>(s.stiffness->rows()));
      for (std::size_t i = 0; i < found.size(); ++i)
        EXPECT_EQ(interface.positionOf[found[i]], static_cast<int>(i));
      for (const auto& entry : s.constraint)
        touched.push_back(entry.unknown);
      sortUnique(touched);
      std::sort(found.begin(), found.end());
      EXPECT_EQ(found, touched);
      EXPECT_EQ(interface.size(), touched.size());
      EXPECT_EQ(std::count(interface.positionOf.begin(), interface.positionOf.end(), -1),
                s.stiffness->rows() - static_cast<Eigen::Index>(touched.size()));
    }
  }
}

TEST(GroupIdenticalTest, TheInnerSubdomainsOfAUniformGridAreOneGroup) {
  const auto decomposition = plate();
  const auto groups = groupIdentical(decomposition.problem, true);

  // Nine that touch no edge; the edges and corners of the body differ in what is glued or supported, the
  // edges without their corners are alike.
  const std::vector<std::size_t> inner{6, 7, 8, 11, 12, 13, 16, 17, 18};
  EXPECT_EQ(groups[groupOf(groups, 12)].members, inner);
  EXPECT_EQ(groups.size(), 9U);
  for (const IdenticalSubdomains& group : groups)
    EXPECT_EQ(group.numOnAllRanks, static_cast<int>(group.members.size()));
}

TEST(GroupIdenticalTest, EverySubdomainIsInOneGroupAndLikeItsFirst) {
  for (const ContactCase& c : contactCases()) {
    SCOPED_TRACE(c.name);
    const auto decomposition = decompose(c.scene, world());
    const std::vector<Subdomain>& s = decomposition.problem.subdomains;
    std::vector<int> seen(s.size(), 0);
    std::size_t lastFirst = 0;
    for (const IdenticalSubdomains& group : groupIdentical(decomposition.problem, true)) {
      ASSERT_FALSE(group.members.empty());
      EXPECT_TRUE(std::is_sorted(group.members.begin(), group.members.end()));
      EXPECT_GE(group.members.front(), lastFirst); // groups stand in the order of their first members
      lastFirst = group.members.front();
      const Subdomain& first = s[group.members.front()];
      for (const std::size_t member : group.members) {
        ++seen[member];
        EXPECT_EQ(Eigen::MatrixXd(*s[member].stiffness), Eigen::MatrixXd(*first.stiffness));
        EXPECT_EQ(s[member].remainderUnknowns, first.remainderUnknowns);
        EXPECT_EQ(interfaceOf(s[member]).positionOf, interfaceOf(first).positionOf);
      }
    }
    EXPECT_EQ(std::count(seen.begin(), seen.end(), 1), static_cast<std::ptrdiff_t>(s.size()));
  }
}

/// Changes one of the nine inner subdomains; tells whether it is still among the others.
template <class Change>
bool staysInGroup(const Change& change) {
  auto decomposition = plate();
  change(decomposition.problem.subdomains[12]);
  const auto groups = groupIdentical(decomposition.problem, true);
  EXPECT_EQ(groupOf(groups, 6), groupOf(groups, 18));
  return groupOf(groups, 12) == groupOf(groups, 6);
}

TEST(GroupIdenticalTest, OneNumberOfTheStiffnessMakesADifference) {
  const Eigen::Index numEntries = plate().problem.subdomains[12].stiffness->nonZeros();
  for (Eigen::Index entry = 0; entry < numEntries; entry += 13)
    EXPECT_FALSE(staysInGroup([entry](Subdomain& s) {
      decomposition::changeStiffness(s, [entry](decomposition::SparseMatrix& k) {
        double& value = k.valuePtr()[entry];
        value = std::nextafter(value, 2 * value); // by the last bit
      });
    })) << entry;
}

TEST(GroupIdenticalTest, OneConstrainedUnknownMakesADifference) {
  EXPECT_FALSE(staysInGroup([](Subdomain& s) {
    const std::vector<int> positionOf = interfaceOf(s).positionOf;
    const auto untouched = std::find(positionOf.begin(), positionOf.end(), -1);
    s.constraint.push_back({0, static_cast<int>(untouched - positionOf.begin()), 1.0});
  }));
  EXPECT_FALSE(staysInGroup([](Subdomain& s) {
    const int first = s.constraint.front().unknown;
    std::erase_if(s.constraint, [first](const auto& entry) { return entry.unknown == first; });
  }));
}

TEST(GroupIdenticalTest, OneCrosspointMakesADifference) {
  EXPECT_FALSE(staysInGroup([](Subdomain& s) {
    s.remainderUnknowns.push_back(s.crosspointUnknowns.back());
    std::sort(s.remainderUnknowns.begin(), s.remainderUnknowns.end());
    s.crosspointUnknowns.pop_back();
    s.crosspointIndices.pop_back();
  }));
}

TEST(GroupIdenticalTest, WhatDoesNotEnterTheFactorsMayDiffer) {
  EXPECT_TRUE(staysInGroup([](Subdomain& s) {
    s.body = 1;
    for (auto& entry : s.constraint) {
      entry.coefficient *= -2;
      entry.multiplier = entry.multiplier + 1;
    }
    for (decomposition::CoarseNumber& index : s.crosspointIndices)
      index = index + 1;
  }));
}

TEST(GroupIdenticalTest, WithoutSharingEverySubdomainIsAGroupOfItsOwn) {
  const auto decomposition = plate();
  const auto groups = groupIdentical(decomposition.problem, false);
  ASSERT_EQ(groups.size(), 25U);
  for (std::size_t s = 0; s < groups.size(); ++s) {
    EXPECT_EQ(groups[s].members, std::vector<std::size_t>{s});
    EXPECT_FALSE(groups[s].isShared());
  }
}

/// Of every subdomain: whether it is shared, and whether its block is explicit by itself.
std::map<int, std::pair<bool, bool>> decisions(const scene::Scene& scene, const RCP<const Comm>& comm,
                                               int products) {
  const auto decomposition = decompose(scene, comm);
  GeneralizedInverse inverse(decomposition.problem, DirectSolvers());
  inverse.prepareDual({DualOperatorParameters::Mode::automatic, products});
  std::map<int, std::pair<bool, bool>> found;
  for (const SubdomainGroup& group : inverse.groups())
    for (const std::size_t member : group.members())
      found[decomposition.problem.subdomains[member].number] = {
          group.use() == direct::SymmetricBlock::Use::shared, group.isExplicit()};
  return found;
}

TEST(GroupIdenticalTest, WhoIsSharedAndWhoIsExplicitDoNotDependOnTheRanks) {
  int numShared = 0, numExplicit = 0, numAll = 0;
  for (const int perSide : {2, 4, 8})
    for (const int products : {4, 10, 40, 100}) {
      const scene::Scene scene = twoMembranes(false, 4 * perSide, grid(4, 4));
      const auto alone = decisions(scene, thisRankOnly(), products);
      for (const auto& [number, decision] : decisions(scene, world(), products)) {
        EXPECT_EQ(decision, alone.at(number))
            << "subdomain " << number << " of " << perSide << "² elements, " << products << " products";
        numShared += decision.first ? 1 : 0;
        numExplicit += decision.second ? 1 : 0;
        ++numAll;
      }
    }
  const Comm& comm = *world(); // both answers occur
  const double all = sumOverRanks(comm, static_cast<double>(numAll));
  for (const int number : {numShared, numExplicit}) {
    EXPECT_GT(sumOverRanks(comm, static_cast<double>(number)), 0);
    EXPECT_LT(sumOverRanks(comm, static_cast<double>(number)), all);
  }
}

} // namespace
} // namespace epafi::fetidp
