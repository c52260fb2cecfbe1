#pragma once

/// Sections of bolts: tied joints whose sides are moved against each other by one length.
///
/// With δ by how much a bolt is shortened and J_i by what row i of the joint, B_i u, changes as δ grows by 1,
/// Bu = Jδ. Of a given δ that is a joint with gaps. Of a given tension F one row p stands for the length,
/// δ = B_p u / J_p, so that B_i u − J_i/J_p B_p u = 0 for all others, and Fδ is the work of a load
/// B_pᵀ F/J_p: no further unknown is needed. The tension of a given δ is −Jᵀλ.

#include "epafi/contact/ContactLayout.hpp"
#include "epafi/contact/ContactMatrix.hpp"
#include "epafi/fem/BodyModel.hpp"
#include "epafi/scene/Scene.hpp"

#include <memory>
#include <string>
#include <vector>

namespace epafi::model {

/// A section, and its rows among equations.
struct PreloadSection {
  std::string name;
  int number = 0;                  ///< among Scene::contacts
  contact::Equation pilot;         ///< B_p of one row
  double pilotShare = 1;           ///< J_p
  std::vector<double> shares;      ///< J of the rows that are equations; those of a given tension: 0
  GlobalOrdinal firstEquation = 0; ///< their place among all equations
};

/// Appends the equations of a section, but for those that supports fix, and loads the bodies by its tension
/// if that is given. \throws InputError if its sides cannot be moved along its normal, SolvabilityError if
/// supports contradict it. Not collective (every rank finds the same).
/// \param layout  as of a tied joint
PreloadSection addSection(const scene::Scene& scene, const contact::ContactLayout& layout,
                          const std::vector<std::unique_ptr<fem::BodyModel>>& models,
                          std::vector<contact::Equation>& equations);

} // namespace epafi::model
