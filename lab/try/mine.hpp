#pragma once
// An example for `make try`: what a student may write first.
#include "mass_spring.hpp"

template <typename G, typename F, typename C>
double my_step(G& g, double t, double dt, F&& force, C&& constraint) {
  for (auto n : nodes(g)) {
    n.value().vel += (dt / n.value().mass) * force(n, t);
    n.position() += dt * n.value().vel;
  }
  constraint(g, t + dt);
  return t + dt;
}
