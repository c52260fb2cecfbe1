#include "epafi/base/AccurateSum.hpp"

#include "epafi/base/RawCommunicator.hpp"

#include <Teuchos_Comm.hpp>
#include <Tpetra_Map.hpp>
#include <Tpetra_Vector.hpp>
#include <mpi.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

namespace epafi {
namespace {

/// A message is `count` blocks, each as many AccurateSums as the size of its type says. MPI may cut a message
/// between blocks, never inside one.
std::span<AccurateSum> blockOf(void* message, int block, MPI_Datatype type) {
  int bytes = 0;
  MPI_Type_size(type, &bytes);
  const std::size_t length = bytes / sizeof(AccurateSum);
  return {static_cast<AccurateSum*>(message) + block * length, length};
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

/// The type of one sum and the two operations, made at the first use and freed by MPI_Finalize (which deletes
/// the attributes of MPI_COMM_SELF first).
struct MpiObjects {
  MPI_Datatype sum = MPI_DATATYPE_NULL;
  MPI_Op add = MPI_OP_NULL, addTakeMinimum = MPI_OP_NULL;
};

// NOLINTNEXTLINE(readability-non-const-parameter): MPI prescribes the signature
extern "C" int freeMpiObjects(MPI_Comm /*comm*/, int /*key*/, void* attribute, void* /*state*/) {
  auto* objects = static_cast<MpiObjects*>(attribute);
  MPI_Type_free(&objects->sum);
  MPI_Op_free(&objects->add);
  MPI_Op_free(&objects->addTakeMinimum);
  return MPI_SUCCESS;
}

MpiObjects& mpiObjects() {
  static MpiObjects objects;
  if (objects.sum == MPI_DATATYPE_NULL) {
    MPI_Type_contiguous(2, MPI_DOUBLE, &objects.sum);
    MPI_Type_commit(&objects.sum);
    MPI_Op_create(addSums, 1, &objects.add);
    MPI_Op_create(addSumsTakeMinimum, 1, &objects.addTakeMinimum);
    int key = MPI_KEYVAL_INVALID;
    MPI_Comm_create_keyval(MPI_COMM_NULL_COPY_FN, freeMpiObjects, &key, nullptr);
    MPI_Comm_set_attr(MPI_COMM_SELF, key, &objects);
    MPI_Comm_free_keyval(&key);
  }
  return objects;
}

} // namespace

static_assert(sizeof(AccurateSum) == 2 * sizeof(double));

void sumOverRanks(const Comm& comm, std::span<AccurateSum> sums) {
  if (comm.getSize() > 1 && !sums.empty())
    MPI_Allreduce(MPI_IN_PLACE, sums.data(), static_cast<int>(sums.size()), mpiObjects().sum,
                  mpiObjects().add, rawCommunicator(comm));
}

void sumOverRanks(const Comm& comm, std::span<AccurateSum> sums, double* values) {
  sumOverRanks(comm, sums);
  std::transform(sums.begin(), sums.end(), values, [](const AccurateSum& sum) { return sum.value(); });
}

/// A message of `length` sums is one element of this type: MPI must not cut off the minimum.
struct FusedReduction::Type {
  explicit Type(int length) {
    MPI_Type_contiguous(length, mpiObjects().sum, &value);
    MPI_Type_commit(&value);
  }
  Type(const Type&) = delete;
  Type& operator=(const Type&) = delete;
  ~Type() {
    int isOver = 0;
    MPI_Finalized(&isOver);
    if (isOver == 0)
      MPI_Type_free(&value);
  }
  MPI_Datatype value = MPI_DATATYPE_NULL;
};

FusedReduction::FusedReduction(RCP<const Comm> comm, int numSums)
    : comm_(std::move(comm)), values_(static_cast<std::size_t>(numSums) + 1) {
  clear();
  if (comm_->getSize() > 1)
    type_ = std::make_shared<const Type>(numSums + 1);
}

void FusedReduction::clear() {
  std::fill(values_.begin(), values_.end(), AccurateSum());
  setMinimum(std::numeric_limits<double>::infinity());
}

void FusedReduction::reduce() {
  if (type_)
    MPI_Allreduce(MPI_IN_PLACE, values_.data(), 1, type_->value, mpiObjects().addTakeMinimum,
                  rawCommunicator(*comm_));
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
