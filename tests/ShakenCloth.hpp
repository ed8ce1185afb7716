#pragma once
/** @file ShakenCloth.hpp
 * The cloth of the tests of forces. */
#include <gtest/gtest.h>

#include <algorithm>

#include "CME212/Util.hpp"
#include "mass_spring.hpp"

/** A grid with diagonals, shaken: all springs differ, some are compressed,
 * some nodes are gone. */
class ShakenCloth : public ::testing::Test {
 protected:
  Cloth g;

  void SetUp() override {
    CME212::default_generator.seed(1);
    build_cloth(g, grid_points(6), grid_quads(6), MeshSprings::diagonals);
    for (Node n : g.nodes()) {
      n.position() += random_vector(0.08);
      n.value().vel = random_vector(1);
      n.value().mass *= CME212::random(0.5, 2);
    }
    for (Edge e : g.edges()) e.value().K *= CME212::random(0.5, 2);
    for (unsigned i : {30u, 14u, 3u}) g.remove_node(g.node(i));
  }
  static Point random_vector(double size) {
    using CME212::random;
    return size * Point(random(-1, 1), random(-1, 1), random(-1, 1));
  }
  /** The largest |force - other| over all nodes [N], by call. */
  template <typename F>
  double call_distance(const ZeroForce& force, F other) {
    double worst = 0;
    for (Node n : g.nodes())
      worst = std::max(worst, norm(force(n, 0) - other(n)));
    return worst;
  }
};
