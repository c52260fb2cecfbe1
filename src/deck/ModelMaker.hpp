#pragma once

/// What the parts of a DeckModel are made with.

#include "epafi/deck/DeckBodies.hpp"
#include "epafi/deck/DeckModel.hpp"

#include <Eigen/Core>

#include <map>
#include <set>
#include <string>
#include <tuple>
#include <vector>

namespace epafi::deck {

/// A model in the making: keeps references to deck and bodies.
class ModelMaker {
public:
  ModelMaker(const Deck& deck, std::string mesh);

  /// Materials, sections, and what is reduced.
  void addBodies();
  /// Supports, forces, pressures and temperatures, and the steps where there are several.
  void addSteps();
  /// Equations of the deck, and those of nodes that bodies share.
  void addEquations();
  /// Contact pairs and ties, and what changes of them with the steps.
  void addContacts();
  [[nodiscard]] DeckModel take() { return std::move(model_); }

private:
  using Numbers = std::vector<GlobalOrdinal>;
  /// By node and component (0 to 2): what each step prescribes.
  using Prescribed = std::map<std::pair<GlobalOrdinal, int>, std::vector<double>>;

  // DeckModel.cpp
  [[nodiscard]] Teuchos::ParameterList& listOf(int body);
  void addMaterial(Teuchos::ParameterList& list, const Section& section);
  /// Name of a group of nodes or elements of the mesh that has these; equal ones have one name.
  std::string nodesNamed(const std::string& name, Numbers nodes);
  std::string elementsNamed(const std::string& name, Numbers elements);

  // ModelLoads.cpp
  [[nodiscard]] double factorAt(const std::string& amplitude, double delay, std::size_t step) const;
  [[nodiscard]] Prescribed prescribed() const;
  void addSupports();
  void addForces(std::size_t step);
  void addPressures(std::size_t step);
  void addBodyForces(std::size_t step);
  Teuchos::ParameterList& addLoad(int body, std::size_t step, const std::string& kind);

  // ModelTemperatures.cpp
  using Temperatures = std::map<GlobalOrdinal, double>;
  [[nodiscard]] Temperatures initialTemperatures() const;
  /// At the end of a step, of the nodes of which anything is said.
  [[nodiscard]] Temperatures temperaturesAt(std::size_t step) const;
  /// Those of elasticity, at the one temperature of all nodes if they depend on it.
  [[nodiscard]] std::vector<double> constantsOf(const Material& material) const;
  void setExpansion(Teuchos::ParameterList& list, const Material& material) const;
  /// Changes of temperature at the nodes of a body that expands.
  [[nodiscard]] Temperatures changesOf(int body, const Temperatures& initial, const Temperatures& now) const;
  void addTemperatures(std::size_t step);

  // ModelEquations.cpp
  /// Axes of a node's displacements, columns; those of space where nothing transforms it.
  [[nodiscard]] Eigen::Matrix3d axesOf(GlobalOrdinal node) const;
  [[nodiscard]] const Point& pointOf(GlobalOrdinal node) const;
  std::string term(int body, GlobalOrdinal node, const Eigen::Vector3d& direction);
  void addEquation(const std::string& name, const std::string& terms, double value);

  // ModelContacts.cpp
  [[nodiscard]] std::vector<std::pair<GlobalOrdinal, int>> facesAt(const Surface& surface,
                                                                   const std::string& name) const;
  [[nodiscard]] std::set<int> bodiesAt(const std::string& surface);
  [[nodiscard]] double typicalSize(const std::string& surface) const;
  [[nodiscard]] bool hasNodesOf(const std::string& set, const std::string& surface) const;
  [[nodiscard]] std::vector<std::string> addPairs(const std::string& name, const std::string& dependent,
                                                  const std::string& independent, const Place& place);
  void addContactPair(const ContactPair& pair);
  void changeFriction();

  const Deck& deck_;
  std::string mesh_;
  DeckBodies bodies_;
  DeckModel model_;
  std::map<Numbers, std::string> nodeNames_, elementNames_;
  std::map<GlobalOrdinal, int> transformOf_; ///< place in Deck::transforms
  /// Of each step the factors of loads and supports, "body/load = 1, …".
  std::vector<std::string> loadFactors_, supportFactors_;
  std::map<std::string, std::vector<std::string>> contactsOf_; ///< their names, by interactions
};

} // namespace epafi::deck
