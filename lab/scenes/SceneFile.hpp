#pragma once
/** @file SceneFile.hpp
 * Scene files: read into a Model, and written from one. See README.md. */
#include <functional>
#include <map>
#include <stdexcept>
#include <string>
#include <vector>

#include "lab/scenes/KeyValues.hpp"
#include "lab/scenes/Model.hpp"

namespace lab {

/** An error in a scene file: "FILE:LINE: what is wrong". */
struct SceneFileError : std::runtime_error {
  using std::runtime_error::runtime_error;
};

/** Where the keys of a scene stand in its file. */
struct Origins {
  std::string file;
  std::map<std::string, std::size_t> line_of;  ///< by key

  /** "FILE:LINE: " of the first option that @a message names; @a otherwise if
   * the file does not have it. */
  std::string of(const std::string& message,
                 const std::string& otherwise) const;
};

/** Set the fields of @a m that @a text, the content of @a file, names; then
 * call @a check().
 * @param other called with each other key; returns false if it is unknown
 * @return the lines of the keys
 * Throws SceneFileError: a wrong line, an unknown key, a wrong value; what
 * check() throws, with its line */
Origins set_fields(Model& m, const std::string& file, const std::string& text,
                   const std::function<void()>& check,
                   const std::function<bool(const KeyValue&)>& other = {});

/** The text of a scene file.  Throws SceneFileError if it can't be read. */
std::string scene_text(const std::string& file);
/** The name of the scene in @a file: the file's, without folder and ending. */
std::string scene_name(const std::string& file);
/** The path of the file that the scene file @a scene calls @a name: names are
 * relative to the folder of the scene file. */
std::string beside(const std::string& scene, const std::string& name);

/** Throws SceneError if @a m has no cloth. A scene file may leave the cloth to
 * the command line. */
void check_has_cloth(const Model& m);

/** The scene in @a file; for load_open_model() it may have no mesh.
 * Throws SceneFileError */
Model load_model(const std::string& file);
Model load_open_model(const std::string& file);

/** @a m as a scene file: the help of each field as a comment, and its value.
 * Fields that are not set, and those of the names @a without, are left out;
 * file names are absolute. Reading the text gives the same scene, whatever
 * characters its names have. */
std::string to_scene_file(const Model& m,
                          const std::vector<std::string>& without = {});

/** The names of fields_of() a Model, in their order. */
std::vector<std::string> scene_keys();

}  // namespace lab
