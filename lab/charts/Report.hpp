#pragma once
/** @file Report.hpp
 * For all programs that measure: the origin of their numbers, the cells of a
 * CSV file, and options that are lists of names. */
#include <algorithm>
#include <iosfwd>
#include <stdexcept>
#include <string>
#include <type_traits>
#include <vector>

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

/** The elements of @a all whose names are in @a names, in the order of @a all;
 * all of them if @a names is empty.
 * @param option for messages   @param name_of the name of an element
 * Throws std::runtime_error for an unknown name. */
template <typename All, typename NameOf>
auto pick(const std::vector<std::string>& names, const All& all,
          const char* option, NameOf name_of) {
  std::vector<std::decay_t<decltype(all[0])>> chosen;
  for (const auto& a : all)
    if (names.empty() ||
        std::find(names.begin(), names.end(), name_of(a)) != names.end())
      chosen.push_back(a);
  for (const std::string& name : names)
    if (std::none_of(chosen.begin(), chosen.end(),
                     [&](const auto& a) { return name_of(a) == name; })) {
      std::string what = option;
      what.append(": there is no '").append(name).append("'; there are:");
      for (const auto& a : all) what.append(" ").append(name_of(a));
      throw std::runtime_error(what);
    }
  return chosen;
}

}  // namespace lab::report
