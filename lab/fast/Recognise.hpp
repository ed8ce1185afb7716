#pragma once
/** @file Recognise.hpp
 * Finds out which force or constraint of the course an object is, also if
 * make_combined_force() has copied it. */
#include <concepts>
#include <memory>
#include <typeinfo>
#include <utility>

namespace lab {

/** T overrides or inherits Base's operator(). Else a T has a call that hides
 * it: one that is not const, or is a template. */
template <typename T, typename Base>
concept Overrides = std::derived_from<T, Base> && requires {
  decltype (&T::operator())() == &Base::operator();
};

/** A copy of @a x as a Base: a T, or an Adapter<T> if its own call hides that
 * of Base. */
template <typename Base, template <typename> class Adapter, typename T>
std::shared_ptr<const Base> shared_as(T x) {
  if constexpr (Overrides<T, Base>)
    return std::make_shared<T>(std::move(x));
  else
    return std::make_shared<Adapter<T>>(std::move(x));
}

/** A call of the object that it points to. */
template <typename T>
struct Pointer {
  T* p;
  template <typename X>
  auto operator()(X& x, double t) const -> decltype((*p)(x, t)) {
    return (*p)(x, t);
  }
};

/** @a x, if it is a T but none of T's children, which may have another call; or
 * the T in an Adapter; else null. */
template <typename T, template <typename> class Adapter, typename Base>
const T* exactly(const Base& x) {
  if (typeid(x) == typeid(T)) return static_cast<const T*>(&x);
  if (typeid(x) == typeid(Adapter<T>))
    return &static_cast<const Adapter<T>&>(x).function;
  return nullptr;
}

}  // namespace lab
