// Writes the sample run into the directory named by its argument, for tests that look at the files from
// outside.

#include "SampleRun.hpp"

#include "epafi/output/FieldWriter.hpp"
#include "epafi/output/HistoryTable.hpp"

#include <Tpetra_Core.hpp>

#include <iostream>

int main(int argc, char** argv) {
  const Tpetra::ScopeGuard scope(&argc, &argv);
  using namespace epafi::output;
  if (argc != 2) {
    std::cerr << "usage: write_sample_fields DIRECTORY\n";
    return 2;
  }
  try {
    const auto comm = Tpetra::getDefaultComm();
    const auto decomposition = epafi::decomposition::decompose(test::sampleScene(), comm);
    writeFields(argv[1], "run", decomposition, test::sampleSolution(decomposition), test::sampleHistory());
    writeHistory(test::sampleHistory(), std::filesystem::path(argv[1]) / "history.csv", *comm);
  } catch (const std::exception& error) {
    std::cerr << error.what() << '\n';
    return 1;
  }
  return 0;
}
