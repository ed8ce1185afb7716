#pragma once
/** @file Arrays.hpp
 * NumPy arrays to vectors, and vectors to arrays. */
#include <cmath>
#include <cstring>
#include <string>
#include <utility>
#include <vector>

#include <pybind11/numpy.h>

#include "CME212/Point.hpp"
#include "CME212/Util.hpp"

namespace lab {

namespace py = pybind11;

template <typename T>
using Array = py::array_t<T, py::array::c_style | py::array::forcecast>;

/** @a rows as an array of shape (n, 3) that owns them: nothing is copied. */
inline py::array as_array(std::vector<Point> rows) {
  auto* kept = new std::vector<Point>(std::move(rows));
  py::capsule owner(
      kept, [](void* p) { delete static_cast<std::vector<Point>*>(p); });
  return py::array_t<double>({py::ssize_t(kept->size()), py::ssize_t(3)},
                             reinterpret_cast<const double*>(kept->data()),
                             owner);
}

/** Throws a ValueError: "NAME is ..., expected ...". */
[[noreturn]] inline void refuse(const std::string& what) {
  throw py::value_error(what);
}

inline std::string shape_of(const py::array& a) {
  return py::str(py::tuple(a.attr("shape")));
}

/** @a given as an array of numbers. Throws a TypeError if it holds others. */
inline Array<double> real(const py::object& given, const char* name) {
  const auto a = py::array::ensure(given);
  if (!a || !std::strchr("fiu", a.dtype().kind()))
    throw py::type_error(
        std::string(name) + " holds " +
        std::string(py::str(a ? a.dtype() : given.get_type())) +
        ", expected numbers");
  return a;
}

/** Nodes, or @a what, of @a n that @a given names by their numbers, or as a
 * mask of n. Throws a TypeError or a ValueError. */
inline std::vector<unsigned> nodes_of(const py::object& given, const char* name,
                                      std::size_t n,
                                      const std::string& what = "node") {
  const bool is_set = py::isinstance<py::set>(given);
  const auto a = py::array::ensure(is_set ? py::list(given) : given);
  const char kind = !a ? 'O' : a.size() == 0 ? 'i' : a.dtype().kind();
  if (!std::strchr("biu", kind) || a.ndim() != 1)
    throw py::type_error(std::string(name) + " holds no " + what +
                         "s, expected their numbers, or a mask "
                         "of shape (" +
                         std::to_string(n) + ",)");
  std::vector<unsigned> nodes;
  if (kind == 'b' && std::size_t(a.size()) != n)
    refuse(std::string(name) + " is a mask of shape " + shape_of(a) +
           ", expected (" + std::to_string(n) + ",)");
  const Array<long long> at = a;
  for (py::ssize_t k = 0; k < at.size(); ++k) {
    const long long i = kind == 'b' ? k : at.data()[k];
    if (i < 0 || i >= (long long)(n))
      refuse(std::string(name) + '[' + std::to_string(k) + "] is " +
             std::to_string(i) + ", expected a " + what + ", 0 to " +
             std::to_string(n - 1));
    if (kind != 'b' || at.data()[k]) nodes.push_back(unsigned(i));
  }
  return nodes;
}

/** The rows of @a given, an array of shape (n, 3) of finite numbers. */
inline std::vector<Point> points_of(const py::object& given, const char* name,
                                    py::ssize_t n = -1) {
  const Array<double> a = real(given, name);
  if (a.ndim() != 2 || a.shape(1) != 3 || (n >= 0 && a.shape(0) != n))
    refuse(std::string(name) + " has shape " + shape_of(a) + ", expected (" +
           (n < 0 ? "n" : std::to_string(n)) + ", 3)");
  const auto* first = reinterpret_cast<const Point*>(a.data());
  std::vector<Point> points(first, first + a.shape(0));
  for (std::size_t i = 0; i < points.size(); ++i)
    if (!std::isfinite(norm_1(points[i])))
      refuse(std::string(name) + '[' + std::to_string(i) +
             "] is not finite, expected three numbers");
  return points;
}

/** One number for all of @a n, or an array of n; each at least @a least. */
inline std::vector<double> numbers_of(const py::object& given, const char* name,
                                      std::size_t n, bool positive) {
  const Array<double> a = real(given, name);
  if (a.ndim() != 0 && (a.ndim() != 1 || std::size_t(a.shape(0)) != n))
    refuse(std::string(name) + " has shape " + shape_of(a) +
           ", expected a number or (" + std::to_string(n) + ",)");
  std::vector<double> all(n);
  for (std::size_t i = 0; i < n; ++i) {
    all[i] = a.data()[a.ndim() == 0 ? 0 : i];
    if (!std::isfinite(all[i]) || all[i] < 0 || (positive && all[i] == 0))
      refuse(std::string(name) +
             (a.ndim() == 0 ? "" : '[' + std::to_string(i) + ']') + " is " +
             CME212::short_text(all[i]) + ", expected a number " +
             (positive ? "above 0" : "of at least 0"));
  }
  return all;
}

}  // namespace lab
