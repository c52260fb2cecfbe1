// What a library may do to the process that it works in.

#include "epafi/meshing/ChildProcess.hpp"

#include "epafi/base/Errors.hpp"

#include <gtest/gtest.h>

#include <csignal>
#include <cstdlib>
#include <stdexcept>
#include <string>
#include <unistd.h>

namespace epafi::meshing {
namespace {

constexpr int patience = 2; // seconds

template <class Refusal>
std::string refusalOfChild(const std::function<void()>& work) {
  try {
    inChildProcess(work, "The library", "try another", patience);
  } catch (const Refusal& refusal) {
    return refusal.what();
  }
  return "none";
}

TEST(ChildProcessTest, SaysWhatTheWorkThrows) {
  EXPECT_EQ(refusalOfChild<InputError>([] { throw InputError("wrong"); }), "wrong");
  EXPECT_EQ(refusalOfChild<Error>([] { throw std::runtime_error("failed"); }), "failed");
  EXPECT_NO_THROW(inChildProcess([] {}, "The library", "try another"));
}

TEST(ChildProcessTest, GoesOnWhenTheWorkEndsItsProcess) {
  EXPECT_EQ(refusalOfChild<InputError>([] { std::exit(0); }),
            "The library ended of its own accord; try another");
  EXPECT_EQ(refusalOfChild<InputError>([] { std::raise(SIGKILL); }),
            "The library ended by signal 9 (Killed); try another");
}

TEST(ChildProcessTest, EndsWorkThatWaitsForItself) {
  EXPECT_EQ(refusalOfChild<InputError>([] { ::pause(); }),
            "The library waited for itself, 2 seconds long, and was stopped; try another");
}

} // namespace
} // namespace epafi::meshing
