#pragma once
/** @file Nearest.hpp
 * Suggests the nearest known name for a misspelt one. */
#include <algorithm>
#include <cstddef>
#include <numeric>
#include <string>
#include <string_view>
#include <vector>

namespace lab {

/** Number of letters to insert, delete or replace to make @a b of @a a: the
 * edit distance of Levenshtein (1966).  O(a.size() b.size()) */
inline std::size_t edit_distance(std::string_view a, std::string_view b) {
  std::vector<std::size_t> row(b.size() + 1);  // of each beginning of b
  std::iota(row.begin(), row.end(), 0);
  for (std::size_t i = 0; i < a.size(); ++i) {
    std::size_t diagonal = row[0]++;
    for (std::size_t j = 0; j < b.size(); ++j) {
      const std::size_t replaced = diagonal + (a[i] != b[j]);
      diagonal = row[j + 1];
      row[j + 1] = std::min({replaced, diagonal + 1, row[j] + 1});
    }
  }
  return row.back();
}

/** The first nearest of @a names; "" if none is near: more than a third of the
 * letters differ.
 * @param names a range of what a std::string_view can be made from */
template <typename Names>
std::string nearest(std::string_view name, const Names& names) {
  std::string found;
  std::size_t least = name.size() / 3 + 1;
  for (std::string_view other : names)
    if (const std::size_t d = edit_distance(name, other); d < least)
      least = d, found = other;
  return found;
}

/** ": did you mean NAME?", of the nearest of @a names; "" if none is near. */
template <typename Names>
std::string did_you_mean(std::string_view name, const Names& names) {
  const std::string found = nearest(name, names);
  return found.empty() ? "" : ": did you mean " + found + "?";
}

/** did_you_mean(); of a key or option of other programs, what stands for it. */
template <typename Names>
std::string key_instead_of(std::string_view name, const Names& names) {
  constexpr const char* others[][2] = {
      {"mass", "density, or masses in a .net file"},
      {"friction", "the word friction of plane, sphere and self-collision"},
      {"iterations", "dt: xpbd has ten substeps a step, of one iteration each"},
      {"substeps",
       "dt: xpbd has ten substeps a step, other methods have none"}};
  for (const auto& [other, here] : others)
    if (name.ends_with(other)) return std::string(": expected ") + here;
  return did_you_mean(name, names);
}

}  // namespace lab
