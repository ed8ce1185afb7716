#pragma once
/** @file FlatCloth.hpp
 * FlatCloth: the state of a cloth by component, each number in an array of its
 * own, for methods that take many steps before anybody looks. README.md of this
 * room walks through it. */
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

/** Arrays of numbers, all of one length: aligned for vectors, and beginning at
 * different places of a page, so that a cache can hold the same part of all. */
class Columns {
 public:
  /** @a count arrays of zeros of at least @a length numbers.  O(all) */
  void resize(std::size_t count, std::size_t length) {
    constexpr std::size_t page = 4096 / sizeof(Real), skew = page / 64 * 9;
    stride_ = (length + page - 1) / page * page + skew;
    all_.assign(count * stride_, 0);
  }
  Real* operator[](std::size_t column) { return &all_[column * stride_]; }
  const Real* operator[](std::size_t column) const {
    return &all_[column * stride_];
  }
  /** How far one array lies behind the one before. */
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
  std::vector<Real, Aligned<Real>> all_;
  std::size_t stride_ = 0;
};

/** Positions, velocities, 1/m, K and L of a cloth by component, and its springs
 * as the kernels go through them.
 *
 * An offset of ids that many springs have is a row: the spring of node i to
 * node i + offset has number i of it, with K = 0 where there is none. Each
 * spring of a row is evaluated once. All other springs are gathered, by a
 * stencil, from both of their ends.
 *
 * The graph stays the owner: read() takes its state, write() gives positions
 * and velocities back. The rows are found anew when its version() is another;
 * memory is allocated only then. */
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
  /** Springs of consecutive ids whose numbers are consecutive, too. */
  struct Run {
    unsigned edge, count;
    std::size_t number;
  };

  /** @param more how many columns a method has for itself, behind those */
  explicit FlatCloth(unsigned more = 0) : columns_(columns + more) {}

  /** The state of @a g, with @a multiplicity K in place of K, and the drag
   * @a c. Accelerations stay as they are while the topology does, else they are
   * 0.  O(N + springs) */
  void take(const Cloth& g, int multiplicity, const Drag& c);
  /** The same again, with what the last read() had.  @pre its drag lives */
  void take(const Cloth& g) { take(g, multiplicity_, *drag_); }
  /** Positions and velocities of the nodes of ids in [first, last). */
  void read_nodes(const Cloth& g, unsigned first, unsigned last);
  /** Give them to @a g. Removed nodes have none. */
  void write(Cloth& g, unsigned first, unsigned last) const;

  void write(Cloth& g) const { write(g, 0, slots_); }

  /** Keep positions, velocities and accelerations in @a copy; take them back.
   */
  void save(std::vector<Real>& copy) const;
  void restore(const std::vector<Real>& copy);

  /** True if @a holds(position) for any id in [first, last): 0 of a removed
   * node. */
  template <typename Holds>
  bool any(unsigned first, unsigned last, Holds holds) const {
    const Real *x = nodes_[X], *y = nodes_[Y], *z = nodes_[Z];
    bool found = false;
    for (unsigned i = first; i < last; ++i)
      found |= holds(Point(x[i], y[i], z[i]));
    return found;
  }

  unsigned slots() const { return slots_; }
  /** The version() of the graph whose topology this is. */
  std::uint64_t version() const { return version_; }
  Columns& nodes() { return nodes_; }
  const Columns& nodes() const { return nodes_; }
  const std::vector<Row>& rows() const { return rows_; }
  const Real* K() const { return springs_[0]; }
  const Real* L() const { return springs_[1]; }
  /** The springs in no row, whose numbers in K() and L() go on behind the rows:
   * those of row r from rest_first() + r lanes::width on; nullptr: none. */
  const Rest* rest() const { return rest_ ? &*rest_ : nullptr; }
  std::size_t rest_first() const { return rest_first_; }
  /** The largest difference of two neighbors' ids. */
  unsigned reach() const { return reach_; }

  /** Of three columns: @a x and the two behind it. */
  Point point(unsigned x, unsigned id) const {
    const Real* at = nodes_[x] + id;
    const std::size_t s = nodes_.stride();
    return {at[0], at[s], at[2 * s]};
  }
  void set(unsigned x, unsigned id, const Point& p) {
    Real* at = nodes_[x] + id;
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
