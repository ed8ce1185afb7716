// Cholesky.hpp: each back end that the program was compiled with, against a
// dense factor.
#include <gtest/gtest.h>

#include <cstdlib>
#include <limits>
#include <type_traits>

#include <Eigen/Cholesky>

#include "CME212/Util.hpp"
#include "lab/methods/BlockCholesky.hpp"
#include "lab/methods/Cholesky.hpp"
#include "lab/methods/CholeskyBackEnds.hpp"
#include "tests/Allocations.hpp"

using namespace lab;

namespace {

using cholesky_detail::Best;
using cholesky_detail::ByEigen;
using Matrix = cholesky_detail::Matrix;
using Triplets = std::vector<Eigen::Triplet<double>>;
using CME212::random;

/** Eigen first, then what SparseCholesky takes, if that is another one. */
template <typename BackEnd>
class Cholesky : public ::testing::Test {
 protected:
  BasicSparseCholesky<BackEnd> solver;
  Cholesky() { CME212::default_generator.seed(7); }

  /** Factor @a lower, and solve for random b as a dense LL^T does. */
  void expect_right(const Matrix& lower) {
    const auto n = std::size_t(lower.rows());
    ASSERT_TRUE(solver.factorize(lower));
    ASSERT_EQ(solver.rows(), n);
    EXPECT_GE(solver.nonzeros(), std::size_t(lower.nonZeros()));
    EXPECT_LE(solver.nonzeros(), n * (n + 1) / 2);
    const Eigen::MatrixXd full =
        Eigen::MatrixXd(lower).selfadjointView<Eigen::Lower>();
    const Eigen::LLT<Eigen::MatrixXd> reference(full);
    for (int turn = 0; turn < 2; ++turn) {  // the factor is kept
      std::vector<Point> b(n);
      Eigen::MatrixXd dense(n, 3);
      for (unsigned i = 0; i < n; ++i)
        for (unsigned c = 0; c < 3; ++c) dense(i, c) = b[i][c] = random(-1, 1);
      const Eigen::MatrixXd expected = reference.solve(dense);
      solver.solve(b);
      double worst = 0;
      for (unsigned i = 0; i < n; ++i)
        for (unsigned c = 0; c < 3; ++c)
          worst = std::max(worst, std::abs(b[i][c] - expected(i, c)));
      // The condition numbers here are below 1e4.
      EXPECT_LT(worst, 1e-11 * expected.cwiseAbs().maxCoeff()) << n << " rows";
    }
  }
};
struct Names {
  template <typename BackEnd>
  static std::string GetName(int) {
    return BackEnd::name;
  }
};
using BackEnds =
    std::conditional_t<std::is_same_v<Best, ByEigen>, ::testing::Types<ByEigen>,
                       ::testing::Types<ByEigen, Best>>;
TYPED_TEST_SUITE(Cholesky, BackEnds, Names);

Matrix lower(int rows, const Triplets& entries) {
  Matrix a(rows, rows);
  a.setFromTriplets(entries.begin(), entries.end());
  return a;
}

/** Random places and values; positive definite by its diagonal. */
Matrix scattered(int rows, int entries) {
  Triplets all;
  for (int i = 0; i < rows; ++i) all.emplace_back(i, i, random(0.1, 1));
  for (int k = 0; k < entries; ++k) {
    const int i = int(random(0, rows)), j = int(random(0, rows));
    if (i == j) continue;
    const double value = random(-1, 1);
    all.emplace_back(std::max(i, j), std::min(i, j), value);
    all.emplace_back(i, i, std::abs(value));
    all.emplace_back(j, j, std::abs(value));
  }
  return lower(rows, all);
}

/** M + L of a grid with diagonals: masses from 0.1 to 10, K from 0 to 100. */
Matrix grid(int side) {
  Triplets all;
  auto spring = [&all](int i, int j) {
    const double K = random(0, 100);
    all.emplace_back(i, i, K);
    all.emplace_back(j, j, K);
    all.emplace_back(std::max(i, j), std::min(i, j), -K);
  };
  for (int i = 0; i < side * side; ++i) {
    const bool inner = i % side + 1 < side, below = i + side < side * side;
    all.emplace_back(i, i, std::pow(10, random(-1, 1)));
    if (inner) spring(i, i + 1);
    if (below) spring(i, i + side);
    if (inner && below) spring(i, i + side + 1), spring(i + 1, i + side);
  }
  return lower(side * side, all);
}

TYPED_TEST(Cholesky, SolvesWhatADenseFactorSolves) {
  for (int rows : {1, 2, 3, 10, 50, 200})
    for (int per_row : {0, 1, 3, 20}) {
      SCOPED_TRACE(per_row);
      this->expect_right(scattered(rows, rows * per_row));
    }
}

TYPED_TEST(Cholesky, SolvesGrids) {
  for (int side : {2, 5, 12, 25}) this->expect_right(grid(side));
}

TYPED_TEST(Cholesky, SolvesWhereTheFactorIsDense) {
  this->expect_right(scattered(300, 10000));
}

// On a large grid dense blocks may pay; their zeros are no part of the factor.
TYPED_TEST(Cholesky, KeepsTheFactorOfAGridSparse) {
  const int side = 60;
  const Matrix a = grid(side);
  ASSERT_TRUE(this->solver.factorize(a));
  EXPECT_LT(double(this->solver.nonzeros()), 28.0 * side * side);
  std::vector<Point> x(side * side, Point(1, -2, 3));
  this->solver.solve(x);
  std::vector<Point> left(side * side, Point(-1, 2, -3));  // A x - b
  for (int j = 0; j < side * side; ++j)
    for (Matrix::InnerIterator it(a, j); it; ++it) {
      left[unsigned(it.row())] += it.value() * x[unsigned(j)];
      if (it.row() != j)
        left[unsigned(j)] += it.value() * x[unsigned(it.row())];
    }
  for (const Point& r : left) ASSERT_LT(norm(r), 1e-11);
}

// Wide blocks of columns and narrow ones, with rows in common and without.
TYPED_TEST(Cholesky, SolvesAsEigensOwnSolverDoes) {
  for (const Matrix& a : {grid(50), grid(57), scattered(1000, 4000),
                          scattered(3000, 3000), scattered(3000, 6000)}) {
    const auto n = std::size_t(a.rows());
    ASSERT_TRUE(this->solver.factorize(a));
    const Eigen::SimplicialLDLT<Matrix, Eigen::Lower> reference(a);
    std::vector<Point> x(n);
    Eigen::MatrixXd b(n, 3);
    for (unsigned i = 0; i < n; ++i)
      for (unsigned c = 0; c < 3; ++c) b(i, c) = x[i][c] = random(-1, 1);
    const Eigen::MatrixXd expected = reference.solve(b);
    std::vector<Point> again = x;
    this->solver.solve(x);
    this->solver.solve(again);
    EXPECT_EQ(x, again);  // bit for bit
    double worst = 0;
    for (unsigned i = 0; i < n; ++i)
      for (unsigned c = 0; c < 3; ++c)
        worst = std::max(worst, std::abs(x[i][c] - expected(i, c)));
    EXPECT_LT(worst, 1e-12 * expected.cwiseAbs().maxCoeff()) << n << " rows";
  }
}

TYPED_TEST(Cholesky, ForgetsABThatIsNotFinite) {
  const Matrix a = grid(12);
  ASSERT_TRUE(this->solver.factorize(a));
  std::vector<Point> bad(144, Point(HUGE_VAL, 1, 1)), x(144, Point(1, -2, 3)),
      y = x;
  this->solver.solve(x);
  this->solver.solve(bad);
  EXPECT_FALSE(std::isfinite(bad[0].x));
  this->solver.solve(y);
  EXPECT_EQ(x, y);
}

// Another pattern, another size: nothing of the matrix before is left.
TYPED_TEST(Cholesky, FactorsOneMatrixAfterAnother) {
  for (int side : {12, 3, 7}) {
    this->expect_right(grid(side));
    this->expect_right(scattered(side * side, 5 * side));
    this->expect_right(scattered(side, 2 * side));
  }
}

TYPED_TEST(Cholesky, LooksAtTheLowerTriangleAlone) {
  Matrix a = grid(4);
  Matrix b = a;
  b.coeffRef(0, 1) = 1e3;
  b.coeffRef(3, 15) = std::numeric_limits<double>::quiet_NaN();
  b.makeCompressed();
  std::vector<Point> x(16, Point(1, -2, 3)), y = x;
  ASSERT_TRUE(this->solver.factorize(a));
  this->solver.solve(x);
  ASSERT_TRUE(this->solver.factorize(b));
  this->solver.solve(y);
  for (unsigned i = 0; i < 16; ++i)
    EXPECT_LT(norm(x[i] - y[i]), 1e-12 * norm(x[i]));
}

TYPED_TEST(Cholesky, TakesAMatrixWithoutRows) {
  std::vector<Point> none;
  this->solver.solve(none);  // before any matrix
  for (int turn = 0; turn < 2; ++turn) {
    EXPECT_TRUE(this->solver.factorize(Matrix(0, 0)));
    EXPECT_EQ(this->solver.rows(), 0u);
    EXPECT_EQ(this->solver.nonzeros(), 0u);
    this->solver.solve(none);
    this->expect_right(grid(3));
  }
}

TYPED_TEST(Cholesky, RefusesWhatIsNotPositiveDefinite) {
  const double inf = std::numeric_limits<double>::infinity();
  const double nan = std::numeric_limits<double>::quiet_NaN();
  std::vector<Matrix> bad;
  bad.push_back(lower(2, {{0, 0, 1}, {1, 1, -1}}));
  bad.push_back(lower(2, {{0, 0, 1}, {1, 0, 2}, {1, 1, 1}}));
  bad.push_back(lower(2, {{0, 0, 1}, {1, 0, 1}, {1, 1, 1}}));  // singular
  bad.push_back(lower(3, {{0, 0, 1}, {2, 2, 1}}));             // no diagonal
  bad.push_back(lower(3, {}));
  for (double value : {nan, inf, -inf}) {
    bad.push_back(lower(2, {{0, 0, 1}, {1, 1, value}}));
    bad.push_back(lower(2, {{0, 0, value}, {1, 1, 1}}));
    bad.push_back(lower(2, {{0, 0, 1}, {1, 0, value}, {1, 1, 1}}));
  }
  for (int side : {25, 60})  // small and large: a node in the middle
    for (double value : {-1e3, nan}) {
      bad.push_back(grid(side));
      bad.back().coeffRef(side * side / 2, side * side / 2) = value;
    }
  for (std::size_t k = 0; k < bad.size(); ++k) {
    SCOPED_TRACE(k);
    EXPECT_FALSE(this->solver.factorize(bad[k]));
    EXPECT_EQ(this->solver.rows(), 0u);
    EXPECT_EQ(this->solver.nonzeros(), 0u);
    this->expect_right(grid(4));  // as if nothing had been
  }
}

TEST(CholeskyBackEnds, AreBothTested) {
  if (std::is_same_v<Best, ByEigen>)
    GTEST_SKIP() << "built without CHOLMOD: tested Eigen alone";
  EXPECT_STREQ(SparseCholesky::back_end, "CHOLMOD");
}

// ------------------------------------------------------------- BlockCholesky

using Pair = BlockCholesky::Pair;
constexpr std::size_t enough = 1'000'000;

Matrix3 matrix(const Eigen::Matrix3d& m) {
  Matrix3 all;
  for (int i = 0; i < 3; ++i)
    for (int c = 0; c < 3; ++c) all.column[c][i] = m(i, c);
  return all;
}
Matrix3 diagonal(double x, double y, double z) {
  return matrix(Eigen::Vector3d(x, y, z).asDiagonal());
}

TEST(Matrix3, IsAnArrayOfNumbers) {
  CME212::default_generator.seed(7);
  for (int turn = 0; turn < 20; ++turn) {
    Eigen::Matrix3d dense;
    for (int k = 0; k < 9; ++k) dense(k / 3, k % 3) = random(-1, 1);
    Matrix3 a = matrix(dense);
    const Point x(random(-1, 1), random(-1, 1), random(-1, 1));
    const Eigen::Vector3d v(x.x, x.y, x.z), of_rows = dense * v,
                                            of_columns = dense.transpose() * v;
    for (int k = 0; k < 3; ++k) {
      EXPECT_NEAR(times(a, four(x))[k], of_rows[k], 1e-15);
      EXPECT_NEAR(turned_times(a, four(x))[k], of_columns[k], 1e-15);
    }
    // From left to right, to the last bit.
    EXPECT_EQ(point(times(a, four(x))).y,
              dense(1, 0) * x.x + dense(1, 1) * x.y + dense(1, 2) * x.z);
    EXPECT_EQ(times(a, four(x))[3], 0);
    const Eigen::Matrix3d square = dense * dense.transpose();
    const Eigen::Matrix3d l = square.llt().matrixL();
    a = matrix(square);
    ASSERT_TRUE(invert_factor(a, Four()));
    const Eigen::Matrix3d one = Eigen::Matrix3d::Identity(),
                          inverse = l.triangularView<Eigen::Lower>().solve(one);
    for (int k = 0; k < 9; ++k)
      EXPECT_NEAR(a.column[k % 3][k / 3], inverse(k / 3, k % 3),
                  1e-9 * inverse.norm());
  }
}

/** A matrix of springs of random directions, in a BlockCholesky and dense. */
struct Springs {
  std::vector<Pair> pairs;
  Eigen::MatrixXd dense;

  Springs(unsigned rows, std::vector<Pair> p) : pairs(std::move(p)) {
    dense.setZero(3 * rows, 3 * rows);
  }
  void fill(BlockCholesky& a) {
    a.clear();
    dense.setZero();
    for (unsigned i = 0; i < a.rows(); ++i) {
      const Eigen::Matrix3d m = random(0.1, 1) * Eigen::Matrix3d::Identity();
      a.add_diagonal(i, matrix(m));
      dense.block<3, 3>(3 * i, 3 * i) += m;
    }
    for (std::size_t k = 0; k < pairs.size(); ++k) {
      const Eigen::Vector3d n(random(-3, 3), random(-3, 3), random(-3, 3));
      Eigen::Matrix3d b = n * n.transpose();
      const auto [i, j] = pairs[k];
      a.add_diagonal(i, matrix(b));
      a.add_diagonal(j, matrix(b));
      dense.block<3, 3>(3 * i, 3 * i) += b;
      dense.block<3, 3>(3 * j, 3 * j) += b;
      b = -b;
      a.add(k, matrix(b));
      dense.block<3, 3>(3 * i, 3 * j) += b;
      dense.block<3, 3>(3 * j, 3 * i) += b;
    }
  }
};

std::vector<Pair> sheet_pairs(unsigned side) {
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
std::vector<Pair> random_pairs(unsigned rows, unsigned count) {
  std::vector<Pair> all;
  while (all.size() < count) {
    const auto i = unsigned(random(0, rows)), j = unsigned(random(0, rows));
    if (i != j) all.push_back({i, j});  // also twice, and turned round
  }
  return all;
}

void expect_right(BlockCholesky& a, unsigned rows, std::vector<Pair> pairs) {
  ASSERT_TRUE(a.analyze(rows, pairs, enough));
  ASSERT_EQ(a.rows(), rows);
  Springs springs(rows, pairs);
  for (int turn = 0; turn < 2; ++turn) {  // the pattern is kept
    springs.fill(a);
    ASSERT_TRUE(a.factorize());
    std::vector<Point> b(rows);
    Eigen::VectorXd dense(3 * rows);
    for (unsigned i = 0; i < rows; ++i)
      for (unsigned c = 0; c < 3; ++c)
        dense(3 * i + c) = b[i][c] = random(-1, 1);
    if (rows == 0) return a.solve(b);
    const Eigen::VectorXd expected = springs.dense.llt().solve(dense);
    a.solve(b);
    double worst = 0;
    for (unsigned i = 0; i < rows; ++i)
      for (unsigned c = 0; c < 3; ++c)
        worst = std::max(worst, std::abs(b[i][c] - expected(3 * i + c)));
    EXPECT_LT(worst, 1e-11 * expected.cwiseAbs().maxCoeff()) << rows << " rows";
  }
}

TEST(BlockCholesky, SolvesWhatADenseFactorSolves) {
  CME212::default_generator.seed(7);
  BlockCholesky a;
  expect_right(a, 0, {});
  for (unsigned rows : {1u, 2u, 5u, 30u, 90u})
    for (unsigned per_row : {0u, 1u, 3u})
      expect_right(a, rows, random_pairs(rows, rows > 1 ? per_row * rows : 0));
  for (unsigned side : {2u, 5u, 10u})
    expect_right(a, side * side, sheet_pairs(side));
}

// Counted by hand: an arrow keeps its order, a ring fills in.
TEST(BlockCholesky, TellsItsWork) {
  BlockCholesky a;
  ASSERT_TRUE(a.analyze(4, std::vector<Pair>{{0, 3}, {1, 3}, {2, 3}}, enough));
  EXPECT_EQ(a.blocks(), 7u);
  EXPECT_EQ(a.updates(), 3);
  ASSERT_TRUE(
      a.analyze(4, std::vector<Pair>{{0, 1}, {1, 2}, {2, 3}, {3, 0}}, enough));
  EXPECT_EQ(a.blocks(), 9u);
  EXPECT_EQ(a.updates(), 7);
  ASSERT_TRUE(a.analyze(900, sheet_pairs(30), enough));
  EXPECT_LT(double(a.blocks()), 20. * 900);
  for (int turn = 0; turn < 2; ++turn)
    EXPECT_FALSE(a.analyze(961, sheet_pairs(31), 5000));
  EXPECT_EQ(a.rows(), 0u);
}

TEST(BlockCholesky, AllocatesForAnotherPatternOnly) {
  CME212::default_generator.seed(7);
  const auto pairs = sheet_pairs(12);
  BlockCholesky a;
  ASSERT_TRUE(a.analyze(144, pairs, enough));
  std::vector<Point> x(144, Point(1, 2, 3));
  const Matrix3 nine = diagonal(9, 9, 9), less = diagonal(-1, -1, -1);
  const long before = allocations;
  for (int turn = 0; turn < 3; ++turn) {
    EXPECT_TRUE(a.analyze(144, pairs, enough));
    a.clear();
    for (unsigned i = 0; i < 144; ++i) a.add_diagonal(i, nine);
    for (std::size_t k = 0; k < pairs.size(); ++k) a.add(k, less);
    EXPECT_TRUE(a.factorize());
    a.solve(x);
  }
  EXPECT_EQ(allocations, before);
  EXPECT_TRUE(a.analyze(144, sheet_pairs(11), enough));
  EXPECT_GT(allocations, before);
}

TEST(BlockCholesky, RefusesWhatIsNotPositiveDefinite) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const std::vector<Pair> pairs = {{0, 1}};
  BlockCholesky a;
  ASSERT_TRUE(a.analyze(2, pairs, enough));
  for (double d : {-1.0, 0.0, 0.5, 1.0, nan, HUGE_VAL, 2.0}) {
    a.clear();
    for (unsigned i : {0u, 1u}) a.add_diagonal(i, diagonal(d, d, d));
    a.add(0, diagonal(1, 1, 1));
    EXPECT_EQ(a.factorize(), d == 2) << d;  // singular at 1
  }
  a.clear();
  for (unsigned i : {0u, 1u}) a.add_diagonal(i, diagonal(2, 2, 2));
  a.add(0, diagonal(1, nan, 1));
  EXPECT_FALSE(a.factorize());
}

}  // namespace
