/** @file NetBinary.cpp
 * Readers of nets in formats that may be binary: STL, PLY. */
#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <utility>
#include <vector>

#include "lab/scenes/NetParsing.hpp"

namespace lab::net_parsing {

namespace {

// ------------------------------------------------------------------ Raw bytes

template <typename T>
T raw(const char* bytes, bool swap = false) {
  char copy[sizeof(T)];
  std::memcpy(copy, bytes, sizeof copy);
  if (swap) std::reverse(copy, copy + sizeof copy);
  return std::bit_cast<T>(copy);
}
constexpr bool big = std::endian::native == std::endian::big;

/** A kind of number in a .ply file. */
struct Kind {
  const char* names[2];
  std::size_t size;
  double (*read)(const char*, bool);
};
template <typename T>
double as_double(const char* bytes, bool swap) {
  return double(raw<T>(bytes, swap));
}
constexpr Kind kinds[] = {{{"char", "int8"}, 1, as_double<std::int8_t>},
                          {{"uchar", "uint8"}, 1, as_double<std::uint8_t>},
                          {{"short", "int16"}, 2, as_double<std::int16_t>},
                          {{"ushort", "uint16"}, 2, as_double<std::uint16_t>},
                          {{"int", "int32"}, 4, as_double<std::int32_t>},
                          {{"uint", "uint32"}, 4, as_double<std::uint32_t>},
                          {{"float", "float32"}, 4, as_double<float>},
                          {{"double", "float64"}, 8, as_double<double>}};
const Kind& kind_of(std::string_view name) {
  for (const Kind& k : kinds)
    if (std::ranges::count(k.names, name)) return k;
  fail("there is no type " + quoted(name));
}

// ------------------------------------------------------------------------ stl

}  // namespace

void parse_stl(std::string_view text, const std::string& file, Builder& b) {
  std::vector<long long> nodes;  // of a facet that is not finished
  const auto corner = [&](const Point& p) {
    nodes.push_back((long long)b.net.points.size());
    b.net.points.push_back(p);
  };
  const auto end_facet = [&] { b.face(nodes), nodes.clear(); };
  constexpr std::size_t head = 84, facet = 50;
  if (text.size() >= head && text.find('\0') < text.npos) {
    const std::size_t n = raw<std::uint32_t>(text.data() + 80, big),
                      whole_ones = (text.size() - head) / facet;
    if (whole_ones < n)
      throw InputError(file, 0,
                       "announces " + CME212::count_of(n, "triangle") +
                           ", of which " + std::to_string(whole_ones) +
                           (whole_ones == 1 ? " is" : " are") +
                           " there, expected a whole file");
    for (std::size_t k = 0; k < 3 * n; ++k) {
      const char* from = text.data() + head + k / 3 * facet + 12 * (k % 3 + 1);
      Point p;
      for (int c : {0, 1, 2}) p[c] = raw<float>(from + 4 * c, big);
      if (!is_finite(p))
        throw InputError(file, 0,
                         "facet " + std::to_string(k / 3) +
                             " is not finite, expected numbers");
      corner(p);
      if (k % 3 == 2) end_facet();
    }
    if (const auto left = text.size() - head - n * facet; left > 0)
      b.skip(CME212::count_of(left, "byte") + " behind the last triangle");
    return;
  }
  bool is_stl = false, ends = false;
  const auto use = [&](Words w) {
    const std::string name = CME212::lower_case(std::string(w[0]));
    if (!std::exchange(is_stl, true) && name != "solid")
      fail(quoted(w[0]) + " begins the file");
    if (name == "vertex") corner(point(w, 1));
    if (name == "endloop") end_facet();
    if (name.ends_with("solid")) ends = name == "endsolid";
  };
  const std::string expected =
      "an STL file of triangles: 'solid', 'vertex x y z' three times a facet, "
      "'endsolid'; or a binary one";
  each_line(text, file, use, [&] { return expected; });
  if (!ends)
    throw InputError(file, 0,
                     "ends early, behind " +
                         CME212::count_of(b.net.points.size() / 3, "triangle") +
                         ", expected " + expected);
}

// ------------------------------------------------------------------------ ply

namespace {

class Ply {
 public:
  Ply(std::string_view text, const std::string& file, Builder& b)
      : file_(file), b_(b) {
    header(text);
    const auto check = [&](const std::string& what, auto read) {
      try {
        read();
      } catch (const std::runtime_error& error) {
        const auto read_so_far = text.substr(0, text.size() - rest_.size());
        throw InputError(
            file_,
            ascii_ ? 1 + std::size_t(std::ranges::count(read_so_far, '\n')) : 0,
            what + error.what() + ", expected numbers as in the header");
      }
    };
    for (const Element& e : elements_)
      for (std::size_t k = 0; k < e.count; ++k)
        check(quoted(e.name) + ' ' + std::to_string(k) + ": ", [&] { row(e); });
    check("", [&] {
      if (rest_.find_first_not_of(" \t\r\n") != rest_.npos) fail("more data");
    });
  }

 private:
  struct Property {
    std::string_view name;
    const Kind *kind, *count;  // count: null unless a list
  };
  struct Element {
    std::string_view name;
    std::size_t count;
    std::vector<Property> properties;
  };
  static constexpr std::string_view known[] = {"vertex", "face", "edge",
                                               "tristrips"};
  std::string file_;
  std::vector<Element> elements_;
  bool ascii_ = false, swap_ = false;
  std::string_view rest_;
  Builder& b_;

  void header(std::string_view text) {
    const auto end = text.find("end_header");
    const auto next = text.find('\n', end);
    if (!text.starts_with("ply") || end == text.npos || next == text.npos)
      throw InputError(file_, 0,
                       "has no header, expected 'ply' to "
                       "'end_header'");
    rest_ = text.substr(next + 1);
    each_line(
        text.substr(0, end), file_,
        [this](Words w) {
          if (w[0] == "format" && w.size() > 1) {
            ascii_ = w[1] == "ascii";
            swap_ = (w[1] == "binary_big_endian") != big;
            if (!ascii_ && w[1] != "binary_big_endian" &&
                w[1] != "binary_little_endian")
              fail(quoted(w[1]) + " is no format");
          } else if (w[0] == "element" && w.size() == 3) {
            const auto count = std::size_t(std::max(0LL, whole(w[2])));
            elements_.push_back({w[1], count, {}});
            if (w[1] == "vertex") b_.announced += count;
            if (count > 0 && std::ranges::count(known, w[1]) == 0)
              b_.skip(quoted(w[1]));
          } else if (w[0] == "property" && !elements_.empty() &&
                     (w.size() == 3 || (w.size() == 5 && w[1] == "list"))) {
            elements_.back().properties.push_back(
                {w.back(), &kind_of(w[w.size() - 2]),
                 w.size() == 5 ? &kind_of(w[2]) : nullptr});
          } else if (w[0] != "ply" && w[0] != "comment" && w[0] != "obj_info") {
            fail(quoted(w[0]) + " begins the line");
          }
        },
        [] { return std::string("a header of a PLY file"); });
  }

  double next(const Kind& kind) {
    if (ascii_) {
      rest_.remove_prefix(
          std::min(rest_.find_first_not_of(" \t\r\n"), rest_.size()));
      const auto word = rest_.substr(
          0, std::min(rest_.find_first_of(" \t\r\n"), rest_.size()));
      if (word.empty()) fail("the file ends early");
      rest_.remove_prefix(word.size());
      return number(word);
    }
    if (rest_.size() < kind.size) fail("the file ends early");
    const double a = kind.read(rest_.data(), swap_);
    rest_.remove_prefix(kind.size);
    return a;
  }

  void row(const Element& e) {
    if (e.properties.empty()) fail("no property");
    Point place, velocity;
    bool moves = false;
    long long ends[2] = {};
    for (const Property& p : e.properties) {
      if (p.count) {
        std::vector<long long> nodes;
        for (auto left = index_of(next(*p.count)); left > 0; --left)
          nodes.push_back(index_of(next(*p.kind)));
        if (!p.name.starts_with("vertex_ind")) continue;
        if (e.name == "face") b_.face(nodes);
        // Each node with the two before it; -1 begins another strip.
        std::size_t from = 0;
        for (std::size_t k = 0; e.name == "tristrips" && k < nodes.size(); ++k)
          if (nodes[k] == -1)
            from = k + 1;
          else if (k >= from + 2)
            b_.face(std::span(nodes).subspan(k - 2, 3));
        continue;
      }
      const double a = next(*p.kind);
      const char* const axes = "xyz";
      for (int k : {0, 1, 2}) {
        if (p.name == std::string_view(axes + k, 1)) place[k] = a;
        if (p.name == std::string("v") + axes[k]) velocity[k] = a, moves = true;
      }
      if (p.name == "vertex1") ends[0] = index_of(a);
      if (p.name == "vertex2") ends[1] = index_of(a);
    }
    if (e.name == "edge") b_.spring(ends[0], ends[1]);
    if (e.name != "vertex") return;
    b_.net.points.push_back(finite(place));
    if (moves) b_.net.velocities.push_back(finite(velocity));
  }
};

}  // namespace

void parse_ply(std::string_view text, const std::string& file, Builder& b) {
  Ply(text, file, b);
}

}  // namespace lab::net_parsing
