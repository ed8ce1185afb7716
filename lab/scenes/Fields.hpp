#pragma once
/** @file Fields.hpp
 * The fields of a Model, in one table: name, help, reader and writer of each.
 * Scene files, options of ./cloth, help and dumps are made from it. README.md
 */
#include <string>
#include <string_view>
#include <vector>

#include "lab/scenes/Model.hpp"
#include "lab/scenes/Words.hpp"

namespace lab {

/** What a field says of a scene. */
enum class Role {
  mesh,     ///< a file of the cloth
  cloth,    ///< a part: what the cloth is
  number,   ///< acts with its default, too
  acts,     ///< a part: holds nodes, or changes the material in a place
  contact,  ///< a part: not smooth
  method,   ///< how it is computed
  asked,    ///< what is asked of it, how long it runs, what is shown
};

/** A field of one Model. */
struct Field {
  const char* name;  ///< the key of a scene file; as an option --name
  Role role;
  const char* group;  ///< of the help
  Member member;
  const char* help;           ///< with units
  const char* expected = "";  ///< of a number
  Word::Range range = Word::Range::any;
  /** The name of the field that has no effect while this one has a value. */
  std::string_view instead_of = {};

  /** FILE, FLOAT, TEXT or another form of a value. */
  const char* type() const;
  bool repeats() const;  ///< it may have several values
  /** Its values; empty: it is not there. */
  std::vector<std::string> values() const;
};

/** All fields of @a m, in the order in which they are written. */
std::vector<Field> fields_of(Model& m);

/** Set the field @a name to the @a values, and clear the one that would replace
 * it.  @return false if there is no such field
 * Throws SceneError: a wrong value; several for a field that has one */
bool set_field(Model& m, std::string_view name,
               const std::vector<std::string>& values);

/** @a m as it is run. If it names no part, it gets those of assignment_scene();
 * a default step that is longer than t-end becomes t-end.
 * Throws SceneError: fields that contradict each other */
Model checked(Model m);

}  // namespace lab
