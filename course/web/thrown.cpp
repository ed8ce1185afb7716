/** @file thrown.cpp
 * A throw or a failed assertion ends a call in WebAssembly, which has no catch:
 * the call traps, and page_thrown() tells the page why. The other sources need
 * no change for that. */
#include <__verbose_abort>
#include <cstdarg>
#include <cstdio>
#include <cstdlib>
#include <exception>
#include <string>
#include <typeinfo>

namespace {

char thrown[1000] = "";

[[noreturn]] void end_with(const char* format, std::va_list values) {
  std::vsnprintf(thrown, sizeof thrown, format, values);
  __builtin_trap();
}
[[noreturn]] void end(const char* format, ...) {
  std::va_list values;
  va_start(values, format);
  end_with(format, values);
}

/** How the ABI of C++ stores the type of a class with one base. */
struct ClassType {
  const void* functions;
  const char* name;
  const std::type_info* base;
};
/** Is it std::exception, or a class derived from it, one base at a time? */
bool is_exception(const std::type_info* type) {
  const std::string one_base = "N10__cxxabiv120__si_class_type_infoE";
  while (*type != typeid(std::exception)) {
    if (typeid(*type).name() != one_base) return false;
    type = reinterpret_cast<const ClassType*>(type)->base;
  }
  return true;
}

}  // namespace

extern "C" {

/** The message of the throw that ended the last call; "" if it was another
 * fault. */
const char* page_thrown() { return thrown; }

void* __cxa_allocate_exception(std::size_t size) { return std::malloc(size); }
void __cxa_free_exception(void*) {}

[[noreturn]] void __cxa_throw(void* object, std::type_info* type,
                              void (*)(void*)) {
  if (is_exception(type))
    end("%s", static_cast<const std::exception*>(object)->what());
  if (*type == typeid(const char*))
    end("%s", *static_cast<const char* const*>(object));
  if (*type == typeid(std::string))
    end("%s", static_cast<const std::string*>(object)->c_str());
  if (*type == typeid(int)) end("throw %d", *static_cast<const int*>(object));
  end("a throw of type %s", type->name());
}

[[noreturn]] void __assert_fail(const char* text, const char* file, int line,
                                const char* function) {
  end("%s:%d: assertion `%s' failed in %s", file, line, text, function);
}
}

/** The checks of libc++: an index beyond the end of a vector and the like. */
// Newer versions declare it noexcept.
void std::__libcpp_verbose_abort(const char* format, ...) noexcept(
    noexcept(std::__libcpp_verbose_abort("%s", ""))) {
  std::va_list values;
  va_start(values, format);
  end_with(format, values);
}
