#pragma once
/** @file Words.hpp
 * Parts of a scene in words: names, each with its numbers, as in
 * "at 0.5 0.5 -0.5 radius 0.15 friction 0.3". The one place that reads and
 * prints them. README.md */
#include <initializer_list>
#include <map>
#include <string>
#include <vector>

#include "lab/scenes/Model.hpp"

namespace lab {

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
        std::initializer_list<Word> allowed);

  bool has(const char* name) const { return found_.count(name) > 0; }
  /** The number after @a name, or @a otherwise. */
  double number(const char* name, double otherwise) const;
  /** The three numbers after @a name, or @a otherwise. */
  Point point(const char* name, const Point& otherwise) const;
  /** The numbers after @a name.  @pre has(name) */
  const std::vector<double>& numbers(const char* name) const {
    return found_.at(name);
  }
  /** The number after @a name, which must be there, and be above @a low. */
  double above(const char* name, double low) const;
  /** The number after @a name or @a otherwise; it must be @a low or more. */
  double at_least(const char* name, double low, double otherwise) const;
  /** Throws SceneError unless @a name is there. */
  void require(const char* name) const;
  /** Throws SceneError: this part @a what. */
  [[noreturn]] void fail(const std::string& what) const;

 private:
  std::string option_, text_;
  std::map<std::string, std::vector<double>> found_;

  [[noreturn]] void fail_range(const char* name, double value,
                               const char* relation, double low) const;
};

/** Each reads one part.  Throws SceneError: other words or numbers than it may
 * have. */
Edges read_edges(const std::string& text);
Sheet read_sheet(const std::string& text);
Region read_region(const std::string& text);
Pin read_pin(const std::string& text);
Wall read_plane(const std::string& text);
Solid read_sphere(const std::string& text);
Ball read_tear(const std::string& text);
Distance read_self_collision(const std::string& text);
Box read_view(const std::string& text);
Measure read_measure(const std::string& text);
/** A number [s]; or auto[:sharp][:GAIN], as "auto:0.02" */
TimeStep read_time_step(const std::string& text);
const MethodEntry* read_method(const std::string& text);

/** The words of a part, in the order of README.md: what differs from the
 * default, with all digits. Read again, they are the same part. */
std::string to_words(const Edges&);
std::string to_words(const Sheet&);
std::string to_words(const Region&);
std::string to_words(const Pin&);
std::string to_words(const Wall&);
std::string to_words(const Solid&);
std::string to_words(const Ball&);
std::string to_words(const Distance&);
std::string to_words(const Box&);
std::string to_words(const TimeStep&);

}  // namespace lab
