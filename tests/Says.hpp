#pragma once
/** @file Says.hpp
 * Do texts say something? EXPECT_TRUE and EXPECT_FALSE print them if not. And
 * the text of an error. */
#include <gtest/gtest.h>

#include <algorithm>
#include <stdexcept>
#include <string>
#include <string_view>

/** @a text has @a part in it. */
inline testing::AssertionResult has(std::string_view text,
                                    std::string_view part) {
  return testing::AssertionResult(text.find(part) != text.npos)
         << "'" << part << "' in:\n"
         << text;
}
/** @a text begins with @a part. */
inline testing::AssertionResult begins(std::string_view text,
                                       std::string_view part) {
  return testing::AssertionResult(text.starts_with(part))
         << "'" << part << "' first in:\n"
         << text;
}

/** The message of the Error that @a f throws; "" if it throws none. */
template <typename Error = std::runtime_error>
std::string error_of(const auto& f) {
  try {
    f();
  } catch (const Error& e) {
    return e.what();
  }
  return {};
}

/** @a name as that of a test, which has no '-'. */
inline std::string test_name(std::string_view name) {
  std::string text(name);
  std::ranges::replace(text, '-', '_');
  return text;
}
