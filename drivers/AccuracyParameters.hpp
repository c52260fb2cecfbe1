#pragma once

/// How accurate a run is to be, and what it may cost: the list Accuracy of a scene.

#include <Teuchos_ParameterList.hpp>

namespace epafi::drivers {

struct AccuracyParameters {
  bool estimate = true;     ///< whether to estimate the error at the end
  double target = 0;        ///< of the relative error; 0: as accurate as the scene's mesh
  int maxLevels = 8;        ///< meshes at most, the scene's own the first
  double maxUnknowns = 2e6; ///< no mesh with more is made

  /// Adds the list Accuracy to the schema of a scene file.
  static void addTo(Teuchos::ParameterList& schema);
  /// From a validated list Accuracy. \throws InputError if the target is no share.
  static AccuracyParameters from(const Teuchos::ParameterList& list);
};

} // namespace epafi::drivers
