#pragma once
/** @file Json.hpp
 * Values as JSON (RFC 8259). A number that is not finite is null. */
#include <cmath>
#include <string>
#include <string_view>
#include <type_traits>

#include "CME212/Util.hpp"

namespace lab::json {

/** A text that is JSON already. */
struct Json {
  std::string text;
};

inline std::string text(const Json& j) { return j.text; }
inline std::string text(std::string_view words) {
  std::string all = "\"";
  for (char c : words) {
    if (c == '"' || c == '\\') all += '\\';
    all += c < ' ' && c >= 0 ? ' ' : c;
  }
  return all += '"';
}
template <typename T>
requires std::is_arithmetic_v<T>  //
    std::string text(T a) {
  if constexpr (std::is_same_v<T, bool>)
    return a ? "true" : "false";
  else
    return std::isfinite(double(a)) ? CME212::exact_text(double(a)) : "null";
}

/** "name": value, ... */
inline std::string members() { return {}; }
template <typename T, typename... Rest>
std::string members(std::string_view name, const T& value,
                    const Rest&... rest) {
  return text(name) + ':' + text(value) + (sizeof...(rest) > 0 ? "," : "") +
         members(rest...);
}
/** {"name": value, ...} */
template <typename... NamesAndValues>
Json object(const NamesAndValues&... all) {
  return {'{' + members(all...) + '}'};
}

/** [to_json(element), ...], between other brackets if @a ends says so. */
template <typename List, typename ToJson>
Json list(const List& all, ToJson to_json, const char* ends = "[]") {
  std::string elements;
  for (const auto& a : all) {
    if (!elements.empty()) elements += ',';
    elements += text(to_json(a));
  }
  return {ends[0] + elements + ends[1]};
}
template <typename List>
Json list(const List& numbers) {
  return list(numbers, [](double a) { return a; });
}

}  // namespace lab::json
