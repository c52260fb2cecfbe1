#include "HeterogeneityStudy.hpp"

#include "HeterogeneityCase.hpp"
#include "HeterogeneousScenes.hpp"

#include "epafi/output/AtomicFile.hpp"

#include <Teuchos_Comm.hpp>

#include <functional>
#include <iomanip>
#include <iostream>
#include <sstream>
#include <vector>

namespace epafi::drivers {
namespace {

/// A series of runs over the jump.
struct Series {
  std::string bodies, pattern, cut;
  std::function<scene::Scene(double jump)> scene;
};

std::vector<Series> allSeries(bool quick) {
  const int cuts = quick ? 3 : 4;
  std::vector<Series> all;
  const auto add = [&](HeterogeneousScene what) {
    what.cuts = cuts;
    const bool isMembrane = what.bodies == Bodies::heldMembranes || what.bodies == Bodies::floatingMembrane;
    what.elements = quick ? 8 : isMembrane ? 16 : 12;
    all.push_back(
        {toString(what.bodies), toString(what.pattern), what.byMetis ? "METIS" : "grid", [what](double jump) {
           HeterogeneousScene scene = what;
           scene.jump = jump;
           return scene.build();
         }});
  };
  for (const Bodies bodies :
       {Bodies::heldMembranes, Bodies::floatingMembrane, Bodies::heldBlocks, Bodies::slidingBlock}) {
    for (const Pattern pattern :
         {Pattern::stripes, Pattern::checkerboard, Pattern::inclusions, Pattern::channels, Pattern::crossing})
      add({bodies, pattern});
    add({bodies, Pattern::channels, 1, cuts, 0, true});
  }
  all.push_back({"cubes in space", "columns", "grid",
                 [quick](double jump) { return cubesWithColumns(jump, quick ? 3 : 5); }});
  return all;
}

} // namespace

bool studyHeterogeneity(const std::filesystem::path& directory, bool quick, const RCP<const Comm>& comm) {
  const std::vector<double> jumps =
      quick ? std::vector<double>{1, 1e6} : std::vector<double>{1, 1e2, 1e4, 1e6};
  std::ostringstream csv;
  csv << "bodies,pattern,cut,jump,adaptive,constraints,hessian_multiplications,condition,smallest_eigenvalue,"
         "largest_eigenvalue,converged,energy,setup_seconds,solve_seconds\n";
  if (comm->getRank() == 0)
    std::cout << "| bodies | pattern | cut | jump | products without | κ | products | κ | constraints |\n"
                 "| --- | --- | --- | --- | --- | --- | --- | --- | --- |\n";
  bool allConverged = true;
  for (const Series& series : allSeries(quick))
    for (const double jump : jumps) {
      std::ostringstream line;
      line << std::setprecision(3) << "| " << series.bodies << " | " << series.pattern << " | " << series.cut
           << " | " << jump << " |";
      for (const char* use : {"no", "auto"}) {
        const HeterogeneityRun run = runHeterogeneous(series.scene(jump), use, comm);
        csv << series.bodies << ',' << series.pattern << ',' << series.cut << ',' << jump << ',' << use << ','
            << run.constraints << ',' << run.products << ',' << run.condition() << ',' << run.smallest << ','
            << run.largest << ',' << (run.converged ? 1 : 0) << ',' << std::setprecision(12) << run.energy
            << std::setprecision(6) << ',' << run.setup << ',' << run.solve << '\n';
        line << ' ' << run.products << (run.converged ? "" : " (not converged)") << " | " << run.condition()
             << " |";
        if (std::string(use) == "auto") {
          line << ' ' << run.constraints << " |";
          allConverged = allConverged && run.converged;
        }
      }
      if (comm->getRank() == 0)
        std::cout << line.str() << std::endl;
    }
  output::writeTextFile(
      directory / "heterogeneity.csv", [&] { return csv.str(); }, *comm);
  if (comm->getRank() == 0)
    std::cout << "written: " << (directory / "heterogeneity.csv").string() << '\n';
  return allConverged;
}

} // namespace epafi::drivers
