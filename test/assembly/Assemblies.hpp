#pragma once

/// STEP files as CAD programs write them, in this folder; pairs.csv says which of their faces meet.

#include "epafi/assembly/AssemblyReader.hpp"

#include <Tpetra_Core.hpp>

#include <map>
#include <string>

namespace epafi::test {

inline std::string stepFile(const std::string& name) {
  return EPAFI_SOURCE_DIR "/test/assembly/" + name + ".step";
}

/// Read once. Collective.
inline const assembly::Assembly& assemblyCalled(const std::string& name) {
  static std::map<std::string, assembly::Assembly> known;
  if (const auto found = known.find(name); found != known.end())
    return found->second;
  return known[name] = assembly::readAssembly(stepFile(name), {}, *Tpetra::getDefaultComm());
}

} // namespace epafi::test
