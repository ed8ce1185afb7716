#pragma once
/** @file SceneFile.hpp
 * A Model as options, and as a file of options: the one table of their names,
 * and how such a file is read and written. README.md */
#include <functional>
#include <map>
#include <memory>
#include <stdexcept>
#include <string>
#include <vector>

#include "lab/scenes/Model.hpp"

namespace CLI {
class App;
class Option;
}  // namespace CLI

namespace lab {

/** A scene file that makes no sense: "FILE:LINE: what is wrong". */
struct SceneFileError : std::runtime_error {
  using std::runtime_error::runtime_error;
};

/** Let @a option take the name of a file: none that is empty, as a shell's
 * variable that is not set, and not the next option, as without the name.
 * @return it */
CLI::Option* takes_file(CLI::Option* option);

/** Where the options of a scene stand in its file. */
struct Origins {
  std::string file;
  std::map<std::string, std::size_t> line_of;  ///< of each key of the file

  /** "FILE:LINE: " of what @a message is about: the first option that it
   * names; @a otherwise if that does not stand in the file. */
  std::string of(const std::string& message,
                 const std::string& otherwise) const;
};

/** The options of a scene, as a command line or a file gives them. */
class SceneOptions {
 public:
  /** Those of a Model that nobody changed. */
  SceneOptions();
  ~SceneOptions();

  /** Give @a app the options; their defaults are what they are now. `modulus`
   * takes the place of `stiffness`, and that of `modulus`; so do `drag` and
   * `damping`.  @pre this lives until @a app has parsed */
  void add_to(CLI::App& app);

  /** Set the options of @a app, those of add_to() and others, from a scene
   * file, and then call @a check(), which may throw SceneError. The scene is
   * called by the stem of @a file; file names in it are relative to its folder.
   * Throws SceneFileError: a file that can't be read, a wrong line, an unknown
   * key, a value of a wrong type, and what check() threw, all with file and
   * line. */
  void read(CLI::App& app, const std::string& file,
            const std::function<void()>& check);
  /** The same of the @a text of such a file, which is in @a file, and whose
   * scene is called @a name. */
  void read_text(CLI::App& app, const std::string& file,
                 const std::string& name, const std::string& text,
                 const std::function<void()>& check);

  /** What they say. If they name no part, it has those of assignment_scene().
   * Throws SceneError: a value out of range, words that make no sense, parts
   * that contradict each other. */
  Model model() const;

  /** Where what model() says stands in the file that was read. */
  const Origins& origins() const { return origins_; }
  /** What the command line @a app has set does not stand there any more. */
  void overridden_by(const CLI::App& app);

  struct Text;  ///< in SceneFile.cpp only

 private:
  std::unique_ptr<Text> text_;
  Origins origins_;
};

/** Throws SceneError unless @a m has a cloth: a scene file may leave it to the
 * command line. */
void check_has_cloth(const Model& m);

/** The scene of a file; that of load_open_model() may leave the mesh open.
 * Throws SceneFileError */
Model load_model(const std::string& file);
Model load_open_model(const std::string& file);
/** The scene in the @a text of a @a file, called @a name.
 * Throws SceneFileError */
Model read_model(const std::string& file, const std::string& name,
                 const std::string& text);

/** @a m as a scene file: what each key means as a comment, and then what it is
 * set to. What is not named is left out; names of files are absolute. Read
 * again it is the same scene, whatever the names hold. */
std::string to_scene_file(const Model& m);

/** The keys of a scene file that describe a scene, in their order. */
std::vector<std::string> scene_keys();

}  // namespace lab
