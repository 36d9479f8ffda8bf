#pragma once

#include <cstdint>
#include <deque>
#include <optional>
#include <set>
#include <utility>
#include <vector>

#include "slam/robust/graph/graph_solver.h"
#include "slam/robust/graph/key_frames.h"
#include "slam/robust/graph/loop_record.h"
#include "slam/robust/matching/correlator.h"
#include "slam/robust/matching/scan_fit.h"

namespace rubble::slam {

/// How loops are looked for and what they must stand.
struct LoopConfig {
  double least_path = 6.0;               ///< a loop is at least so long, along the graph and along the drive [m]
  double window = 0.30;                  ///< half width of the search [m] ...
  double window_per_m = 0.03;            ///< ... and what it gains per metre of path through the graph
  double largest_window = 4.0;           ///< [m]
  double angle = 0.07;                   ///< the same for the heading [rad]
  double angle_per_m = 0.006;            ///< [rad/m]
  double largest_angle = 0.5;            ///< [rad]
  double reach = 1.2;                    ///< old key frames so far beyond the window are candidates [m]
  int searches = 2;                      ///< candidates tried per key frame
  int new_frames = 6;                    ///< key frames that are matched ...
  double new_path = 2.5;                 ///< ... and the path they cover at most [m]
  int old_frames = 8;                    ///< key frames they are matched with
  double old_path = 4.0;                 ///< [m]
  double cell = 0.05;                    ///< raster of the search [m]
  double blur = 0.06;                    ///< sigma of a surface in the raster [m]
  double least_score = 0.55;             ///< of the search
  double runner_up = 0.90;               ///< refused when another place scores so much of the best
  double least_inliers = 0.55;           ///< of the fit
  double most_contradiction = 0.15;      ///< share of points seen through, either way
  double expected_contradiction = 0.15;  ///< null test: below, the pose expected without the loop stands
  int confirmations = 3;                 ///< loops that must agree before they count ...
  double sure_contradiction = 0.075;     ///< ... one of them contradicting no more than this ...
  double apart_distance = 1.0;           ///< ... and those that move it farther than expected so far apart [m] ...
  int views = 2;                         ///< ... and leading to so many old key frames where they move it at all
  double agree_distance = 0.20;          ///< within this [m]
  double agree_angle = 0.05;             ///< and this [rad]
  double sigma_distance = 0.03;          ///< least error of a loop [m]
  double sigma_angle = 0.008;            ///< [rad]
  double scaling = 8.0;                  ///< of dynamic covariance scaling
  double near_window = 0.20;             ///< of edges to old key frames where the graph is tight [m]
  double astray_contradiction =
      0.25;  ///< share of points that old key frames around contradict in one that strayed; above 1: never
  double astray_window = 1.6;  ///< half width of the search for it at least [m] ...
  double astray_angle = 0.75;  ///< ... and of its heading: less than half a quarter turn, which walls leave open [rad]
};

struct LoopCounts {
  std::uint64_t searched = 0;      ///< candidates tried
  std::uint64_t ambiguous = 0;     ///< refused: another place fits nearly as well
  std::uint64_t contradicted = 0;  ///< refused: one would have seen through walls
  std::uint64_t needless = 0;      ///< refused: the robot stands well where it is
  std::uint64_t closed = 0;        ///< loops that count
  std::uint64_t near_edges = 0;    ///< edges to old key frames where the graph was tight
  std::uint64_t removed = 0;       ///< loops found wrong later
  std::uint64_t solved = 0;        ///< solutions of the pose graph
  std::uint64_t astray = 0;        ///< key frames that old ones around contradicted when they came
};

/// A loop that waits for others to agree.
struct LoopClaim {
  GraphEdge loop;
  bool clear;              ///< next to nothing contradicts it
  bool expected;           ///< it moves the robot no farther than the way there explains
  double moves;            ///< how far it moves the robot [m]
  std::size_t record = 0;  ///< its place in LoopCloser::records()
};

/// Whether the newest claim is to be believed together with a group of older ones that say the same of key frames.
bool believed(const LoopConfig& config, const KeyFrames& frames, const LoopClaim& newest,
              const std::vector<LoopClaim>& group);

/// Of the points of a newer sub-map as an older one judges them, and the reverse.
struct MutualAgreement {
  KeyFrames::Agreement there;
  KeyFrames::Agreement back;
};

/// Of the last key frames up to `frame` with the old ones closest to it that are below `end`, as both lie now; nothing
/// where there are none. `points`: of the last ones, seen from `frame` [m]; the work is taken off the `budget`.
std::optional<MutualAgreement> agreement_here(const KeyFrames& frames, const LoopConfig& config, double surfel_cell,
                                              int frame, int end, const std::vector<OrientedPoint>& points,
                                              Work& budget);

/// Finds loops among the key frames and keeps their graph solved. What a new key frame asks for is queued and done by
/// work(), in slices; what comes of it is the same for all sizes of slices that keep up with the drive.
class LoopCloser {
 public:
  LoopCloser(const LoopConfig& config, double surfel_cell, KeyFrames& frames);

  /// Takes the key frames as they are now for those of a map that was loaded. `shift`: what the numbers of those of
  /// before rose by, where they are among them.
  void begin_anew(const std::optional<int>& shift);
  /// Queues the searches for the newest key frame.
  void look(Work* work = nullptr);
  /// Does queued work until `budget` is used up; returns whether poses moved.
  bool work(Work& budget);
  /// Does all that is queued, adds edges between all neighbours, and solves to the end.
  void finish();

  const LoopCounts& counts() const { return counts_; }
  /// The searches that found a place, one by one.
  const std::vector<LoopRecord>& records() const { return records_; }
  std::size_t queued() const { return tasks_.size(); }
  /// Whether old key frames around contradicted the newest one when it came: the robot is not where it seems to be.
  bool astray() const { return astray_; }
  /// Key frames that see through walls of older ones around, as these do through theirs, as poses are now: there the
  /// map shows two places on top of each other. Right maps of 56 recorded drives and six buildings have at most 2,
  /// those that are off by a quarter of a metre and more 14 to 39 of about a thousand.
  std::vector<int> doubled() const;
  /// Covariance of the newest key frame's pose as of the last solution.
  const Eigen::Matrix3d& covariance() const { return covariance_; }
  /// The newest key frame that took part in it.
  int solved() const { return covariance_frame_; }

 private:
  enum class Kind { Wide, Near, Solve };
  struct Task {
    Kind kind;
    int frame;  ///< new key frame
    int old;    ///< candidate; -1 with Solve
    double window = 0.0;
    double angle = 0.0;
    double path = 0.0;  ///< through the graph
  };

  void begin(const Task& task, Work& budget);
  bool draw_both(const Task& task);
  void go_on(Work& budget);
  void verify(const Task& task, const mrpt::math::TPose2D& start, Work& budget);
  bool sees_through(const Task& task, const mrpt::math::TPose2D& T_old_new, const mrpt::math::TPose2D& T_expected,
                    double* contradiction);
  void confirm(const LoopClaim& claim);
  bool agree(const GraphEdge& a, const GraphEdge& b) const;
  void accept(const GraphEdge& loop, bool near);
  LoopRecord& record_of(const Task& task);
  /// An old key frame that may be close.
  struct Candidate {
    int frame;
    double away;  ///< [m]
    double path;  ///< through the graph [m]
  };
  std::vector<Candidate> candidates_within(int frame, int end, double distance, double most_path, Work* work) const;
  double usual_window(double path) const;
  /// Shares of points that are contradicted; 0: too little is seen by both.
  struct Testimony {
    double one_way = 0.0;    ///< the larger share, of the key frame's points by old ones or the other way round
    double both_ways = 0.0;  ///< the smaller
  };
  Testimony testimony(int frame, Work* work) const;
  void queue_near(int frame, const std::vector<Candidate>& candidates);
  void consider_solving();
  bool solve(Work& budget);
  void take_solution(Work& budget);
  enum class Suspects { Some, All };
  bool remove_worst_loop(Suspects suspects, Work& budget);
  std::vector<std::size_t> suspects(Suspects which) const;
  bool explained_already(const Task& task, const KeyFrames::Agreement& by_loop) const;
  bool stands_well(const Task& task, const mrpt::math::TPose2D& T_old_new, Work& budget) const;
  void run_queue();

  const LoopConfig config_;
  const ScanFitConfig wide_fit_;
  const ScanFitConfig near_fit_;
  const double surfel_cell_;
  KeyFrames& frames_;

  std::deque<Task> tasks_;
  Task task_{};                  ///< the one under way
  int closed_for_ = -1;          ///< newest key frame with an edge of its own
  std::vector<int> new_frames_;  ///< of the task under way
  std::vector<int> old_frames_;
  SurfelGrid old_surfels_;
  SurfelGrid new_surfels_;
  std::vector<OrientedPoint> points_;      ///< of the new key frames
  std::vector<OrientedPoint> old_points_;  ///< of the old ones
  Correlator correlator_;
  RivalSearch search_;

  std::deque<LoopClaim> waiting_;
  std::set<std::pair<int, int>> linked_;  ///< pairs with an edge already
  std::vector<GraphEdge> fresh_;          ///< edges since the last solve
  int frames_since_solve_ = 0;
  GraphSolver solver_;
  Eigen::Matrix3d covariance_ = Eigen::Matrix3d::Zero();
  int covariance_frame_ = 0;  ///< whose covariance it is
  bool astray_ = false;       ///< the newest key frame
  LoopCounts counts_;
  std::vector<LoopRecord> records_;  ///< the last one is of the task under way, where that is a search
  LoopRecord near_record_;           ///< of a near edge, which nobody asks for
};

}  // namespace rubble::slam
