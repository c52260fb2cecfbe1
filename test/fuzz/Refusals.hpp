#pragma once

/// What a reader may answer to bad input.

#include "epafi/base/Errors.hpp"

#include <cstdlib>
#include <iostream>
#include <string>

namespace epafi::fuzz {

/// A sentence that a person can read: not empty, and no book.
inline void requireSentence(const std::string& text) {
  constexpr std::size_t longest = 1u << 20;
  if (!text.empty() && text.size() < longest)
    return;
  std::cerr << "The refusal is a text of " << text.size() << " bytes.\n";
  std::abort();
}

/// Does the work, which either succeeds or refuses the input; what else it throws goes through.
template <class Work>
void orRefused(const Work& work) {
  try {
    work();
  } catch (const InputError& error) {
    requireSentence(error.what());
  } catch (const SolvabilityError& error) {
    requireSentence(error.what());
  }
}

} // namespace epafi::fuzz
