#pragma once
/** @file Fields.hpp
 * The fields of a Model, in one table: name, help, reader and writer of each.
 * Scene files, options of ./cloth, help and dumps use it. See README.md. */
#include <string>
#include <string_view>
#include <vector>

#include "lab/scenes/Model.hpp"
#include "lab/scenes/Words.hpp"

namespace lab {

/** The kinds of fields. */
enum class Role {
  mesh,     ///< a file of the mesh
  cloth,    ///< a part that makes up the cloth
  number,   ///< a number whose default has an effect, too
  acts,     ///< a part that holds nodes or changes the material in a region
  contact,  ///< a part that makes the motion not smooth
  method,   ///< how the motion is computed
  asked,    ///< what is asked, how long the run is, what is shown
};

/** A field of one Model. */
struct Field {
  const char* name;  ///< the key of a scene file; as an option --name
  Role role;
  const char* group;  ///< its heading in the help
  Member member;
  const char* help;           ///< with units
  const char* expected = "";  ///< of a number, for messages
  Word::Range range = Word::Range::any;
  /** While this field has a value, the field of this name has no effect. */
  std::string_view instead_of = {};
  bool* percent = nullptr;  ///< says if its number is followed by %

  /** The form of a value: FILE, FLOAT, TEXT ... */
  const char* type() const;
  bool repeats() const;  ///< it may have several values
  /** Its values as text; empty if it is not set. */
  std::vector<std::string> values() const;
};

/** All fields of @a m, in the order in which they are written. */
std::vector<Field> fields_of(Model& m);

/** Set the field @a name to @a values, and clear the field that would replace
 * it.  @return false if there is no such field
 * Throws SceneError: a wrong value; several values for a field of one */
bool set_field(Model& m, std::string_view name,
               const std::vector<std::string>& values);

/** The scene that is run for @a m: a default step longer than t-end becomes
 * t-end; a file that is no `.nodes` is a net.
 * Throws SceneError: fields that contradict each other */
Model checked(Model m);
/** The part of it that is about the step and t-end.  Throws SceneError */
void check_step(Model& m);

}  // namespace lab
