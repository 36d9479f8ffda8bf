#pragma once

#include <Eigen/Core>
#include <utility>
#include <vector>

#include "slam/robust/matching/work.h"

namespace rubble::slam {

/// A = L D L^T of a sparse, symmetric, positive definite matrix of 3x3 blocks, a node a row of blocks. Rows are taken
/// one after the other (up-looking; Davis 2005, Algorithm 849), so that a large matrix is factorised in slices, with
/// the same bits however it is cut. Nodes are reordered by minimum degree on the graph of the blocks.
class BlockCholesky {
 public:
  using Block = Eigen::Matrix3d;
  /// Where the block of a pair is stored.
  struct Place {
    int index = 0;
    bool first_is_row = false;  ///< else the second node of the pair is the row
  };

  /// The pattern: a block for each node and for each pair of two different ones (in any order, more than once). All
  /// blocks are zero after that. Returns the place of each pair.
  std::vector<Place> analyse(int nodes, const std::vector<std::pair<int, int>>& pairs);
  int nodes() const { return static_cast<int>(position_.size()); }
  /// Of L, without the diagonal.
  int blocks() const { return column_starts_.empty() ? 0 : column_starts_.back(); }

  /// For another matrix of the same pattern: all blocks are zero again.
  void clear();
  Block& diagonal(int node) { return diagonal_[static_cast<std::size_t>(position_[static_cast<std::size_t>(node)])]; }
  /// Block of the pair, of the row and column that the place says.
  Block& between(const Place& place) { return between_[static_cast<std::size_t>(place.index)]; }

  /// Goes on until the budget is spent; returns whether it came to the end.
  bool factorise(Work& budget);
  /// To the end, and positive definite.
  bool factorised() const { return next_ == nodes() && !failed_; }

  /// x of A x = b. Asks for a factorised matrix.
  Eigen::VectorXd solve(const Eigen::VectorXd& b) const;
  /// J A^-1 J^T for a J of three rows, of which the blocks of a few nodes are not zero. Only the columns of L that
  /// these reach are looked at.
  Block covariance(const std::vector<std::pair<int, Block>>& J, Work* work) const;

 private:
  std::vector<Place> place_blocks(const std::vector<std::pair<int, int>>& pairs);
  void grow_tree();
  void eliminate(int row, Work& work);

  std::vector<int> position_;  ///< of a node, in the order of elimination
  // A below the diagonal, row by row in that order.
  std::vector<int> row_starts_;
  std::vector<int> columns_;
  std::vector<Block> between_;
  std::vector<Block> diagonal_;
  // L, column by column, and the inverse of D.
  std::vector<int> parent_;  ///< in the elimination tree; -1: none
  std::vector<int> column_starts_;
  std::vector<int> column_ends_;  ///< what is filled so far
  std::vector<int> rows_;
  std::vector<Block> L_;
  std::vector<Block> D_inverse_;
  // Of the row that is eliminated.
  std::vector<Block> gathered_;
  std::vector<int> seen_in_;  ///< the last row that reached a column
  std::vector<int> pattern_;
  int next_ = 0;
  bool failed_ = false;
};

}  // namespace rubble::slam
