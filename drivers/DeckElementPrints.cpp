// What a deck asks to be printed of elements, contacts and sections.

#include "DeckPrints.hpp"
#include "PrintText.hpp"
#include "epafi/deck/DeckSections.hpp"

#include <Eigen/Geometry>

#include <algorithm>
#include <array>

namespace epafi::drivers {
namespace {

using Eigen::Vector3d;

/// CalculiX' order of components.
std::array<double, 6> printed(const fem::SymmetricTensor& tensor) {
  const auto& [xx, yy, zz, xy, yz, zx] = tensor;
  return {xx, yy, zz, xy, zx, yz};
}

/// ½σ:ε.
std::array<double, 1> energyOf(const fem::PointState& state) {
  double sum = 0;
  for (std::size_t c = 0; c < 6; ++c)
    sum += (c < 3 ? 0.5 : 1) * state.stress[c] * state.elasticStrain[c];
  return {sum};
}

} // namespace

void DeckPrints::addElements(const deck::Print& print, const Values& values) {
  if (values.points.empty())
    return;
  const auto addField = [&](const std::string& what, const auto& valuesAt) {
    text_ += printTitle(what + " for set " + print.set, values.time);
    for (const GlobalOrdinal number : deck_.elementSets.at(print.set))
      if (const auto element = values.points.find(number); element != values.points.end())
        for (std::size_t k = 0; k < element->second.size(); ++k)
          text_ += inWidth(number, 10) + inWidth(static_cast<GlobalOrdinal>(k) + 1, 4) +
                   inColumns(valuesAt(element->second[k])) + '\n';
  };
  using State = fem::PointState;
  const std::string place = " (elem, integ.pnt.,";
  for (const std::string& field : print.fields)
    if (field == "S")
      addField("stresses" + place + "sxx,syy,szz,sxy,sxz,syz)",
               [](const State& state) { return printed(state.stress); });
    else if (field == "E")
      addField("strains" + place + "exx,eyy,ezz,exy,exz,eyz)",
               [](const State& state) { return printed(state.strain); });
    else if (field == "ME")
      addField("mechanical strains" + place + "exx,eyy,ezz,exy,exz,eyz)",
               [](const State& state) { return printed(state.elasticStrain); });
    else
      addField("internal energy density" + place + "energy)", energyOf);
}

/// Bodies that have faces of both surfaces count together.
void DeckPrints::addContactForces(const deck::ContactPair& pair, const simulation::RunResult& result,
                                  const std::string& time) {
  const std::string name = pair.dependent + " - " + pair.independent;
  std::array<double, 3> total{};
  const auto add = [&](const auto& joints) {
    for (const auto& joint : joints)
      if (joint.name == name || joint.name.starts_with(name + ' '))
        for (std::size_t d = 0; d < 3; ++d)
          total[d] += joint.resultant[d];
  };
  add(result.contacts);
  add(result.ties);
  text_ +=
      printTitle("statistics for slave set " + pair.dependent + ", master set " + pair.independent, time) +
      "   total surface force (fx,fy,fz)\n\n  " + inColumns(total) + '\n';
}

/// Of nodes that are pressed.
void DeckPrints::addContactNodes(const deck::ContactPair& pair, const std::string& field,
                                 const simulation::SceneRun& run, const Values& values) {
  constexpr std::size_t pressure = 3;
  const std::string name = pair.dependent + " - " + pair.independent;
  for (std::size_t c = 0; c < values.contacts.size(); ++c) {
    const std::string& own = run.decomposition->contacts[c].name;
    if (own != name && !own.starts_with(name + ' '))
      continue;
    for (const auto& [node, contact] : values.contacts[c])
      if (contact[pressure] > 0)
        text_ += printedRow(node, std::span(contact).subspan(field == "CDIS" ? 0 : pressure, 3));
  }
}

void DeckPrints::addContacts(const deck::Print& print, const simulation::SceneRun& run,
                             const Values& values) {
  for (const std::string& field : print.fields) {
    if (field == "CDIS")
      text_ +=
          printTitle("relative contact displacement (slave node,normal,tang1,tang2) for all contact elements",
                     values.time);
    else if (field == "CSTR")
      text_ +=
          printTitle("contact stress (slave node,press,tang1,tang2) for all contact elements", values.time);
    for (const deck::ContactPair& pair : deck_.contacts) {
      if ((!print.dependent.empty() && print.dependent != pair.dependent) ||
          (!print.independent.empty() && print.independent != pair.independent))
        continue;
      if (field == "CF")
        addContactForces(pair, run.result, values.time);
      else
        addContactNodes(pair, field, run, values);
    }
  }
}

void DeckPrints::addSection(const deck::Print& print, const simulation::SectionForce& through,
                            const std::string& time) {
  const auto section = sectionAt(deck_, deck::DeckBodies(deck_), deck_.surfaces.at(print.set));
  if (!section || print.fields.empty())
    return;
  const Vector3d force = Vector3d::Map(through.force.data()), normal = section->normal,
                 moment = Vector3d::Map(through.moment.data()) - section->centre.cross(force);
  const double tension = force.dot(normal), torque = moment.dot(normal);
  const auto add = [&](const std::string& what, std::initializer_list<std::span<const double>> values) {
    text_ += "   " + what + "\n\n  ";
    for (const std::span<const double> own : values)
      text_ += inColumns(own);
    text_ += "\n\n";
  };
  const std::array sizes{section->area, tension, (force - tension * normal).norm(), torque,
                         (moment - torque * normal).norm()};
  text_ += printTitle("statistics for surface set " + print.set, time);
  add("total surface force (fx,fy,fz) and moment about the origin(mx,my,mz)",
      {through.force, through.moment});
  add("center of gravity and mean normal",
      {std::span(section->centre.data(), 3), std::span(normal.data(), 3)});
  add("moment about the center of gravity(mx,my,mz)", {std::span(moment.data(), 3)});
  add("area, normal force (+ = tension), shear force (size), torque and bending moment (size)", {sizes});
}

} // namespace epafi::drivers
