#pragma once
/** @file Problem.hpp
 * Problems for comparing methods: a scene, and the right answer at its end. */
#include <functional>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "lab/methods/Method.hpp"
#include "lab/scenes/Compose.hpp"

namespace lab {

/** How two final states of a run are compared; both norms are lengths [m].
 * positions    RMS over the nodes of the distance between their positions
 * functionals  sqrt(|dc|^2 + (dE/(M g))^2): distance of the centers of mass,
 *              and the difference of energies as a height. For contact, to
 *              which positions are too sensitive. */
enum class Norm { positions, functionals };
constexpr const char* name_of(Norm norm) {
  return norm == Norm::positions ? "rms position"
                                 : "center of mass and energy/(M g)";
}

/** A problem for methods: a scene, run by any of them. */
struct Problem : Model {
  std::string about;  ///< for the title of a chart
  Norm norm = Norm::positions;
  /** Without contact, at rest at the end. Its runs may take four times the
   * effort of others. */
  bool rests = false;
  Net mesh;
  /** What acts in place of its obstacles and pins. */
  std::function<CombinedConstraints(const Cloth&)> constraint = {};
  /** The exact positions at a time [s], by node id; empty if not known.
   * Such a problem has no drag, so its energy is constant. */
  std::function<std::vector<Point>(double)> exact = {};

  /** Of mesh_of(@a m), or of a net that no scene file describes. */
  Problem(const Model& m, std::string title)
      : Problem(m, std::move(title), mesh_of(m)) {}
  Problem(const Model& m, std::string title, Net net)
      : Model(m), about(std::move(title)), mesh(std::move(net)) {}
  /** Held nodes move and do work. Runs are not guarded: energy may grow. */
  bool driven() const;
  /** The cloth at t = 0, in an empty graph. */
  void build(Cloth& g) const { build_model(g, *this, mesh); }
  /** @pre @a g was just built */
  CombinedConstraints constraints(const Cloth& g) const {
    return constraint ? constraint(g) : constraint_of(*this, mesh, g);
  }
};

/** A problem at t = 0, ready to run. It can't be copied: pins hold handles into
 * the cloth. */
struct Start {
  Cloth cloth;
  ForcePlan force;
  ConstraintPlan constraint;

  explicit Start(const Problem& p);
  Start(const Start&) = delete;
  Start& operator=(const Start&) = delete;

  /** The present kinetic and potential energy [J]. */
  double energy() const;
};

/** The final state of a run. */
struct End {
  std::vector<Point> positions;  // [m], by node id
  Point center;                  // [m]
  double energy = 0;             // [J]
};
End end_of(const Start& s);

/** The distance [m] of two final states of @a p.
 * @pre for Norm::positions: no node was removed in either */
double distance(const Problem& p, const End& a, const End& b);

/** How a run ended. */
struct Outcome {
  enum class Status { ok, diverged, failed } status = Status::ok;
  std::string reason;    // empty if ok
  long long steps = 0;   // done
  long long sweeps = 0;  // force evaluations
  Work work = {};        // besides those
  double seconds = 0;
  End end;

  bool ok() const { return status == Status::ok; }
};

/** Run @a p to its end in @a steps steps of equal length.
 * @param guarded stop when the energy leaves its bounds; else only the end is
 *        checked, so that only the method takes time
 * @pre steps > 0 */
Outcome run(const Problem& p, Method& method, long long steps,
            bool guarded = true);

/** The answer to a problem, and its accuracy. */
struct Reference {
  End end;
  double floor;           ///< distance of two independent answers [m]
  std::string made = {};  ///< the two, as "pefrl 120 steps, verlet 90 steps"
};

/** Two independent answers: the exact solution and srkn11b; or srkn11b and
 * pefrl; or, with contact, where every method has at most order 2, Verlet and
 * pefrl. So the two differ in order, in step, and in the point of a step at
 * which the constraint is applied.
 * @param fineness the stable step over the step; more for the lower orders and
 *        with contact
 * Throws std::runtime_error if one of the runs does not reach the end. */
Reference reference(const Problem& p, double fineness = 16);

// ------------------------------------------------------- Problems
// (Problems.cpp)

/** @a n masses of 1/n kg in a row along x, between two walls 1 m apart, with
 * springs of @a K under tension, so that the row stays straight. It starts at
 * rest, with several modes at once. The motion is linear:
 *   omega_k = 2 sqrt(K n) sin(k pi/(2(n + 1))) */
struct Chain {
  struct Mode {
    unsigned k;        // half waves between the walls
    double amplitude;  // [m]
  };
  unsigned n = 20;
  double K = 100;     // [N/m]
  double rest = 0.5;  // rest length of a spring, as a share of its length
  std::vector<Mode> modes = {{1, 0.02}, {2, 0.01}, {5, 0.005}};

  double omega(unsigned k) const;  // [1/s]
  /** The positions at time @a t [s]. */
  std::vector<Point> exact(double t) const;
};

/** A chain without gravity and drag. */
Problem chain_problem(std::string name, std::string about, double t_end,
                      Chain chain = {});
/** A square cloth of side x side nodes, K = 100 N/m, without diagonals and
 * drag, that hangs from its whole upper row and starts unstretched. The motion
 * is linear: each column is a chain. */
Problem curtain_problem(std::string name, std::string about, double t_end,
                        unsigned side = 16);
/** The assignment's cloth of side x side nodes: diagonals, K [N/m], pinned at
 * its corners, drag c = 1/N. */
Problem grid_problem(std::string name, std::string about, double t_end,
                     unsigned side, double K = 100);
/** A grid of 25 x 25 nodes, held at the side y = 0, with K = 1e6 N/m where x <
 * 0.09 m. */
Problem mixed_problem();

/** All problems of the charts. */
std::vector<Problem> make_problems();

}  // namespace lab
