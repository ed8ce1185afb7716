#pragma once
/** @file NeighborPool.hpp
 * NeighborPool: the lists of neighbors of a graph. To remove an entry is fast
 * even if the node has very many edges. */
#include <cstddef>
#include <span>

#include "CME212/SlotMap.hpp"

namespace graph_detail {

/** The list of node i has an entry {j, e} for each edge e, j its other end.
 *
 * To remove an entry, the pool searches the list for it, which is fast in a
 * mesh, where lists are short. Once the searches of long lists have read more
 * entries than there are edges, the pool notes the places of each edge in its
 * two lists (8 bytes an edge), keeps them up to date, and searches no more. So
 * a removal takes O(1) amortized, however long the list is.
 * @tparam Neighbor struct of the ids `node` and `edge` */
template <typename Neighbor>
class NeighborPool : public ListPool<Neighbor> {
 public:
  using typename ListPool<Neighbor>::List;

  /** Make room for an edge @a e between the nodes of lists @a a and @a b.
   * Throws std::length_error, std::bad_alloc: no change. */
  void reserve_edge(List& a, List& b, size_type e) {
    if (has_places()) grow_to_hold(places_, e);
    this->reserve_one(a);
    this->reserve_one(b);
  }
  /** Append @a entry to the @a list of node @a i.  @pre reserve_edge() */
  void add(List& list, size_type i, const Neighbor& entry) {
    if (has_places()) place(i, entry) = list.size;
    this->push_back(list, entry);
  }

  /** Get ready to remove edges: all that may throw is done here.
   * @param lists those of all nodes, by id   @param edges their number
   * @param edge_slots all ids of edges lie below
   * Throws std::bad_alloc: no change.  Complexity: O(1) amortized */
  void reserve_removal(std::span<const List> lists, size_type edges,
                       size_type edge_slots) {
    if (has_places() || searched_ <= edges) return;
    grow_to_hold(places_, edge_slots - 1);
    for (size_type i = 0; i < lists.size(); ++i) note_places(lists[i], i);
  }
  /** Remove @a entry from the @a list of node @a i; the last entry takes its
   * place.  @pre reserve_removal()   Complexity: O(1) amortized */
  void remove(List& list, size_type i, const Neighbor& entry) {
    const size_type k = find(list, i, entry);
    this->erase(list, k);
    if (has_places() && k < list.size) place(i, (*this)[list.begin + k]) = k;
  }

  /** To be called when the @a list of node @a i was reordered. */
  void note_places(const List& list, size_type i) {
    if (!has_places()) return;
    size_type k = 0;
    for (const Neighbor& entry : this->items(list)) place(i, entry) = k++;
  }
  void clear() {
    ListPool<Neighbor>::clear();
    places_.clear();
    searched_ = 0;
  }
  /** True unless a place is noted that an entry of @a list does not have. */
  bool has_right_places(const List& list, size_type i) const {
    size_type k = 0;
    for (const Neighbor& entry : this->items(list))
      if (has_places() && places_[entry.edge][entry.node < i] != k++)
        return false;
    return true;
  }

 private:
  GrowingArray<std::array<size_type, 2>> places_;  // by edge id
  std::size_t searched_ = 0;                       // entries of long lists

  bool has_places() const { return places_.size() != 0; }
  /** Where @a entry stands in the list of node @a i. Of an edge's two places
   * the first one is that in the list of the smaller node id. */
  size_type& place(size_type i, const Neighbor& entry) {
    return places_[entry.edge][entry.node < i];
  }
  size_type find(const List& list, size_type i, const Neighbor& entry) {
    if (has_places()) return place(i, entry);
    if (list.size > 16) searched_ += list.size;
    size_type k = 0;
    while ((*this)[list.begin + k].edge != entry.edge) ++k;
    return k;
  }
};

}  // namespace graph_detail
