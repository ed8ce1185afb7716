#pragma once
/** @file Version.hpp
 * The version of the laboratory: of ./cloth and of the module for Python. */

namespace lab {

inline constexpr const char* version = "2.0.0";

}  // namespace lab
