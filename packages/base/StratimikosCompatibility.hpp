#pragma once

/// The builder of Stratimikos without its header, which is not C++20 in Trilinos 13.2; later releases make it
/// of a template.

namespace Stratimikos { // NOLINT(readability-identifier-naming): it is theirs
#if __has_include(<Stratimikos_LinearSolverBuilder.hpp>)
template <class Scalar>
class LinearSolverBuilder;
using DefaultLinearSolverBuilder = LinearSolverBuilder<double>;
#else
class DefaultLinearSolverBuilder;
#endif
} // namespace Stratimikos
