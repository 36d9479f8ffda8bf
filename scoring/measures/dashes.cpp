#include "scoring/measures/dashes.h"

#include <Eigen/Core>
#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdlib>
#include <map>
#include <opencv2/imgproc.hpp>

namespace rubble::scoring {
namespace {

constexpr double kLongestGap = 0.13;    // longest gap between two dashes [m]
constexpr double kLine = 0.35;          // from which length three dashes are a line [m]
constexpr double kNear = 0.20;          // of a neighbour so much decides about its direction [m]
constexpr double kWidth = 0.06;         // off the line at the most, a cell at least [m]
constexpr double kBeside = 0.25;        // from the line: where nothing else may stand, three cells at least [m]
constexpr double kDrawn = 0.75;         // of the line at least is dashes
constexpr std::size_t kNeighbours = 6;  // with more the piece is one of many

using Cells = std::vector<Cell>;

/// A piece near another one.
struct Neighbour {
  Cells cells;  ///< what of it is near
  Cell from;    ///< nearest cell of the other one
  Cell to;      ///< nearest cell of this one
  int away = 0;
};

/// The line that fits cells best.
struct Line {
  explicit Line(const std::vector<const Cells*>& pieces) {
    double n = 0.0;
    for (const Cells* piece : pieces)
      for (const Cell& c : *piece) {
        middle += Eigen::Vector2d(c.x, c.y);
        n += 1.0;
      }
    middle /= n;
    Eigen::Matrix2d spread = Eigen::Matrix2d::Zero();
    for (const Cells* piece : pieces)
      for (const Cell& c : *piece) {
        const Eigen::Vector2d d = Eigen::Vector2d(c.x, c.y) - middle;
        spread += d * d.transpose();
      }
    along = Eigen::SelfAdjointEigenSolver<Eigen::Matrix2d>().computeDirect(spread).eigenvectors().col(1);
  }
  double at(const Cell& c) const { return along.dot(Eigen::Vector2d(c.x, c.y) - middle); }
  double off(const Cell& c) const {
    const Eigen::Vector2d d = Eigen::Vector2d(c.x, c.y) - middle;
    return std::abs(along.x() * d.y() - along.y() * d.x());
  }
  /// Least and greatest place along the line.
  std::pair<double, double> reach(const Cells& cells) const {
    std::pair<double, double> out{at(cells[0]), at(cells[0])};
    for (const Cell& c : cells) out = {std::min(out.first, at(c)), std::max(out.second, at(c))};
    return out;
  }
  bool holds(const Cells& cells, double width) const {
    return std::all_of(cells.begin(), cells.end(), [&](const Cell& c) { return off(c) <= width; });
  }
  /// What of the line cells cover [cells].
  double drawn(const std::vector<const Cells*>& pieces) const {
    std::vector<double> places;
    for (const Cells* piece : pieces)
      for (const Cell& c : *piece) places.push_back(at(c));
    std::sort(places.begin(), places.end());
    const double one = std::abs(along.x()) + std::abs(along.y());
    double sum = one;
    for (std::size_t i = 1; i < places.size(); ++i) sum += std::min(one, places[i] - places[i - 1]);
    return sum;
  }
  Eigen::Vector2d middle = Eigen::Vector2d::Zero();
  Eigen::Vector2d along;
};

class Dashes {
 public:
  explicit Dashes(const OccupancyGrid& grid)
      : grid_(grid),
        width_(std::max(1.0, kWidth / grid.resolution())),
        beside_(std::max(3.0, kBeside / grid.resolution())),
        labels_(grid.frame(), 0) {
    cv::Mat walls(grid.height(), grid.width(), CV_8U);
    for (std::size_t i = 0; i < grid.cells().size(); ++i)
      walls.data[i] = grid.cells()[i] == Occupancy::Occupied ? 255 : 0;
    cv::Mat labels;
    const int pieces = cv::connectedComponents(walls, labels, 8);
    pieces_.resize(static_cast<std::size_t>(pieces));
    for (int y = 0; y < grid.height(); ++y)
      for (int x = 0; x < grid.width(); ++x) {
        labels_[{x, y}] = labels.at<int>(y, x);
        if (labels.at<int>(y, x) > 0) pieces_[static_cast<std::size_t>(labels.at<int>(y, x))].push_back({x, y});
      }
  }

  std::vector<std::pair<Cell, Cell>> in_line(double most_work) {
    std::vector<std::pair<Cell, Cell>> out;
    for (const Cells& piece : pieces_) {
      if (piece.empty() || static_cast<double>(piece.size()) * grid_.resolution() > 2.0 * kLine) continue;
      if (work_ > most_work) return {};
      const std::vector<Neighbour> neighbours = around(piece);
      for (std::size_t a = 0; a < neighbours.size(); ++a)
        for (std::size_t b = a + 1; b < neighbours.size(); ++b)
          if (make_line(neighbours[a], piece, neighbours[b])) {
            out.emplace_back(neighbours[a].from, neighbours[a].to);
            out.emplace_back(neighbours[b].from, neighbours[b].to);
          }
    }
    return out;
  }

 private:
  /// Cells of a window that reaches so far.
  static double square_of(int reach) { return (2.0 * reach + 1.0) * (2.0 * reach + 1.0); }

  /// None where there are more than kNeighbours.
  std::vector<Neighbour> around(const Cells& piece) {
    const int gap = std::max(1, static_cast<int>(kLongestGap / grid_.resolution())) + 1;
    const int self = labels_[piece[0]];
    std::map<int, Neighbour> found;
    for (const Cell& c : piece) {
      work_ += square_of(gap);
      for (int dy = -gap; dy <= gap; ++dy)
        for (int dx = -gap; dx <= gap; ++dx) {
          const Cell to{c.x + dx, c.y + dy};
          if (!labels_.inside(to) || labels_[to] == 0 || labels_[to] == self) continue;
          Neighbour& one = found[labels_[to]];
          const int away = dx * dx + dy * dy;
          if (one.away == 0 || away < one.away) one = {{}, c, to, away};
          if (found.size() > kNeighbours) return {};
        }
    }
    std::vector<Neighbour> out;
    const int near = static_cast<int>(kNear / grid_.resolution());
    for (auto& [label, one] : found) {
      work_ += square_of(near);
      for (int dy = -near; dy <= near; ++dy)
        for (int dx = -near; dx <= near; ++dx) {
          const Cell c{one.to.x + dx, one.to.y + dy};
          if (labels_.inside(c) && labels_[c] == label) one.cells.push_back(c);
        }
      out.push_back(std::move(one));
    }
    return out;
  }

  bool make_line(const Neighbour& a, const Cells& piece, const Neighbour& b) {
    const std::vector<const Cells*> all{&a.cells, &piece, &b.cells};
    const Line line(all);
    if (!std::all_of(all.begin(), all.end(), [&](const Cells* one) { return line.holds(*one, width_); })) return false;
    const auto first = line.reach(a.cells), here = line.reach(piece), last = line.reach(b.cells);
    const bool end_to_end = (first.second <= here.first && here.second <= last.first) ||
                            (last.second <= here.first && here.second <= first.first);
    const double begin = std::min(first.first, last.first), end = std::max(first.second, last.second);
    if (!end_to_end || (end - begin + 1.0) * grid_.resolution() < kLine) return false;
    if (line.drawn(all) < kDrawn * (end - begin + 1.0)) return false;
    // Beside the dash and its gaps; beside a neighbour's far part a wall may turn.
    const double from = std::min(line.at(a.to), line.at(b.to)), to = std::max(line.at(a.to), line.at(b.to));
    const int around = static_cast<int>(to - from) + static_cast<int>(beside_) + 1;
    const Cell middle = piece[piece.size() / 2];
    work_ += square_of(around);
    for (int dy = -around; dy <= around; ++dy)
      for (int dx = -around; dx <= around; ++dx) {
        const Cell c{middle.x + dx, middle.y + dy};
        if (!labels_.inside(c) || labels_[c] == 0 || line.at(c) < from || line.at(c) > to) continue;
        if (line.off(c) > width_ && line.off(c) <= beside_) return false;
      }
    return true;
  }

  const OccupancyGrid& grid_;
  double width_;       ///< off a line at the most [cells]
  double beside_;      ///< [cells]
  double work_ = 0.0;  ///< cells looked at
  Grid<int> labels_;
  std::vector<Cells> pieces_;
};

}  // namespace

std::vector<std::pair<Cell, Cell>> dashes_in_line(const OccupancyGrid& grid, double most_work) {
  if (grid.cells().empty()) return {};
  return Dashes(grid).in_line(most_work);
}

}  // namespace rubble::scoring
