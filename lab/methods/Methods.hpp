#pragma once
/** @file Methods.hpp
 * The table of all methods, used by every program that lets its user choose.
 * A program that names a class of methods includes that class's header. */
#include <span>
#include <string_view>

#include "lab/methods/Method.hpp"

namespace lab {

/** One line a method of the laboratory; Methods.cpp lists them. */
extern const std::span<const MethodEntry> methods;

/** The lines that programs name. */
namespace table {
extern const MethodEntry &forward_euler, &symplectic_euler, &verlet,
    &mollified_impulse, &pefrl, &srkn11b, &rk4, &rkn64, &implicit_euler,
    &tr_bdf2, &xpbd;
}  // namespace table

/** The method called @a name, or nullptr. */
const MethodEntry* find_method(std::string_view name);

/** The work of a step of @a limits times Verlet's stability limit, in force
 * evaluations; that of linear solves is from Costs.hpp, so that it depends on
 * no clock.  @param side nodes along a side of the cloth */
double work_of_step(const MethodInfo& method, double limits, double side);
/** True if the work of a step depends on the motion: only a run tells it. */
bool work_varies(const MethodInfo& method);

}  // namespace lab
