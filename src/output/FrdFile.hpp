#pragma once

/// Results in the format of CalculiX (.frd, ASCII, long), which FreeCAD, PrePoMax and cgx read (Wittig,
/// *CalculiX USER'S MANUAL - CalculiX GraphiX*, Result Format).

#include "epafi/output/ContactValues.hpp"
#include "epafi/output/FieldWriter.hpp"

#include <functional>
#include <string>

namespace epafi::output {

/// Numbers in the file of the nodes and of the elements of a body, which counts both from 0: of models that
/// come from elsewhere those that they have there, all different, from 1 to 9 digits. Called on rank 0. Where
/// one is empty, all bodies' are counted from 1 on, one body after the other.
struct FrdNumbering {
  std::function<GlobalOrdinal(int body, GlobalOrdinal index)> node, element;
};

/// \throws InputError naming the first membrane: the format has no elements for a deflection across a plane.
/// \param asker  what the error begins with. Not collective.
void requireElasticBodies(const scene::Scene& scene, const std::string& asker);

/// The text of one file, on rank 0, which holds all of it: the nodes and elements of all bodies, and blocks
/// of results of one load step after the other:
/// - DISP, the displacement;
/// - STRESS and TOSTRAIN at the nodes (simulation::stressesAtNodes, strainsAtNodes);
/// - FORC, the forces of supports (simulation::supportForcesAtNodes);
/// - CONTACT, of scenes with contacts, at the nodes that have a row: COPEN, the gap that remains, CPRESS, the
///   pressure around the node, and, with friction, CSLIP and CSHEAR, by how much its side slips on the other
///   one and the force per area that it has on that, along CalculiX' tangents: x as the surface has it (z
///   where the surface is across x), and the other side's normal × that. A node of several contacts is in
///   that which presses most.
///
/// Elements with nodes inside faces or themselves (quadrilateral9, hexahedron27) are written without these,
/// of which the results know. A body's elements have its number as material, and its name stands in the head.
class FrdFile {
public:
  /// Empty. \param numbering  of all that is added  \param slip  of load steps before (StepsDone::slip)
  explicit FrdFile(FrdNumbering numbering = {}, const std::vector<simulation::NodeSlip>& slip = {})
      : numbering_(std::move(numbering)), slip_(slip) {}

  /// Adds results, and, before the first ones, the mesh.
  /// \param step  its number is the results' time
  /// Preconditions: all bodies are elastic and those of the first call; `evaluation` is that of `solved`.
  /// Collective. \throws Error, the same on all ranks, and nothing is added.
  void add(const simulation::SolvedScene& solved, const simulation::Evaluation& evaluation,
           const FieldStep& step = {});
  /// Complete; empty on other ranks than 0.
  [[nodiscard]] std::string text() const { return text_.empty() ? text_ : text_ + " 9999\n"; }

private:
  FrdNumbering numbering_;
  std::string text_;
  TotalSlip slip_;
  int numSteps_ = 0, numBlocks_ = 0; ///< so far
};

} // namespace epafi::output
