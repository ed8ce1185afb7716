#pragma once
/** @file FastestCpu.hpp
 * Which of the kernels that this processor can run are the fastest. */
#include "lab/fast/Lanes.hpp"

namespace lab {

/** Time steps of a small cloth with each kind of kernel in turn, and
 * @return the kind of the shortest time. The longest registers are not always
 * the fastest: a root and a division of 512 bits may take longer than two of
 * 256 bits. All kinds give the same bits, so the choice changes no result.
 * @post lanes::cpu is as before.   About 1 ms where there is a choice, else 0
 */
lanes::Cpu fastest_cpu();

}  // namespace lab
