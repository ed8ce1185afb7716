#pragma once
/** @file Methods.hpp
 * The table of all methods, used by every program that lets its user choose.
 * A program that names a class of methods includes that class's header. */
#include <span>
#include <string_view>

#include "lab/methods/Method.hpp"

namespace lab {

/** One line a method; Methods.cpp lists them. */
extern const std::span<const MethodEntry> methods;

/** The lines that programs name. */
namespace table {
extern const MethodEntry &symplectic_euler, &verlet, &mollified_impulse, &pefrl,
    &srkn11b, &rkn64, &tr_bdf2;
}  // namespace table

/** A method that a program adds to the table, or nullptr. */
inline const MethodEntry* own_method = nullptr;

/** The method called @a name, or nullptr. */
const MethodEntry* find_method(std::string_view name);

}  // namespace lab
