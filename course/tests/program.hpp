/** @file program.hpp
 * Runs the submission's main() on a small cloth. Its viewer keeps what it is
 * given to draw: see film(). Sleeping takes no time. */
#ifndef KIT_PROGRAM_HPP
#define KIT_PROGRAM_HPP
#include <time.h>
#include <unistd.h>

#include "cloth.hpp"
#include "film.hpp"

namespace kit {

/** A file of data/, or of the folder that a grader names: KIT_DATA. */
inline std::string data_file(const char* name) {
#ifdef KIT_TESTS
  std::string folder = KIT_TESTS;
#else
  std::string folder = __FILE__;
  folder.resize(std::max(folder.rfind('/'), std::size_t(0)));
#endif
  const char* data = std::getenv("KIT_DATA");
  return (data ? data : folder + "/data") + ('/' + std::string(name));
}

}  // namespace kit

#ifdef KIT_HAS_MAIN
// In place of the C library's.
extern "C" {
__attribute__((weak)) int nanosleep(const timespec*, timespec*) { return 0; }
__attribute__((weak)) int clock_nanosleep(clockid_t, int, const timespec*,
                                          timespec*) {
  return 0;
}
__attribute__((weak)) int usleep(useconds_t) { return 0; }
}

namespace kit {

template <typename Main>
void call_main(Main main_of, int argc, char** argv) {
  if constexpr (std::is_invocable_v<Main, int, char**>)
    main_of(argc, argv);
  else if constexpr (std::is_invocable_v<Main, int, const char**>)
    main_of(argc, const_cast<const char**>(argv));
  else
    main_of();
}

/** Run a main() with the cloth of cloth.nodes and cloth.tets until it
 * returns, or @a enough(film()) says so after a frame. */
template <typename Main>
const Film& run_program(Main main_of, std::function<bool(const Film&)> enough) {
  std::string words[] = {"mass_spring", data_file("cloth.nodes"),
                         data_file("cloth.tets")};
  char* argv[] = {words[0].data(), words[1].data(), words[2].data(), nullptr};
  new_film().enough = std::move(enough);
  auto* out = std::cout.rdbuf(nullptr);  // what it prints is of no interest
  auto* errors = std::cerr.rdbuf(nullptr);
  auto restore = [&] { std::cout.rdbuf(out), std::cerr.rdbuf(errors); };
  try {
    call_main(main_of, 3, argv);
  } catch (...) {
    restore();
    throw;
  }
  restore();
  return film();
}

}  // namespace kit
#endif
#endif
