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

  /// Notes what is not printed.
  void checkPrints();
  /// Materials, sections, and what is reduced.
  void addBodies();
  /// Supports, forces, pressures and temperatures, and the steps where there are several.
  void addSteps();
  /// Equations of the deck, and those of nodes that bodies share.
  void addEquations();
  /// Contact pairs and ties, and what changes of them with the steps.
  void addContacts();
  /// Bolts; before equations, which join what they do not.
  void addPretensions();
  [[nodiscard]] DeckModel take() { return std::move(model_); }

private:
  using Numbers = std::vector<GlobalOrdinal>;
  /// What a step says of a displacement.
  struct Hold {
    bool isHeld = false, isFixed = false; ///< at the value; where it is
    double value = 0;
    auto operator<=>(const Hold& other) const = default;
  };
  /// By node and component (0 to 2): of each step.
  using Prescribed = std::map<std::pair<GlobalOrdinal, int>, std::vector<Hold>>;

  // DeckModel.cpp
  [[nodiscard]] Teuchos::ParameterList& listOf(int body);
  void addMaterial(Teuchos::ParameterList& list, const Section& section, int body);
  /// Name of a group of nodes or elements of the mesh that has these; equal ones have one name.
  std::string nodesNamed(const std::string& name, Numbers nodes);
  std::string elementsNamed(const std::string& name, Numbers elements);
  /// The same of faces on a body's surface, if nodes are all of some; finer meshes have those, too.
  std::string placeNamed(int body, const std::string& name, const Numbers& nodes);

  // ModelLoads.cpp
  [[nodiscard]] double factorAt(const std::string& amplitude, double delay, std::size_t step) const;
  [[nodiscard]] Prescribed prescribed() const;
  void addSupports();
  void addForces(std::size_t step);
  struct SpreadForce {
    Eigen::Vector3d force{0, 0, 0}, moment{0, 0, 0};
  };
  using NodeForces = std::map<GlobalOrdinal, Eigen::Vector3d>;
  void shareOut(const std::map<const Coupling*, SpreadForce>& spread, std::size_t step, NodeForces& forces);
  void addSpreadForce(const Coupling& coupling, const SpreadForce& spread, std::size_t step);
  void addPressures(std::size_t step);
  void addBodyForces(std::size_t step);
  Teuchos::ParameterList& addLoad(int body, std::size_t step, const std::string& kind);

  // ModelTemperatures.cpp
  using Temperatures = std::map<GlobalOrdinal, double>;
  [[nodiscard]] Temperatures initialTemperatures() const;
  /// At the end of a step, of the nodes of which anything is said.
  [[nodiscard]] Temperatures temperaturesAt(std::size_t step) const;
  /// All that nodes of a body have in any step.
  [[nodiscard]] std::set<double> temperaturesIn(int body) const;
  [[nodiscard]] std::vector<const Material*> materialsOf(int body) const;
  /// Those of elasticity; if they depend on it at the one temperature of the body's nodes, or else as
  /// addStiffnessFactors() wants them.
  [[nodiscard]] std::vector<double> constantsOf(const Material& material, int body) const;
  void addStiffnessFactors(int body);
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
  using Face = std::pair<GlobalOrdinal, int>; ///< of an element, S1 being 1
  [[nodiscard]] Eigen::Vector3d areaVectorOf(const Face& face) const;
  [[nodiscard]] std::vector<Face> facesAt(const Surface& surface, const std::string& name,
                                          const Eigen::Vector3d& against) const;
  [[nodiscard]] std::set<int> bodiesAt(const std::string& surface, const Surface* facing);
  [[nodiscard]] double typicalSize(const std::string& surface) const;
  [[nodiscard]] bool hasNodesOf(const std::string& set, const std::string& surface) const;
  [[nodiscard]] std::vector<std::string> addPairs(const std::string& name, const std::string& dependent,
                                                  const std::string& independent, const Place& place);
  void addContactPair(const ContactPair& pair);
  void changeFriction();
  void changePairs();

  // ModelPretensions.cpp
  /// Where a bolt is cut.
  struct Cut {
    int first = 0, second = 0; ///< bodies
    std::set<GlobalOrdinal> nodes;
  };
  [[nodiscard]] Cut cutAt(const Pretension& pretension) const;

  const Deck& deck_;
  std::string mesh_;
  DeckBodies bodies_;
  DeckModel model_;
  std::map<Numbers, std::string> nodeNames_, elementNames_;
  std::map<std::vector<std::pair<GlobalOrdinal, int>>, std::string> faceNames_;
  std::map<GlobalOrdinal, int> transformOf_; ///< place in Deck::transforms
  /// Of each step the factors of loads and supports, "body/load = 1, …".
  std::vector<std::string> loadFactors_, supportFactors_;
  std::map<std::string, std::vector<std::string>> contactsOf_; ///< their names, by interactions
  std::map<std::pair<std::string, std::string>, std::vector<std::string>> contactsBetween_; ///< by surfaces
  std::map<GlobalOrdinal, std::vector<double>> tensions_; ///< of nodes of bolts, at each step
  std::vector<Cut> cuts_;
};

} // namespace epafi::deck
