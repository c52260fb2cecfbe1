#include "epafi/output/FrdFile.hpp"

#include "epafi/base/Collective.hpp"
#include "epafi/base/Errors.hpp"
#include "epafi/output/BodyFields.hpp"
#include "epafi/output/ContactValues.hpp"
#include "epafi/output/FrdRecords.hpp"
#include "epafi/simulation/SupportResults.hpp"

#include <algorithm>
#include <array>
#include <map>
#include <span>

namespace epafi::output {
namespace {

/// What rank 0 has of a body.
struct WholeBody {
  std::string name;
  mesh::CellType cellType;        ///< of the largest elements
  std::vector<double> points;     ///< 3 a node
  std::vector<double> u;          ///< components a node
  std::vector<long long> corners; ///< of the elements, in rows (mesh/Cell.hpp)
  std::vector<fem::SymmetricTensor> stresses, strains;
  std::vector<Vector3> forces;

  [[nodiscard]] GlobalOrdinal numNodes() const { return std::ssize(points) / 3; }
  [[nodiscard]] GlobalOrdinal numElements() const { return std::ssize(corners) / numNodesOf(cellType); }
};

/// Collective.
std::vector<WholeBody> gatherBodies(const simulation::SolvedScene& solved) {
  std::vector<WholeBody> bodies;
  for (int b = 0; b < std::ssize(solved.decomposition.bodies); ++b) {
    const BodyFields fields = gatherBodyFields(solved, b);
    bodies.push_back({solved.decomposition.bodies[b].name, fields.cellType,
                      gatherOnFirst(solved.comm(), fields.points), gatherOnFirst(solved.comm(), fields.u),
                      gatherOnFirst(solved.comm(), fields.corners),
                      gatherOnFirst(solved.comm(), simulation::stressesAtNodes(solved, b)),
                      gatherOnFirst(solved.comm(), simulation::strainsAtNodes(solved, b)),
                      gatherOnFirst(solved.comm(), simulation::supportForcesAtNodes(solved, b))});
  }
  return bodies;
}

/// What the file calls nodes and elements.
class Numbers {
public:
  Numbers(const FrdNumbering& given, const std::vector<WholeBody>& bodies) : given_(given) {
    for (const WholeBody& body : bodies) {
      firstNodes_.push_back(numNodes_ + 1);
      firstElements_.push_back(numElements_ + 1);
      numNodes_ += body.numNodes();
      numElements_ += body.numElements();
    }
  }
  [[nodiscard]] GlobalOrdinal numNodes() const { return numNodes_; }
  [[nodiscard]] GlobalOrdinal numElements() const { return numElements_; }
  [[nodiscard]] GlobalOrdinal node(int body, GlobalOrdinal index) const {
    return given_.node ? given_.node(body, index) : firstNodes_[body] + index;
  }
  [[nodiscard]] GlobalOrdinal element(int body, GlobalOrdinal index) const {
    return given_.element ? given_.element(body, index) : firstElements_[body] + index;
  }

private:
  const FrdNumbering& given_;
  std::vector<GlobalOrdinal> firstNodes_, firstElements_;
  GlobalOrdinal numNodes_ = 0, numElements_ = 0;
};

void putElements(std::string& text, const WholeBody& body, int number, const Numbers& numbers) {
  const std::size_t perElement = numNodesOf(body.cellType);
  std::vector<GlobalOrdinal> nodes;
  for (GlobalOrdinal e = 0; e < body.numElements(); ++e) {
    nodes.clear();
    for (const long long node :
         mesh::withoutFilling(std::span(body.corners).subspan(e * perElement, perElement)))
      nodes.push_back(numbers.node(number, node));
    putFrdElement(text, numbers.element(number, e), number + 1, cellOf(body.cellType, nodes.size()), nodes);
  }
}

void putMesh(std::string& text, const std::vector<WholeBody>& bodies, const Numbers& numbers) {
  std::vector<std::string> names;
  for (const WholeBody& body : bodies)
    names.push_back(body.name);
  putFrdStart(text, names);
  putFrdSize(text, "    2C", numbers.numNodes());
  for (int b = 0; b < std::ssize(bodies); ++b)
    for (GlobalOrdinal k = 0; k < bodies[b].numNodes(); ++k)
      putFrdNode(text, numbers.node(b, k), std::span(bodies[b].points).subspan(3 * k, 3));
  putFrdEnd(text);
  putFrdSize(text, "    3C", numbers.numElements());
  for (int b = 0; b < std::ssize(bodies); ++b)
    putElements(text, bodies[b], b, numbers);
  putFrdEnd(text);
}

/// By the nodes' numbers. \param values  of each contact
std::map<GlobalOrdinal, ContactValues> atNodes(const std::vector<contact::ContactLayout>& contacts,
                                               const std::vector<std::vector<ContactValues>>& values,
                                               const Numbers& numbers) {
  constexpr std::size_t pressure = 3;
  std::map<GlobalOrdinal, ContactValues> result;
  for (std::size_t c = 0; c < contacts.size(); ++c) {
    const std::vector<std::size_t> own = contacts[c].ownRows();
    for (std::size_t k = 0; k < own.size(); ++k) {
      const GlobalOrdinal node = numbers.node(contacts[c].firstBody, contacts[c].firstNodes[own[k]]);
      const auto [place, isNew] = result.try_emplace(node, values[c][k]);
      if (!isNew && values[c][k][pressure] > place->second[pressure])
        place->second = values[c][k];
    }
  }
  return result;
}

void putContacts(std::string& text, FrdPlace& place, const std::map<GlobalOrdinal, ContactValues>& atNodes) {
  ++place.block;
  putFrdHead(text, place, std::ssize(atNodes), frdContact);
  for (const auto& [node, values] : atNodes)
    putFrdNode(text, node, values);
  putFrdEnd(text);
}

/// A block at all nodes. \param valuesOf  (body, node in it): what the node has
template <class Values>
void putBlock(std::string& text, FrdPlace& place, const std::vector<WholeBody>& bodies,
              const Numbers& numbers, const char* kind, const Values& valuesOf) {
  ++place.block;
  putFrdHead(text, place, numbers.numNodes(), kind);
  for (int b = 0; b < std::ssize(bodies); ++b)
    for (GlobalOrdinal k = 0; k < bodies[b].numNodes(); ++k)
      putFrdNode(text, numbers.node(b, k), valuesOf(bodies[b], k));
  putFrdEnd(text);
}

} // namespace

void requireElasticBodies(const scene::Scene& scene, const std::string& asker) {
  for (const scene::Body& body : scene.bodies)
    if (body.physics == fem::Physics::membrane)
      throw InputError(asker + ": body \"" + body.name +
                       "\" is a membrane, of which CalculiX' format has none; take --output instead, whose "
                       "files have the deflection");
}

void FrdFile::add(const simulation::SolvedScene& solved, const simulation::Evaluation& evaluation,
                  const FieldStep& step) {
  const std::vector<WholeBody> bodies = gatherBodies(solved);
  const std::vector<contact::ContactLayout>& contacts = solved.decomposition.contacts;
  std::vector<std::vector<ContactValues>> contactValues;
  for (int c = 0; c < std::ssize(contacts); ++c) {
    contactValues.push_back(gatherContactValues(solved, c, evaluation.contacts[c]));
    slip_.enter(solved, c, contactValues.back());
  }
  collectively(solved.comm(), [&] {
    if (solved.comm().getRank() > 0)
      return;
    const Numbers numbers(numbering_, bodies);
    const int components = solved.decomposition.problem.components;
    std::string text;
    if (text_.empty())
      putMesh(text, bodies, numbers);
    FrdPlace place{numBlocks_, numSteps_ + 1, step.number, step.name};
    putBlock(text, place, bodies, numbers, frdDisplacement, [&](const WholeBody& body, GlobalOrdinal node) {
      std::array<double, 3> u{};
      std::copy_n(body.u.begin() + node * components, components, u.begin());
      return u;
    });
    putBlock(text, place, bodies, numbers, frdStress,
             [](const WholeBody& body, GlobalOrdinal node) { return body.stresses[node]; });
    putBlock(text, place, bodies, numbers, frdStrain,
             [](const WholeBody& body, GlobalOrdinal node) { return body.strains[node]; });
    putBlock(text, place, bodies, numbers, frdForce,
             [](const WholeBody& body, GlobalOrdinal node) { return body.forces[node]; });
    if (!contacts.empty())
      putContacts(text, place, atNodes(contacts, contactValues, numbers));
    text_ += text;
    numBlocks_ = place.block;
    ++numSteps_;
  });
}

} // namespace epafi::output
