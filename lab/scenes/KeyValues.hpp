#pragma once
/** @file KeyValues.hpp
 * Reads lines KEY = VALUE, the grammar of a scene file. See README.md. */
#include <functional>
#include <string>
#include <string_view>
#include <vector>

namespace lab {

/** The content of one line. */
struct KeyValue {
  std::string key;
  std::vector<std::string> values;  ///< one, unless it is a list
};

/** Call @a use(KeyValue, line number) for each line of @a text that is neither
 * blank nor a comment (#). A value is text in double quotes, with the escapes
 * of TOML; text in single quotes, as it stands; a list of values in brackets,
 * on one line; or anything else, up to a comment. A byte order mark is skipped.
 * @param file its name, for messages
 * Throws InputError: any other line. */
void each_key_value(
    std::string_view text, const std::string& file,
    const std::function<void(const KeyValue&, std::size_t line)>& use);

/** @a text as a message can show it: short, without control characters. */
std::string printable(std::string_view text);

/** @a text in double quotes, on one line, with escapes: each_key_value() reads
 * the same bytes. */
std::string in_quotes(std::string_view text);

}  // namespace lab
