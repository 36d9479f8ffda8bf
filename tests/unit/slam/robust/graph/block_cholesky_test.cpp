#include "slam/robust/graph/block_cholesky.h"

#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <algorithm>
#include <limits>
#include <string>
#include <utility>
#include <vector>

#include "base/rng.h"

namespace rubble::slam {
namespace {

using Pairs = std::vector<std::pair<int, int>>;

/// A chain of nodes with ties between some that lie far apart, some of them twice and either way round.
Pairs chain_with_ties(int nodes, int ties, Rng& rng) {
  Pairs pairs;
  for (int k = 1; k < nodes; ++k) pairs.push_back({k - 1, k});
  for (int k = 0; k < ties; ++k) {
    const int a = static_cast<int>(rng.below(static_cast<std::uint32_t>(nodes)));
    const int b = static_cast<int>(rng.below(static_cast<std::uint32_t>(nodes)));
    if (a == b) continue;
    pairs.push_back({a, b});
    if (k % 5 == 0) pairs.push_back({b, a});
  }
  return pairs;
}

Eigen::Matrix3d random_block(Rng& rng) {
  Eigen::Matrix3d block;
  for (int u = 0; u < 3; ++u)
    for (int v = 0; v < 3; ++v) block(u, v) = rng.gaussian();
  return block;
}

/// Filled with J^T J, J having two random blocks a pair; returns it as a dense matrix.
Eigen::MatrixXd fill(BlockCholesky& factor, const Pairs& pairs, const std::vector<BlockCholesky::Place>& places,
                     Rng& rng) {
  const int nodes = factor.nodes();
  Eigen::MatrixXd A = Eigen::MatrixXd::Zero(3 * nodes, 3 * nodes);
  for (int node = 0; node < nodes; ++node) {
    factor.diagonal(node) += Eigen::Matrix3d::Identity();
    A.block<3, 3>(3 * node, 3 * node) += Eigen::Matrix3d::Identity();
  }
  for (std::size_t k = 0; k < pairs.size(); ++k) {
    const auto [a, b] = pairs[k];
    const Eigen::Matrix3d by_a = random_block(rng);
    const Eigen::Matrix3d by_b = random_block(rng);
    A.block<3, 3>(3 * a, 3 * a) += by_a.transpose() * by_a;
    A.block<3, 3>(3 * b, 3 * b) += by_b.transpose() * by_b;
    A.block<3, 3>(3 * a, 3 * b) += by_a.transpose() * by_b;
    A.block<3, 3>(3 * b, 3 * a) += by_b.transpose() * by_a;
    factor.diagonal(a) += by_a.transpose() * by_a;
    factor.diagonal(b) += by_b.transpose() * by_b;
    factor.between(places[k]) +=
        places[k].first_is_row ? Eigen::Matrix3d(by_a.transpose() * by_b) : by_b.transpose() * by_a;
  }
  return A;
}

Eigen::VectorXd random_vector(int size, Rng& rng) {
  Eigen::VectorXd b(size);
  for (int k = 0; k < size; ++k) b[k] = rng.gaussian();
  return b;
}

/// How often it was called with so small a budget.
int factorised_in_slices(BlockCholesky& factor, Work slice) {
  int slices = 0;
  for (bool done = false; !done; ++slices) {
    Work budget = slice;
    done = factor.factorise(budget);
  }
  return slices;
}

constexpr Work kAll = std::numeric_limits<Work>::max();

TEST(BlockCholesky, SolvesAndTellsCovariancesAsADenseMatrixDoes) {
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    Rng rng(seed, "blocks");
    const int nodes = 2 + static_cast<int>(rng.below(60));
    const Pairs pairs = chain_with_ties(nodes, nodes / 2, rng);
    BlockCholesky factor;
    const auto places = factor.analyse(nodes, pairs);
    for (int round = 0; round < 2; ++round) {  // of the same pattern
      if (round > 0) factor.clear();
      const Eigen::MatrixXd A = fill(factor, pairs, places, rng);
      EXPECT_FALSE(factor.factorised());
      factorised_in_slices(factor, kAll);
      ASSERT_TRUE(factor.factorised());
      const Eigen::VectorXd b = random_vector(3 * nodes, rng);
      const Eigen::VectorXd x = A.ldlt().solve(b);
      EXPECT_LT((factor.solve(b) - x).norm(), 1e-9 * (1.0 + x.norm()));

      Eigen::MatrixXd J = Eigen::MatrixXd::Zero(3, 3 * nodes);
      std::vector<std::pair<int, Eigen::Matrix3d>> blocks;
      for (const int node : {0, nodes / 2, nodes - 1, 0}) {
        blocks.push_back({node, random_block(rng)});
        J.middleCols<3>(3 * node) += blocks.back().second;
      }
      const Eigen::Matrix3d covariance = J * A.ldlt().solve(J.transpose());
      EXPECT_LT((factor.covariance(blocks, nullptr) - covariance).norm(), 1e-9 * covariance.norm());
    }
  }
}

TEST(BlockCholesky, SlicesGiveTheSameBits) {
  const int nodes = 200;
  Rng ties(1, "ties");
  const Pairs pairs = chain_with_ties(nodes, 60, ties);
  std::vector<Eigen::VectorXd> solutions;
  for (const Work slice : {kAll, Work{1}, Work{2000}}) {
    BlockCholesky factor;
    const auto places = factor.analyse(nodes, pairs);
    Rng rng(2, "values");
    fill(factor, pairs, places, rng);
    const int slices = factorised_in_slices(factor, slice);
    if (slice == kAll) {
      EXPECT_EQ(slices, 1);
    }
    if (slice == 1) {
      EXPECT_EQ(slices, nodes) << "a row a slice";
    }
    solutions.push_back(factor.solve(random_vector(3 * nodes, rng)));
  }
  EXPECT_EQ(solutions[0], solutions[1]);
  EXPECT_EQ(solutions[0], solutions[2]);
}

TEST(BlockCholesky, OrderKeepsTheFactorSparse) {
  // A grid of n x n nodes: eliminated row after row, L has n^3 blocks.
  const int n = 40;
  Pairs pairs;
  for (int row = 0; row < n; ++row)
    for (int column = 0; column < n; ++column) {
      if (column > 0) pairs.push_back({row * n + column - 1, row * n + column});
      if (row > 0) pairs.push_back({(row - 1) * n + column, row * n + column});
    }
  BlockCholesky factor;
  factor.analyse(n * n, pairs);
  EXPECT_LT(factor.blocks(), n * n * n / 2);
  EXPECT_GT(factor.blocks(), static_cast<int>(pairs.size())) << "those of the matrix at least";
}

TEST(BlockCholesky, AMatrixThatIsNotPositiveDefiniteIsTold) {
  BlockCholesky factor;
  const auto places = factor.analyse(3, {{0, 1}, {2, 1}});
  for (int node = 0; node < 3; ++node) factor.diagonal(node) = Eigen::Matrix3d::Identity();
  factor.between(places[0]) = 2.0 * Eigen::Matrix3d::Identity();
  Work budget = kAll;
  EXPECT_TRUE(factor.factorise(budget)) << "it ends";
  EXPECT_FALSE(factor.factorised());
  factor.clear();
  for (int node = 0; node < 3; ++node) factor.diagonal(node) = Eigen::Matrix3d::Identity();
  factor.between(places[1])(0, 0) = std::numeric_limits<double>::quiet_NaN();
  EXPECT_TRUE(factor.factorise(budget));
  EXPECT_FALSE(factor.factorised()) << "nor is one with numbers that are none";
  factor.clear();
  for (int node = 0; node < 3; ++node) factor.diagonal(node) = Eigen::Matrix3d::Identity();
  factor.between(places[0]) = 0.5 * Eigen::Matrix3d::Identity();
  EXPECT_TRUE(factor.factorise(budget));
  EXPECT_TRUE(factor.factorised()) << "what failed is forgotten";
}

}  // namespace
}  // namespace rubble::slam
