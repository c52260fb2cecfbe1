#pragma once

#include "epafi/base/Types.hpp"

/// One V-cycle of MueLu for the symmetric matrix `a`. In a file of its own, because Trilinos 13.2 has a
/// header, which MueLu's include, that g++ takes as C++17 but not as C++20; Epafi's headers need C++20.
epafi::RCP<epafi::Operator> makeMueLu(const epafi::RCP<epafi::CrsMatrix>& a);
