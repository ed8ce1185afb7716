/** @file module.cpp
 * The module mass_spring for Python: nets from arrays, scenes from files, runs
 * with their states as arrays, and advice. mass_spring.pyi has its contract,
 * docs/python.md its examples. */
#include <pthread.h>

#include <array>
#include <cmath>
#include <cstring>
#include <filesystem>
#include <optional>
#include <regex>
#include <string>
#include <tuple>
#include <utility>
#include <vector>

#include <pybind11/pybind11.h>
#include <pybind11/stl.h>
#include <pybind11/stl/filesystem.h>

#include "CME212/Util.hpp"
#include "lab/advice/Advise.hpp"
#include "lab/fast/Lanes.hpp"
#include "lab/fast/Sweep.hpp"
#include "lab/fast/Version.hpp"
#include "lab/python/Arrays.hpp"
#include "lab/python/Signals.hpp"
#include "lab/python/Simulation.hpp"
#include "lab/scenes/MeshFile.hpp"
#include "lab/scenes/SceneFile.hpp"
#include "lab/stepping/Changes.hpp"

namespace lab {
namespace {

/** @a message as Python shows it: options without their dashes. */
std::string without_dashes(const std::string& message) {
  return std::regex_replace(message, std::regex("--([a-z])"), "$1");
}

/** The net that arrays describe: mass_spring.pyi has their shapes.
 * Throws py::value_error "ARRAY[INDEX] is ..., expected ..." */
Simulation make_net(const py::object& x, const py::object& edges,
                    const py::object& k, const py::object& L,
                    const py::object& mass, const py::object& fixed,
                    const py::object& v, const py::object& drag,
                    const py::object& gravity, const py::object& cables,
                    const py::object& struts, const py::object& load) {
  Net net;
  net.points = points_of(x, "x");
  const auto n = net.points.size();
  if (!v.is_none()) net.velocities = points_of(v, "v", py::ssize_t(n));
  const auto pairs = py::array::ensure(edges);
  if (!pairs || (pairs.size() > 0 && !std::strchr("iu", pairs.dtype().kind())))
    throw py::type_error("edges holds no nodes, expected pairs of integers");
  if (pairs.ndim() != 2 || pairs.shape(1) != 2)
    refuse("edges has shape " + shape_of(pairs) + ", expected (e, 2)");
  const Array<long long> ends = pairs;
  const auto e = std::size_t(ends.shape(0));
  const auto stiffness = numbers_of(k, "k", e, false);
  const auto length =
      L.is_none() ? std::vector<double>(e, -1) : numbers_of(L, "L", e, false);
  for (std::size_t s = 0; s < e; ++s) {
    const long long i = ends.data()[2 * s], j = ends.data()[2 * s + 1];
    if (std::min(i, j) < 0 || std::max(i, j) >= (long long)(n) || i == j)
      refuse("edges[" + std::to_string(s) + "] is (" + std::to_string(i) +
             ", " + std::to_string(j) +
             "), expected two different nodes, 0 to " + std::to_string(n - 1));
    net.springs.push_back({unsigned(i), unsigned(j), stiffness[s], length[s]});
  }
  for (unsigned s : nodes_of(cables, "cables", e, "spring"))
    net.springs[s].acts = Acts::pulls;
  for (unsigned s : nodes_of(struts, "struts", e, "spring"))
    if (std::exchange(net.springs[s].acts, Acts::pushes) == Acts::pulls)
      refuse("struts has spring " + std::to_string(s) +
             ", which is a cable, expected one of both");
  if (!load.is_none()) {
    const std::vector<Point> force = points_of(load, "load", py::ssize_t(n));
    for (unsigned i = 0; i < n; ++i)
      if (force[i] != Point()) net.loads.push_back({i, force[i]});
  }
  join_ends(net);
  for (const std::string& note : net.notes)
    if (PyErr_WarnEx(PyExc_UserWarning, note.c_str(), 1) != 0)
      throw py::error_already_set();
  net.masses = mass.is_none() ? std::vector<double>(n, 1. / double(n))
                              : numbers_of(mass, "mass", n, true);
  net.held = nodes_of(fixed, "fixed", n);
  Model m;
  m.name = "net";
  const Array<double> a = real(gravity, "gravity");
  if (a.size() != 1 && a.size() != 3)
    refuse("gravity has shape " + shape_of(a) + ", expected a number or (3,)");
  m.gravity = a.size() == 1
                  ? Gravity(*a.data())
                  : Gravity(Point(a.data()[0], a.data()[1], a.data()[2]));
  if (!std::isfinite(m.gravity.size())) refuse("gravity is not finite");
  m.damping = numbers_of(drag, "drag", 1, false)[0];
  return {std::move(m), std::move(net)};
}

/** @a dt as a scene file has it: "" keeps the scene's own. */
std::string step_text(const py::object& dt) {
  if (dt.is_none()) return "";
  if (py::isinstance<py::str>(dt)) return dt.cast<std::string>();
  return CME212::exact_text(dt.cast<double>());
}

Advice advise_on(const Simulation& s, std::optional<double> tolerance,
                 const std::string& method) {
  if (s.is_of_arrays())
    refuse("a Net has one grid and no question: advise() takes a Scene");
  Model m = s.model();
  AdviceRules rules;
  if (tolerance) set_field(m, "tolerance", {CME212::exact_text(*tolerance)});
  if ((rules.keeps_method = !method.empty())) set_field(m, "method", {method});
  return without_gil([&] { return advise(m, rules); });
}

// ------------------------------------------------------------------ The module

/** Errors of the laboratory are ValueErrors or RuntimeErrors with its sentence.
 */
void translate_errors() {
  py::register_exception_translator([](std::exception_ptr p) {
    const auto raise = [](PyObject* type, const std::exception& e) {
      PyErr_SetString(type, without_dashes(e.what()).c_str());
    };
    try {
      std::rethrow_exception(std::move(p));
    } catch (const py::builtin_exception&) {
      throw;
    } catch (const SceneError& e) {
      raise(PyExc_ValueError, e);
    } catch (const SceneFileError& e) {
      raise(PyExc_ValueError, e);
    } catch (const InputError& e) {
      raise(PyExc_ValueError, e);
    } catch (const std::runtime_error& e) {
      raise(PyExc_RuntimeError, e);
    }
  });
}

/** A class whose metaclass is that of Python's own. */
template <typename... T>
py::class_<T...> define(py::module_& module, const char* name,
                        const char* meaning) {
  return {module, name, meaning, py::metaclass((PyObject*)&PyType_Type)};
}

void define_values(py::module_& module) {
  using M = MethodInfo;
  define<M>(module, "Method", "A method: what it declares of itself.")
      .def_readonly("name", &M::name)
      .def_readonly("order", &M::order, "The error of a run goes as dt**order.")
      .def_readonly("forces", &M::sweeps,
                    "Force evaluations a step, without those in linear solves.")
      .def_readonly("limit", &M::limit,
                    "Stable while dt * omega < limit; inf: with any step.")
      .def_readonly("good_for", &M::good_for)
      .def_readonly("fails_when", &M::fails_when)
      .def_readonly("source", &M::source)
      .def("__repr__",
           [](const M& m) { return "<Method " + std::string(m.name) + '>'; });

  define<Why>(module, "Failure", "How and why a run failed.")
      .def_readonly("kind", &Why::kind,
                    "'start', 'diverged', 'refused'; or 'energy': the method "
                    "has added energy, so this is not the scene's motion.")
      .def_readonly("step", &Why::step,
                    "The number of the step that failed, from 1; of the last "
                    "one for 'energy'.")
      .def_readonly("time", &Why::time, "The time of the last good state [s].")
      .def_readonly("dt", &Why::dt, "The step that failed [s].")
      .def_readonly("node", &Why::node,
                    "The worst node of the bad state, or None.")
      .def_readonly("cause", &Why::cause, "The cause, in words.")
      .def_readonly(
          "cure", &Why::cure,
          "A method and a step [s] with which a trial did not fail, or None.")
      .def("__str__", [](const Why& w) { return without_dashes(w.text); });

  // An array of a Result, in its memory.
  const auto array = [](auto values, bool of_nodes) {
    return [=](const py::object& self) {
      const auto& r = self.cast<const Result&>();
      std::vector<py::ssize_t> shape = {py::ssize_t(r.t.size())};
      if (of_nodes) shape.insert(shape.end(), {py::ssize_t(r.nodes), 3});
      return py::array_t<double>(
          shape, reinterpret_cast<const double*>((r.*values).data()), self);
    };
  };
  define<Result>(module, "Result", "The states of a run: k of n nodes.")
      .def_property_readonly("t", array(&Result::t, false),
                             "Times [s], shape (k,).")
      .def_property_readonly(
          "x", array(&Result::x, true),
          "Positions [m], shape (k, n, 3); nan: the node was removed.")
      .def_property_readonly("v", array(&Result::v, true),
                             "Velocities [m/s], shape (k, n, 3).")
      .def_property_readonly(
          "energy", array(&Result::energy, false),
          "Kinetic, elastic and gravitational energy [J], together, shape "
          "(k,).")
      .def_readonly("work", &Result::evaluations, "Force evaluations.")
      .def_readonly("steps", &Result::steps, "Steps done.")
      .def_readonly("why", &Result::why, "A Failure, or None.")
      .def_property_readonly(
          "status", [](const Result& r) { return r.why ? 3 : 0; },
          "0: done; 3: the run failed, and why says how.");

  const auto rows = [](std::vector<Point> AtRest::*points) {
    return [=](const AtRest& r) { return as_array(r.*points); };
  };
  define<AtRest>(module, "Rest", "A scene at rest. str() has the whole report.")
      .def_property_readonly("x", rows(&AtRest::x),
                             "Positions [m], shape (n, 3).")
      .def_property_readonly(
          "force", rows(&AtRest::force),
          "The force on each node [N], shape (n, 3): what pins and obstacles "
          "carry, elsewhere the residual.")
      .def_property_readonly(
          "pins",
          [](const AtRest& r) {
            std::vector<std::tuple<std::string, std::array<double, 3>>> all;
            for (const auto& [pin, f] : r.pins)
              all.push_back({pin, {f.x, f.y, f.z}});
            return all;
          },
          "The force that each pin carries [N]: (name, [x, y, z]).")
      .def_readonly("residual", &AtRest::residual,
                    "What is left of all forces [N].")
      .def_readonly("load", &AtRest::load,
                    "Weight and loads, or else all forces at first [N].")
      .def_readonly("factors", &AtRest::factors, "Cholesky factors it took.")
      .def_property_readonly(
          "stable", &AtRest::stable,
          "Does the energy rise whichever way nodes may move?")
      .def_property_readonly("growing", &AtRest::growing_nodes,
                             "Nodes that leave this state, if it is unstable.")
      .def_property_readonly(
          "loose", &AtRest::loose_nodes,
          "Nodes that no energy holds, which may move freely.")
      .def_readonly("slack", &AtRest::slack,
                    "The ends of cables and struts that do not act.")
      .def_property_readonly("frequencies", &AtRest::frequencies,
                             "The lowest, at most ten [Hz], rising.")
      .def("__str__", &AtRest::text);

  define<Advice>(module, "Advice",
                 "The cheapest run found that answers a scene's question. "
                 "str() has the whole report.")
      .def_readonly("refusal", &Advice::refusal,
                    "Why nothing is advised; empty: it is.")
      .def_property_readonly(
          "method", [](const Advice& a) { return a.model.method->info.name; })
      .def_property_readonly(
          "dt", [](const Advice& a) { return a.model.step.dt; }, "[s]")
      .def_readonly("error", &Advice::error,
                    "The expected error, in the unit of the measure.")
      .def_readonly("tolerance", &Advice::tolerance)
      .def_readonly("work", &Advice::work, "Spring evaluations of that run.")
      .def_property_readonly(
          "scene", [](const Advice& a) { return Simulation(a.model); },
          "The advised Scene.")
      .def("__str__", [](const Advice& a) { return in_words(a); });
}

struct FromArrays : Simulation {
  explicit FromArrays(Simulation s) : Simulation(std::move(s)) {}
};

void define_simulations(py::module_& module) {
  define<Simulation>(module, "Scene", "A scene; or a Net.")
      .def_property_readonly(
          "x", [](const Simulation& s) { return as_array(s.mesh().points); },
          "Positions at the start [m], shape (n, 3); a copy.")
      .def("limit", &Simulation::limit, py::arg("method"),
           "The largest step [s] with which a method is stable; inf: any is, "
           "0: none is.")
      .def(
          "run",
          [](const Simulation& s, const std::string& method,
             std::optional<double> t_end, const py::object& dt,
             std::optional<double> every, std::optional<double> atol,
             const py::object& x0, const py::object& v0) {
            const std::string step = step_text(dt);
            const auto n = py::ssize_t(s.mesh().points.size());
            const auto rows = [n](const py::object& given, const char* name) {
              return given.is_none() ? std::vector<Point>()
                                     : points_of(given, name, n);
            };
            auto x = rows(x0, "x0"), v = rows(v0, "v0");
            return without_gil([&] {
              return s.run(method, t_end, step, every, atol, std::move(x),
                           std::move(v));
            });
          },
          py::arg("method") = "", py::arg("t_end") = py::none(),
          py::arg("dt") = py::none(), py::kw_only(),
          py::arg("every") = py::none(), py::arg("atol") = py::none(),
          py::arg("x0") = py::none(), py::arg("v0") = py::none(),
          "Run from the start to t_end [s] and return a Result.\n\n"
          "method: a name, see methods(). dt: the step [s]; 'auto': chosen by "
          "the stability limit and the energy; each by default as the scene "
          "says. every: record a state every so many seconds, at the first "
          "step there; None: the first and the last state. atol: tolerated "
          "error of an inner step of rkn64 [m]. x0, v0: positions [m] and "
          "velocities [m/s] to start from, (n, 3), with the rest lengths of "
          "the net; None: its own.\n\n"
          "A run that fails returns: see Result.why. Raises ValueError for an "
          "argument that can't be used, KeyboardInterrupt by Ctrl-C. Releases "
          "the GIL.")
      .def(
          "rest",
          [](const Simulation& s) {
            return without_gil([&] { return s.rest(); });
          },
          "The Rest at which the cloth can hang for ever, by Newton's method "
          "from the start.\n\n"
          "Raises ValueError for what has no such state: moving pins, tearing, "
          "self-collision, changes in time; RuntimeError if nothing holds a "
          "node, or no rest is found; KeyboardInterrupt by Ctrl-C. Releases "
          "the GIL.")
      .def(
          "force",
          [](Simulation& s, const py::object& x, const py::object& v,
             double t) {
            const auto n = py::ssize_t(s.mesh().points.size());
            return as_array(
                s.force(points_of(x, "x", n), points_of(v, "v", n), t));
          },
          py::arg("x"), py::arg("v"), py::arg("t") = 0.,
          "The force on each node [N], shape (n, 3), in positions x [m] with "
          "velocities v [m/s], both (n, 3). Held nodes are not excepted.")
      .def("advise", &advise_on, py::arg("tolerance") = py::none(),
           py::arg("method") = "",
           "Find the cheapest model that answers the scene's question to "
           "tolerance, in the unit of its measure; with this method only. "
           "Raises ValueError if the scene can't answer it.");
  define<FromArrays, Simulation>(
      module, "Net",
      "A net of point masses and springs.\n\n"
      "x: positions [m], (n, 3). edges: pairs of nodes, (e, 2). k: stiffness "
      "[N/m], a number or (e,). L: rest lengths [m], a number or (e,); None: "
      "as long as in x. mass [kg]: a number or (n,); None: 1 kg in all. "
      "fixed: nodes that are held, or a mask of n. v: velocities [m/s], (n, "
      "3); None: at rest. "
      "drag: c of each node [kg/s], force -c v. gravity [m/s^2]: a number acts "
      "down, along -z; or a vector. cables, struts: edges that only pull, only "
      "push, by number or as a mask of e. load: forces on nodes [N], (n, "
      "3).\n\n"
      "Raises ValueError \"ARRAY[INDEX] is ..., expected ...\".")
      .def(py::init([](const py::object& x, const py::object& edges,
                       const py::object& k, const py::object& L,
                       const py::object& mass, const py::object& fixed,
                       const py::object& v, const py::object& drag,
                       const py::object& gravity, const py::object& cables,
                       const py::object& struts, const py::object& load) {
             return FromArrays(make_net(x, edges, k, L, mass, fixed, v, drag,
                                        gravity, cables, struts, load));
           }),
           py::arg("x"), py::arg("edges"), py::kw_only(), py::arg("k") = 100.,
           py::arg("L") = py::none(), py::arg("mass") = py::none(),
           py::arg("fixed") = py::tuple(), py::arg("v") = py::none(),
           py::arg("drag") = 0., py::arg("gravity") = grav,
           py::arg("cables") = py::tuple(), py::arg("struts") = py::tuple(),
           py::arg("load") = py::none());
}

}  // namespace
}  // namespace lab

PYBIND11_MODULE(mass_spring, module) {
  using namespace lab;
  module.doc() = "Mass-spring cloth: nets, scenes, methods, advice.";
  module.attr("__version__") = version;
  lanes::cpu = lanes::fastest_cpu();
  // The threads of OpenMP are not there after a fork.
  pthread_atfork(nullptr, nullptr, [] { Sweep::set_threads(1); });
  translate_errors();
  define_values(module);
  define_simulations(module);
  module.def(
      "scene",
      [](const std::filesystem::path& file) {
        Simulation s =
            without_gil([&] { return Simulation(load_model(file.string())); });
        read_changes(s.model().at);
        return s;
      },
      py::arg("file"), "The Scene in a scene file: see lab/scenes/README.md.");
  module.def(
      "methods",
      [] {
        std::vector<MethodInfo> all;
        for (const MethodEntry& m : methods) all.push_back(m.info);
        return all;
      },
      "All methods that run() takes.");
}
