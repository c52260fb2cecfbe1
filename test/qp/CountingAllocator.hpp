#pragma once

/// Counts every call of operator new in a program that links CountingAllocator.cpp.

namespace epafi::test {

long numAllocations();

} // namespace epafi::test
