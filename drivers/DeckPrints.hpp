#pragma once

/// What a deck asks to be printed (*NODE PRINT, *EL PRINT, *CONTACT PRINT, *SECTION PRINT), in the words and
/// columns of CalculiX (.dat).

#include "epafi/deck/DeckBodies.hpp"
#include "epafi/deck/DeckModel.hpp"
#include "epafi/output/ContactValues.hpp"
#include "epafi/output/ElementPoints.hpp"
#include "epafi/simulation/SceneRun.hpp"
#include "epafi/simulation/SectionForces.hpp"

#include <array>
#include <map>
#include <string>
#include <vector>

namespace epafi::drivers {

/// The text of one file, on rank 0, one load step after the other, in the axes of space: displacements (U),
/// forces of supports (RF) and their totals at the nodes of sets; stresses, strains and energy (S, E, ME,
/// ENER) of solids at the points by which elements are integrated; gaps and slips (CDIS), pressures and
/// tractions (CSTR) at the nodes in contact, and forces (CF) of contacts; forces through sections of solids.
/// Nodes that no element has are left out; a node that several bodies share has the forces on all.
class DeckPrints {
public:
  /// \param scene  the deck's file; another scene's prints are empty. Reads on the rank that calls it.
  /// \param slip  of load steps before (StepsDone::slip)
  explicit DeckPrints(const std::string& scene, const std::vector<simulation::NodeSlip>& slip = {});

  /// Adds what is asked for at the end of a step. \param step  from 0 on. Collective.
  void add(simulation::SceneRun& run, std::size_t step);
  [[nodiscard]] const std::string& text() const { return text_; }

private:
  struct NodeValues {
    std::array<double, 3> displacement{}, force{};
  };
  /// By the deck's numbers.
  using Nodes = std::map<GlobalOrdinal, NodeValues>;
  using Points = std::map<GlobalOrdinal, std::vector<fem::PointState>>;
  using Contacts = std::vector<std::map<GlobalOrdinal, output::ContactValues>>;
  /// What rank 0 has of a step.
  struct Values {
    std::string time;
    Nodes nodes;
    Points points;
    Contacts contacts;
    std::vector<simulation::SectionForce> sections; ///< of the prints of sections, in their order
  };

  [[nodiscard]] std::vector<deck::Print> printsOf(std::size_t step) const;
  [[nodiscard]] Values valuesOf(simulation::SceneRun& run, const std::vector<deck::Print>& prints);
  [[nodiscard]] Nodes nodesOf(const simulation::SolvedScene& solved) const;
  [[nodiscard]] Points pointsOf(const simulation::SolvedScene& solved) const;
  [[nodiscard]] Contacts contactsOf(const simulation::SceneRun& run);
  [[nodiscard]] std::vector<simulation::SectionForce>
  sectionsOf(const simulation::SolvedScene& solved, const std::vector<deck::Print>& prints) const;

  void addNodes(const deck::Print& print, const Values& values);
  void addElements(const deck::Print& print, const Values& values);
  void addContacts(const deck::Print& print, const simulation::SceneRun& run, const Values& values);
  void addContactForces(const deck::ContactPair& pair, const simulation::RunResult& result,
                        const std::string& time);
  void addContactNodes(const deck::ContactPair& pair, const std::string& field,
                       const simulation::SceneRun& run, const Values& values);
  void addSection(const deck::Print& print, const simulation::SectionForce& through, const std::string& time);

  deck::Deck deck_;
  std::vector<std::vector<GlobalOrdinal>> nodeNumbers_, elementNumbers_; ///< of each body
  output::TotalSlip slip_;
  std::string text_;
};

} // namespace epafi::drivers
