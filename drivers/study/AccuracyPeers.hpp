#pragma once

/// Rows of other solvers in the accuracy study, from what `drivers/compare/peers` has measured.

#include "AccuracyReference.hpp"
#include "AccuracyTable.hpp"

#include <filesystem>
#include <vector>

namespace epafi::drivers {

/// Of problems of order 1 the contact solvers of DIR/peers.csv and DIR/peers/*/peers.csv that ran on a mesh
/// of the problem's ladder; none where there is no such file. They solve the same discrete problem, so that
/// their discretisation error is that of the mesh; the algebraic one follows from the energy, ½‖u − u_h‖² ≤
/// E(u) − E(u_h) for feasible u, and E(u_h) = −½‖u_h‖² without gaps. Their times leave out the assembly.
/// \throws InputError if a file is no table of peers
std::vector<Row> peerRows(const std::filesystem::path& directory, const AccuracyProblem& problem,
                          const AccuracyReference& reference);

} // namespace epafi::drivers
