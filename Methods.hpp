#pragma once
/** @file Methods.hpp
 * The table of all methods: one line a method, used by every program that
 * lets its user choose. */
#include <array>
#include <string_view>

#include "Implicit.hpp"
#include "Integrator.hpp"
#include "RungeKutta.hpp"
#include "Xpbd.hpp"

inline constexpr std::array methods = {entry_of<ForwardEuler>(),
                                       entry_of<SymplecticEuler>(),
                                       entry_of<Verlet>(),
                                       entry_of<Yoshida4>(),
                                       entry_of<Pefrl>(),
                                       entry_of<Srkn6b>(),
                                       entry_of<Srkn11b>(),
                                       entry_of<Rk4>(),
                                       entry_of<DormandPrince>(),
                                       entry_of<ImplicitEuler>(),
                                       entry_of<ImplicitMidpoint>(),
                                       entry_of<TrBdf2>(),
                                       entry_of<AugmentedVerlet>(),
                                       entry_of<Xpbd>()};

/** The method called @a name, or nullptr. */
inline const MethodEntry* find_method(std::string_view name) {
  for (const MethodEntry& m : methods)
    if (m.info.name == name) return &m;
  return nullptr;
}
