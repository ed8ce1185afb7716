#pragma once
/** @file FlatCloth.hpp
 * FlatCloth: the state of a cloth by component, with an array for each, for
 * methods that make many steps without the graph. Explained in README.md. */
#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <new>
#include <optional>
#include <vector>

#include "lab/fast/Drag.hpp"
#include "lab/fast/Lanes.hpp"
#include "lab/fast/Stencil.hpp"

namespace lab {

struct Zone;

/** Arrays of one length, aligned for vectors. They start at different offsets
 * in a page, so that a cache can hold the same part of all. */
class Columns {
 public:
  /** @a count arrays of zeros of at least @a length numbers.  O(all) */
  void resize(std::size_t count, std::size_t length) {
    constexpr std::size_t page = 4096 / sizeof(double), skew = page / 64 * 9;
    stride_ = (length + page - 1) / page * page + skew;
    all_.assign(count * stride_, 0);
  }
  double* operator[](std::size_t column) { return &all_[column * stride_]; }
  const double* operator[](std::size_t column) const {
    return &all_[column * stride_];
  }
  /** The distance of the starts of consecutive arrays. */
  std::size_t stride() const { return stride_; }

 private:
  template <typename T>
  struct Aligned {
    using value_type = T;
    static constexpr std::align_val_t line{64};
    Aligned() = default;
    template <typename U>
    Aligned(const Aligned<U>&) {}  // NOLINT
    T* allocate(std::size_t n) {
      return static_cast<T*>(::operator new(n * sizeof(T), line));
    }
    void deallocate(T* p, std::size_t) { ::operator delete(p, line); }
    bool operator==(const Aligned&) const = default;
  };
  std::vector<double, Aligned<double>> all_;
  std::size_t stride_ = 0;
};

/** Positions, velocities, 1/m, K and L of a cloth by component, and its springs
 * as the kernels go through them.
 *
 * If many springs have the same offset of ids, they form a row: the spring from
 * node i to node i + offset is number i of the row; K = 0 if there is none.
 * Each spring of a row is evaluated once. All other springs are in a stencil,
 * and evaluated at both of their ends.
 *
 * The graph owns the state: take() reads it, write() writes positions and
 * velocities back. When its version() changes, the rows are found anew; only
 * then memory is allocated. */
class FlatCloth {
 public:
  static constexpr unsigned tile = 64;  ///< nodes; arrays have whole tiles
  static constexpr unsigned most_rows = 8, longest_row = 1 << 15;
  enum Column { X, Y, Z, VX, VY, VZ, PerMass, AX, AY, AZ, DragC, columns };

  /** One row: its springs are numbers [first, first + nodes) of K() and L(). */
  struct Row {
    unsigned offset;  ///< of the far end's id, > 0
    std::size_t first;
  };
  using Rest = Stencil<lanes::width>;
  /** Springs with consecutive ids and consecutive numbers. */
  struct Run {
    unsigned edge, count;
    std::size_t number;
  };

  /** @param more number of additional columns, for a method */
  explicit FlatCloth(unsigned more = 0) : columns_(columns + more) {}

  /** Read the state of @a g, with @a multiplicity K instead of K, and the drag
   * @a c. If the topology has changed, accelerations become 0; else they stay.
   * O(N + springs) */
  void take(const Cloth& g, int multiplicity, const Drag& c);
  /** The same with the arguments of the last take().  @pre its drag exists */
  void take(const Cloth& g) { take(g, multiplicity_, *drag_); }
  /** Read positions and velocities of the nodes with ids in [first, last). */
  void read_nodes(const Cloth& g, unsigned first, unsigned last);
  /** Write them to @a g; removed nodes are skipped. */
  void write(Cloth& g, unsigned first, unsigned last) const;

  void write(Cloth& g) const { write(g, 0, slots_); }

  /** Copy positions, velocities and accelerations, and restore them. */
  void save(std::vector<double>& copy) const;
  void restore(const std::vector<double>& copy);

  /** True if any node with an id in [first, last) may be inside @a zone.
   * Removed nodes have position 0. */
  bool any_inside(const Zone& zone, unsigned first, unsigned last) const;

  unsigned slots() const { return slots_; }
  /** The version() of the graph whose topology this is. */
  std::uint64_t version() const { return version_; }
  Columns& nodes() { return nodes_; }
  const Columns& nodes() const { return nodes_; }
  const std::vector<Row>& rows() const { return rows_; }
  const double* K() const { return springs_[0]; }
  const double* L() const { return springs_[1]; }
  /** The springs in no row; null if there are none. In K() and L() they follow
   * the rows: row r of the stencil starts at rest_first() + r lanes::width. */
  const Rest* rest() const { return rest_ ? &*rest_ : nullptr; }
  std::size_t rest_first() const { return rest_first_; }
  /** The largest difference of two neighbors' ids. */
  unsigned reach() const { return reach_; }

  /** The Point in columns @a x, x + 1 and x + 2. */
  Point point(unsigned x, unsigned id) const {
    const double* at = nodes_[x] + id;
    const std::size_t s = nodes_.stride();
    return {at[0], at[s], at[2 * s]};
  }
  void set(unsigned x, unsigned id, const Point& p) {
    double* at = nodes_[x] + id;
    const std::size_t s = nodes_.stride();
    at[0] = p.x, at[s] = p.y, at[2 * s] = p.z;
  }
  /** Copy @a count columns.  O(count N) */
  void copy(unsigned from, unsigned to, unsigned count) {
    for (unsigned k = 0; k < count; ++k)
      std::copy_n(nodes_[from + k], slots_, nodes_[to + k]);
  }
  Point position(unsigned id) const { return point(X, id); }
  Point velocity(unsigned id) const { return point(VX, id); }
  Point acceleration(unsigned id) const { return point(AX, id); }
  void set_position(unsigned id, const Point& p) { set(X, id, p); }
  void set_velocity(unsigned id, const Point& v) { set(VX, id, v); }
  void set_acceleration(unsigned id, const Point& a) { set(AX, id, a); }

 private:
  Columns nodes_, springs_;
  std::vector<Row> rows_;
  std::vector<Run> runs_;
  std::optional<Rest> rest_;
  std::size_t rest_first_ = 0;
  unsigned columns_, slots_ = 0, reach_ = 0;
  std::uint64_t version_ = 0;
  int multiplicity_ = 0;
  const Drag* drag_ = nullptr;

  void lay_out(const Cloth& g);
  void find_rows(const Cloth& g, std::vector<char>& is_row);
  void add_run(unsigned edge, std::size_t number);
};

}  // namespace lab
