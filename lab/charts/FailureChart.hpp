#pragma once
/** @file FailureChart.hpp
 * The pictures of how methods fail: failures.csv, which failures.gp draws. */
#include <iosfwd>
#include <vector>

#include "lab/methods/Method.hpp"

namespace lab {

/** Make the runs of Failure.hpp for @a chosen methods and write them to @a out:
 * titles, axes and what was measured in the head, then a row for each point of
 * a curve.
 * @param said what was measured goes there as well; nullptr: nowhere */
void write_failures(const std::vector<const MethodEntry*>& chosen,
                    std::ostream* said, std::ostream& out);

}  // namespace lab
