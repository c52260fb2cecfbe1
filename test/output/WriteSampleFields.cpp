// Writes the sample run into the directory named by its argument, for tests that look at the files from
// outside; or, if a cell type is named too, the patch test of two elastic blocks of such cells.

#include "SampleRun.hpp"
#include "support/ElasticSample.hpp"

#include "epafi/ContactSolver.hpp"
#include "epafi/output/FieldWriter.hpp"
#include "epafi/output/Report.hpp"

#include <Tpetra_Core.hpp>

#include <algorithm>
#include <iostream>
#include <stdexcept>

namespace {

using namespace epafi;

void writeMembranes(const std::filesystem::path& directory, const RCP<const Comm>& comm) {
  using namespace output;
  const scene::Scene scene = test::sampleScene();
  const auto decomposition = model::decompose(scene, comm);
  const auto solution = test::sampleSolution(decomposition);
  const simulation::SolvedScene solved{scene, decomposition, solution};
  writeFields(directory, "run", solved, simulation::evaluate(solved), test::sampleHistory());
  writeHistory(test::sampleHistory(), directory / "history.csv", *comm);
}

void writeBlocks(const std::filesystem::path& directory, const std::string& cells,
                 const RCP<const Comm>& comm) {
  using namespace output;
  const auto kind = std::find_if(test::kinds().begin(), test::kinds().end(),
                                 [&](const test::Kind& k) { return mesh::toString(k.cell) == cells; });
  if (kind == test::kinds().end())
    throw std::invalid_argument("no cells are called " + cells);
  const test::TemporaryDirectory meshes(comm);
  const scene::Scene scene = test::stackedBlocks(*kind, 3, 3.0, meshes, *comm);
  const auto decomposition = model::decompose(scene, comm);
  ContactSolver solver{Teuchos::ParameterList()};
  solver.setup(decomposition.problem, decomposition.data);
  const auto solution = solver.solve(decomposition.data);
  const simulation::SolvedScene solved{scene, decomposition, solution};
  writeFields(directory, "run", solved, simulation::evaluate(solved), solver.report().history);
}

} // namespace

int main(int argc, char** argv) {
  const Tpetra::ScopeGuard scope(&argc, &argv);
  if (argc != 2 && argc != 3) {
    std::cerr << "usage: write_sample_fields DIRECTORY [CELLS]\n";
    return 2;
  }
  try {
    const auto comm = Tpetra::getDefaultComm();
    if (argc == 2)
      writeMembranes(argv[1], comm);
    else
      writeBlocks(argv[1], argv[2], comm);
  } catch (const std::exception& error) {
    std::cerr << error.what() << '\n';
    return 1;
  }
  return 0;
}
