/** @file cloth_laws.hpp
 * Part of cloth.hpp: forces and constraints that a test makes, as children of
 * the submission's base classes if it has some. */
#ifndef KIT_CLOTH_LAWS_HPP
#define KIT_CLOTH_LAWS_HPP

namespace kit {

/** Tells a copy that lives from a reference to what is gone. */
class Life {
 public:
  Life() = default;
  Life(const Life&) {}
  Life& operator=(const Life&) { return *this; }
  ~Life() { alive_ = 0; }
  // AddressSanitizer must not stop here, as fail() says it in words.
  __attribute__((no_sanitize("address"))) void look() const {
    if (alive_ != here)
      fail("what was combined to be kept as a copy",
           "a reference to a temporary that is gone");
  }

 private:
  static constexpr unsigned here = 0x6c697665;
  volatile unsigned alive_ = here;
};

/** The law of a test's force or constraint: a reference to a function object,
 * which has to outlive it. */
struct ForceLaw {
  const void* f = nullptr;
  Point (*call)(const void*, ClothNode, double) = [](const void*, ClothNode,
                                                     double) -> Point {
    fail("the force that was combined", "one made from nothing");
  };
  ForceLaw() = default;
  template <typename F>
  ForceLaw(const F& function)
      : f(&function), call([](const void* p, ClothNode n, double t) {
          return Point((*static_cast<const F*>(p))(n, t));
        }) {}
  template <typename F>
  ForceLaw(const F&&) = delete;  // a temporary
};
struct ConstraintLaw {
  const void* f = nullptr;
  void (*call)(const void*, Cloth&, double) = [](const void*, Cloth&, double) {
    fail("the constraint that was combined", "one made from nothing");
  };
  ConstraintLaw() = default;
  template <typename F>
  ConstraintLaw(const F& function)
      : f(&function), call([](const void* p, Cloth& g, double t) {
          (*static_cast<const F*>(p))(g, t);
        }) {}
  template <typename F>
  ConstraintLaw(const F&&) = delete;
};

/** A force or a constraint of the test's: for templates, no base needed. */
class FreeForce {
 public:
  using Law = ForceLaw;
  using Called = FreeForce;
  FreeForce() = default;  // some assign what they combine
  explicit FreeForce(Law law) : law_(law) {}
  template <typename N>
  Point operator()(N n, double t) const {
    return call(n, t);
  }

 protected:
  Point call(ClothNode n, double t) const {
    life_.look();
    return law_.call(law_.f, n, t);
  }

 private:
  Life life_;
  Law law_;
};
class FreeConstraint {
 public:
  using Law = ConstraintLaw;
  using Called = FreeConstraint;
  FreeConstraint() = default;
  explicit FreeConstraint(Law law) : law_(law) {}
  template <typename G>
  void operator()(G& g, double t) const {
    call(g, t);
  }
  void operator()(Cloth* g, double t) const { call(g, t); }

 protected:
  void call(Cloth& g, double t) const {
    life_.look();
    law_.call(law_.f, g, t);
  }
  void call(Cloth* g, double t) const { call(*g, t); }

 private:
  Life life_;
  Law law_;
};

/** The same as a child of Base, whose virtual call has the type Call. */
template <typename Base, typename Free, typename Call>
struct Child;
template <typename Base, typename Free, typename R, typename C, typename A,
          typename B>
struct Child<Base, Free, R (C::*)(A, B)> : Base, private Free {
  using Called = Base;
  Child() = default;
  explicit Child(typename Free::Law law) : Free(law) {}
  R operator()(A a, B b) override { return Free::call(a, b); }
};
template <typename Base, typename Free, typename R, typename C, typename A,
          typename B>
struct Child<Base, Free, R (C::*)(A, B) const> : Base, private Free {
  using Called = Base;
  Child() = default;
  explicit Child(typename Free::Law law) : Free(law) {}
  R operator()(A a, B b) const override { return Free::call(a, b); }
};

template <typename Base>
concept HasVirtualCall =
    Complete<Base> && std::is_polymorphic_v<Base> && requires {
  &Base::operator();
};

/** A child of First or, if that is no base with a virtual call, of the next
 * one; without any a free one. */
template <typename Free, typename First, typename... Others>
auto child_of_one_of() {
  if constexpr (HasVirtualCall<First>)
    return std::type_identity<
        Child<First, Free, decltype(&First::operator())>>();
  else if constexpr (sizeof...(Others) > 0)
    return child_of_one_of<Free, Others...>();
  else
    return std::type_identity<Free>();
}
using TestForce = decltype(child_of_one_of<FreeForce, ::KIT_FORCE_BASE,
                                           ::ZeroForce, ::Force>())::type;
using TestConstraint =
    decltype(child_of_one_of<FreeConstraint, ::KIT_CONSTRAINT_BASE,
                             ::ZeroConstraint, ::Constraint>())::type;

template <typename C, typename Base>
constexpr bool inherits_from() {
  if constexpr (Complete<Base>)
    return std::is_convertible_v<C*, Base*>;
  else
    return false;
}
/** A force of the submission is a child of one of its base classes, if there
 * is any with a virtual call; so is a constraint. */
template <typename C, typename... Bases>
void check_inherits(const char* child, const char* base) {
  if constexpr ((HasVirtualCall<Bases> || ...))
    check((inherits_from<C, Bases>() || ...),
          words(child, " to inherit from ", base, ", publicly"));
}
template <typename F>
void check_is_force(const char* name) {
  check_inherits<F, ::KIT_FORCE_BASE, ::ZeroForce, ::Force>(name, "ZeroForce");
}
template <typename C>
void check_is_constraint(const char* name) {
  check_inherits<C, ::KIT_CONSTRAINT_BASE, ::ZeroConstraint, ::Constraint>(
      name, "ZeroConstraint");
}

inline TestConstraint no_constraint() {
  static constexpr auto nothing = [](Cloth&, double) {};
  return TestConstraint(nothing);
}

}  // namespace kit
#endif
