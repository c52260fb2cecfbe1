#include "epafi/base/AccurateSum.hpp"

#include "epafi/base/Errors.hpp"

#include <Teuchos_DefaultMpiComm.hpp>
#include <Tpetra_Map.hpp>
#include <Tpetra_Vector.hpp>
#include <mpi.h>

#include <cmath>

namespace epafi {
namespace {

/// A message is `count` blocks, each as many AccurateSums as the size of its type says. MPI may cut a message
/// between blocks, never inside one.
std::span<AccurateSum> blockOf(void* message, int block, MPI_Datatype type) {
  int bytes = 0;
  MPI_Type_size(type, &bytes);
  const std::size_t length = static_cast<std::size_t>(bytes) / sizeof(AccurateSum);
  return {static_cast<AccurateSum*>(message) + static_cast<std::size_t>(block) * length, length};
}

// NOLINTBEGIN(readability-non-const-parameter): MPI prescribes the signature
extern "C" void addSums(void* in, void* inout, int* count, MPI_Datatype* type) {
  for (int block = 0; block < *count; ++block) {
    const auto other = blockOf(in, block, *type), mine = blockOf(inout, block, *type);
    for (std::size_t i = 0; i < mine.size(); ++i)
      mine[i].add(other[i]);
  }
}

extern "C" void addSumsTakeMinimum(void* in, void* inout, int* count, MPI_Datatype* type) {
  for (int block = 0; block < *count; ++block) {
    const auto other = blockOf(in, block, *type), mine = blockOf(inout, block, *type);
    for (std::size_t i = 0; i + 1 < mine.size(); ++i)
      mine[i].add(other[i]);
    if (other.back().value() < mine.back().value())
      mine.back() = other.back();
  }
}
// NOLINTEND(readability-non-const-parameter)

/// Combines `blocks` blocks of `length` values each over all ranks.
void reduce(const Comm& comm, AccurateSum* values, int blocks, int length, MPI_User_function* function) {
  const auto* mpi = dynamic_cast<const Teuchos::MpiComm<int>*>(&comm);
  if (mpi == nullptr)
    throw Error("sums over several ranks need a communicator of MPI");
  MPI_Datatype type = MPI_DATATYPE_NULL;
  MPI_Op operation = MPI_OP_NULL;
  MPI_Type_contiguous(2 * length, MPI_DOUBLE, &type);
  MPI_Type_commit(&type);
  MPI_Op_create(function, 1, &operation);
  MPI_Allreduce(MPI_IN_PLACE, values, blocks, type, operation, *mpi->getRawMpiComm());
  MPI_Op_free(&operation);
  MPI_Type_free(&type);
}

} // namespace

static_assert(sizeof(AccurateSum) == 2 * sizeof(double));

void sumOverRanks(const Comm& comm, std::span<AccurateSum> sums) {
  if (comm.getSize() > 1 && !sums.empty())
    reduce(comm, sums.data(), static_cast<int>(sums.size()), 1, addSums);
}

void sumAndMinimumOverRanks(const Comm& comm, std::span<AccurateSum> sumsAndMinimum) {
  if (comm.getSize() > 1 && !sumsAndMinimum.empty())
    reduce(comm, sumsAndMinimum.data(), 1, static_cast<int>(sumsAndMinimum.size()), addSumsTakeMinimum);
}

double accurateDot(const Vector& x, const Vector& y) {
  const auto a = x.getLocalViewHost(Tpetra::Access::ReadOnly);
  const auto b = y.getLocalViewHost(Tpetra::Access::ReadOnly);
  AccurateSum sum;
  for (std::size_t i = 0; i < a.extent(0); ++i)
    sum.add(a(i, 0) * b(i, 0));
  sumOverRanks(*x.getMap()->getComm(), {&sum, 1});
  return sum.value();
}

double accurateNorm(const Vector& x) {
  return std::sqrt(accurateDot(x, x));
}

} // namespace epafi
