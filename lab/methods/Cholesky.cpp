#include "lab/methods/Cholesky.hpp"

#include "lab/methods/CholeskyBackEnds.hpp"

namespace lab {

using cholesky_detail::Best;

const char* const SparseCholesky::back_end = Best::name;

struct SparseCholesky::Solver : BasicSparseCholesky<Best> {};

SparseCholesky::SparseCholesky() : solver_(std::make_unique<Solver>()) {}
SparseCholesky::~SparseCholesky() = default;

bool SparseCholesky::factorize(std::size_t rows, std::span<const Entry> lower) {
  cholesky_detail::Matrix a{Eigen::Index(rows), Eigen::Index(rows)};
  a.setFromTriplets(lower.begin(), lower.end());
  return solver_->factorize(a);
}

std::size_t SparseCholesky::rows() const { return solver_->rows(); }
std::size_t SparseCholesky::nonzeros() const { return solver_->nonzeros(); }
void SparseCholesky::solve(std::span<Point> b) { solver_->solve(b); }

}  // namespace lab
