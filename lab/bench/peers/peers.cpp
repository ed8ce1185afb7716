/** @file peers.cpp
 * Compares our methods with those of Boost.odeint, SUNDIALS and GSL, with the
 * same problem, force kernel and clock: grid1 with diagonals, pinned at the
 * corners, from rest to t = 0.25 s. Writes CSV to the standard output:
 *   make peers-deps peers-chart
 *
 * Each library is used as its manual suggests for such a problem. All runs take
 * turns, REPEATS times. A library calls our kernel with a copy of the
 * positions, which takes 15 % of the time. */
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
#include <cstdio>
#include <functional>
#include <iostream>
#include <vector>

#include "lab/fast/Sweep.hpp"
#include "lab/methods/Methods.hpp"

using namespace lab;

namespace {

using State = std::vector<double>;

/** The cloth as an ordinary differential equation in flat arrays: positions
 * and velocities of all nodes. The pinned ones have no acceleration. */
class Problem {
 public:
  Cloth g;
  ForcePlan force = make_combined_force(GravityForce(), MassSpringForce());
  long calls = 0;
  const double t_end = 0.25;  // [s]

  Problem() {
    build_cloth(g, grid_points(25), grid_quads(25), MeshSprings::diagonals);
    for (unsigned i = 0; i < g.node_slots(); ++i)
      per_mass_.push_back(
          is_corner(g.positions()[i]) ? 0 : 1 / g.node_values()[i].mass);
    start_ = positions();
    flow_.begin(g, force, true);
  }
  /** Number of coordinates. */
  std::size_t size() const { return 3 * g.node_slots(); }
  const State& start() const { return start_; }

  void set_positions(const double* q) {
    std::copy(q, q + size(), &g.positions()[0].x);
  }
  State positions() const {
    const double* x = &g.positions()[0].x;
    return {x, x + size()};
  }
  /** a = F(q)/m [m/s^2] */
  void acceleration(const double* q, double* a) {
    ++calls;
    const unsigned n = g.node_slots();
    for (unsigned i = 0; i < n; ++i, q += 3)
      flow_.cloth().set_position(i, Point(q[0], q[1], q[2]));
    flow_.run({.t = 0, .kick = 0, .keep = true});
    for (unsigned i = 0; i < n; ++i)
      for (double c : flow_.acceleration(i)) *a++ = per_mass_[i] > 0 ? c : 0;
  }
  /** (q, v)' for y = (q, v) */
  void derivative(const double* y, double* dy) {
    std::copy(y + size(), y + 2 * size(), dy);
    acceleration(y, dy + size());
  }

 private:
  std::vector<double> per_mass_;  // 1/m [1/kg] of each node, 0 if pinned
  FlatFlow flow_;
  State start_;
};

Problem* problem;  // for the C callbacks

/** RMS distance of the nodes [m]. */
double distance(const State& a, const State& b) {
  double sum = 0;
  for (std::size_t k = 0; k < a.size(); ++k)
    sum += (a[k] - b[k]) * (a[k] - b[k]);
  return std::sqrt(3 * sum / double(a.size()));
}

// ----------------------------------------------------------------------- Ours

State run_ours(const MethodEntry& entry, int steps) {
  struct Count : SweptForce {  // a force of nothing, called once a sweep
    void add_to(const Part& part, double, std::span<Point>) const override {
      if (part.first == 0) ++problem->calls;
    }
    std::optional<int> spring_multiplicity() const override { return 0; }
  };
  const ForcePlan force =
      make_combined_force(GravityForce(), MassSpringForce(), Count());
  Cloth& g = problem->g;
  problem->set_positions(problem->start().data());
  for (Node n : g.nodes()) n.value().vel = Point();
  const ConstraintPlan pin = PinConstraint(g);
  auto method = entry.make();
  const double dt = problem->t_end / steps;
  for (int n = 0; n < steps; ++n) method->step(g, n * dt, dt, force, pin);
  return problem->positions();
}

// --------------------------------------------------------------- Boost.odeint

namespace odeint = boost::numeric::odeint;

struct Acceleration {
  void operator()(const State& x, State& a) const {
    problem->acceleration(x.data(), a.data());
  }
  void operator()(const State& x, const State&, State& a, double) const {
    (*this)(x, a);
  }
};

template <typename Stepper>
State run_odeint(int steps) {
  Stepper stepper;
  State q = problem->start(), v(q.size(), 0.0);
  const double dt = problem->t_end / steps;
  for (int n = 0; n < steps; ++n)
    stepper.do_step(Acceleration(), std::pair(std::ref(q), std::ref(v)), n * dt,
                    dt);
  return q;
}

/** (start, 0): all of the first state. */
State full_start() {
  State y = problem->start();
  y.resize(2 * y.size(), 0.0);
  return y;
}
State first_half(const double* y) { return {y, y + problem->size()}; }

State run_odeint_dopri5(double tolerance) {
  State y = full_start();
  auto f = [](const State& x, State& dx, double) {
    problem->derivative(x.data(), dx.data());
  };
  odeint::integrate_adaptive(
      odeint::make_controlled(tolerance, tolerance,
                              odeint::runge_kutta_dopri5<State>()),
      f, y, 0.0, problem->t_end, 1e-4);
  return first_half(y.data());
}

// ------------------------------------------------------------------- SUNDIALS

void require(bool ok, const char* what) {
  if (!ok) throw std::runtime_error(what);
}
int sundials_rhs(realtype, N_Vector y, N_Vector dy, void*) {
  problem->derivative(N_VGetArrayPointer(y), N_VGetArrayPointer(dy));
  return 0;
}

/** Context and vector of one run; freed with it. */
struct Sundials {
  SUNContext context = nullptr;
  State y = full_start();
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
  CVodeSetStopTime(mem, problem->t_end);
  auto solver = SUNNonlinSol_FixedPoint(s.vector, 0, s.context);
  CVodeSetNonlinearSolver(mem, solver);
  realtype t;
  int flag = CVode(mem, problem->t_end, s.vector, &t, CV_NORMAL);
  SUNNonlinSolFree(solver);
  CVodeFree(&mem);
  require(flag >= 0, "CVODE failed");
  return first_half(s.y.data());
}

State run_arkode_dopri(double tolerance) {
  Sundials s;
  void* mem = ERKStepCreate(sundials_rhs, 0, s.vector, s.context);
  ERKStepSStolerances(mem, tolerance, tolerance);
  ERKStepSetTableNum(mem, ARKODE_DORMAND_PRINCE_7_4_5);
  ERKStepSetMaxNumSteps(mem, 10000000);
  ERKStepSetStopTime(mem, problem->t_end);
  realtype t;
  int flag = ERKStepEvolve(mem, problem->t_end, s.vector, &t, ARK_NORMAL);
  ERKStepFree(&mem);
  require(flag >= 0, "ARKODE failed");
  return first_half(s.y.data());
}

// ------------------------------------------------------------------------ GSL

State run_gsl(const gsl_odeiv2_step_type* type, double tolerance) {
  gsl_odeiv2_system system = {[](double, const double* y, double* dy, void*) {
                                problem->derivative(y, dy);
                                return int(GSL_SUCCESS);
                              },
                              nullptr, 2 * problem->size(), nullptr};
  gsl_odeiv2_driver* driver =
      gsl_odeiv2_driver_alloc_y_new(&system, type, 1e-4, tolerance, tolerance);
  State y = full_start();
  double t = 0;
  int flag = gsl_odeiv2_driver_apply(driver, &t, problem->t_end, y.data());
  gsl_odeiv2_driver_free(driver);
  require(flag == GSL_SUCCESS, "GSL failed");
  return first_half(y.data());
}

// ------------------------------------------------------------------- Measuring

struct Candidate {
  const char* method;
  double parameter;  // step [s], or tolerance
  std::function<State()> run;
  std::vector<double> seconds = {};
  double error = 0;
  long calls = 0;
  std::string status = "ok";
};

std::vector<Candidate> candidates() {
  std::vector<Candidate> all;
  for (const MethodEntry& m : methods) {
    if (m.info.limit == 0 || m.info.limit == no_limit) continue;
    // h_safe omega_max = limit with omega_max^2 = 12 K N (docs: Stability).
    double largest = m.info.limit / std::sqrt(12.0 * 100 * 625);
    int least = int(std::ceil(problem->t_end / largest));
    for (double factor = 1; factor < 3000; factor *= 1.2) {
      int steps = int(std::ceil(least * factor));
      if (double(steps) * m.info.sweeps > 20000) break;
      all.push_back({m.info.name, problem->t_end / steps,
                     [&m, steps] { return run_ours(m, steps); }});
    }
  }
  for (int steps = 70; steps < 10000; steps = steps * 6 / 5) {
    auto add = [&](const char* name, State (*run)(int)) {
      all.push_back(
          {name, problem->t_end / steps, [run, steps] { return run(steps); }});
    };
    add("odeint-m4",
        run_odeint<odeint::symplectic_rkn_sb3a_m4_mclachlan<State>>);
    // Calls itself order 1, and is of order 2.
    add("odeint-verlet", run_odeint<odeint::velocity_verlet<State>>);
  }
  for (double tol = 1e-2; tol > 1e-13; tol /= 4) {
    auto add = [&](const char* name, auto run) {
      all.push_back({name, tol, [run, tol] { return run(tol); }});
    };
    add("odeint-dopri5", run_odeint_dopri5);
    add("cvode-adams", run_cvode_adams);
    add("arkode-dopri", run_arkode_dopri);
    add("gsl-rk8pd",
        [](double t) { return run_gsl(gsl_odeiv2_step_rk8pd, t); });
    add("gsl-msadams",
        [](double t) { return run_gsl(gsl_odeiv2_step_msadams, t); });
  }
  return all;
}

double median(std::vector<double> a) {
  std::ranges::sort(a);
  return a[a.size() / 2];
}

}  // namespace

int main(int argc, char** argv) {
  Sweep::set_threads(1);  // as the peers have
  const int repeats = argc > 1 ? std::atoi(argv[1]) : 7;
  if (repeats < 1) {
    std::cerr << "usage: peers [REPEATS], 1 or more; 7 if left out\n";
    return 2;
  }
  gsl_set_error_handler_off();
  Problem grid1;
  problem = &grid1;
  // Two methods of different order and step; how far they agree is the floor.
  State reference = run_ours(*find_method("srkn11b"), 3000);
  double floor = distance(reference, run_ours(*find_method("srkn6b"), 12000));

  auto all = candidates();
  for (int r = 0; r <= repeats; ++r)  // the first is a warm-up
    for (Candidate& c : all) {
      if (c.status != "ok") continue;
      problem->calls = 0;
      CME212::Clock clock;
      try {
        State end = c.run();
        double seconds = clock.seconds();
        if (r > 0) c.seconds.push_back(seconds);
        c.error = distance(end, reference);
        c.calls = problem->calls;
        if (!(c.error < 1)) c.status = "diverged";
        if (seconds > 0.5) c.status = "left out: over 0.5 s";
      } catch (const std::exception& e) {
        c.status = e.what();
      }
    }
  std::cout << "method,parameter,sweeps,seconds_min,seconds_median,error,floor,"
               "status\n";
  for (const Candidate& c : all) {
    std::cout << c.method << ',' << c.parameter << ',';
    if (c.status == "ok") {
      std::cout << c.calls << ',' << std::ranges::min(c.seconds) << ','
                << median(c.seconds) << ',' << c.error << ',';
    } else {
      std::cout << ",,,,";
    }
    std::cout << floor << ',' << c.status << '\n';
  }
}
