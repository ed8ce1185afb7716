#include "lab/methods/Methods.hpp"

namespace lab {

const MethodEntry* find_method(std::string_view name) {
  for (const MethodEntry& m : methods)
    if (m.info.name == name) return &m;
  return own_method && name == own_method->info.name ? own_method : nullptr;
}

}  // namespace lab
