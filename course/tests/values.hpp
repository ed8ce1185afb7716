/** @file values.hpp
 * The members of the values of nodes and edges, by the names in programs:
 * mass and velocity of a node, K and L of a spring. A function gives the
 * address of the number in a value, or an absent one (a null void*). */
#ifndef KIT_VALUES_HPP
#define KIT_VALUES_HPP
#include "prelude.hpp"

namespace kit {

// The usual names. What stands first is the course's own.
// clang-format off
#define KIT_NAMES_OF_MASS(X) X(mass) X(m) X(mass_) X(m_)
#define KIT_NAMES_OF_VELOCITY(X) X(vel) X(velocity) X(v) X(vel_) X(velocity_)
#define KIT_NAMES_OF_START(X)                                               \
  X(initial_position) X(initial_pos) X(initial) X(initialPosition)          \
  X(init_position) X(init_pos) X(initpos) X(initPos) X(init) X(start)       \
  X(initialpos) X(initialPos) X(startpos) X(startPos) X(start_position)     \
  X(start_pos) X(original_position) X(orig_pos) X(orig) X(pos0) X(p0) X(x0) \
  X(pin) X(pos_init) X(position0) X(fixed_pos)
#define KIT_NAMES_OF_K(X)                                                   \
  X(K) X(k) X(K_) X(k_) X(Ks) X(ks) X(K0) X(k0) X(Kij) X(kij) X(K_ij)       \
  X(k_ij) X(spring_constant) X(spring_constant_) X(spring_const)            \
  X(springConstant) X(springConst) X(spring_k) X(spring_K) X(spring_coef)   \
  X(spring) X(constant) X(stiffness) X(stiff) X(K_spring) X(k_spring)       \
  X(kval) X(K_const) X(k_const)
#define KIT_NAMES_OF_L(X)                                                   \
  X(L) X(l) X(L_) X(l_) X(L0) X(l0) X(Lij) X(lij) X(L_ij) X(l_ij) X(length) \
  X(length_) X(len) X(len_) X(rest_length) X(rest_length_) X(rest_len)      \
  X(restLength) X(resting_length) X(rest) X(initial_length) X(initial_len)  \
  X(init_length) X(init_len) X(initialLength) X(initLength) X(initial)      \
  X(RestLength) X(original_length) X(orig_length) X(natural_length)         \
  X(edge_length) X(spring_length) X(spring_len) X(length0) X(len0)     \
  X(lval) X(dist) X(distance)
// clang-format on

// If v has the member, give its address; else go on with the next name.
#define KIT_NUMBER(member)                                     \
  if constexpr (requires {                                     \
                  { v.member } -> std::convertible_to<double>; \
                  v.member = 1.5;                              \
                })                                             \
    return &v.member;                                          \
  else
#define KIT_POINT(member)                                     \
  if constexpr (requires {                                    \
                  { v.member } -> std::convertible_to<Point>; \
                  v.member = Point();                         \
                })                                            \
    return &v.member;                                         \
  else

/** None there. */
inline void* absent() { return nullptr; }
template <typename Address>
constexpr bool is_there = !std::is_same_v<Address, void*>;

template <typename V>
auto* mass_in(V& v) {
  KIT_NAMES_OF_MASS(KIT_NUMBER) return absent();
}
template <typename V>
auto* velocity_in(V& v) {
  KIT_NAMES_OF_VELOCITY(KIT_POINT) return absent();
}
/** Where the node was at first: some keep it there for their pins. */
template <typename V>
auto* start_in(V& v) {
  KIT_NAMES_OF_START(KIT_POINT) return absent();
}
template <typename V>
auto* named_K(V& v) {
  KIT_NAMES_OF_K(KIT_NUMBER) return absent();
}
template <typename V>
auto* named_L(V& v) {
  KIT_NAMES_OF_L(KIT_NUMBER) return absent();
}
#undef KIT_NUMBER
#undef KIT_POINT

/** Which of two numbers that have other names is L: the second. */
inline int place_of_L = 1;

/** A class of so many numbers and nothing else. */
template <typename E, int count>
constexpr bool is_numbers =
    std::is_trivially_copyable_v<E>&& std::is_class_v<E>&&
        std::is_default_constructible_v<E> &&
    sizeof(E) == count * sizeof(double) && alignof(E) == alignof(double);
/** One number: if it is not K, it is L. */
template <typename E>
constexpr bool one_number = is_numbers<E, 1>;
/** Two numbers: if one is K, the other one is L. */
template <typename E>
constexpr bool two_numbers = is_numbers<E, 2>;
template <typename E>
double* number_in(E& v, std::ptrdiff_t place) {
  return reinterpret_cast<double*>(&v) + place;
}
template <typename E, typename Known>
double* other_number_in(E& v, Known* known) {
  auto* first = reinterpret_cast<double*>(&v);
  return reinterpret_cast<double*>(known) == first ? first + 1 : first;
}

/** K in the value of an edge; absent if all springs have the same. */
template <typename E>
auto* K_in(E& v) {
  if constexpr (is_there<decltype(named_K(v))>)
    return named_K(v);
  else if constexpr (!two_numbers<E>)
    return absent();
  else if constexpr (is_there<decltype(named_L(v))>)
    return other_number_in(v, named_L(v));
  else
    return number_in(v, 1 - place_of_L);
}
/** L in the value of an edge; a value that is a number is L. */
template <typename E>
auto* L_in(E& v) {
  if constexpr (std::is_arithmetic_v<E>)
    return &v;
  else if constexpr (is_there<decltype(named_L(v))>)
    return named_L(v);
  else if constexpr (one_number<E> && !is_there<decltype(named_K(v))>)
    return number_in(v, 0);
  else if constexpr (!two_numbers<E>)
    return absent();
  else if constexpr (is_there<decltype(named_K(v))>)
    return other_number_in(v, named_K(v));
  else
    return number_in(v, place_of_L);
}

/** Is it only the layout that tells K from L? */
template <typename E>
constexpr bool unnamed =
    two_numbers<E> && !is_there<decltype(named_K(std::declval<E&>()))> &&
    !is_there<decltype(named_L(std::declval<E&>()))>;

}  // namespace kit
#endif
