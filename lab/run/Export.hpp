#pragma once
/** @file Export.hpp
 * Series of files for other programs: the states of a cloth, frame by frame. */
#include <deque>
#include <string>
#include <vector>

#include "lab/scenes/Compose.hpp"
#include "lab/stepping/Settled.hpp"

namespace lab {

class Scene;

/** A frame: the state of a cloth as files hold it. */
struct Frame {
  double time = 0;  ///< [s]
  /** For each point of the first mesh, in its order: whether its node is in
   * use, and the last position of the node [m]. */
  std::vector<char> there;
  std::vector<Point> places;
  /** [m/s], [N], [kg], 1, of each point; 0 where the node was removed. Strain:
   * the mean l/L - 1 of the springs at the node. */
  std::vector<Point> velocities, forces;
  std::vector<double> masses, strains;
  std::vector<char> pinned;
  /** The ends of each remaining spring, by the points, and its l/L - 1. */
  std::vector<std::array<unsigned, 2>> springs;
  std::vector<double> spring_strains;
  std::vector<Quad> quads;  ///< that remain: see mesh_left()
};

/** The formats.
 * vtp: VTK PolyData in XML, arrays in base64: all data of a Frame about what
 *   remains; positions in double precision, else in single. frames.pvd lists
 *   the files with their times. docs.vtk.org, "VTK XML Formats"
 * ply: binary, single precision: positions, velocities, strains, quads. Each
 *   frame has all points of the first one, in one order: a removed node stays
 *   at its last position, and its quads are removed. */
enum class FrameFormat { vtp, ply };

/** The text of the file of one frame.  O(points + springs) */
std::string to_file(const Frame& frame, FrameFormat format);

/** The state of @a scene.
 * @param before the frame before it, for the positions of nodes removed since;
 *        null: the first one  O(points + springs) */
Frame frame_of(const Scene& scene, const Frame* before);

/** A folder of files frame_000000.vtp, ... Each is written whole or not at all.
 */
class FrameFolder {
 public:
  /** @param folder new or empty: what lies there is not ours
   * Throws std::runtime_error "FOLDER: why". */
  FrameFolder(const std::string& folder, FrameFormat format);
  FrameFolder(const FrameFolder&) = delete;
  FrameFolder& operator=(const FrameFolder&) = delete;
  /** Removes the folder if nothing was written. */
  ~FrameFolder();

  /** Write @a frame.  @pre it is later than all others
   * Throws std::runtime_error "FILE: why". */
  void add(const Frame& frame);
  /** Remove all frames: the run begins anew. */
  void clear();
  /** Write the list of times, for vtp.
   * @return frames and folder, as a sentence  Throws std::runtime_error. */
  std::string finish() const;

 private:
  std::string folder_;
  FrameFormat format_;
  bool made_ = false;
  std::vector<double> times_;

  std::string name(std::size_t frame) const;
};

/** The frames of a run, in all folders that it writes. */
class Export {
 public:
  struct Folder {
    FrameFormat format;
    std::string name;  ///< empty: none
  };
  /** The frames of @a scene are written by its steps, once they are settled.
   * @param rate frames a second of simulated time [1/s], > 0
   * Throws std::runtime_error "FOLDER: why". */
  Export(const std::vector<Folder>& folders, double rate, Scene& scene);

  bool empty() const { return folders_.empty(); }
  /** True if the next frame is due at the time of @a scene: half a step early
   * is as good as half a step late. */
  bool due(const Scene& scene) const;
  /** Add the present state of @a scene, unless it is there already.
   * @pre the state is good */
  void add(const Scene& scene);
  /** Remove all frames: the run begins anew. */
  void restart();
  /** Write all frames of a run that is at its end, and complete the folders.
   * @return what is in them, a sentence each
   * Throws std::runtime_error "FILE: why". */
  std::vector<std::string> finish();

 private:
  double rate_;
  std::deque<FrameFolder> folders_;
  Settled<Frame> frames_;
  Frame last_;          // its places, waiting or written
  double written_ = 0;  // time of the last one in the folders [s]
};

}  // namespace lab
