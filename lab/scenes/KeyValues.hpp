#pragma once
/** @file KeyValues.hpp
 * Reads the text of a scene file, which is TOML. See README.md. */
#include <functional>
#include <string>
#include <string_view>
#include <vector>

namespace lab {

/** A key and its values. */
struct KeyValue {
  std::string key;
  std::vector<std::string> values;  ///< one, unless it is a list
};

/** Call @a use(KeyValue, line of the key) for each key of @a text, in order. A
 * value is a text, a number, true or false, or a list of these; numbers are
 * passed as text that std::strtod() reads back.
 * @param file its name, for messages
 * Throws InputError: no TOML; tables, dates, lists in lists, a text with \0. */
void each_key_value(
    std::string_view text, const std::string& file,
    const std::function<void(const KeyValue&, std::size_t line)>& use);

/** @a text as a message can show it: short, without control characters. */
std::string printable(std::string_view text);

/** @a text in double quotes, on one line, with escapes: each_key_value() reads
 * the same text.  @pre is_utf8(@a text) */
std::string in_quotes(std::string_view text);

/** Can @a text be the value of a key? */
bool is_utf8(std::string_view text);

}  // namespace lab
