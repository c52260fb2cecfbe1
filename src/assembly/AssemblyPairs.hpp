#pragma once

/// The contacts of an assembly's scene.

#include "epafi/assembly/Assembly.hpp"

#include <Teuchos_ParameterList.hpp>

#include <set>
#include <string>
#include <utility>
#include <vector>

namespace epafi::assembly {

/// Whether faces touch in a point or line, about which the gap opens.
bool isPoint(const Assembly& assembly, const FacePair& pair);

/// Whether cylinders coincide, as bolts and nuts do that are drawn without threads.
bool isThread(const Assembly& assembly, const FacePair& pair);

/// How many elements must go around circles so that the facets of cylinders and balls in bores are off by
/// less than 1 % of the clearance or overlap; 16 at least.
int elementsAroundFor(const Assembly& assembly);

/// A list of contacts: those of `given`, their bodies and faces in words, then the pairs that were found
/// but for these and the excluded ones. \param automatic  validated list Contact/Automatic
/// \throws InputError, without the name of the file
Teuchos::ParameterList contactsOf(const Assembly& assembly, const Teuchos::ParameterList& given,
                                  const Teuchos::ParameterList& automatic, std::string& notes);

/// Indices of two faces, the lower first.
using FacesInPairs = std::set<std::pair<int, int>>;

/// Adds the pairs that were found but for the known and the excluded ones. \throws InputError, without the
/// name of the file, if facets are too far off for it
void addFoundPairs(const Assembly& assembly, const Teuchos::ParameterList& automatic,
                   const FacesInPairs& known, Teuchos::ParameterList& contacts, std::string& notes);

/// Pairs and near misses in lines for people, those of equal parts in one.
std::string wordsOfPairs(const Assembly& assembly, const std::vector<FacePair>& pairs);
std::string wordsOfNearMisses(const Assembly& assembly);

} // namespace epafi::assembly
