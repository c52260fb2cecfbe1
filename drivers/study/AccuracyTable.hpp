#pragma once

/// accuracy.csv: one row a run, errors and costs.

#include "Table.hpp"

namespace epafi::drivers {

/// What ran, how wrong its result is, and what it cost. Errors are relative: in the energy norm to ‖u‖_K of
/// the reference, in L2 to ‖u‖, contact zone and force to those of the reference. `energy_error` is that of
/// both parts, (algebraic_error² + discretisation_error²)^½, `estimated_error` what the run itself says of
/// it; `elements` are those along a side of the first body, `order` theirs; `seconds` from scene to solution,
/// on all meshes that were solved on; products are those on the finest of them, all_multiplications those on
/// all, by their share of unknowns.
Table accuracyTable();

/// Adds what follows from the others: effectivity, unknowns a second, digits of accuracy, of efficacy,
/// −log₁₀(error · seconds), and of size: Chang, Fabien, Knepley, Mills, *Comparative study of finite element
/// methods using the Time-Accuracy-Size (TAS) spectrum analysis*, SIAM J. Sci. Comput. 40 (2018).
void addDigits(Row& row);

/// Marks the rows of each problem beside which no other is both faster and no less accurate; none without a
/// time.
void markFront(Table& table);
/// The fastest row of a row's problem and order with an error at most 2 % larger, itself perhaps.
const Row& fastestLike(const Row& row, const Table& table);

} // namespace epafi::drivers
