#pragma once
/** @file FastestCpu.hpp
 * Which of the kernels that this processor can run are the fastest. */
#include <span>

#include "lab/fast/Lanes.hpp"

namespace lab {

/** Choose by the @a times of the kinds, from the shortest registers on.
 * @return the first kind, or the last later one that takes less than 0.9 of
 *         the time of the choice before: noise does not decide. */
lanes::Cpu clearly_fastest(std::span<const double> times);

/** Time steps of a small cloth with each kind of kernel in turn, by the
 * processor time of this thread, and
 * @return the clearly_fastest() kind. The longest registers are not always
 * the fastest: a root and a division of 512 bits may take longer than two of
 * 256 bits. All kinds give the same bits, so the choice changes no result.
 * @post lanes::cpu is as before.   About 1 ms where there is a choice, else 0
 */
lanes::Cpu fastest_cpu();

}  // namespace lab
