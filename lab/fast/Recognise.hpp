#pragma once
/** @file Recognise.hpp
 * Finds out which force or constraint of the course an object is, also if
 * make_combined_force() has copied it. */
#include <concepts>
#include <memory>
#include <type_traits>
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

/** A reference to a T, or a temporary one, is or derives from Base. */
template <typename T, typename Base>
concept IsA = std::derived_from<std::remove_cvref_t<T>, Base>;

/** @a x as a Base. A temporary is kept; anything else must outlive the result.
 * If its own call hides that of Base, it is in an Adapter. */
template <typename Base, template <typename> class Adapter, IsA<Base> T>
std::shared_ptr<const Base> term_of(T&& x) {
  using Call = Pointer<std::remove_reference_t<T>>;
  if constexpr (!std::is_reference_v<T> && !std::is_const_v<T>)
    return shared_as<Base, Adapter>(std::move(x));
  else if constexpr (Overrides<std::remove_cvref_t<T>, Base>)
    return {std::shared_ptr<void>(), &x};
  else
    return std::make_shared<Adapter<Call>>(Call{&x});
}

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
