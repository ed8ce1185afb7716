#pragma once
/** @file ScatteredCloth.hpp
 * The cloth of the tests of constraints. */
#include <gtest/gtest.h>

#include <vector>

#include "CME212/Util.hpp"
#include "mass_spring.hpp"

/** 8 x 8 nodes in space around the ball and the floor, with velocities. */
class ScatteredCloth : public ::testing::Test {
 protected:
  Cloth g;
  const Ball ball{};

  void SetUp() override {
    CME212::default_generator.seed(2);
    build_cloth(g, grid_points(8), grid_quads(8), MeshSprings::diagonals);
    using CME212::random;
    for (Node n : g.nodes()) {
      n.position() = ball.center +
                     Point(random(-.2, .2), random(-.2, .2), random(-.35, .2));
      n.value().vel = Point(random(-1, 1), random(-1, 1), random(-1, 1));
    }
  }
  /** Positions and velocities of all nodes. */
  std::vector<Point> state() const {
    std::vector<Point> all;
    for (Node n : g.nodes()) {
      all.push_back(n.position());
      all.push_back(n.value().vel);
    }
    return all;
  }
  void set_state(const std::vector<Point>& all) {
    for (Node n : g.nodes()) {
      n.position() = all[2 * n.index()];
      n.value().vel = all[2 * n.index() + 1];
    }
  }
};
