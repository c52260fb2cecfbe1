#pragma once

/// What a wrong input is told.

#include "epafi/base/Errors.hpp"

#include <gtest/gtest.h>

#include <initializer_list>
#include <string>

namespace epafi::test {

/// Text of the InputError that `work` throws; empty, and a failed test, if it throws none.
template <class Work>
std::string refusal(const Work& work) {
  try {
    work();
  } catch (const InputError& error) {
    return error.what();
  } catch (const std::exception& error) {
    ADD_FAILURE() << "not an InputError: " << error.what();
    return {};
  }
  ADD_FAILURE() << "nothing was refused";
  return {};
}

/// Text of the SolvabilityError of that kind that `work` throws; empty, and a failed test, if it throws none.
template <class Work>
std::string unsolvable(SolvabilityError::Kind kind, const Work& work) {
  try {
    work();
  } catch (const SolvabilityError& error) {
    EXPECT_EQ(error.kind(), kind) << error.what();
    return error.what();
  }
  ADD_FAILURE() << "nothing was refused";
  return {};
}

/// One line that holds all the parts.
inline void expectSays(const std::string& message, std::initializer_list<std::string> parts) {
  EXPECT_EQ(message.find('\n'), std::string::npos) << message;
  for (const std::string& part : parts)
    EXPECT_NE(message.find(part), std::string::npos) << '"' << part << "\" is not in: " << message;
}

} // namespace epafi::test
