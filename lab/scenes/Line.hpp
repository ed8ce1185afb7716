#pragma once
/** @file Line.hpp
 * Reads one line of a request or of a recording, word by word. */
#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "CME212/Mesh.hpp"
#include "CME212/Util.hpp"
#include "lab/scenes/Nearest.hpp"

namespace lab {

/** The words of a line. It keeps the first error, as the page has no
 * exceptions; after one there are no more words. @a expected is the part of an
 * error's text that says what should be there. */
class Line {
 public:
  /** @pre @a text outlives this */
  explicit Line(std::string_view text) : text_(text) { skip_blanks(); }

  /** The error in the words read so far; "" if there is none. */
  const std::string& error() const { return error_; }
  void fail(const std::string& what) {
    if (error_.empty()) error_ = what;
    text_ = {};
  }
  bool at_end() const { return text_.empty(); }
  /** Fails unless every word was read. */
  void end() {
    if (!at_end())
      fail("continues with " + mesh_detail::quoted(word("")) +
           ", expected the end of the line");
  }
  std::string_view word(const char* expected) {
    if (at_end()) fail(std::string("ends too early, expected ") + expected);
    const auto word = text_.substr(0, text_.find_first_of(blanks));
    text_.remove_prefix(word.size());
    skip_blanks();
    return word;
  }
  /** The rest of the text, unchanged, over any number of lines. */
  std::string_view rest() { return std::exchange(text_, {}); }
  /** A finite number. */
  template <typename T = double>
  T number(const char* expected, T least = std::numeric_limits<T>::lowest()) {
    const std::string_view text = word(expected);
    const char* const last = text.data() + text.size();
    T a{};
    const auto [end, fault] = mesh_detail::from_chars(text.data(), last, a);
    if (fault != std::errc() || end != last)
      fail(mesh_detail::quoted(text) + " is not " + expected);
    else if (!std::isfinite(double(a)))
      fail(std::string("is not finite, expected ") + expected);
    else if (a < least)
      fail(CME212::short_text(double(a)) + " is not " + expected);
    return a;
  }
  /** The element of @a all with the name that the next word is; or null. */
  auto* one_of(const char* expected, const auto& all, auto name_of) {
    const std::string_view name = word(expected);
    std::vector<std::string_view> names;
    for (const auto& a : all) {
      names.push_back(std::invoke(name_of, a));
      if (names.back() == name) return &a;
    }
    fail(mesh_detail::quoted(name) + " is not " + expected +
         did_you_mean(name, names));
    return decltype(&*std::begin(all))(nullptr);
  }

 private:
  static constexpr const char* blanks = " \t\r\n";
  std::string_view text_;
  std::string error_;

  void skip_blanks() {
    text_.remove_prefix(
        std::min(text_.find_first_not_of(blanks), text_.size()));
  }
};

}  // namespace lab
