/** @file peers.cpp
 * Compares our methods with those of Boost.odeint, SUNDIALS and GSL, on the
 * same problems, with the same force kernel and clock. Writes CSV to the
 * standard output:
 *   make peers-deps peers-chart
 * All are used as their manuals suggest. All runs take turns, five times. A
 * library calls our kernel with a copy of the positions: 15 % of the time. */
#if !__has_include(<boost/numeric/odeint.hpp>) || \
    !__has_include(<cvode/cvode.h>) || !__has_include(<gsl/gsl_odeiv2.h>)
#error "Boost, SUNDIALS or GSL is missing: make peers-deps"
#endif

#include <arkode/arkode_erkstep.h>
#include <cvode/cvode.h>
#include <gsl/gsl_errno.h>
#include <gsl/gsl_odeiv2.h>
#include <nvector/nvector_serial.h>
#include <sunnonlinsol/sunnonlinsol_fixedpoint.h>

#include <algorithm>
#include <boost/numeric/odeint.hpp>
#include <boost/numeric/odeint/stepper/symplectic_rkn_sb3a_m4_mclachlan.hpp>
#include <boost/numeric/odeint/stepper/velocity_verlet.hpp>
#include <functional>
#include <iostream>
#include <string>
#include <vector>

#include "lab/charts/Problem.hpp"
#include "lab/fast/FlatFlow.hpp"
#include "lab/fast/GraphArrays.hpp"
#include "lab/fast/Sweep.hpp"
#include "lab/methods/Methods.hpp"
#include "lab/stability/Spectrum.hpp"

using namespace lab;

namespace {

using State = std::vector<double>;

/** A problem as an ordinary differential equation in flat arrays: positions
 * and velocities of all nodes. Held nodes have no acceleration. */
class Equation {
 public:
  const Problem& problem;
  const double t_end = problem.t_end;  // [s]
  const Reference right = reference(problem);
  Start at_start{problem};
  long calls = 0;

  explicit Equation(const Problem& p) : problem(p) {
    at_start.constraint.each_held(at_start.cloth,
                                  [this](Node n) { held_[n.id()] = true; });
    flow_.begin(at_start.cloth, at_start.force, true);
  }
  /** Number of coordinates. */
  std::size_t size() const { return 3 * held_.size(); }
  /** Positions and velocities at t = 0. */
  State start() const {
    const double* x = &arrays(at_start.cloth).positions()[0].x;
    State y(x, x + size());
    y.resize(2 * size());
    return y;
  }
  /** a = F(q)/m [m/s^2] */
  void acceleration(const double* q, double* a) {
    ++calls;
    for (unsigned i = 0; i < held_.size(); ++i, q += 3)
      flow_.cloth().set_position(i, Point(q[0], q[1], q[2]));
    flow_.run({.t = 0, .kick = 0, .keep = true});
    for (unsigned i = 0; i < held_.size(); ++i)
      for (double c : flow_.acceleration(i)) *a++ = held_[i] ? 0 : c;
  }
  /** (q, v)' for y = (q, v) */
  void derivative(const double* y, double* dy) {
    std::copy(y + size(), y + 2 * size(), dy);
    acceleration(y, dy + size());
  }
  /** RMS distance of the nodes from the right answer [m]. */
  double error(const double* q) const {
    End end;
    for (const double* last = q + size(); q != last; q += 3)
      end.positions.emplace_back(q[0], q[1], q[2]);
    return distance(problem, end, right.end);
  }

 private:
  FlatFlow flow_;
  std::vector<bool> held_ =
      std::vector<bool>(arrays(at_start.cloth).node_slots());
};

Equation* equation;  // for the C callbacks

int steps_of(double dt) { return int(std::lround(equation->t_end / dt)); }

// --------------------------------------------------------------- Boost.odeint

namespace odeint = boost::numeric::odeint;

struct Acceleration {
  void operator()(const State& x, State& a) const {
    equation->acceleration(x.data(), a.data());
  }
  void operator()(const State& x, const State&, State& a, double) const {
    (*this)(x, a);
  }
};

template <typename Stepper>
State run_odeint(double dt) {
  Stepper stepper;
  State q = equation->start(), v(equation->size());
  q.resize(v.size());
  for (int n = 0; n < steps_of(dt); ++n)
    stepper.do_step(Acceleration(), std::pair(std::ref(q), std::ref(v)), n * dt,
                    dt);
  return q;
}

// ------------------------------------------------------------------- SUNDIALS

void require(bool ok, const char* what) {
  if (!ok) throw std::runtime_error(what);
}
int sundials_rhs(realtype, N_Vector y, N_Vector dy, void*) {
  equation->derivative(N_VGetArrayPointer(y), N_VGetArrayPointer(dy));
  return 0;
}

/** Context and vector of one run; freed with it. */
struct Sundials {
  SUNContext context = nullptr;
  State y = equation->start();
  N_Vector vector;
  Sundials() {
    SUNContext_Create(nullptr, &context);
    vector = N_VMake_Serial(sunindextype(y.size()), y.data(), context);
  }
  ~Sundials() {
    N_VDestroy(vector);
    SUNContext_Free(&context);
  }
};

State run_cvode_adams(double tolerance) {
  Sundials s;
  void* mem = CVodeCreate(CV_ADAMS, s.context);
  CVodeInit(mem, sundials_rhs, 0, s.vector);
  CVodeSStolerances(mem, tolerance, tolerance);
  CVodeSetMaxNumSteps(mem, 10000000);
  CVodeSetStopTime(mem, equation->t_end);
  auto solver = SUNNonlinSol_FixedPoint(s.vector, 0, s.context);
  CVodeSetNonlinearSolver(mem, solver);
  realtype t;
  int flag = CVode(mem, equation->t_end, s.vector, &t, CV_NORMAL);
  SUNNonlinSolFree(solver);
  CVodeFree(&mem);
  require(flag >= 0, "CVODE failed");
  return s.y;
}

State run_arkode_dopri(double tolerance) {
  Sundials s;
  void* mem = ERKStepCreate(sundials_rhs, 0, s.vector, s.context);
  ERKStepSStolerances(mem, tolerance, tolerance);
  ERKStepSetTableNum(mem, ARKODE_DORMAND_PRINCE_7_4_5);
  ERKStepSetMaxNumSteps(mem, 10000000);
  ERKStepSetStopTime(mem, equation->t_end);
  realtype t;
  int flag = ERKStepEvolve(mem, equation->t_end, s.vector, &t, ARK_NORMAL);
  ERKStepFree(&mem);
  require(flag >= 0, "ARKODE failed");
  return s.y;
}

// ------------------------------------------------------------------------ GSL

State run_gsl_rk8pd(double tolerance) {
  gsl_odeiv2_system system = {[](double, const double* y, double* dy, void*) {
                                equation->derivative(y, dy);
                                return int(GSL_SUCCESS);
                              },
                              nullptr, 2 * equation->size(), nullptr};
  gsl_odeiv2_driver* driver = gsl_odeiv2_driver_alloc_y_new(
      &system, gsl_odeiv2_step_rk8pd, 1e-4, tolerance, tolerance);
  State y = equation->start();
  double t = 0;
  int flag = gsl_odeiv2_driver_apply(driver, &t, equation->t_end, y.data());
  gsl_odeiv2_driver_free(driver);
  require(flag == GSL_SUCCESS, "GSL failed");
  return y;
}

// ------------------------------------------------------------------- Measuring

/** The cost of a run, and the error of its end [m]. */
struct Result {
  double seconds = 0, error = 0;
  long calls = 0;
};
/** A method with a step [s] or a tolerance. */
using Runner = std::function<Result(double parameter)>;

Runner ours(const MethodEntry& entry) {
  return [&entry](double parameter) {
    const Problem& p = equation->problem;
    Start s(p);
    const ConstraintPlan pins = p.constraints(s.cloth);
    auto method = entry.make();
    method->set_tolerance(parameter);
    const double dt = entry.info.adaptive ? p.t_end : parameter;
    CME212::Clock clock;
    method->steps(s.cloth, {0, dt}, steps_of(dt), s.force, pins);
    return Result{clock.seconds(), distance(p, end_of(s), equation->right.end),
                  long(s.force.evaluations())};
  };
}
Runner theirs(State (*run)(double)) {
  return [run](double parameter) {
    equation->calls = 0;
    CME212::Clock clock;
    const State end = run(parameter);
    const double seconds = clock.seconds();
    return Result{seconds, equation->error(end.data()), equation->calls};
  };
}

struct Candidate {
  const char* method;
  double parameter;
  Runner run;
  Result first;
  std::vector<double> seconds = {};  // of the repeats
};

/** Add runs of a method, each to warm up: up to the first one that the
 * reference cannot judge, or that takes too long. Tolerances become smaller by
 * half, steps by a sixth. A run that fails is reported and left out.
 * @param steps the least number; 0 if the parameter is a tolerance */
void add(std::vector<Candidate>& all, const char* name, double steps,
         const Runner& run) {
  for (double t = 1e-2; t > 1e-14; t /= 2, steps *= 1.2) {
    const double parameter = steps > 0 ? equation->t_end / std::ceil(steps) : t;
    try {
      const Result r = run(parameter);
      require(r.error < 1, "diverged");
      all.push_back({name, parameter, run, r});
      if (r.error <= 10 * equation->right.floor || r.calls > 20000) return;
    } catch (const std::exception& e) {
      std::cerr << name << ' ' << parameter << ": " << e.what() << '\n';
    }
  }
}

std::vector<Candidate> candidates() {
  std::vector<Candidate> all;
  const Start& s = equation->at_start;
  const double turns =  // of the fastest oscillation [rad]
      equation->t_end * omega_safe(s.cloth, s.force, s.constraint);
  for (const char* name :
       {"symplectic-euler", "verlet", "pefrl", "srkn11b", "rkn64"}) {
    const MethodEntry& m = *find_method(name);
    add(all, name, m.info.adaptive ? 0 : turns / m.info.limit, ours(m));
  }
  add(all, "odeint-m4", turns / 3,
      theirs(run_odeint<odeint::symplectic_rkn_sb3a_m4_mclachlan<State>>));
  // Calls itself order 1, and is of order 2.
  add(all, "odeint-verlet", turns / 2,
      theirs(run_odeint<odeint::velocity_verlet<State>>));
  add(all, "cvode-adams", 0, theirs(run_cvode_adams));
  add(all, "arkode-dopri", 0, theirs(run_arkode_dopri));
  add(all, "gsl-rk8pd", 0, theirs(run_gsl_rk8pd));
  return all;
}

void compare() {
  const Problem& p = equation->problem;
  std::cout << "# scene " << p.name << ": " << p.about << '\n';
  std::vector<Candidate> all = candidates();
  for (int repeat = 0; repeat < 5; ++repeat)
    for (Candidate& c : all) c.seconds.push_back(c.run(c.parameter).seconds);
  for (Candidate& c : all) {
    std::ranges::sort(c.seconds);
    std::cout << p.name << ',' << c.method << ',' << c.parameter << ','
              << c.first.calls << ',' << c.seconds[0] << ',' << c.seconds[2]
              << ',' << c.first.error << ',' << equation->right.floor << '\n';
  }
}

}  // namespace

int main() {
  Sweep::set_threads(1);  // as the peers have
  gsl_set_error_handler_off();
  std::cout << "problem,method,parameter,sweeps,seconds_min,seconds_median,"
               "error,floor\n";
  Problem grid1 = grid_problem("grid1", "25 x 25 cloth, to 0.25 s", 0.25, 25);
  grid1.damping = 0;  // the methods for x'' = F(x) need that
  for (const Problem& p :
       {grid1, curtain_problem("curtain", "16 x 16 curtain, to 1 s", 1)}) {
    Equation one(p);
    equation = &one;
    compare();
  }
}
