#include "slam/robust/graph/loop_closer.h"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <limits>

#include "base/angle.h"
#include "base/planar.h"

namespace rubble::slam {

using mrpt::math::TPose2D;

namespace {

constexpr std::size_t kLeastSurfels = 40;
constexpr int kLeastLoopPairs = 30;
constexpr double kOtherCandidate = 3.0;  ///< candidates lie so far apart along the drive [m]
constexpr double kNear = 0.8;            ///< near edges reach so far [m]
constexpr double kLastNear = 1.0;        ///< at the end [m]
constexpr double kLastNearPath = 25.0;   ///< [m]
constexpr double kTightPath = 40.0;      ///< a loop of less path that hardly moves needs no confirmation [m]
constexpr double kHardlyMoves = 0.12;    ///< [m]
constexpr double kHardlyTurns = 0.04;    ///< [rad]
constexpr double kExpectedMoves = 0.3;   ///< from here the null test asks [m]
constexpr int kConfirmedWithin = 12;     ///< key frames ...
constexpr int kConfirmedFromAfar = 60;   ///< ... and those that were taken elsewhere
constexpr std::size_t kMostWaiting = 400;
constexpr int kSolveEvery = 15;     ///< key frames with near edges only
constexpr double kSolveNow = 0.10;  ///< disagreement that is solved at once [m + 2 rad]
constexpr double kSolveGradually = 0.25;
constexpr double kWrongDistance = 0.4;     ///< a loop that ends up so far off is wrong [m]
constexpr double kWrongAngle = 0.15;       ///< [rad]
constexpr int kMostRemovals = 30;          ///< at the end, each with a solution of the whole graph
constexpr double kStrained = 1.0;          ///< loops off by less (squared sigmas) bend nothing
constexpr double kExplainedWithin = 1.5;   ///< old key frames so close explain what is seen [m]
constexpr double kAsFar = 0.7;             ///< and are so much of the loop's path away ...
constexpr double kExplained = 0.8;         ///< when they support so much of what the loop's would ...
constexpr double kAsGood = 0.03;           ///< ... and contradict hardly more
constexpr double kSeenHere = 0.5;          ///< the same share of a robot that stands well: what contradicts it counts
constexpr double kWitnessAway = 2.5;       ///< old key frames so close are asked whether a new one can be true [m] ...
constexpr std::size_t kLoopWitnesses = 8;  ///< ... so many of them
constexpr double kDoubledOneWay = 0.40;    ///< shares of points contradicted where the map shows two places at once:
constexpr double kDoubledBothWays = 0.10;  ///< by the older ones or of them, and both
constexpr int kLeastContradicted = 12;     ///< points
constexpr int kLeastJudged = 60;           ///< points of which they can say something
constexpr Work kWorkPerSuspected = 40;     ///< edge

double size_of(const TPose2D& T) { return length(T.x, T.y); }
double disagreement_of(const TPose2D& T) { return size_of(T) + 2.0 * std::abs(wrap_angle(T.phi)); }

/// Without a loop, compared with what speaks for it.
bool as_good(const KeyFrames::Agreement& now, const KeyFrames::Agreement& by_loop, double share) {
  return now.supported >= share * by_loop.supported && now.contradiction() <= by_loop.contradiction() + kAsGood;
}

/// The first key frame that does not lie far enough back along the drive to close a loop with `frame`.
int end_of_old(const KeyFrames& frames, const LoopConfig& config, int frame) {
  int end = 0;
  while (end < frame && frames[frame].path - frames[end].path >= config.least_path) ++end;
  return end;
}

ScanFitConfig fit_config(double first_radius) {
  ScanFitConfig config;
  config.first_radius = first_radius;
  config.iterations = 15;
  return config;
}

}  // namespace

LoopCloser::LoopCloser(const LoopConfig& config, double surfel_cell, KeyFrames& frames)
    : config_(config),
      wide_fit_(fit_config(0.15)),
      near_fit_(fit_config(0.25)),
      surfel_cell_(surfel_cell),
      frames_(frames),
      search_({config.least_score, config.runner_up}) {}

/// Key frames below `end` that lie within `distance` of where `frame` is expected, and no more than `most_path` away
/// through the graph.
std::vector<LoopCloser::Candidate> LoopCloser::candidates_within(int frame, int end, double distance, double most_path,
                                                                 Work* work) const {
  const TPose2D& here = frames_.pose(frame);
  std::vector<int> close;
  std::vector<Candidate> candidates;
  for (int j = 0; j < end; ++j) {
    const double away = length(frames_.pose(j).x - here.x, frames_.pose(j).y - here.y);
    if (away >= distance) continue;
    close.push_back(j);
    candidates.push_back({j, away, 0.0});
  }
  if (work != nullptr) *work += 2 * static_cast<Work>(end);
  if (close.empty()) return candidates;
  const std::vector<double> paths = frames_.paths_from(frame, close, most_path, work);
  for (std::size_t k = 0; k < close.size(); ++k) candidates[k].path = paths[k];
  return candidates;
}

/// Other key frames have taken the place of those before: what waits is forgotten, edges that are there are known.
void LoopCloser::begin_anew(const std::optional<int>& shift) {
  for (LoopRecord& record : records_)
    record.old_frame = shift && record.old_frame >= 0 ? record.old_frame + *shift : -1;
  tasks_.clear();
  search_.stop();
  closed_for_ = frames_.last();
  waiting_.clear();
  linked_.clear();
  for (const GraphEdge& edge : frames_.graph().edges)
    if (edge.loop) linked_.insert({edge.to, edge.from});
  fresh_.clear();
  frames_since_solve_ = 0;
  solver_.start(PoseGraph(), GraphSolver::Plan::Refine, config_.scaling);
  astray_ = false;
  covariance_.setZero();
  covariance_frame_ = 0;
}

/// Half width of the search for a loop of so much path through the graph.
double LoopCloser::usual_window(double path) const {
  return std::min(config_.largest_window, config_.window + config_.window_per_m * path);
}

void LoopCloser::look(Work* work) {
  const int i = frames_.last();
  const std::vector<Candidate> close =
      candidates_within(i, end_of_old(frames_, config_, i), config_.reach + config_.largest_window,
                        std::numeric_limits<double>::infinity(), work);
  // Between walls that look the same all along, wheels that spin carry the robot away and nothing tells. Once it looks
  // out of there, it or old key frames see through walls of the other, however short the way back through the graph.
  const bool strayed = astray_ = testimony(i, work).one_way >= config_.astray_contradiction;
  counts_.astray += strayed ? 1 : 0;
  std::vector<std::pair<double, Task>> candidates;
  for (const Candidate& old : close) {
    if (old.path < config_.least_path && !strayed) continue;
    const double window = std::max(usual_window(old.path), strayed ? config_.astray_window : 0.0);
    if (old.away >= config_.reach + window) continue;
    const double angle = std::max(std::min(config_.largest_angle, config_.angle + config_.angle_per_m * old.path),
                                  strayed ? config_.astray_angle : 0.0);
    candidates.push_back({old.away, {Kind::Wide, i, old.frame, window, angle, old.path}});
  }
  std::stable_sort(candidates.begin(), candidates.end(),
                   [](const auto& a, const auto& b) { return a.first < b.first; });
  std::vector<int> taken;
  for (const auto& [away, task] : candidates) {
    if (static_cast<int>(taken.size()) >= config_.searches) break;
    const bool near_taken = std::any_of(taken.begin(), taken.end(), [&, j = task.old](int k) {
      return std::abs(frames_[k].path - frames_[j].path) < kOtherCandidate;
    });
    if (near_taken) continue;
    taken.push_back(task.old);
    tasks_.push_back(task);
  }
  if (!strayed) queue_near(i, close);
  tasks_.push_back({Kind::Solve, i, -1});
}

/// What the old key frames closest by say of a key frame, and it of them.
LoopCloser::Testimony LoopCloser::testimony(int frame, Work* work) const {
  KeyFrames::Agreement there;
  KeyFrames::Agreement back;
  const auto sum = [](KeyFrames::Agreement& all, const KeyFrames::Agreement& more) {
    all.contradicted += more.contradicted;
    all.supported += more.supported;
  };
  for (const int old :
       frames_.closest(frames_.pose(frame), kWitnessAway, kLoopWitnesses, end_of_old(frames_, config_, frame))) {
    sum(there, frames_.agreement(frames_[frame].cloud.points, {}, frames_.pose(frame), {old}));
    sum(back, frames_.agreement(frames_[old].cloud.points, {}, frames_.pose(old), {frame}));
    if (work != nullptr)
      *work +=
          kWorkPerJudged * static_cast<Work>(frames_[frame].cloud.points.size() + frames_[old].cloud.points.size());
  }
  const auto judged = [](const KeyFrames::Agreement& a) { return a.contradicted + a.supported; };
  if (std::max(judged(there), judged(back)) < kLeastJudged ||
      std::max(there.contradicted, back.contradicted) < kLeastContradicted)
    return {};
  return {std::max(there.contradiction(), back.contradiction()), std::min(there.contradiction(), back.contradiction())};
}

/// One way alone is glass, or things that were moved; two places on top of each other see through each other's walls.
std::vector<int> LoopCloser::doubled() const {
  std::vector<int> frames;
  for (int i = 0; i <= frames_.last(); ++i) {
    const Testimony said = testimony(i, nullptr);
    if (said.one_way >= kDoubledOneWay && said.both_ways >= kDoubledBothWays) frames.push_back(i);
  }
  return frames;
}

/// Where the graph is tight already, one edge to the closest old key frame.
void LoopCloser::queue_near(int i, const std::vector<Candidate>& candidates) {
  const Candidate* closest = nullptr;
  double least = kNear;
  for (const Candidate& old : candidates) {
    if (old.path >= config_.least_path || old.path <= 0.25 || old.away >= least) continue;
    if (frames_[i].path - frames_[old.frame].path <= config_.least_path) continue;
    least = old.away;
    closest = &old;
  }
  if (closest == nullptr || linked_.count({i, closest->frame}) != 0) return;
  tasks_.push_back({Kind::Near, i, closest->frame, config_.near_window, 0.05, closest->path});
}

bool LoopCloser::work(Work& budget) {
  bool moved = false;
  while (budget > 0) {
    if (solver_.running()) {
      moved = solve(budget) || moved;
    } else if (search_.running()) {
      go_on(budget);
    } else if (!tasks_.empty()) {
      const Task task = tasks_.front();
      tasks_.pop_front();
      begin(task, budget);
      budget -= kWorkPerDrawnFrame * static_cast<Work>(new_frames_.size() + old_frames_.size());
      if (task.kind == Kind::Near && !points_.empty())
        verify(task, frames_.pose(task.frame) - frames_.pose(task.old), budget);
    } else {
      break;
    }
  }
  return moved;
}

void LoopCloser::begin(const Task& task, Work& budget) {
  points_.clear();
  new_frames_.clear();
  old_frames_.clear();
  if (task.kind == Kind::Solve) return consider_solving();
  if (task.kind == Kind::Near && closed_for_ == task.frame) return;
  ++counts_.searched;
  if (!draw_both(task) || task.kind == Kind::Near) return;

  Work used = 0;
  correlator_.build(old_surfels_.surfels(), config_.cell, config_.blur, &used);
  budget -= used;
  task_ = task;
  const TPose2D expected = frames_.pose(task.frame) - frames_.pose(task.old);
  search_.start(correlator_, points_, {expected, task.window, task.angle});
}

/// The two sub-maps of a task; false when one of them shows too little.
bool LoopCloser::draw_both(const Task& task) {
  new_frames_ = frames_.ending_at(task.frame, config_.new_frames, config_.new_path);
  old_frames_ = frames_.around(task.old, config_.old_frames, config_.old_path, new_frames_.back());
  frames_.draw(old_frames_, frames_.pose(task.old), surfel_cell_, old_surfels_);
  if (old_surfels_.surfels().size() < kLeastSurfels) return false;
  frames_.draw(new_frames_, frames_.pose(task.frame), surfel_cell_, new_surfels_);
  points_ = new_surfels_.thinned_to(kSearchedPoints);
  if (points_.size() < kLeastSurfels) {
    points_.clear();
    return false;
  }
  old_points_ = old_surfels_.every_nth(2);
  return true;
}

void LoopCloser::go_on(Work& budget) {
  if (!search_.advance(budget) || !search_.best()) return;
  const CorrelativeSearch::Found& best = *search_.best();
  const TPose2D moved = best.pose - (frames_.pose(task_.frame) - frames_.pose(task_.old));
  LoopRecord record;
  record.stamp = frames_[task_.frame].stamp;
  record.old_stamp = frames_[task_.old].stamp;
  record.old_frame = task_.old;
  record.path = task_.path;
  record.window = task_.window;
  record.score = best.score;
  record.T_old_new = best.pose;
  record.moves = size_of(moved);
  record.turns = std::abs(wrap_angle(moved.phi));
  record.end = search_.rival() ? LoopRecord::End::Ambiguous : LoopRecord::End::Unfit;
  records_.push_back(record);
  if (search_.rival())
    ++counts_.ambiguous;
  else
    verify(task_, best.pose, budget);
}

/// Of a search that found a place; near edges are not told one by one.
LoopRecord& LoopCloser::record_of(const Task& task) { return task.kind == Kind::Wide ? records_.back() : near_record_; }

void LoopCloser::verify(const Task& task, const TPose2D& start, Work& budget) {
  const bool near = task.kind == Kind::Near;
  Work used = 0;
  ScanFitConfig config = near ? near_fit_ : wide_fit_;
  if (!near) config.first_radius = std::max(config.first_radius, correlator_.least_radius());
  const ScanFit fit =
      fit_scan(old_surfels_, points_, start, {start, 1e-3 * Eigen::Matrix3d::Identity()}, config, &used);
  budget -= used;
  LoopRecord& record = record_of(task);
  record.inliers = fit.inliers;
  if (fit.inliers < config_.least_inliers || fit.paired < kLeastLoopPairs || !well_conditioned(fit)) return;
  const TPose2D expected = frames_.pose(task.frame) - frames_.pose(task.old);
  const TPose2D moved = fit.pose - expected;
  if (near && size_of(moved) > 1.5 * task.window) return;
  record.T_old_new = fit.pose;
  record.moves = size_of(moved);
  record.turns = std::abs(wrap_angle(moved.phi));
  budget -= kWorkPerJudged * static_cast<Work>(points_.size() + old_points_.size()) *
            static_cast<Work>(new_frames_.size() + old_frames_.size());
  double contradiction = 0.0;
  if (sees_through(task, fit.pose, expected, &contradiction)) return;
  if (!near && size_of(moved) > kExpectedMoves && stands_well(task, fit.pose, budget)) {
    ++counts_.needless;
    record.end = LoopRecord::End::Needless;
    return;
  }

  GraphEdge loop;
  loop.from = task.old;
  loop.to = task.frame;
  loop.T_from_to = fit.pose;
  loop.information = limited(fit.information, config_.sigma_distance, config_.sigma_angle);
  loop.loop = true;
  const bool hardly = size_of(moved) < kHardlyMoves && std::abs(wrap_angle(moved.phi)) < kHardlyTurns;
  if (near || (hardly && task.path < kTightPath)) {
    accept(loop, true);
    record.end = LoopRecord::End::Closed;
  } else {
    record.end = LoopRecord::End::Waits;
    confirm({loop, contradiction <= config_.sure_contradiction, size_of(moved) <= usual_window(task.path),
             size_of(moved), records_.size() - 1});
  }
}

/// Whether the loop would have beams pass through walls; or, null test, whether the pose expected without it does not:
/// in a maze of equal cells a wrong loop may contradict nothing, but neither does the truth.
bool LoopCloser::sees_through(const Task& task, const TPose2D& T_old_new, const TPose2D& T_expected,
                              double* contradiction) {
  const TPose2D& old_pose = frames_.pose(task.old);
  const TPose2D& new_pose = frames_.pose(task.frame);
  const auto there = frames_.agreement(points_, T_old_new, old_pose, old_frames_);
  const auto back = frames_.agreement(old_points_, TPose2D() - T_old_new, new_pose, new_frames_);
  *contradiction = std::max(there.contradiction(), back.contradiction());
  LoopRecord& record = record_of(task);
  record.contradiction = *contradiction;
  if (*contradiction > config_.most_contradiction) {
    ++counts_.contradicted;
    record.end = LoopRecord::End::Contradicted;
    return true;
  }
  if (task.kind == Kind::Near || size_of(T_old_new - T_expected) <= kExpectedMoves) return false;
  constexpr auto kSlack = SightFan::Slack::AcrossSurface;  // only what a pose off by a little cannot explain counts
  const auto expected_there = frames_.agreement(points_, T_expected, old_pose, old_frames_, kSlack);
  const auto expected_back = frames_.agreement(old_points_, TPose2D() - T_expected, new_pose, new_frames_, kSlack);
  const bool overlap = expected_there.supported + expected_back.supported > 0.15 * (there.supported + back.supported);
  const double without = std::max(expected_there.contradiction(), expected_back.contradiction());
  const bool stands = overlap ? without < config_.expected_contradiction : explained_already(task, there);
  record.expected_contradiction = without;
  if (stands) {
    ++counts_.needless;
    record.end = LoopRecord::End::Needless;
  }
  return stands;
}

/// Whether the map as it stands, with other old key frames than the loop's, shows what the new ones see: with equal
/// cells all around, the cell that the robot is expected in fits as well as the loop's.
bool LoopCloser::explained_already(const Task& task, const KeyFrames::Agreement& by_loop) const {
  int closest = -1;
  double least = std::numeric_limits<double>::infinity();
  for (const Candidate& old : candidates_within(task.frame, new_frames_.back(), kExplainedWithin,
                                                std::numeric_limits<double>::infinity(), nullptr)) {
    if (old.path < kAsFar * task.path) continue;  // what moves along explains nothing
    if (old.away >= least) continue;
    least = old.away;
    closest = old.frame;
  }
  if (closest < 0) return false;
  const std::vector<int> there = frames_.around(closest, config_.old_frames, config_.old_path, new_frames_.back());
  return as_good(frames_.agreement(points_, {}, frames_.pose(task.frame), there), by_loop, kExplained);
}

/// Whether the map as it stands shows what the new key frames see, and these what it shows, as well as what the loop
/// leads to. Only what is older than that is asked: what was seen after a slide has moved along, and tells of nothing.
bool LoopCloser::stands_well(const Task& task, const TPose2D& T_old_new, Work& budget) const {
  const auto now = agreement_here(frames_, config_, surfel_cell_, task.frame, task.old, points_, budget);
  if (!now) return false;
  const TPose2D& here = frames_.pose(task.frame);
  budget -= kWorkPerJudged * static_cast<Work>(points_.size() + old_points_.size()) *
            static_cast<Work>(new_frames_.size() + old_frames_.size());
  return as_good(now->there, frames_.agreement(points_, T_old_new, frames_.pose(task.old), old_frames_), kSeenHere) &&
         as_good(now->back, frames_.agreement(old_points_, TPose2D() - T_old_new, here, new_frames_), kSeenHere);
}

std::optional<MutualAgreement> agreement_here(const KeyFrames& frames, const LoopConfig& config, double surfel_cell,
                                              int frame, int end, const std::vector<OrientedPoint>& points,
                                              Work& budget) {
  const TPose2D& here = frames.pose(frame);
  const int old_end = std::min(end, end_of_old(frames, config, frame));
  const std::vector<int> closest = frames.closest(here, kExplainedWithin, 1, old_end);
  if (closest.empty()) return std::nullopt;
  const std::vector<int> late = frames.ending_at(frame, config.new_frames, config.new_path);
  const std::vector<int> old = frames.around(closest.front(), config.old_frames, config.old_path, late.back());
  SurfelGrid seen;
  frames.draw(old, here, surfel_cell, seen);
  const std::vector<OrientedPoint> old_points = seen.every_nth(2);
  budget -= kWorkPerDrawnFrame * static_cast<Work>(old.size()) +
            kWorkPerJudged * static_cast<Work>(points.size() + old_points.size()) *
                static_cast<Work>(late.size() + old.size());
  return MutualAgreement{frames.agreement(points, {}, here, old), frames.agreement(old_points, {}, here, late)};
}

/// A loop that moves the robot counts when others of the last key frames say the same.
void LoopCloser::confirm(const LoopClaim& claim) {
  std::vector<std::size_t> group;
  std::vector<LoopClaim> claims;
  for (std::size_t k = 0; k < waiting_.size(); ++k) {
    if (!agree(claim.loop, waiting_[k].loop)) continue;
    group.push_back(k);
    claims.push_back(waiting_[k]);
  }
  if (!believed(config_, frames_, claim, claims)) {
    waiting_.push_back(claim);
    if (waiting_.size() > kMostWaiting) waiting_.pop_front();
    return;
  }
  accept(claim.loop, false);
  records_[claim.record].end = LoopRecord::End::Closed;
  for (const std::size_t k : group) {
    accept(waiting_[k].loop, false);
    records_[waiting_[k].record].end = LoopRecord::End::Closed;
  }
  for (auto k = group.rbegin(); k != group.rend(); ++k)
    waiting_.erase(waiting_.begin() + static_cast<std::ptrdiff_t>(*k));
}

/// One of them at least must contradict next to nothing: where cells are alike, a wrong place fits half, and stays the
/// same wrong place for metres. What is wrong about one old view is wrong each time that it is asked, so loops that
/// move the robot must lead to several, and to each with one that contradicts next to nothing: from a robot that is off
/// by a quarter of a cell the next cell fits as well as its own does, but for what little differs. And what a robot
/// says that turns or shuffles on the spot is one thing said thrice: that is enough for what was to be expected after
/// the way there, and for a slide only with a loop from elsewhere.
bool believed(const LoopConfig& config, const KeyFrames& frames, const LoopClaim& newest,
              const std::vector<LoopClaim>& group) {
  const auto enough = [&](int loops) { return loops >= config.confirmations; };
  const TPose2D& here = frames.pose(newest.loop.to);
  std::set<int> clear_views;
  if (newest.clear) clear_views.insert(newest.loop.from);
  bool sure = newest.clear && newest.expected;
  int close = 1;
  double apart = 0.0;
  for (const LoopClaim& claim : group) {
    const TPose2D& there = frames.pose(claim.loop.to);
    apart = std::max(apart, length(there.x - here.x, there.y - here.y));
    if (claim.clear) clear_views.insert(claim.loop.from);
    if (newest.loop.to - claim.loop.to > kConfirmedWithin) continue;
    sure = sure || (claim.clear && claim.expected);
    ++close;
  }
  if (newest.moves > kExpectedMoves && static_cast<int>(clear_views.size()) < config.views) return false;
  return (enough(close) && sure) ||
         (enough(static_cast<int>(group.size()) + 1) && !clear_views.empty() && apart >= config.apart_distance);
}

/// Whether two loops place the newer key frame of `b` alike, as seen from the older one of `a`.
bool LoopCloser::agree(const GraphEdge& a, const GraphEdge& b) const {
  if (a.to - b.to > kConfirmedFromAfar || a.to == b.to) return false;
  const TPose2D by_a = a.T_from_to + (frames_.pose(b.to) - frames_.pose(a.to));
  const TPose2D by_b = (frames_.pose(b.from) - frames_.pose(a.from)) + b.T_from_to;
  const TPose2D off = by_b - by_a;
  const double slack = 0.02 * (std::abs(frames_[a.to].path - frames_[b.to].path) +
                               std::abs(frames_[a.from].path - frames_[b.from].path));
  return size_of(off) < config_.agree_distance + slack &&
         std::abs(wrap_angle(off.phi)) < config_.agree_angle + 0.1 * slack;
}

void LoopCloser::accept(const GraphEdge& loop, bool near) {
  frames_.add_loop(loop, kLoopLength);
  linked_.insert({loop.to, loop.from});
  fresh_.push_back(loop);
  closed_for_ = std::max(closed_for_, loop.to);
  ++(near ? counts_.near_edges : counts_.closed);
}

void LoopCloser::consider_solving() {
  ++frames_since_solve_;
  if (fresh_.empty()) return;
  double worst = 0.0;
  for (const GraphEdge& edge : fresh_) worst = std::max(worst, disagreement_of(disagreement(frames_.graph(), edge)));
  if (worst <= kSolveNow && frames_since_solve_ <= kSolveEvery) return;
  fresh_.clear();
  frames_since_solve_ = 0;
  solver_.start(frames_.graph(), worst > kSolveGradually ? GraphSolver::Plan::Gradually : GraphSolver::Plan::Refine,
                config_.scaling);
}

bool LoopCloser::solve(Work& budget) {
  if (solver_.advance(budget)) return false;
  take_solution(budget);
  return true;
}

void LoopCloser::take_solution(Work& budget) {
  ++counts_.solved;
  frames_.move(solver_.nodes());
  Work used = 0;
  if (solver_.solved()) covariance_ = solver_.covariance_of_last(&used);
  budget -= used;
  covariance_frame_ = static_cast<int>(solver_.nodes().size()) - 1;
  if (remove_worst_loop(Suspects::Some, budget))
    solver_.start(frames_.graph(), GraphSolver::Plan::Gradually, config_.scaling);
}

/// Loops that may be wrong: those that the rest has outvoted, and those that pull - of these only the one that pulls
/// hardest, unless all are asked for.
std::vector<std::size_t> LoopCloser::suspects(Suspects which) const {
  const PoseGraph& graph = frames_.graph();
  std::vector<std::size_t> suspects;
  std::optional<std::size_t> hardest;
  double most = kStrained;
  for (std::size_t k = 0; k < graph.edges.size(); ++k) {
    const GraphEdge& edge = graph.edges[k];
    if (!edge.loop || !edge.on || edge.to > covariance_frame_) continue;
    const TPose2D off = disagreement(graph, edge);
    const double strain = squared_sigmas(graph, edge);
    const bool outvoted = size_of(off) > kWrongDistance || std::abs(wrap_angle(off.phi)) > kWrongAngle;
    if (outvoted || (which == Suspects::All && strain > kStrained)) {
      suspects.push_back(k);
    } else if (strain > most) {
      most = strain;
      hardest = k;
    }
  }
  if (hardest) suspects.push_back(*hardest);
  return suspects;
}

/// Takes out for good the loop that disagrees most with all others; a single one may bend the whole graph until it
/// seems to agree, and others to disagree. One at a time, each followed by a new solution, therefore.
bool LoopCloser::remove_worst_loop(Suspects which, Work& budget) {
  budget -= kWorkPerSuspected * static_cast<Work>(frames_.graph().edges.size());
  std::optional<std::size_t> worst;
  double most = 1.0;
  for (const std::size_t k : suspects(which)) {
    Work used = 0;
    const Eigen::Vector3d off = solver_.disagreement_without(frames_.graph().edges[k], &used);
    budget -= used;
    const double wrong = std::max(length(off[0], off[1]) / kWrongDistance, std::abs(off[2]) / kWrongAngle);
    if (wrong <= most) continue;
    most = wrong;
    worst = k;
  }
  if (!worst) return false;
  frames_.switch_off(*worst);
  ++counts_.removed;
  const GraphEdge& loop = frames_.graph().edges[*worst];
  for (LoopRecord& record : records_)
    if (record.stamp == frames_[loop.to].stamp && record.old_stamp == frames_[loop.from].stamp &&
        record.end == LoopRecord::End::Closed)
      record.end = LoopRecord::End::Removed;
  return true;
}

void LoopCloser::run_queue() {
  Work budget = std::numeric_limits<Work>::max();
  work(budget);
}

void LoopCloser::finish() {
  run_queue();
  if (frames_.size() < 2) return;
  const auto solve_all = [this](GraphSolver::Plan plan) {
    fresh_.clear();
    solver_.start(frames_.graph(), plan, config_.scaling);
    run_queue();
  };
  solve_all(GraphSolver::Plan::Gradually);
  for (int i = 0; i < frames_.size(); ++i) {
    std::vector<std::pair<double, int>> close;
    for (const Candidate& old : candidates_within(i, i - 6, kLastNear, kLastNearPath, nullptr)) {
      if (frames_[i].path - frames_[old.frame].path <= config_.least_path || linked_.count({i, old.frame}) != 0)
        continue;
      if (old.path < kLastNearPath) close.push_back({old.away, old.frame});
    }
    std::sort(close.begin(), close.end());
    int last = -100;
    int tried = 0;
    for (const auto& [away, j] : close) {
      if (tried == 2) break;
      if (std::abs(j - last) < 6) continue;
      last = j;
      ++tried;
      closed_for_ = -1;
      tasks_.push_back({Kind::Near, i, j, 0.15, 0.04, 0.0});
      run_queue();
    }
  }
  solve_all(GraphSolver::Plan::Gradually);
  solve_all(GraphSolver::Plan::Final);
  Work unlimited = std::numeric_limits<Work>::max();
  for (int round = 0; round < kMostRemovals && remove_worst_loop(Suspects::All, unlimited); ++round)
    solve_all(GraphSolver::Plan::Final);
}

}  // namespace rubble::slam
