#pragma once

/// The errors that a user can act on. Each carries one sentence: what is wrong, the value found, what to do.

#include <stdexcept>
#include <string>

namespace epafi {

/// Base of Epafi's errors.
class Error : public std::runtime_error {
public:
  using std::runtime_error::runtime_error;
};

/// The input is wrong: file, list, parameter, value and what is allowed (exit code 2 of the driver).
class InputError : public Error {
public:
  using Error::Error;
};

/// The problem has no solution, or more than one (exit code 3 of the driver); names the body and the reason.
class SolvabilityError : public Error {
public:
  /// Which of the two.
  enum class Kind { noSolution, notUnique };

  /// \param what  the sentence for people
  SolvabilityError(Kind kind, const std::string& what) : Error(what), kind_(kind) {}

  [[nodiscard]] Kind kind() const noexcept { return kind_; } ///< which of the two

private:
  Kind kind_;
};

/// The candidate that is nearest to `word` in spelling, or an empty string if none is near: if every one
/// needs more edits than about a third of the word's letters, or the word has more than 100. Used to suggest
/// a name in error messages.
template <class Names>
std::string nearestName(const std::string& word, const Names& candidates);

/// Number of edits between two words: insert, delete or replace a letter, swap two neighbours; case ignored.
std::size_t editDistance(const std::string& a, const std::string& b);

/// The text with a full stop at its end, unless it ends as a sentence already: `… did you mean "left"?`.
std::string asSentence(const std::string& text);

/// The text as a message shows it: of more than 200 bytes the first ones and "...", and '?' for control
/// characters.
std::string shortened(const std::string& text);

/// What an exception says, on one line; of a failed allocation, which says nothing, which rank has no memory
/// left and what to do.
std::string sentenceOf(const std::exception& error, int rank);

template <class Names>
std::string nearestName(const std::string& word, const Names& candidates) {
  std::string best;
  constexpr std::size_t longest = 100; // the distance takes the product of both lengths
  if (word.size() > longest)
    return best;
  std::size_t bestDistance = (word.size() + 1) / 3 + 1;
  for (const std::string& candidate : candidates) {
    if (candidate.size() > 2 * longest)
      continue;
    const std::size_t distance = editDistance(word, candidate);
    if (distance < bestDistance) {
      bestDistance = distance;
      best = candidate;
    }
  }
  return best;
}

} // namespace epafi
