#pragma once
/** @file SceneFile.hpp
 * Scene files: read into a Model, and written from one. Nothing but
 * load_model() and load_open_model() reads a file. README.md */
#include <functional>
#include <map>
#include <stdexcept>
#include <string>
#include <vector>

#include "lab/scenes/KeyValues.hpp"
#include "lab/scenes/Model.hpp"

namespace lab {

/** A scene file that makes no sense: "FILE:LINE: what is wrong". */
struct SceneFileError : std::runtime_error {
  using std::runtime_error::runtime_error;
};

/** Where the keys of a scene stand in its file. */
struct Origins {
  std::string file;
  std::map<std::string, std::size_t> line_of;  ///< of each key of the file

  /** "FILE:LINE: " of the first option that @a message names; @a otherwise if
   * that does not stand in the file. */
  std::string of(const std::string& message,
                 const std::string& otherwise) const;
};

/** Set the fields of @a m that the @a text of a @a file names, and then call
 * @a check().
 * @param other called with each key that is no field; false: unknown
 * @return where its keys stand
 * Throws SceneFileError: a wrong line, an unknown key, a wrong value; and what
 * check() throws, with its place */
Origins set_fields(Model& m, const std::string& file, const std::string& text,
                   const std::function<void()>& check,
                   const std::function<bool(const KeyValue&)>& other = {});

/** The text of a scene file.  Throws SceneFileError if it can't be read. */
std::string scene_text(const std::string& file);
/** The name of its scene: of the file, without folder and ending. */
std::string scene_name(const std::string& file);
/** A file that the scene file @a scene names, as the program opens it: names
 * are relative to the folder of the scene file. */
std::string beside(const std::string& scene, const std::string& name);

/** Throws SceneError unless @a m has a cloth: a scene file may leave it to the
 * command line. */
void check_has_cloth(const Model& m);

/** The scene of a file; that of load_open_model() may have no mesh.
 * Throws SceneFileError */
Model load_model(const std::string& file);
Model load_open_model(const std::string& file);
/** The scene in the @a text of a @a file, called @a name.
 * Throws SceneFileError */
Model read_model(const std::string& file, const std::string& name,
                 const std::string& text);

/** @a m as a scene file: the help of each field as a comment, and then its
 * value. What is not named is left out; names of files are absolute. Read
 * again it is the same scene, whatever the names hold. */
std::string to_scene_file(const Model& m);

/** The names of fields(), in their order. */
std::vector<std::string> scene_keys();

}  // namespace lab
