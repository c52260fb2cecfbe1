#pragma once

/// Changes of the tractions on edges that keep each element in balance, up to three to a group: those of an
/// *edge* that have neither force nor moment, and those round a *node*, where one element hands the same
/// force or moment on to the next.

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
  static constexpr Eigen::Index most = 3; ///< modes of a group

  /// Keeps a reference to the cells. Collective.
  ModeGroups(const std::vector<std::unique_ptr<BoundCells>>& cells, const std::vector<BoundLoads>& loads,
             const RCP<const Comm>& comm);

  [[nodiscard]] std::size_t number() const { return groups_.size(); } ///< that own cells have
  [[nodiscard]] bool has(std::size_t group, Eigen::Index mode) const {
    return groups_[group].isThere.at(mode);
  }
  /// Of an own cell: of its edges, then of its corners.
  [[nodiscard]] std::span<const std::size_t> of(std::size_t body, std::size_t place) const {
    return ofCells_[body][place];
  }
  /// Moments of all modes of an own cell, a column each, 0 of those that are not there.
  [[nodiscard]] Eigen::MatrixXd moments(std::size_t body, std::size_t place) const;
  /// Adds up over ranks what each has of a group, a column each. Collective.
  void sum(Eigen::MatrixXd& values) const;
  /// Of such columns. Collective.
  [[nodiscard]] double dot(const Eigen::MatrixXd& a, const Eigen::MatrixXd& b) const;

private:
  struct Group {
    GlobalOrdinal number = 0; ///< in the whole problem
    bool isShared = false;    ///< with another rank
    bool isOwned = true;      ///< by this rank, where it is shared
    std::array<bool, most> isThere{};
  };
  using OfCells = std::vector<std::vector<std::size_t>>;

  void findEdges(const BoundCells& cells, const BoundLoads& loads, GlobalOrdinal first, OfCells& own);
  void findNodes(const BoundCells& cells, const BoundLoads& loads, GlobalOrdinal first, OfCells& own);

  const std::vector<std::unique_ptr<BoundCells>>& cells_;
  RCP<const Comm> comm_;
  std::array<Eigen::MatrixXd, 2> legendre_; ///< of each order
  std::vector<Group> groups_;
  std::vector<OfCells> ofCells_;
  std::vector<std::size_t> shared_;
  RCP<const Map> here_, owned_;
  RCP<const Export> plan_;
};

} // namespace epafi::accuracy
