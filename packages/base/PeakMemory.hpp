#pragma once

/// The most memory that a part of a program holds, not the whole program since its start.

namespace epafi {

/// From now on memory that is freed stays with the program, ready to be used again: the system would have to
/// clear it, page by page, at its next first touch. Not collective.
void keepFreedMemory();

/// Gives back to the system what is free, and starts anew; returns the bytes held now. Where the system does
/// not allow it (Linux does), peaks go on from the program's start. Not collective.
double resetPeakBytes();

/// Most bytes that this process held in memory since `resetPeakBytes`. Not collective.
double peakBytes();

/// Bytes of memory that programs can still take on this machine. Not collective.
double freeBytes();

} // namespace epafi
