#include "slam/robust/graph/block_cholesky.h"

#include <Eigen/Cholesky>
#include <Eigen/OrderingMethods>
#include <Eigen/SparseCore>
#include <algorithm>

namespace rubble::slam {

namespace {

constexpr Work kWorkPerRow = 60;
constexpr Work kWorkPerProduct = 15;  ///< of two blocks
constexpr Work kWorkPerReached = 30;  ///< block of L that a covariance comes by
constexpr Work kWorkPerPassed = 2;    ///< row that it need not look at

std::size_t at(int k) { return static_cast<std::size_t>(k); }

/// The nodes in the order in which they are eliminated.
std::vector<int> order_of(int nodes, const std::vector<std::pair<int, int>>& pairs) {
  std::vector<Eigen::Triplet<double>> entries;
  entries.reserve(at(nodes) + pairs.size());
  for (int k = 0; k < nodes; ++k) entries.emplace_back(k, k, 1.0);
  for (const auto& [a, b] : pairs) entries.emplace_back(std::max(a, b), std::min(a, b), 1.0);
  Eigen::SparseMatrix<double> pattern(nodes, nodes);
  pattern.setFromTriplets(entries.begin(), entries.end());
  Eigen::AMDOrdering<int>::PermutationType order;
  Eigen::AMDOrdering<int>()(pattern, order);
  return {order.indices().data(), order.indices().data() + nodes};
}

}  // namespace

std::vector<BlockCholesky::Place> BlockCholesky::analyse(int nodes, const std::vector<std::pair<int, int>>& pairs) {
  position_.assign(at(nodes), 0);
  const std::vector<int> order = order_of(nodes, pairs);
  for (int k = 0; k < nodes; ++k) position_[at(order[at(k)])] = k;
  std::vector<Place> places = place_blocks(pairs);
  grow_tree();
  rows_.resize(at(column_starts_.back()));
  L_.resize(at(column_starts_.back()));
  D_inverse_.resize(at(nodes));
  gathered_.assign(at(nodes), Block::Zero());
  pattern_.resize(at(nodes));
  diagonal_.resize(at(nodes));
  between_.resize(columns_.size());
  clear();
  return places;
}

/// Lays out A below the diagonal by row, then by column; each block once.
std::vector<BlockCholesky::Place> BlockCholesky::place_blocks(const std::vector<std::pair<int, int>>& pairs) {
  std::vector<std::pair<int, int>> cells;
  cells.reserve(pairs.size());
  for (const auto& [a, b] : pairs) {
    const auto [column, row] = std::minmax(position_[at(a)], position_[at(b)]);
    cells.push_back({row, column});
  }
  std::vector<std::pair<int, int>> blocks = cells;
  std::sort(blocks.begin(), blocks.end());
  blocks.erase(std::unique(blocks.begin(), blocks.end()), blocks.end());
  row_starts_.assign(at(nodes()) + 1, 0);
  columns_.clear();
  for (const auto& [row, column] : blocks) {
    ++row_starts_[at(row) + 1];
    columns_.push_back(column);
  }
  for (int k = 0; k < nodes(); ++k) row_starts_[at(k) + 1] += row_starts_[at(k)];
  std::vector<Place> places;
  places.reserve(pairs.size());
  for (std::size_t k = 0; k < pairs.size(); ++k) {
    const auto found = std::lower_bound(blocks.begin(), blocks.end(), cells[k]);
    places.push_back({static_cast<int>(found - blocks.begin()), position_[at(pairs[k].first)] == cells[k].first});
  }
  return places;
}

/// The elimination tree, and how many blocks each column of L has: a row of L reaches the columns of its blocks in A,
/// and from each up the tree.
void BlockCholesky::grow_tree() {
  parent_.assign(at(nodes()), -1);
  seen_in_.assign(at(nodes()), -1);
  column_starts_.assign(at(nodes()) + 1, 0);
  for (int row = 0; row < nodes(); ++row) {
    seen_in_[at(row)] = row;
    for (int entry = row_starts_[at(row)]; entry < row_starts_[at(row) + 1]; ++entry)
      for (int column = columns_[at(entry)]; seen_in_[at(column)] != row; column = parent_[at(column)]) {
        if (parent_[at(column)] < 0) parent_[at(column)] = row;
        ++column_starts_[at(column) + 1];
        seen_in_[at(column)] = row;
      }
  }
  for (int k = 0; k < nodes(); ++k) column_starts_[at(k) + 1] += column_starts_[at(k)];
}

void BlockCholesky::clear() {
  std::fill(diagonal_.begin(), diagonal_.end(), Block::Zero());
  std::fill(between_.begin(), between_.end(), Block::Zero());
  column_ends_.assign(column_starts_.begin(), column_starts_.end() - 1);
  std::fill(seen_in_.begin(), seen_in_.end(), -1);
  next_ = 0;
  failed_ = false;
}

bool BlockCholesky::factorise(Work& budget) {
  while (next_ < nodes() && !failed_ && budget > 0) {
    Work work = 0;
    eliminate(next_++, work);
    budget -= work;
  }
  return next_ == nodes() || failed_;
}

void BlockCholesky::eliminate(int row, Work& work) {
  // The columns that the row reaches, each before those up the tree that it changes.
  int top = nodes();
  seen_in_[at(row)] = row;
  for (int entry = row_starts_[at(row)]; entry < row_starts_[at(row) + 1]; ++entry) {
    gathered_[at(columns_[at(entry)])] = between_[at(entry)];
    int length = 0;
    for (int column = columns_[at(entry)]; seen_in_[at(column)] != row; column = parent_[at(column)]) {
      pattern_[at(length++)] = column;
      seen_in_[at(column)] = row;
    }
    while (length > 0) pattern_[at(--top)] = pattern_[at(--length)];
  }
  work += kWorkPerRow;
  Block D = diagonal_[at(row)];
  for (; top < nodes(); ++top) {
    const int column = pattern_[at(top)];
    const Block LD = gathered_[at(column)];
    gathered_[at(column)].setZero();
    int& end = column_ends_[at(column)];
    for (int k = column_starts_[at(column)]; k < end; ++k)
      gathered_[at(rows_[at(k)])].noalias() -= LD * L_[at(k)].transpose();
    work += kWorkPerProduct * (end - column_starts_[at(column)] + 2);
    Block& L = L_[at(end)];
    L.noalias() = LD * D_inverse_[at(column)];
    D.noalias() -= L * LD.transpose();
    rows_[at(end)] = row;
    ++end;
  }
  const Eigen::LLT<Block> llt(D);
  failed_ = llt.info() != Eigen::Success || !D.allFinite();  // NaN is no reason for LLT
  D_inverse_[at(row)] = llt.solve(Block::Identity());
}

Eigen::VectorXd BlockCholesky::solve(const Eigen::VectorXd& b) const {
  Eigen::VectorXd x(b.size());
  for (int node = 0; node < nodes(); ++node) x.segment<3>(3 * position_[at(node)]) = b.segment<3>(3 * node);
  for (int column = 0; column < nodes(); ++column) {
    const Eigen::Vector3d here = x.segment<3>(3 * column);
    for (int k = column_starts_[at(column)]; k < column_ends_[at(column)]; ++k)
      x.segment<3>(3 * rows_[at(k)]).noalias() -= L_[at(k)] * here;
  }
  for (int column = nodes() - 1; column >= 0; --column) {
    Eigen::Vector3d here = D_inverse_[at(column)] * x.segment<3>(3 * column);
    for (int k = column_starts_[at(column)]; k < column_ends_[at(column)]; ++k)
      here.noalias() -= L_[at(k)].transpose() * x.segment<3>(3 * rows_[at(k)]);
    x.segment<3>(3 * column) = here;
  }
  Eigen::VectorXd out(b.size());
  for (int node = 0; node < nodes(); ++node) out.segment<3>(3 * node) = x.segment<3>(3 * position_[at(node)]);
  return out;
}

BlockCholesky::Block BlockCholesky::covariance(const std::vector<std::pair<int, Block>>& J, Work* work) const {
  // With y = L^-1 J^T it is y^T D^-1 y.
  using Rows = Eigen::Matrix<double, Eigen::Dynamic, 3, Eigen::RowMajor>;
  Rows y = Rows::Zero(3 * nodes(), 3);
  int first = nodes();
  for (const auto& [node, block] : J) {
    const int row = position_[at(node)];
    y.middleRows<3>(3 * row) += block.transpose();
    first = std::min(first, row);
  }
  Block covariance = Block::Zero();
  Work reached = 0;
  for (int column = first; column < nodes(); ++column) {
    const Block here = y.middleRows<3>(3 * column);
    if (here.isZero(0.0)) continue;
    covariance.noalias() += here.transpose() * D_inverse_[at(column)] * here;
    for (int k = column_starts_[at(column)]; k < column_ends_[at(column)]; ++k)
      y.middleRows<3>(3 * rows_[at(k)]).noalias() -= L_[at(k)] * here;
    reached += 1 + column_ends_[at(column)] - column_starts_[at(column)];
  }
  if (work != nullptr) *work += kWorkPerReached * reached + kWorkPerPassed * nodes();
  return covariance;
}

}  // namespace rubble::slam
