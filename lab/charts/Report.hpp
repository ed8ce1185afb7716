#pragma once
/** @file Report.hpp
 * For all programs that measure: the origin of their numbers, and the cells of
 * a CSV file. */
#include <iosfwd>
#include <string>

namespace lab::report {

/** The processor and the number of cores. */
std::string machine();

/** Write the head of a CSV file, lines that begin with #: @a what it holds,
 * machine, compiler, and commit; "after COMMIT" if files other than results
 * differ from that commit. */
void write_head(std::ostream& out, const char* what);

/** @a text as a cell, without commas, quotes and ends of lines. */
std::string cell(std::string text);
/** @a a as a cell, six digits; empty if it is not finite. */
std::string cell(double a);

}  // namespace lab::report
