#include "epafi/base/Errors.hpp"
#include "epafi/base/ParameterValue.hpp"
#include "epafi/deck/ModelMaker.hpp"

#include <Eigen/Geometry>

#include <algorithm>
#include <functional>

namespace epafi::deck {

const Point& ModelMaker::pointOf(GlobalOrdinal node) const {
  const Numbers& numbers = deck_.nodes.numbers;
  return deck_.nodes.points[std::lower_bound(numbers.begin(), numbers.end(), node) - numbers.begin()];
}

Eigen::Matrix3d ModelMaker::axesOf(GlobalOrdinal node) const {
  const auto found = transformOf_.find(node);
  if (found == transformOf_.end())
    return Eigen::Matrix3d::Identity();
  using Eigen::Vector3d;
  const Transform& transform = deck_.transforms[found->second];
  const Vector3d a = Eigen::Map<const Vector3d>(transform.a.data()),
                 b = Eigen::Map<const Vector3d>(transform.b.data());
  Eigen::Matrix3d axes;
  if (!transform.isCylindrical) {
    const Vector3d third = a.cross(b).normalized();
    axes << a.normalized(), third.cross(a.normalized()), third;
    return axes;
  }
  const Vector3d along = (b - a).normalized(), away = Eigen::Map<const Vector3d>(pointOf(node).data()) - a;
  const Vector3d radius = (away - away.dot(along) * along).normalized();
  axes << radius, along.cross(radius), along;
  return axes;
}

/// "0.5 body 1/node 17/X, 0.5 body 1/node 17/Y".
std::string ModelMaker::term(int body, GlobalOrdinal node, const Eigen::Vector3d& direction) {
  std::string terms;
  const std::string nodes = nodesNamed("node " + std::to_string(node), {node});
  for (int c = 0; c < bodies_.all()[body].type->dimension; ++c)
    if (direction[c] != 0)
      terms += valueText(direction[c]) + ' ' + bodies_.all()[body].name + '/' + nodes + '/' + "XYZ"[c] + ", ";
  return terms;
}

void ModelMaker::addEquation(const std::string& name, const std::string& terms, double value) {
  Teuchos::ParameterList& equation = model_.scene.sublist("Equations").sublist(name);
  equation.set("Terms", terms);
  if (value != 0)
    equation.set("Value", value);
}

void ModelMaker::addEquations() {
  const Prescribed held = deck_.equations.empty() ? Prescribed() : prescribed();
  int number = 0;
  for (const Equation& equation : deck_.equations) {
    std::string terms;
    double value = 0;
    for (const Equation::Term& each : equation.terms) {
      if (const std::vector<int>& bodies = bodies_.ofNode(each.node); !bodies.empty()) {
        terms += term(bodies.front(), each.node, each.factor * axesOf(each.node).col(each.component - 1));
        continue;
      }
      const auto known = held.find({each.node, each.component - 1}); // a node that stands for a number
      const auto changes = [](const std::vector<Hold>& holds) {
        return std::any_of(holds.begin(), holds.end(), [&](const Hold& hold) {
          return !hold.isHeld || hold.isFixed || hold != holds.front();
        });
      };
      if (known == held.end() || changes(known->second))
        throw InputError(text(equation.place) + ": *EQUATION: node " + std::to_string(each.node) +
                         " belongs to no element, and no *BOUNDARY holds it at one value");
      value -= each.factor * known->second.front().value;
    }
    if (!terms.empty())
      addEquation("equation " + std::to_string(++number), terms, value);
  }
  const auto isCut = [&](GlobalOrdinal node, int body, int other) {
    return std::any_of(cuts_.begin(), cuts_.end(), [&](const Cut& cut) {
      return std::minmax(cut.first, cut.second) == std::minmax(body, other) && cut.nodes.contains(node);
    });
  };
  for (const GlobalOrdinal node : deck_.nodes.numbers) { // bodies grow together where they share nodes
    const std::vector<int>& bodies = bodies_.ofNode(node);
    const Eigen::Matrix3d axes = bodies.size() > 1 ? axesOf(node) : Eigen::Matrix3d();
    for (std::size_t b = 1; b < bodies.size(); ++b)
      for (int c = 0; !isCut(node, bodies[b - 1], bodies[b]) && c < bodies_.all()[bodies[b]].type->dimension;
           ++c)
        addEquation("node " + std::to_string(node) + " of bodies " + std::to_string(bodies[b - 1] + 1) +
                        " and " + std::to_string(bodies[b] + 1) + ' ' + "XYZ"[c],
                    term(bodies[b - 1], node, axes.col(c)) + term(bodies[b], node, -axes.col(c)), 0);
  }
}

} // namespace epafi::deck
