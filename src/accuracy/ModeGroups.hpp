#pragma once

/// Changes of the tractions between elements that keep each of them in balance, in groups: those of a *facet*
/// that have neither force nor moment, and in the plane those round a *node*, where one element hands the
/// same force or moment on to the next.

#include "epafi/accuracy/BoundCells.hpp"
#include "epafi/accuracy/BoundLoads.hpp"

#include <Eigen/Core>
#include <Tpetra_Export.hpp>

#include <array>
#include <memory>
#include <vector>

namespace epafi::accuracy {

class ModeGroups {
public:
  /// Keeps a reference to the cells. Collective.
  ModeGroups(const std::vector<std::unique_ptr<BoundCells>>& cells, const std::vector<BoundLoads>& loads,
             const RCP<const Comm>& comm);

  [[nodiscard]] Eigen::Index most() const { return most_; }           ///< modes of a group
  [[nodiscard]] std::size_t number() const { return groups_.size(); } ///< that own cells have
  [[nodiscard]] const Comm& comm() const { return *comm_; }
  /// Of an own cell: of its facets, then of its corners.
  [[nodiscard]] std::span<const std::size_t> of(std::size_t body, std::size_t place) const {
    return ofCells_[body][place];
  }
  /// Moments of all modes of an own cell, a column each, most() of each group, 0 of those that are not there.
  [[nodiscard]] Eigen::MatrixXd moments(std::size_t body, std::size_t place) const;
  /// Adds up over ranks what each has of a group, a column each. Collective.
  void sum(Eigen::MatrixXd& values) const;
  /// Of such columns. Collective.
  [[nodiscard]] double dot(const Eigen::MatrixXd& a, const Eigen::MatrixXd& b) const;

private:
  struct Group {
    GlobalOrdinal number = 0;     ///< in the whole problem
    GlobalOrdinal element = 0;    ///< the first of those that have it
    bool isShared = false;        ///< with another rank
    bool isOwned = true;          ///< by this rank, where it is shared
    std::array<bool, 3> isFree{}; ///< components in which tractions may change; round a node the modes
  };
  using OfCells = std::vector<std::vector<std::size_t>>;

  void findFacets(const BoundCells& cells, const BoundLoads& loads, GlobalOrdinal first, OfCells& own);
  void findNodes(const BoundCells& cells, const BoundLoads& loads, GlobalOrdinal first, OfCells& own);

  void addNodeModes(std::size_t body, std::size_t place, Eigen::MatrixXd& result) const;

  const std::vector<std::unique_ptr<BoundCells>>& cells_;
  RCP<const Comm> comm_;
  Eigen::Index most_ = 0;
  std::vector<Group> groups_;
  std::vector<OfCells> ofCells_;
  std::vector<std::size_t> shared_;
  RCP<const Map> here_, owned_;
  RCP<const Export> plan_;
};

} // namespace epafi::accuracy
