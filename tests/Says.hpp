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

/** @a text with the lines whole that lab::say() has broken: what follows, too,
 * is indented, and had no place in the line before. */
inline std::string joined(std::string_view text) {
  std::string all;
  std::size_t begin = 0;  // of the last line, as it was printed
  for (std::size_t k = 0; k < text.size(); ++k) {
    if (text[k] != '\n') {
      all += text[k];
      continue;
    }
    const std::size_t word = text.find_first_not_of(' ', k + 1);
    const bool cut = text.substr(begin, k - begin).ends_with(" \\"),
               indented = word != text.npos && word > k + 2;
    const std::size_t size = k - begin;
    begin = k + 1;
    if (indented && cut) all.resize(all.size() - 2);
    if (indented && size <= 80 &&
        (cut || size + 1 + text.find_first_of(" \n", word) - word > 80)) {
      all += ' ';
      k = word - 1;
    } else {
      all += '\n';
    }
  }
  return all;
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
