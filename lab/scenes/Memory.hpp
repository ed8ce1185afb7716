#pragma once
/** @file Memory.hpp
 * The memory that a run needs and the memory that is available: compared before
 * a cloth is built. */

namespace lab {

/** The least memory [bytes] of a run of a cloth of that many nodes and springs:
 * measured with the method that needs least. Methods with several stages need
 * up to twice as much, implicit methods more. */
double needed_memory(double nodes, double springs);

/** Memory [bytes] that this process can still allocate: the least of what the
 * system has available, the rest of the control group's limit, and
 * available_addresses(); infinity if none is known. */
double available_memory();
/** The rest of the address space [bytes] (ulimit -v); infinity: no limit. */
double available_addresses();

}  // namespace lab
