#pragma once
/** @file Words.hpp
 * A part of a scene as text: words, each followed by its numbers, as in
 * "at 0.5 0.5 -0.5 radius 0.15 friction 0.3". words_of() declares the words of
 * a part once; reading and writing both use it. See README.md. */
#include <array>
#include <functional>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "lab/scenes/Model.hpp"

namespace lab {

class Line;

/** A word of a part. */
struct Word {
  enum class Range { any, not_negative, positive };
  enum class Need {
    none,  ///< it may be missing
    word,  ///< it must be there
    some,  ///< at least one of these words must be there
  };
  const char* name;
  /** What its numbers set; a bool, unless null, says if the word is there. A
   * SpringKind has one number or none. */
  std::variant<bool*, double*, std::optional<double>*, Point*,
               std::array<unsigned, 2>*, SpringKind*>
      member;
  Range range = Range::any;
  Need need = Need::none;
};
/** All words that a part may have, in the order in which they are written. */
struct Words {
  const char* option;  ///< the key of the part
  std::vector<Word> all;
  const char* wrong = nullptr;  ///< what is wrong with the part as a whole
};

/** The words of a part, bound to its members. */
Words words_of(Edges&);
Words words_of(Sheet&);
Words words_of(Region&);
Words words_of(Pin&);
Words words_of(Wind&);
Words words_of(Wall&);
Words words_of(Solid&);
Words words_of(Ball&);
Words words_of(Distance&);
Words words_of(Measure&);
Words words_of(Box&);

/** The member of a Model that a field sets. */
using Member =
    std::variant<bool*, double*, std::string*, std::vector<std::string>*,
                 TimeStep*, const MethodEntry**, Measure*, Edges*,
                 std::optional<double>*, std::optional<Distance>*, Gravity*,
                 std::optional<Box>*, std::optional<Wind>*, std::vector<Sheet>*,
                 std::vector<Region>*, std::vector<Pin>*, std::vector<Wall>*,
                 std::vector<Solid>*, std::vector<Ball>*>;

/** Set the members of @a words() from @a text.
 * Throws SceneError: an unknown, repeated or missing word; too many or too few
 * numbers; a number out of its range or not finite; Words::wrong. */
void read_words(const std::string& text, const std::function<Words()>& words);
/** The words whose members differ from @a usual, numbers with all digits. */
std::string written(const Words& words, const Words& usual);

/** The part that @a text describes.  Throws as read_words() */
template <typename Part>
Part read_part(const std::string& text) {
  Part part;
  read_words(text, [&part] { return words_of(part); });
  return part;
}
/** The text of @a part. Reading it gives the same part. */
template <typename Part>
std::string to_words(Part part) {
  Part usual;
  return written(words_of(part), words_of(usual));
}

/** The coordinates of @a p, three digits each. */
std::string short_text(const Point& p);

/** "[max|min|mean|first|last|period] NAME [words]", NAME as in Measure.hpp.
 * Throws SceneError: anything else; no such method. */
Measure read_measure(const std::string& text);
const MethodEntry* read_method(const std::string& text);
/** The method called @a name, also by another name in use, as "leapfrog". Else
 * null, and @a hint is ": did you mean NAME?" or "". */
const MethodEntry* method_named(std::string_view name, std::string& hint);
/** A number [s]; or auto[:sharp][:GAIN], as "auto:0.02"
 * Throws SceneError: anything else */
TimeStep read_time_step(const std::string& text);
std::string to_words(const TimeStep&);
/** A number if it acts down, else three, with all digits. */
std::string to_words(const Gravity&);
inline constexpr const char* gravity_expected =
    "an acceleration or a vector of three [m/s^2]";
/** The next number or three of @a in, which says if they are none. */
Gravity read_gravity(Line& in);

}  // namespace lab
