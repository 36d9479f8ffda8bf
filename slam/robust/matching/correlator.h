#pragma once

#include <mrpt/math/TPose2D.h>

#include <array>
#include <cstdint>
#include <optional>
#include <vector>

#include "base/large_pages.h"
#include "slam/robust/matching/surfel_grid.h"
#include "slam/robust/matching/work.h"

namespace rubble::slam {

/// How well a point would lie on the surfaces of a target: a raster that falls off from each surfel as a Gaussian, with
/// levels of maxima over ever larger squares, as upper bounds for the search (Olson 2009; Hess et al. 2016). Sums over
/// points are taken in stretches: what a square's stretches still promise bounds those of the squares in it, which are
/// given up as soon as that is too little.
class Correlator {
 public:
  static constexpr int kLevels = 4;             ///< squares of 1, 2, 4, 8 cells
  static constexpr int kRootCells = 16;         ///< a side of the squares that a search begins with
  static constexpr std::size_t kStretches = 8;  ///< of the points

  /// Where surfels lie [m].
  struct Extent {
    float low_x = 0.0F, low_y = 0.0F, high_x = 0.0F, high_y = 0.0F;
  };

  /// `blur`: sigma of the Gaussian [m]. Where surfels lie so far apart that the raster would have more than some
  /// millions of cells, which no scan has the time for, both are coarser than asked for.
  void build(const std::vector<Surfel>& surfels, double resolution, double blur, Work* work = nullptr);

  double resolution() const { return resolution_; }
  /// Whoever fits what a search found begins at least so far around it [m]: what is found is a cell of the raster.
  double least_radius() const { return 2.0 * resolution_; }
  double coarser() const { return coarser_; }
  /// Of a point; may lie outside the raster.
  Cell cell(float x, float y) const {
    return {static_cast<int>(std::floor((x - x0_) * per_m_)), static_cast<int>(std::floor((y - y0_) * per_m_))};
  }
  /// Mean over `cells`, shifted by (x, y), of the largest value within 2^level cells up and right, 0..1.
  double value(const std::vector<Cell>& cells, int x, int y, int level) const;

  /// Sums over the points of a square, in 255ths of a point.
  struct Sums {
    std::uint32_t whole = 0;
    std::array<std::uint32_t, kStretches> parts{};
  };
  /// What value() sums for the four squares of `level` at (x, y) and 2^level cells to the right, up, and both, in this
  /// order; `around` are the sums of a square that holds them. Gives up (then nothing) once none can be above `floor`.
  /// Counts the cells it had to look at.
  std::optional<std::array<Sums, 4>> quarters(const std::vector<Cell>& cells, int x, int y, int level,
                                              const Sums& around, std::uint32_t floor, Work& looked_at) const;
  /// Where each point looks; memory that roots() may use again.
  struct RootWork {
    std::vector<int> column, row, at;
  };
  /// Upper bounds for squares of kRootCells, `columns` x `rows` of them side by side from (x, y) on, row by row.
  void roots(const std::vector<Cell>& cells, int x, int y, int columns, int rows, RootWork& work,
             std::vector<Sums>& out) const;

 private:
  void lay_out(const Extent& extent, int reach);
  void draw(const std::vector<Surfel>& surfels, double blur, int reach);
  void pool(int level);
  void pool_roots();

  double resolution_ = 0.05;
  double coarser_ = 1.0;  ///< times the cell asked for
  float per_m_ = 20.0F;
  float x0_ = 0.0F, y0_ = 0.0F;
  int width_ = 0, height_ = 0;
  LargeBuffer memory_;                           ///< of the planes
  std::array<std::uint8_t*, kLevels> levels_{};  ///< level l: padded by 2^l - 1 cells below and left
  std::vector<std::uint8_t> half_pooled_;
  // For the roots, four cells make one: values of squares that hold all that kRootCells from any of its cells on see.
  // Every fourth of a row lies side by side, as neighbouring squares ask for them: plane after plane, row after row.
  std::uint8_t* coarse_ = nullptr;
  int coarse_columns_ = 0;
  int coarse_height_ = 0;
  int coarse_stride_ = 0;  ///< with a margin of a whole group of squares to each side
};

/// Where to look: about a pose, so far to each side.
struct SearchWindow {
  mrpt::math::TPose2D centre;
  double distance = 0.5;  ///< [m]
  double angle = 0.1;     ///< [rad]
};

/// Poses that do not count: those close to one, or next to it on a coarse raster.
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
    Correlator::Sums sums;
  };
  void open_angle();
  void expand(const Node& parent);
  double score(const Correlator::Sums& sums) const;
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
  std::vector<std::vector<Cell>> turned_;  ///< cells of the points, for each angle; memory that stays
  int opened_ = 0;                         ///< angles looked at so far
  std::vector<Node> roots_;
  std::size_t next_root_ = 0;
  bool sorted_ = false;
  std::vector<Node> stack_;
  Correlator::RootWork root_work_;
  std::vector<Correlator::Sums> bounds_;  ///< work space of open_angle()
  Work used_ = 0;
};

/// Points of a sub-map that are searched with: more tell little more.
inline constexpr std::size_t kSearchedPoints = 350;

/// What makes another place a rival of the best one.
struct RivalConfig {
  double least_score = 0.5;                      ///< of the best one
  double share = 0.9;                            ///< of its score
  double distance = SearchExclusion{}.distance;  ///< so far away from it [m] ...
  double angle = SearchExclusion{}.angle;        ///< ... or turned so much [rad]
};

/// Looks for the best pose in a window and then for its rival. Can be stopped and taken up again as the search itself.
class RivalSearch {
 public:
  explicit RivalSearch(const RivalConfig& config) : config_(config) {}

  /// `target` must stay as it is until the search is over.
  void start(const Correlator& target, const std::vector<OrientedPoint>& points, const SearchWindow& window);
  void stop() { stage_ = Stage::Idle; }
  bool running() const { return stage_ != Stage::Idle; }
  /// Goes on until the search is over (then true) or `budget` is used up; takes what it used from `budget`.
  bool advance(Work& budget);
  /// The best pose; nothing when none scores enough.
  const std::optional<CorrelativeSearch::Found>& best() const { return best_; }
  const std::optional<CorrelativeSearch::Found>& rival() const { return search_.found(); }

 private:
  enum class Stage { Idle, Best, Rival };

  const RivalConfig config_;
  CorrelativeSearch search_;
  Stage stage_ = Stage::Idle;
  std::optional<CorrelativeSearch::Found> best_;
};

}  // namespace rubble::slam
