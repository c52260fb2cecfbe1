#pragma once

/// Whole runs for the system tests, and what they are compared with.

#include "OneRank.hpp"
#include "epafi/simulation/SceneRun.hpp"

#include "epafi/base/Types.hpp"
#include "epafi/scene/Scene.hpp"

#include <Eigen/Core>
#include <Teuchos_Comm.hpp>

#include <map>
#include <string>
#include <vector>

namespace epafi::test {

/// One line of a CSV file by the names of its columns.
using Row = std::map<std::string, std::string>;

/// Rows of test/reference/<name>.
std::vector<Row> referenceRows(const std::string& name);
double number(const Row& row, const std::string& column);

/// Cuts every body of the scene alike.
scene::Scene cutInGrid(scene::Scene scene, int counts);
scene::Scene cutByMetis(scene::Scene scene, int parts);

/// Solves the scene to a relative tolerance (that of the equilibrium too). Collective over `comm`.
/// \param solver  what else the solver is told
simulation::SceneRun solve(const scene::Scene& scene, double tolerance, const RCP<const Comm>& comm,
                           Teuchos::ParameterList solver = Teuchos::ParameterList());
/// Over all ranks.
simulation::SceneRun solve(const scene::Scene& scene, double tolerance);

/// u at the nodes of a body, component by component, each node once, in the order of its mesh, on every rank.
/// Collective.
Eigen::VectorXd deflection(const simulation::SceneRun& run, int body);

} // namespace epafi::test
