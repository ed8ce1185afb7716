/** @file cloth.hpp
 * A bridge from the tests to any mass_spring.hpp or mass_spring.cpp of the
 * course. It brings the submission and check.hpp; a test of the cloth includes
 * this file and nothing else.
 *
 * Accepts all that the assignment leaves open: calls that are const or
 * not, templates or not, that take a node by value or by reference; classes
 * that are made from nothing, from numbers, from points or from a graph; the
 * names in the values of nodes and edges; a base class of the forces or none;
 * calls that are public in that base only; constraints that take a Graph*.
 *
 * A grader may define
 *   KIT_PROGRAM           main() is wanted, too: 7.2.program
 *   KIT_STAGES            main() has the stages of our starter, by STAGE
 *   KIT_STAGE             the only one of them; else tear
 *   KIT_GRAPH             the type of the cloth; else GraphType
 *   KIT_FORCE_BASE        the base of the forces; else ZeroForce or Force
 *   KIT_CONSTRAINT_BASE   of the constraints; else ZeroConstraint, Constraint
 *   KIT_NAMESPACES        there are namespaces, which may hide these bases
 *   KIT_TEAR              the constraint that removes nodes */
#ifndef KIT_CLOTH_HPP
#define KIT_CLOTH_HPP

#ifndef KIT_STAGE
#define KIT_STAGE tear
#endif

// The program includes its header itself, which may have no include guard.
#if __has_include("mass_spring.hpp") && \
                  !(defined(KIT_PROGRAM) && __has_include("mass_spring.cpp"))
#include "mass_spring.hpp"
#endif
#if !__has_include("mass_spring.hpp") || defined(KIT_PROGRAM)
#if __has_include("mass_spring.cpp")
#include <CME212/SDLViewer.hpp>       // of headless/
#if __has_include("mass_spring.hpp")  // made from our starter
#define MASS_SPRING_VIEWER
#endif
// As an inline function it takes no time to compile unless a test calls it. A
// main() may end without a return, another function may not: GCC 13 traps
// there.
#if __GNUC__ >= 13 && !defined(__clang__)
#define main                                      \
  inline __attribute__((no_sanitize("undefined"), \
                        optimize("no-unreachable-traps"))) submitted_main
#else
#define main inline __attribute__((no_sanitize("undefined"))) submitted_main
#endif
#ifdef KIT_STAGES
#include "mass_spring.hpp"
#include "stages.hpp"
#define KIT_MAIN ::kit_tear::submitted_main
#else
#define STAGE KIT_STAGE
#include "mass_spring.cpp"
#define KIT_MAIN ::submitted_main
#endif
#undef main
#undef STAGE
#define KIT_HAS_MAIN
#endif
#endif

// Macros of a submission have done their work.
#undef K
#undef L
#undef C
#undef G
#undef N
#undef c
#undef g
#undef k
#undef l
#undef m
#undef n
#undef t
#undef v
#undef x
#undef dt
#ifdef KIT_UNDEFINED
#include KIT_UNDEFINED
#endif
#include "check.hpp"
#include "values.hpp"

// ------------------------------------------ Names that may be missing

#ifndef KIT_FORCE_BASE
#define KIT_FORCE_BASE ZeroForce
#endif
#ifndef KIT_CONSTRAINT_BASE
#define KIT_CONSTRAINT_BASE ZeroConstraint
#endif
#ifndef KIT_TEAR
#define KIT_TEAR TearConstraint
#endif

// ::ZeroForce is the submission's if it has one. If not, the language looks
// into the namespaces that the global one uses, and finds these.
namespace kit_missing {
struct KIT_FORCE_BASE;  // it may be in a namespace
struct KIT_CONSTRAINT_BASE;
struct ZeroForce;
struct Force;
struct Problem1Force;
struct GravityForce;
struct MassSpringForce;
struct DampingForce;
struct ZeroConstraint;
struct Constraint;
struct PinConstraint;
struct PlaneConstraint;
struct SphereConstraint;
struct TearConstraint;
struct CombinedForces;
struct CombinedConstraints;
struct Ball;
struct Missing {};
inline constexpr Missing K, L, C, c;
template <typename... T>
Missing build_cloth(T&&...) {
  return {};
}
template <typename... T>
Missing make_combined_force(T&&...) {
  return {};
}
template <typename... T>
Missing make_combined_constraint(T&&...) {
  return {};
}
template <typename... T>
Missing make_combined_constraints(T&&...) {
  return {};
}
}  // namespace kit_missing
using namespace kit_missing;

#ifndef KIT_GRAPH
#define KIT_GRAPH GraphType
#endif

namespace kit {

using kit_missing::Missing;
using Cloth = ::KIT_GRAPH;
using ClothNode = typename Cloth::node_type;
using ClothEdge = typename Cloth::edge_type;
// In a test a plain name is the submission's.
using ::DampingForce, ::GravityForce, ::MassSpringForce, ::Problem1Force;
using ::make_combined_constraints, ::make_combined_force, ::build_cloth;
using ::PinConstraint, ::PlaneConstraint, ::SphereConstraint, ::TearConstraint;

template <typename T>
concept Complete = requires {
  sizeof(T);
};
template <typename T>
concept Present = !std::is_same_v<T, Missing>;

/** The class T, or T<Arg> if it is a template; a template is no base. */
template <typename Arg, typename T>
std::type_identity<T> class_of();
template <typename Arg, template <typename...> class T>
std::type_identity<T<Arg>> class_of();
/** Run @a test<C>(), or fail if the class is missing: it costs this test only,
 * and no other one the time to compile it apart. */
template <typename C, typename Test>
void with(const char* name, Test test) {
  if constexpr (Complete<C>)
    test.template operator()<C>();
  else
    fail(words("a class ", name), "none");
}

#define KIT_FORCE(name) \
  typename decltype(kit::class_of<kit::ClothNode, ::name>())::type
#define KIT_CONSTRAINT(name) \
  typename decltype(kit::class_of<kit::Cloth, ::name>())::type

}  // namespace kit

#include "cloth_bodies.hpp"
#include "cloth_laws.hpp"
// Behind the others, which it needs.
#include "cloth_calls.hpp"
#endif

#include "check.hpp"
