#pragma once
/** @file Methods.hpp
 * The table of all methods: one line a method, used by every program that
 * lets its user choose. */
#include <algorithm>
#include <array>
#include <string_view>

#include "lab/methods/FastMassSpring.hpp"
#include "lab/methods/ForwardEuler.hpp"
#include "lab/methods/ImplicitEuler.hpp"
#include "lab/methods/ImplicitMidpoint.hpp"
#include "lab/methods/MollifiedImpulse.hpp"
#include "lab/methods/Pefrl.hpp"
#include "lab/methods/Rk4.hpp"
#include "lab/methods/Rkn64.hpp"
#include "lab/methods/Srkn11b.hpp"
#include "lab/methods/SymplecticEuler.hpp"
#include "lab/methods/TrBdf2.hpp"
#include "lab/methods/Verlet.hpp"
#include "lab/methods/Xpbd.hpp"

namespace lab {

inline constexpr std::array methods = {
    entry_of<ForwardEuler>(),  entry_of<SymplecticEuler>(),
    entry_of<Verlet>(),        entry_of<MollifiedImpulse>(),
    entry_of<Pefrl>(),         entry_of<Srkn11b>(),
    entry_of<Rk4>(),           entry_of<Rkn64>(),
    entry_of<ImplicitEuler>(), entry_of<ImplicitMidpoint>(),
    entry_of<TrBdf2>(),        entry_of<FastMassSpring>(),
    entry_of<Xpbd>()};

/** The line of @a M in the table. It does not compile if there is none. */
template <typename M>
inline constexpr const MethodEntry& table_entry =
    *std::ranges::find(methods, std::string_view(M::info.name),
                       [](const MethodEntry& m) { return m.info.name; });

/** A method that a program adds to the table, or nullptr. */
inline const MethodEntry* own_method = nullptr;

/** The method called @a name, or nullptr. */
const MethodEntry* find_method(std::string_view name);

}  // namespace lab
