#pragma once
/** @file Memory.hpp
 * How much memory a cloth takes, and how much there is: said before it is
 * taken. */
#include <cstddef>

namespace lab {

/** The least memory [bytes] of a run of a cloth of that many nodes and springs:
 * measured with the method that takes least. One with stages takes up to twice
 * as much, an implicit one more. */
double needed_memory(double nodes, double springs);

/** Memory [bytes] that this process can still take: what the system says is
 * available, the limit of its control group, and that of its addresses
 * (ulimit -v), whichever is least; infinity if none is known. */
double available_memory();
/** The last of these alone. */
double available_addresses();

}  // namespace lab
