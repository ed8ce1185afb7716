// SparseCholesky.hpp, against a dense factor.
#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>
#include <limits>

#include <Eigen/Cholesky>

#include "CME212/Util.hpp"
#include "lab/fast/Lanes.hpp"
#include "lab/methods/SparseCholesky.hpp"
#include "tests/Allocations.hpp"

using namespace lab;

namespace {

using CME212::random;
constexpr std::size_t enough = 1'000'000;

Matrix3 matrix(const Eigen::Matrix3d& m) {
  Matrix3 all;
  for (int i = 0; i < 3; ++i)
    for (int c = 0; c < 3; ++c) all.column[c][i] = m(i, c);
  return all;
}

/** A matrix of springs, the usual input of the solver, here dense as well. */
class Cholesky : public ::testing::Test {
 protected:
  using Pair = SparseCholesky::Pair;
  SparseCholesky a;
  Eigen::MatrixXd dense;
  Cholesky() { CME212::default_generator.seed(7); }

  static Eigen::Matrix3d alike(double x) {
    return x * Eigen::Matrix3d::Identity();
  }
  static std::vector<Pair> sheet(unsigned side) {
    std::vector<Pair> all;
    for (unsigned i = 0; i < side * side; ++i) {
      const bool inner = i % side + 1 < side, below = i + side < side * side;
      if (inner) all.push_back({i, i + 1});
      if (below) all.push_back({i + side, i});
      if (inner && below) all.push_back({i, i + side + 1});
      if (inner && below) all.push_back({i + 1, i + side});
    }
    return all;
  }
  static std::vector<Pair> scattered(unsigned rows, unsigned count) {
    std::vector<Pair> all;
    while (all.size() < count) {
      const auto i = unsigned(random(0, rows)), j = unsigned(random(0, rows));
      if (i != j) all.push_back({i, j});  // also twice, and turned round
    }
    return all;
  }

  /** Springs of random stiffness and direction between @a pairs. */
  void fill(const std::vector<Pair>& pairs) {
    a.clear();
    dense.setZero(3 * a.rows(), 3 * a.rows());
    auto add = [this](unsigned i, unsigned j, const Eigen::Matrix3d& m) {
      dense.block<3, 3>(3 * i, 3 * j) += m;
    };
    for (unsigned i = 0; i < a.rows(); ++i) {
      const Eigen::Matrix3d m = alike(random(0.1, 1));
      a.add_diagonal(i, matrix(m)), add(i, i, m);
    }
    for (std::size_t k = 0; k < pairs.size(); ++k) {
      const Eigen::Vector3d n(random(-3, 3), random(-3, 3), random(-3, 3));
      const Eigen::Matrix3d b = n * n.transpose();
      const auto [i, j] = pairs[k];
      a.add_diagonal(i, matrix(b)), add(i, i, b);
      a.add_diagonal(j, matrix(b)), add(j, j, b);
      a.add(k, matrix(-b)), add(i, j, -b), add(j, i, -b);
    }
  }
  void expect_right(unsigned rows, const std::vector<Pair>& pairs) {
    ASSERT_TRUE(a.analyze(rows, pairs, enough));
    ASSERT_EQ(a.rows(), rows);
    for (int turn = 0; turn < 2; ++turn) {  // the pattern is kept
      fill(pairs);
      ASSERT_TRUE(a.factorize());
      std::vector<Point> b(rows);
      Eigen::VectorXd right(3 * rows);
      for (unsigned i = 0; i < rows; ++i)
        for (unsigned c = 0; c < 3; ++c)
          right(3 * i + c) = b[i][c] = random(-1, 1);
      if (rows == 0) return a.solve(b);
      const Eigen::VectorXd expected = dense.llt().solve(right);
      std::vector<Point> again = b;
      a.solve(b);
      a.solve(again);
      EXPECT_EQ(b, again);  // the factor is kept, bit for bit
      double worst = 0;
      for (unsigned i = 0; i < rows; ++i)
        for (unsigned c = 0; c < 3; ++c)
          worst = std::max(worst, std::abs(b[i][c] - expected(3 * i + c)));
      EXPECT_LT(worst, 1e-11 * expected.cwiseAbs().maxCoeff())
          << rows << " rows";
    }
  }
};

// One matrix after another, of another pattern and size: nothing is left.
TEST_F(Cholesky, SolvesWhatADenseFactorSolves) {
  expect_right(0, {});
  for (unsigned rows : {1u, 2u, 5u, 30u, 90u})
    for (unsigned per_row : {0u, 1u, 3u, 20u})
      expect_right(rows, scattered(rows, rows > 1 ? per_row * rows : 0));
  for (unsigned side : {2u, 5u, 10u}) expect_right(side * side, sheet(side));
  expect_right(0, {});
}

// A ring of four fills in to nine entries.
TEST_F(Cholesky, TakesNoMoreEntriesThanItMay) {
  const std::vector<Pair> ring = {{0, 1}, {1, 2}, {2, 3}, {3, 0}};
  ASSERT_TRUE(a.analyze(4, ring, 9));
  EXPECT_EQ(a.entries(), 9u);
  SparseCholesky less;
  for (int turn = 0; turn < 2; ++turn) EXPECT_FALSE(less.analyze(4, ring, 8));
  EXPECT_EQ(less.rows(), 0u);
}

TEST_F(Cholesky, AllocatesForAnotherPatternOnly) {
  const auto pairs = sheet(12);
  ASSERT_TRUE(a.analyze(144, pairs, enough));
  std::vector<Point> x(144, Point(1, 2, 3));
  const auto nine = matrix(alike(9)), one = matrix(alike(-1));
  const long before = allocations;
  for (int turn = 0; turn < 3; ++turn) {
    EXPECT_TRUE(a.analyze(144, pairs, enough));
    a.clear();
    for (unsigned i = 0; i < 144; ++i) a.add_diagonal(i, nine);
    for (std::size_t k = 0; k < pairs.size(); ++k) a.add(k, one);
    EXPECT_TRUE(a.factorize());
    a.solve(x);
  }
  EXPECT_EQ(allocations, before);
  EXPECT_TRUE(a.analyze(144, sheet(11), enough));
  EXPECT_GT(allocations, before);
}

TEST_F(Cholesky, RefusesWhatIsNotPositiveDefinite) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const std::vector<Pair> pairs = {{0, 1}};
  ASSERT_TRUE(a.analyze(2, pairs, enough));
  auto factors = [&](double d, double off) {
    a.clear();
    for (unsigned i : {0u, 1u}) a.add_diagonal(i, matrix(alike(d)));
    a.add(0, matrix(alike(off)));
    return a.factorize();
  };
  for (double d : {-1.0, 0.0, 0.5, 1.0, nan, HUGE_VAL, 2.0})
    EXPECT_EQ(factors(d, 1), d == 2) << d;  // singular at 1
  for (double off : {nan, HUGE_VAL, -HUGE_VAL, -2.0, 1.0})
    EXPECT_EQ(factors(2, off), off == 1) << off;
}

TEST_F(Cholesky, ForgetsABThatIsNotFinite) {
  const auto pairs = sheet(12);
  ASSERT_TRUE(a.analyze(144, pairs, enough));
  fill(pairs);
  ASSERT_TRUE(a.factorize());
  std::vector<Point> bad(144, Point(HUGE_VAL, 1, 1)), x(144, Point(1, -2, 3)),
      y = x;
  a.solve(x);
  a.solve(bad);
  EXPECT_FALSE(std::isfinite(bad[0].x));
  a.solve(y);
  EXPECT_EQ(x, y);
}

TEST_F(Cholesky, HasTheSameBitsOnEveryProcessor) {
  const auto pairs = sheet(12);
  ASSERT_TRUE(a.analyze(144, pairs, enough));
  std::vector<Point> first;
  const auto best = lanes::cpu;
  for (int cpu = 0; cpu <= int(best); ++cpu) {
    lanes::cpu = lanes::Cpu(cpu);
    CME212::default_generator.seed(7);
    fill(pairs);
    ASSERT_TRUE(a.factorize());
    std::vector<Point> x(144, Point(1, -2, 3));
    a.solve(x);
    if (cpu == 0) first = x;
    EXPECT_EQ(x, first) << cpu;
  }
  lanes::cpu = best;
}

}  // namespace
