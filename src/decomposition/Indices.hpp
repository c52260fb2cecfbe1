#pragma once

/// The index spaces of a decomposed problem. Functions name them in their parameters and structures in their
/// members, so that a number of one space is not handed over as one of another.

#include "epafi/base/Index.hpp"
#include "epafi/base/Types.hpp"

#include <Eigen/Core>

#include <cstddef>

/// matrix(row, column) takes them as the integers that they are.
template <class Space, class Integer>
struct Eigen::internal::is_valid_index_type<epafi::Index<Space, Integer>> {
  enum { value = 1 };
};

namespace epafi::decomposition {

/// A subdomain's number in the whole problem, and its place among those of this rank.
using SubdomainNumber = Index<struct SubdomainNumberSpace>;
using SubdomainPlace = Index<struct SubdomainPlaceSpace, std::size_t>;
/// A node's number among those of all bodies, and its place among those of its subdomain.
using NodeNumber = Index<struct NodeNumberSpace, GlobalOrdinal>;
using NodePlace = Index<struct NodePlaceSpace, std::size_t>;
/// An unknown of a subdomain, 0 … n_s − 1.
using Unknown = Index<struct UnknownSpace>;
/// A row of B: its number in the whole problem, and its local indices in multiplierMap and in
/// multiplierGhostMap.
using MultiplierNumber = Index<struct MultiplierNumberSpace, GlobalOrdinal>;
using OwnedMultiplier = Index<struct OwnedMultiplierSpace, LocalOrdinal>;
using TouchedMultiplier = Index<struct TouchedMultiplierSpace, LocalOrdinal>;
/// A coarse unknown: its number in the whole problem (crosspointMap), and its place among those of this
/// rank's subdomains.
using CoarseNumber = Index<struct CoarseNumberSpace, GlobalOrdinal>;
using CoarsePlace = Index<struct CoarsePlaceSpace>;

} // namespace epafi::decomposition
