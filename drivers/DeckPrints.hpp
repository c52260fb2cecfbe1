#pragma once

/// What a deck asks to be printed (*NODE PRINT, *CONTACT PRINT), in the words and columns of CalculiX (.dat).

#include "epafi/deck/DeckModel.hpp"
#include "epafi/simulation/SceneRun.hpp"

#include <array>
#include <map>
#include <string>
#include <vector>

namespace epafi::drivers {

/// The text of one file, on rank 0, one load step after the other: displacements (U), forces of supports (RF)
/// and their totals at the nodes of sets, in the axes of space, and forces of contacts (CF). Nodes that no
/// element has are left out; a node that several bodies share has the forces on all.
class DeckPrints {
public:
  /// \param scene  the deck's file; another scene's prints are empty. Reads on the rank that calls it.
  explicit DeckPrints(const std::string& scene);

  /// Adds what is asked for at the end of a step. \param step  from 0 on. Collective.
  void add(simulation::SceneRun& run, std::size_t step);
  [[nodiscard]] const std::string& text() const { return text_; }

private:
  struct NodeValues {
    std::array<double, 3> displacement{}, force{};
  };
  using Values = std::map<GlobalOrdinal, NodeValues>; ///< by the deck's numbers

  [[nodiscard]] Values valuesOf(const simulation::SolvedScene& solved) const;
  void addNodes(const deck::Print& print, const Values& values, const std::string& time);
  void addContacts(const deck::Print& print, const simulation::RunResult& result, const std::string& time);

  deck::Deck deck_;
  std::vector<std::vector<GlobalOrdinal>> nodeNumbers_; ///< of each body
  std::string text_;
};

} // namespace epafi::drivers
