// Every test program runs on any number of ranks: rank 0 prints, and a failure on one rank fails the program
// on all.

#include <Teuchos_CommHelpers.hpp>
#include <Tpetra_Core.hpp>
#include <gtest/gtest.h>

#include <iostream>

int main(int argc, char** argv) {
  Tpetra::ScopeGuard scope(&argc, &argv);
  testing::InitGoogleTest(&argc, argv);
  const auto comm = Tpetra::getDefaultComm();
  auto& listeners = testing::UnitTest::GetInstance()->listeners();
  if (comm->getRank() != 0 && comm->getSize() > 1) {
    // Only failures speak on the other ranks.
    class FailuresOnly : public testing::EmptyTestEventListener {
      void OnTestPartResult(const testing::TestPartResult& result) override {
        if (result.failed())
          std::cerr << result.file_name() << ':' << result.line_number() << ": " << result.summary() << '\n';
      }
    };
    delete listeners.Release(listeners.default_result_printer());
    listeners.Append(new FailuresOnly);
  }
  const int mine = RUN_ALL_TESTS();
  int worst = 0;
  Teuchos::reduceAll(*comm, Teuchos::REDUCE_MAX, 1, &mine, &worst);
  return worst;
}
