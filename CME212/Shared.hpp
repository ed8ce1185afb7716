#pragma once
/** @file Shared.hpp
 * Objects of many types as shared pointers to their base class, each with the
 * call that it has itself. A child whose operator() is not const, or is a
 * template, does not override that of its base but hides it: through the base
 * it would do what the base does, without a warning. */
#include <concepts>
#include <memory>
#include <type_traits>
#include <utility>

namespace CME212 {

/** A T is a Base and is called by the virtual function of that: T overrides it,
 * or has no call of its own. */
template <typename T, typename Base>
concept Overrides = std::derived_from<T, Base> && requires {
  decltype (&T::operator())() == &Base::operator();
};

/** @a x on the heap as a Base: itself if it overrides the call, else in an
 * Adapter<T>, which is a Base and calls a T. */
template <typename Base, template <typename> class Adapter, typename T>
std::shared_ptr<const Base> shared_as(T x) {
  if constexpr (Overrides<T, Base>)
    return std::make_shared<T>(std::move(x));
  else
    return std::make_shared<Adapter<T>>(std::move(x));
}

/** Calls what it points to. */
template <typename P>
struct Pointer {
  P p;
  template <typename X>
  auto operator()(X& x, double t) -> decltype((*p)(x, t)) {
    return (*p)(x, t);
  }
};

/** What @a p points to as a Base, or in an Adapter as above. A shared_ptr goes
 * on sharing, a unique_ptr gives it away; what a plain pointer points to stays
 * its owner's and must live as long as the result and its copies. */
template <typename Base, template <typename> class Adapter, typename P>
std::shared_ptr<const Base> shared_from(P p) {
  if constexpr (!Overrides<std::remove_cvref_t<decltype(*p)>, Base>)
    return shared_as<Base, Adapter>(Pointer<P>{std::move(p)});
  else if constexpr (std::is_pointer_v<P>)
    return {std::shared_ptr<void>(), p};
  else
    return p;
}

}  // namespace CME212
