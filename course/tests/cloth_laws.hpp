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
template <typename R, typename A>
struct Law {
  using Call = R (*)(const void*, A, double);
  const void* f = nullptr;
  Call call = [](const void*, A, double) -> R {
    fail("what was combined", "what was made from nothing");
  };
  Law() = default;
  template <typename F>
  Law(const F& function)
      : f(&function), call([](const void* p, A a, double t) {
          return R((*static_cast<const F*>(p))(a, t));
        }) {}
  template <typename F>
  Law(const F&&) = delete;  // a temporary
};

/** A force or a constraint of the test's: for templates, no base needed. */
template <typename R, typename A>
class OfLaw {
 public:
  OfLaw() = default;  // some assign what they combine
  explicit OfLaw(Law<R, A> law) : law_(law) {}

 protected:
  R call(A a, double t) const {
    life_.look();
    return law_.call(law_.f, a, t);
  }

 private:
  Life life_;
  Law<R, A> law_;
};
struct FreeForce : OfLaw<Point, ClothNode> {
  using Called = FreeForce;
  using OfLaw::OfLaw;
  template <typename N>
  Point operator()(N n, double t) const {
    return call(n, t);
  }
};
struct FreeConstraint : OfLaw<void, Cloth&> {
  using Called = FreeConstraint;
  using OfLaw::OfLaw;
  template <typename G>
  void operator()(G& g, double t) const {
    call(g, t);
  }
  void operator()(Cloth* g, double t) const { call(g, t); }

 protected:
  using OfLaw::call;
  void call(Cloth* g, double t) const { call(*g, t); }
};

/** Base, with the clone() of a Self if Base asks its children for one. */
template <typename Base, typename Self>
struct Cloning : Base {};
template <typename Base, typename Self>
requires requires(const Base& base) { base.clone(); }
struct Cloning<Base, Self> : Base {
  using Copy = decltype(std::declval<const Base&>().clone());
  virtual Copy clone() const {
    return Copy(new Self(static_cast<const Self&>(*this)));
  }
};

/** The same as a child of Base, whose call has the type Call. It may be no
 * virtual one, but call others: so no override, and Child is abstract then. */
template <typename Base, typename Free, typename Call>
struct Child;
template <typename Base, typename Free, typename R, typename C, typename A,
          typename B>
struct Child<Base, Free, R (C::*)(A, B)>
    : Cloning<Base, Child<Base, Free, R (C::*)(A, B)>>, private Free {
  using Called = Base;
  using Free::Free;
  R operator()(A a, B b) { return Free::call(a, b); }
};
template <typename Base, typename Free, typename R, typename C, typename A,
          typename B>
struct Child<Base, Free, R (C::*)(A, B) const>
    : Cloning<Base, Child<Base, Free, R (C::*)(A, B) const>>, private Free {
  using Called = Base;
  using Free::Free;
  R operator()(A a, B b) const { return Free::call(a, b); }
};

template <typename Base>
concept HasVirtualCall =
    Complete<Base> && std::is_polymorphic_v<Base> && requires {
  &Base::operator();
};
template <typename Base>
using CallOf = decltype(&Base::operator());
/** Can a test make a child of Base? It may ask for more than a call. */
template <typename Base, typename Free>
concept HasChild =
    HasVirtualCall<Base> && !std::is_final_v<Base> &&
    std::is_default_constructible_v<Child<Base, Free, CallOf<Base>>>;

/** A child of First or, if there can be none, of the next one; without any a
 * free one. */
template <typename Free, typename First, typename... Others>
auto child_of_one_of() {
  if constexpr (HasChild<First, Free>)
    return std::type_identity<Child<First, Free, CallOf<First>>>();
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

template <typename C>
constexpr bool has_virtual() {
  if constexpr (Complete<C>)
    return std::is_polymorphic_v<C>;
  else
    return false;
}
/** Is @a F a class with virtual calls, and Free all that a test can make? */
template <typename F, typename Free>
constexpr bool base_is_unknown() {
  return has_virtual<F>() && (std::is_same_v<TestForce, Free> ||
                              std::is_same_v<TestConstraint, Free>);
}

/** The first of these classes that has virtual functions, or else void. */
template <typename First, typename... Others>
auto first_parent() {
  if constexpr (has_virtual<First>())
    return std::type_identity<First>();
  else if constexpr (sizeof...(Others) > 0)
    return first_parent<Others...>();
  else
    return std::type_identity<void>();
}
using ForceParent =
    decltype(first_parent<::KIT_FORCE_BASE, ::ZeroForce, ::Force>())::type;
using ConstraintParent =
    decltype(first_parent<::KIT_CONSTRAINT_BASE, ::ZeroConstraint,
                          ::Constraint>())::type;
/** Is the parent in a namespace, where no test can name it? */
template <typename Parent, typename Child>
constexpr bool parent_is_hidden() {
#ifdef KIT_NAMESPACES
  return std::is_void_v<Parent> && has_virtual<Child>();
#else
  return false;
#endif
}
/** Run @a test<Parent>(), or fail if there is no such class that can be made by
 * itself and have children. */
template <typename Parent, typename Free, typename Test>
void with_parent(const char* name, Test test) {
  const std::string wanted =
      words("a class ", name, " with a virtual operator(), ");
  if constexpr (std::is_void_v<Parent>)
    fail(words(wanted, "the parent of the others"), "none");
  else if constexpr (!std::is_default_constructible_v<Parent>)
    fail(words(wanted, "that does nothing by itself"),
         "one that can't be made by itself, from nothing");
  else if constexpr (!HasChild<Parent, Free>)
    fail(words(wanted, "from which a test can derive"), "another class");
  else
    test.template operator()<Parent>();
}
/** Is C there, and derived from Parent, publicly? */
template <typename C, typename Parent>
constexpr bool inherits_from() {
  if constexpr (Complete<C>)
    return std::is_convertible_v<C*, Parent*>;
  else
    return false;
}
template <typename C, typename Parent>
void check_inherits(const char* child, const char* parent) {
  check(!Complete<C> || inherits_from<C, Parent>(),
        words(child, " to inherit from ", parent, ", publicly"));
}

template <typename Ptr, typename F>
Ptr pointer_to(F& part) {
  if constexpr (std::is_pointer_v<Ptr>)
    return &part;
  else
    return Ptr(new F(part));
}
/** make(list) of a vector of pointers to these parts, which have to outlive
 * what is made: of the first of these kinds of pointer that it takes. */
template <typename Ptr, typename... Others, typename Make, typename... Parts>
auto made_of_first(Make make, Parts&... parts) {
  using List = std::vector<Ptr>;
  if constexpr (std::is_invocable_v<Make, List> ||
                std::is_invocable_v<Make, List&>) {
    static List list;  // some keep a reference
    list.clear();
    (list.push_back(pointer_to<Ptr>(parts)), ...);
    if constexpr (std::is_invocable_v<Make, List>)
      return make(std::move(list));
    else
      return make(list);
  } else if constexpr (sizeof...(Others) > 0) {
    return made_of_first<Others...>(make, parts...);
  } else {
    return Missing();
  }
}
template <typename Parent, typename Make, typename... Parts>
auto made_of_list(Make make, Parts&... parts) {
  if constexpr (std::is_void_v<Parent>)
    return Missing();
  else
    return made_of_first<Parent*, const Parent*, std::shared_ptr<Parent>,
                         std::shared_ptr<const Parent>, std::unique_ptr<Parent>,
                         std::unique_ptr<const Parent>>(make, parts...);
}

inline TestConstraint no_constraint() {
  static constexpr auto nothing = [](Cloth&, double) {};
  return TestConstraint(nothing);
}

}  // namespace kit
#endif
