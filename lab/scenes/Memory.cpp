#include "lab/scenes/Memory.hpp"

#include <sys/resource.h>
#include <unistd.h>

#include <algorithm>
#include <fstream>
#include <limits>
#include <string>

namespace lab {
namespace {

constexpr double unknown = std::numeric_limits<double>::infinity();

/** The number that follows @a name in a file of the system, or all of it. */
double number_in(const char* file, const std::string& name = "") {
  std::ifstream in(file);
  std::string word;
  double value = 0;
  if (!name.empty())
    while (in >> word && word != name) {
    }
  return in >> value ? value : unknown;
}

}  // namespace

double needed_memory(double nodes, double springs) {
  // grid of 10^6 nodes, symplectic-euler: 372 MB with diagonals, 274 without;
  // rk4 629 MB, xpbd 442 MB
  return 175 * nodes + 48 * springs;
}

double available_memory() {
  double least = 1024 * number_in("/proc/meminfo", "MemAvailable:");
  // The limit of a control group, and what all of its processes use.
  const char* of_groups[][2] = {
      {"/sys/fs/cgroup/memory.max", "/sys/fs/cgroup/memory.current"},
      {"/sys/fs/cgroup/memory/memory.limit_in_bytes",
       "/sys/fs/cgroup/memory/memory.usage_in_bytes"}};
  for (const auto& [limit, used] : of_groups)
    if (const double all = number_in(limit); all < unknown)
      least = std::min(least, all - std::min(all, number_in(used)));
  return std::min(least, available_addresses());
}

double available_addresses() {
  rlimit addresses{};
  if (getrlimit(RLIMIT_AS, &addresses) != 0 ||
      addresses.rlim_cur == RLIM_INFINITY)
    return unknown;
  const double taken = number_in("/proc/self/statm") * sysconf(_SC_PAGESIZE);
  const double limit = double(addresses.rlim_cur);
  return limit - std::min(limit, taken);
}

}  // namespace lab
