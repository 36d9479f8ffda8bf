#pragma once

#include <mrpt/math/TPose2D.h>

#include <array>
#include <cstdint>
#include <optional>
#include <vector>

#include "slam/robust/surfel_grid.h"
#include "slam/robust/work.h"

namespace rubble::slam {

/// How well a point would lie on the surfaces of a target: a raster that falls off from each surfel as a Gaussian, with
/// levels of maxima over ever larger squares, as upper bounds for the search (Olson 2009; Hess et al. 2016).
class Correlator {
 public:
  static constexpr int kLevels = 5;  ///< squares of 1, 2, ... 16 cells

  /// `blur`: sigma of the Gaussian [m].
  void build(const std::vector<Surfel>& surfels, double resolution, double blur, Work* work = nullptr);

  double resolution() const { return resolution_; }
  /// Of a point; may lie outside the raster.
  Cell cell(float x, float y) const {
    return {static_cast<int>(std::floor((x - x0_) * per_m_)), static_cast<int>(std::floor((y - y0_) * per_m_))};
  }
  /// Mean over `cells`, shifted by (x, y), of the largest value within 2^level cells up and right, 0..1.
  double value(const std::vector<Cell>& cells, int x, int y, int level) const;
  /// The same where it is above `floor`; elsewhere something at most `floor` and no less than the value. Counts the
  /// cells it had to look at.
  double bound(const std::vector<Cell>& cells, int x, int y, int level, double floor, Work& looked_at) const;

 private:
  void draw(const std::vector<Surfel>& surfels, double blur);
  void pool(int level);

  double resolution_ = 0.05;
  float per_m_ = 20.0F;
  float x0_ = 0.0F, y0_ = 0.0F;
  int width_ = 0, height_ = 0;
  std::array<std::vector<std::uint8_t>, kLevels> levels_;  ///< level l: padded by 2^l - 1 cells below and left
  std::vector<std::uint8_t> half_pooled_;
};

/// Where to look: about a pose, so far to each side.
struct SearchWindow {
  mrpt::math::TPose2D centre;
  double distance = 0.5;  ///< [m]
  double angle = 0.1;     ///< [rad]
};

/// Poses that do not count: those close to one.
struct SearchExclusion {
  mrpt::math::TPose2D pose;
  double distance = 0.45;  ///< [m]
  double angle = 0.2;      ///< [rad]
};

/// Looks for the pose in a window under which points lie best on a target: branch and bound, exact on its raster. Can
/// be stopped after any amount of work and taken up again; the outcome does not depend on where it was stopped.
class CorrelativeSearch {
 public:
  struct Found {
    mrpt::math::TPose2D pose;
    double score = 0.0;  ///< 0..1
  };

  /// Looks for scores above `floor`. `target` must stay as it is until the search is over. `later_floor`: what
  /// start_again() may ask for at least.
  void start(const Correlator& target, const std::vector<OrientedPoint>& points, const SearchWindow& window,
             double floor, const std::optional<SearchExclusion>& exclusion = std::nullopt, double later_floor = 1.0);
  /// After a search is over: looks in the same window once more, for another place, with what is known of it.
  void start_again(double floor, const SearchExclusion& exclusion);
  /// Goes on until the search is over (then true) or `budget` is used up; takes what it used from `budget`.
  bool advance(Work& budget);
  /// The best pose; nothing when none scores above the floor.
  const std::optional<Found>& found() const { return found_; }

 private:
  struct Node {
    int angle, x, y, level;
    double bound;
  };
  void open_angle();
  void expand(const Node& parent);
  Node node(int angle, int x, int y, int level, double floor);
  mrpt::math::TPose2D pose_of(const Node& node) const;
  bool excluded(const mrpt::math::TPose2D& pose) const;

  const Correlator* target_ = nullptr;
  std::vector<OrientedPoint> points_;
  SearchWindow window_;
  std::optional<SearchExclusion> exclusion_;
  double angle_step_ = 0.01;
  int angles_ = 0;  ///< to each side
  int cells_ = 0;   ///< to each side
  double best_ = 0.0;
  double kept_ = 0.0;  ///< roots are kept from this bound
  std::optional<Found> found_;
  std::vector<std::vector<Cell>> turned_;  ///< cells of the points, for each angle looked at so far
  std::vector<Node> roots_;
  std::size_t next_root_ = 0;
  bool sorted_ = false;
  std::vector<Node> stack_;
  Work used_ = 0;
};

/// The whole search at once.
std::optional<CorrelativeSearch::Found> search(const Correlator& target, const std::vector<OrientedPoint>& points,
                                               const SearchWindow& window, double floor,
                                               const std::optional<SearchExclusion>& exclusion, Work* work = nullptr);

}  // namespace rubble::slam
