#pragma once
/** @file KeyValues.hpp
 * Lines KEY = VALUE, as in TOML: the grammar of a scene file. README.md */
#include <functional>
#include <string>
#include <string_view>
#include <vector>

namespace lab {

/** What stands in one line. */
struct KeyValue {
  std::string key;
  std::vector<std::string> values;  ///< one, unless it is a list
};

/** Call @a use(KeyValue, line number) for each line of @a text that is neither
 * blank nor a comment (#). A value is text in double quotes, with the escapes
 * of TOML; text in single quotes, as it stands; a list of values in brackets,
 * on one line; or anything else, up to a comment. A byte order mark is skipped.
 * @param file its name, for messages
 * Throws InputError: another line. */
void each_key_value(
    std::string_view text, const std::string& file,
    const std::function<void(const KeyValue&, std::size_t line)>& use);

/** @a text as a message can show it: short, without control characters. */
std::string printable(std::string_view text);

/** @a text in double quotes, on one line: read again it is the same, whatever
 * bytes it has. */
std::string in_quotes(std::string_view text);

}  // namespace lab
