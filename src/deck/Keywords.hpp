#pragma once

/// Which keywords and parameters of a deck are read, passed over, or refused with which words.

#include "epafi/deck/Cards.hpp"

#include <optional>
#include <string>
#include <vector>

namespace epafi::deck {

/// Keywords that change nothing here: output that Epafi writes anyway, hints for another solver.
bool isIgnoredKeyword(const std::string& keyword);
/// Parameters that change nothing, whatever card they are of.
bool isIgnoredParameter(const std::string& parameter);

/// What is beyond Epafi in a card by its keyword, a parameter, or an element's type.
struct Refusal {
  std::string name; ///< "*INITIAL CONDITIONS, TYPE=STRESS"
  Place place;
  std::string reason; ///< and what to do
};
std::optional<Refusal> refusalOf(const Card& card);

/// The first one of all cards, with the names of others that are to follow.
/// \throws InputError  if there is one
void refuseBeyond(const std::vector<Card>& cards);

/// Keywords that are ignored or refused, for suggestions.
std::vector<std::string> otherKeywords();
std::vector<std::string> ignoredParameters(); ///< likewise

} // namespace epafi::deck
