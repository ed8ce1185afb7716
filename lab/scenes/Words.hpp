#pragma once
/** @file Words.hpp
 * Words: how a part of a scene is described: names, each with its numbers, as
 * in "at 0.5 0.5 -0.5 radius 0.15 friction 0.3". */
#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <initializer_list>
#include <map>
#include <sstream>
#include <stdexcept>
#include <string>
#include <vector>

#include "CME212/Point.hpp"

namespace lab {

/** A scene that makes no sense. what() begins with the option's name. */
struct SceneError : std::runtime_error {
  SceneError(const std::string& option, const std::string& what)
      : std::runtime_error("--" + option + " " + what) {}
};

/** The words of one part. */
class Words {
 public:
  /** A word that may be there, and how many numbers it has. */
  struct Word {
    const char* name;
    std::size_t numbers;
  };

  /** Read @a text, the value of @a option.
   * Throws SceneError: another word, a word twice, too many or too few numbers,
   * one that is none or not finite. */
  Words(std::string option, std::string text,
        std::initializer_list<Word> allowed)
      : option_(std::move(option)), text_(std::move(text)) {
    std::istringstream in(text_);
    std::string word;
    std::vector<double>* numbers = nullptr;
    for (; in >> word;) {
      const Word* is =
          std::find_if(allowed.begin(), allowed.end(),
                       [&](const Word& w) { return w.name == word; });
      if (is != allowed.end()) {
        if (found_.count(word)) fail("has " + word + " twice");
        numbers = &found_[word];
        continue;
      }
      char* end = nullptr;
      const double value = std::strtod(word.c_str(), &end);
      if (*end != '\0' || !std::isfinite(value) || !numbers)
        fail("has \"" + word + "\", expected " +
             (numbers ? "a number or one of " : "one of ") + list(allowed));
      numbers->push_back(value);
    }
    for (const Word& w : allowed)
      if (auto it = found_.find(w.name);
          it != found_.end() && it->second.size() != w.numbers)
        fail("has " + std::to_string(it->second.size()) + " numbers after " +
             w.name + ", expected " + std::to_string(w.numbers));
  }

  bool has(const char* name) const { return found_.count(name) > 0; }
  /** The number after @a name, or @a otherwise. */
  double number(const char* name, double otherwise) const {
    auto it = found_.find(name);
    return it == found_.end() ? otherwise : it->second[0];
  }
  /** The three numbers after @a name, or @a otherwise. */
  Point point(const char* name, const Point& otherwise) const {
    auto it = found_.find(name);
    if (it == found_.end()) return otherwise;
    return Point(it->second[0], it->second[1], it->second[2]);
  }
  /** The numbers after @a name.  @pre has(name) */
  const std::vector<double>& numbers(const char* name) const {
    return found_.at(name);
  }
  /** The number after @a name, which must be there, and be above @a low. */
  double above(const char* name, double low) const {
    require(name);
    const double value = number(name, 0);
    if (!(value > low)) fail_range(name, value, "more than", low);
    return value;
  }
  /** The number after @a name or @a otherwise; it must be @a low or more. */
  double at_least(const char* name, double low, double otherwise) const {
    const double value = number(name, otherwise);
    if (!(value >= low)) fail_range(name, value, "at least", low);
    return value;
  }
  /** Throws SceneError unless @a name is there. */
  void require(const char* name) const {
    if (!has(name)) fail(std::string("has no ") + name);
  }
  /** Throws SceneError: this part @a what. */
  [[noreturn]] void fail(const std::string& what) const {
    throw SceneError(option_, "\"" + text_ + "\" " + what);
  }

 private:
  std::string option_, text_;
  std::map<std::string, std::vector<double>> found_;

  static std::string list(std::initializer_list<Word> words) {
    std::string all;
    for (const Word& w : words)
      all += (all.empty() ? "" : ", ") + std::string(w.name);
    return all;
  }
  [[noreturn]] void fail_range(const char* name, double value,
                               const char* relation, double low) const {
    std::ostringstream out;
    out << "has " << name << ' ' << value << ", expected " << relation << ' '
        << low;
    fail(out.str());
  }
};

}  // namespace lab
