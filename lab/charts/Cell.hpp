#pragma once
/** @file Cell.hpp
 * The cells of the CSV files of charts. */
#include <cmath>
#include <cstdio>
#include <string>

namespace lab {

/** @a a as a cell, six digits; empty if it is not finite. */
inline std::string cell(double a) {
  if (!std::isfinite(a)) return "";
  char text[32];
  std::snprintf(text, sizeof text, "%.6g", a);
  return text;
}
/** @a text as a cell, without commas, quotes and ends of lines. */
inline std::string cell(std::string text) {
  for (char& c : text)
    if (c == ',' || c == '"' || c == '\n') c = ';';
  return text;
}

}  // namespace lab
