#include "lab/run/Export.hpp"

#include <algorithm>
#include <bit>
#include <cassert>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <stdexcept>
#include <system_error>
#include <type_traits>

#include "CME212/OutputFile.hpp"
#include "CME212/Util.hpp"
#include "CME212/viewer/Faces.hpp"
#include "lab/fast/GraphArrays.hpp"
#include "lab/scenes/Measure.hpp"
#include "lab/stepping/Scene.hpp"

namespace lab {

using CME212::exact_text, CME212::write_file;

// ---------------------------------------------------------------------- Frame

Frame frame_of(const Scene& scene, const Frame* before) {
  const Cloth& g = scene.cloth();
  const BuiltMesh& built = scene.mesh();
  const std::size_t n = built.mesh.points.size();
  Frame f;
  f.time = scene.time();
  f.there.resize(n), f.velocities.resize(n), f.forces.resize(n);
  f.masses.resize(n), f.strains.resize(n);
  f.pinned = is_held(scene.model(), built.mesh);
  f.places = before ? before->places : built.mesh.points;
  std::vector<unsigned> point_of(arrays(g).node_slots());
  for (unsigned i = 0; i < n; ++i) {
    if (!arrays(g).node_in_use(built.ids[i])) continue;
    const Node node = arrays(g).node_with_id(built.ids[i]);
    point_of[node.id()] = i;
    f.there[i] = 1;
    f.places[i] = node.position();
    f.velocities[i] = node.value().vel;
    f.forces[i] = scene.force()(node, f.time);
    f.masses[i] = node.value().mass;
    f.strains[i] = strain_at(node);
  }
  for (Edge e : g.edges()) {
    f.springs.push_back({point_of[e.node1().id()], point_of[e.node2().id()]});
    f.spring_strains.push_back(strain_of(e));
  }
  f.quads = quads_left(g, built);
  return f;
}

// -------------------------------------------------------------------- Formats

namespace {

std::string base64(std::string_view bytes) {
  constexpr char digits[] =
      "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string text;
  text.reserve((bytes.size() + 2) / 3 * 4);
  for (std::size_t k = 0; k < bytes.size(); k += 3) {
    const std::size_t n = std::min<std::size_t>(3, bytes.size() - k);
    unsigned three = 0;
    for (std::size_t j = 0; j < 3; ++j)
      three = three << 8 | (j < n ? std::uint8_t(bytes[k + j]) : 0u);
    for (std::size_t j = 0; j < 4; ++j)
      text += j <= n ? digits[three >> 6 * (3 - j) & 63] : '=';
  }
  return text;
}

template <typename T>
void append(std::string& bytes, T a) {
  char raw[sizeof a];
  std::memcpy(raw, &a, sizeof a);
  bytes.append(raw, sizeof raw);
}
constexpr bool little = std::endian::native == std::endian::little;

/** Builds a VTP file. */
class Vtp {
 public:
  /** Arrays of @a f, of the points @a left. */
  explicit Vtp(const Frame& f) : f_(f), new_index_(f.there.size()) {
    for (unsigned i = 0; i < f.there.size(); ++i)
      if (f.there[i])
        new_index_[i] = unsigned(left_.size()), left_.push_back(i);
  }

  std::string text() && {
    open(std::string("VTKFile type=\"PolyData\" version=\"1.0\" "
                     "byte_order=\"") +
         (little ? "Little" : "Big") + "Endian\" header_type=\"UInt64\"");
    open("PolyData");
    open("FieldData");
    text_ +=
        "<DataArray type=\"Float64\" Name=\"TimeValue\" "
        "NumberOfTuples=\"1\" format=\"ascii\">" +
        exact_text(f_.time) + "</DataArray>\n";
    close("FieldData");
    auto count = [](const char* of, std::size_t n) {
      return std::string(" NumberOf") + of + "=\"" + std::to_string(n) + '"';
    };
    open("Piece" + count("Points", left_.size()) + count("Verts", 0) +
         count("Lines", f_.springs.size()) + count("Strips", 0) +
         count("Polys", f_.quads.size()));
    open("Points");
    of_points<double>("points", f_.places);
    close("Points");
    open("PointData Scalars=\"strain\" Vectors=\"velocity\"");
    of_points<float>("velocity", f_.velocities);
    of_points<float>("force", f_.forces);
    of_points<float>("mass", f_.masses);
    of_points<float>("strain", f_.strains);
    of_points<std::uint8_t>("pinned", f_.pinned);
    array("node", left_);
    close("PointData");
    open("CellData Scalars=\"strain\"");
    array("strain", cell_strains());
    close("CellData");
    cells("Lines", f_.springs, std::array<unsigned, 2>{0, 1});
    cells("Polys", f_.quads, CME212::around_quad);
    close("Piece"), close("PolyData"), close("VTKFile");
    return "<?xml version=\"1.0\"?>\n" + std::move(text_);
  }

 private:
  const Frame& f_;
  std::vector<unsigned> left_, new_index_;
  std::string text_;

  void open(const std::string& tag) { text_ += '<' + tag + ">\n"; }
  void close(const std::string& tag) { text_ += "</" + tag + ">\n"; }

  template <typename T>
  static constexpr const char* type_name = std::is_same_v<T, double> ? "Float64"
                                           : std::is_same_v<T, float>
                                               ? "Float32"
                                           : sizeof(T) == 1      ? "UInt8"
                                           : std::is_signed_v<T> ? "Int32"
                                                                 : "UInt32";

  template <typename T>
  void array(const char* name, const std::vector<T>& values,
             int components = 1) {
    std::string bytes;
    append(bytes, std::uint64_t(values.size() * sizeof(T)));
    for (T a : values) append(bytes, a);
    text_ += std::string("<DataArray type=\"") + type_name<T> + "\" Name=\"" +
             name + "\" NumberOfComponents=\"" + std::to_string(components) +
             "\" format=\"binary\">" + base64(bytes) + "</DataArray>\n";
  }
  /** Add the values of @a all at the points that are left. */
  template <typename T, typename V>
  void of_points(const char* name, const std::vector<V>& all) {
    constexpr bool is_vector = std::is_same_v<V, Point>;
    std::vector<T> values;
    for (unsigned i : left_)
      if constexpr (is_vector)
        for (double c : all[i]) values.push_back(T(c));
      else
        values.push_back(T(all[i]));
    array(name, values, is_vector ? 3 : 1);
  }
  /** The strains of the springs, then of the quads: the mean of their sides. */
  std::vector<float> cell_strains() const {
    std::vector<float> all;
    std::vector<std::pair<std::array<unsigned, 2>, double>> by_ends;
    for (std::size_t s = 0; s < f_.springs.size(); ++s) {
      auto [a, b] = f_.springs[s];
      const double strain = f_.spring_strains[s];
      by_ends.push_back({{std::min(a, b), std::max(a, b)}, strain});
      all.push_back(float(strain));
    }
    std::ranges::sort(by_ends);
    for (const Quad& q : f_.quads) {
      double sum = 0;
      for (auto [a, b] : quad_sides) {
        const std::array ends = {std::min(q[a], q[b]), std::max(q[a], q[b])};
        sum += std::ranges::lower_bound(by_ends, ends, {}, [](auto& s) {
                 return s.first;
               })->second;
      }
      all.push_back(float(sum / 4));
    }
    return all;
  }
  template <typename Cell, std::size_t N>
  void cells(const char* tag, const std::vector<Cell>& all,
             const std::array<unsigned, N>& order) {
    std::vector<std::int32_t> corners, ends;
    for (const Cell& cell : all) {
      for (unsigned k : order) corners.push_back(int(new_index_[cell[k]]));
      ends.push_back(int(corners.size()));
    }
    open(tag);
    array("connectivity", corners);
    array("offsets", ends);
    close(tag);
  }
};

std::string to_ply(const Frame& f) {
  std::string text =
      std::string("ply\nformat binary_") + (little ? "little" : "big") +
      "_endian 1.0\ncomment t = " + exact_text(f.time) + " s\nelement vertex " +
      std::to_string(f.places.size()) + '\n';
  for (const char* name : {"x", "y", "z", "vx", "vy", "vz", "strain"})
    text += std::string("property float ") + name + '\n';
  text += "element face " + std::to_string(f.quads.size()) +
          "\nproperty list uchar int vertex_indices\nend_header\n";
  for (std::size_t i = 0; i < f.places.size(); ++i) {
    for (const Point& p : {f.places[i], f.velocities[i]})
      for (double c : p) append(text, float(c));
    append(text, float(f.strains[i]));
  }
  for (const Quad& q : f.quads) {
    text += char(4);
    for (unsigned k : CME212::around_quad) append(text, std::int32_t(q[k]));
  }
  return text;
}

constexpr const char* ending_of(FrameFormat format) {
  return format == FrameFormat::vtp ? ".vtp" : ".ply";
}

}  // namespace

std::string to_file(const Frame& frame, FrameFormat format) {
  return format == FrameFormat::vtp ? Vtp(frame).text() : to_ply(frame);
}

// --------------------------------------------------------------------- Folder

FrameFolder::FrameFolder(const std::string& folder, FrameFormat format)
    : folder_(folder), format_(format) {
  namespace fs = std::filesystem;
  auto fail = [&](const std::string& why) {
    throw std::runtime_error(folder + ": " + why +
                             ", expected a new or an empty folder");
  };
  std::error_code error;
  made_ = fs::create_directory(folder, error);
  if (error) fail("can't be made (" + error.message() + ')');
  const bool empty = fs::is_empty(folder, error);
  if (error) fail("can't be read (" + error.message() + ')');
  if (!empty) fail("has files in it");
  CME212::OutputFile try_it(name(0));
}

FrameFolder::~FrameFolder() {
  std::error_code ignored;
  if (made_ && times_.empty()) std::filesystem::remove(folder_, ignored);
}

std::string FrameFolder::name(std::size_t frame) const {
  char file[32];
  std::snprintf(file, sizeof file, "frame_%06zu%s", frame, ending_of(format_));
  return (std::filesystem::path(folder_) / file).string();
}

void FrameFolder::clear() {
  for (; !times_.empty(); times_.pop_back())
    std::filesystem::remove(name(times_.size() - 1));
}

void FrameFolder::add(const Frame& frame) {
  assert(times_.empty() || times_.back() < frame.time);
  const std::string file = name(times_.size());
  if (std::filesystem::exists(file))
    throw std::runtime_error(file + ": another run writes frames there");
  write_file(file, to_file(frame, format_));
  times_.push_back(frame.time);
}

std::string FrameFolder::finish() const {
  const std::string wrote = CME212::count_of(times_.size(), "frame") + ' ' +
                            ending_of(format_) + " in " + folder_;
  if (format_ != FrameFormat::vtp) return wrote;
  std::string text =
      "<?xml version=\"1.0\"?>\n<VTKFile type=\"Collection\" version=\"1.0\">\n"
      "<Collection>\n";
  for (std::size_t k = 0; k < times_.size(); ++k)
    text += "<DataSet timestep=\"" + exact_text(times_[k]) + "\" file=\"" +
            std::filesystem::path(name(k)).filename().string() + "\"/>\n";
  write_file((std::filesystem::path(folder_) / "frames.pvd").string(),
             text + "</Collection>\n</VTKFile>\n");
  return wrote;
}

// --------------------------------------------------------------------- Export

Export::Export(const std::vector<Folder>& folders, double rate, Scene& scene)
    : rate_(rate), frames_(scene.stepper(), [this](const Frame& f) {
        for (FrameFolder& folder : folders_) folder.add(f);
        written_ = f.time;
      }) {
  for (const Folder& f : folders)
    if (!f.name.empty()) folders_.emplace_back(f.name, f.format);
}

bool Export::due(const Scene& scene) const {
  if (empty()) return false;
  // The frame of number k is due at k/rate.
  auto number = [this](double t) { return std::floor(t * rate_ + 1e-9); };
  const double half = scene.dt() / 2;
  const double last = frames_.back() ? frames_.back()->time : written_;
  return frames_.empty() || number(scene.time() + half) > number(last + half);
}

void Export::add(const Scene& scene) {
  if (empty() || frames_.has_present()) return;
  Frame f = frame_of(scene, frames_.empty() ? nullptr : &last_);
  last_.places = f.places;
  frames_.add(std::move(f));
}

void Export::restart() {
  for (FrameFolder& folder : folders_) folder.clear();
  frames_.clear();
}

std::vector<std::string> Export::finish() {
  frames_.finish();
  std::vector<std::string> all;
  for (const FrameFolder& folder : folders_) all.push_back(folder.finish());
  return all;
}

}  // namespace lab
