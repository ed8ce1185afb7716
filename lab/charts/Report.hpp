#pragma once
/** @file Report.hpp
 * What the programs that measure have in common: where their numbers come from,
 * the cells of a CSV file, and lists of names as options. */
#include <algorithm>
#include <iosfwd>
#include <stdexcept>
#include <string>
#include <type_traits>
#include <vector>

namespace lab::report {

/** Processor and number of cores. */
std::string machine();

/** The head of a CSV file, lines that begin with #: @a what it holds, machine,
 * compiler, and commit, "-dirty" if the sources differ from it. */
void write_head(std::ostream& out, const char* what);

/** @a text as a cell: no comma, quote or end of line in it. */
std::string cell(std::string text);
/** @a a as a cell, six digits; empty if it is not finite. */
std::string cell(double a);

/** The elements of @a all that are named, in the order of @a all; all of them
 * if @a names is empty.
 * @param option for messages   @param name_of an element, as string
 * Throws std::runtime_error for a name that is not there. */
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
