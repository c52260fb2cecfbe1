#pragma once

/// What differs between Trilinos 13.2 and later versions, in one place; `.ci/run` looks for such calls
/// elsewhere.

#include <Tpetra_Map.hpp>
#include <Trilinos_version.h>

#include <cstddef>

namespace epafi {

/// Number of entries that this rank owns (Tpetra renamed the method after 13.2). Not collective.
inline std::size_t numLocal(const Tpetra::Map<>& map) {
#if TRILINOS_MAJOR_MINOR_VERSION >= 130400
  return map.getLocalNumElements();
#else
  return map.getNodeNumElements();
#endif
}

/// Global indices that this rank owns, in local order. Not collective.
inline auto localIndices(const Tpetra::Map<>& map) {
#if TRILINOS_MAJOR_MINOR_VERSION >= 130400
  return map.getLocalElementList();
#else
  return map.getNodeElementList();
#endif
}

/// Whether a Teuchos::any holds something (its method was renamed). Not collective.
template <class Any>
auto holdsValue(const Any& any) -> decltype(any.has_value(), bool()) {
  return any.has_value();
}
/// The same in releases that lack the new name.
template <class Any, class... None>
auto holdsValue(const Any& any, const None&...) -> decltype(any.empty(), bool()) {
  return !any.empty();
}

/// Starts an iteration of Belos at a residual (later releases take state and residual apart). Collective.
template <class Iteration, class Residual>
auto startAt(Iteration& iteration, const Residual& residual)
    -> decltype(iteration.initializeCG(iteration.getState(), residual)) {
  iteration.initializeCG(iteration.getState(), residual);
}
/// The same in releases before.
template <class Iteration, class Residual, class... None>
auto startAt(Iteration& iteration, const Residual& residual, const None&... /*unused*/)
    -> decltype(iteration.getState().R, void()) {
  auto state = iteration.getState();
  state.R = residual;
  iteration.initializeCG(state);
}

} // namespace epafi
