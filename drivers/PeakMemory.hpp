#pragma once

/// The most memory that a part of a program holds, not the whole program since its start.

namespace epafi::drivers {

/// Gives back to the system what is free, and starts anew; returns the bytes held now. Where the system does not allow
/// it (Linux does), peaks go on from the program's start. Not collective.
double resetPeakBytes();

/// Most bytes that this process held in memory since `resetPeakBytes`. Not collective.
double peakBytes();

/// Bytes of memory that programs can still take on this machine. Not collective.
double freeBytes();

} // namespace epafi::drivers
