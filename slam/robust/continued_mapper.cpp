#include "slam/robust/continued_mapper.h"

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "base/error.h"
#include "base/planar.h"
#include "slam/robust/graph/wall_compass.h"
#include "slam/robust/tracking/scan_diary.h"

namespace rubble::slam {

using mrpt::math::TPose2D;
using mrpt::math::TPose3D;

namespace {

constexpr double kMatchedPath = 1.5;  ///< of a drive that is looked for, in paths of the local map
constexpr double kLeastApart = 1.0;   ///< a map is looked for in another one at most each so much of its way [m] ...
constexpr double kMostApart = 3.0;    ///< ... and at least [m]: what is matched each time goes back farther ...
constexpr double kLooks = 30.0;       ///< ... so that a short way has about so many looks
constexpr Work kFinishWork = 20'000'000'000;  ///< of looking for the place once more when a drive is over
constexpr double kAroundPlace = 6.0;   ///< from a place that is believed, all key frames so far along the way [m]
constexpr double kAnywhere = 1e3;      ///< sigma of a robot that may be anywhere [m]
constexpr double kHeldDistance = 0.5;  ///< what holds the first key frame of a drive to the map, beside its ties [m]
constexpr double kHeldAngle = 0.5;     ///< [rad]
constexpr double kSameMount = 5e-3;    ///< [m, rad]: a mount told by poses of few digits, or measured anew
constexpr float kOffInliers = 0.40F;   ///< below, a scan does not show what the map does ...
constexpr float kOffContradiction = 0.30F;  ///< ... nor from here on
constexpr float kLeastHits = 15.0F;         ///< a scan with fewer shows nothing at all
constexpr double kOffTime = 1.15;      ///< off for so much longer than twice the time it was not: carried off [s] ...
constexpr double kMostScanTime = 0.1;  ///< ... where no scan stands for more: twelve at least, if stamps scatter [s]
constexpr double kAgreeing = 2.0;      ///< what a scan that agrees takes off that time, in parts of its own
// Maps of two arenas that were laid on each other contradict: of some 1,750 key frames 8 to 461, those of one arena 0.
// A right map alone has up to 0.0013 of its own (robust_mapper.cpp).
constexpr std::size_t kMostDoubled = 3;     ///< key frames that doing so may add ...
constexpr double kMostDoubledShare = 2e-3;  ///< ... or such a share of the second map's

bool same_mount(const TPose3D& a, const TPose3D& b) {
  return std::abs(a.x - b.x) < kSameMount && std::abs(a.y - b.y) < kSameMount && std::abs(a.z - b.z) < kSameMount &&
         std::abs(wrap_angle(a.yaw - b.yaw)) < kSameMount && std::abs(wrap_angle(a.pitch - b.pitch)) < kSameMount &&
         std::abs(wrap_angle(a.roll - b.roll)) < kSameMount;
}

std::size_t doubled_in(KeyFrames frames, const RobustConfig& config) {
  return LoopCloser(config.loop, config.tracker.cell, frames).doubled().size();
}

SavedMap loaded(const MapBase& base, const robot::RobotModel& model) {
  SavedMap map = decode_map(base.bytes, base.name);
  if (!same_mount(map.T_base_laser, model.T_base_laser))
    throw InputError(base.name + ": was made with the laser mounted at " + map.T_base_laser.asString() +
                     ", but this robot's is at " + model.T_base_laser.asString() +
                     " (x y z yaw pitch roll); map with the same robot");
  return map;
}

/// A map that the mapper would cut is refused before memory is taken for it: of a damaged one little would be left.
void require_room(const SavedMap& saved, const RobustConfig& config, const std::string& name) {
  TPose2D low, high;  // the map begins around the origin
  for (const SavedScan& scan : saved.scans) {
    const TPose2D T_map_base = saved.frames.pose(scan.frame) + scan.T_frame_base;
    low.x = std::min(low.x, T_map_base.x), high.x = std::max(high.x, T_map_base.x);
    low.y = std::min(low.y, T_map_base.y), high.y = std::max(high.y, T_map_base.y);
  }
  const double wide = std::max(high.x - low.x, high.y - low.y);
  const double room = config.max_map_cells * config.resolution;
  if (wide > room)
    throw InputError(name + ": its scans lie " + std::to_string(std::llround(wide)) + " m apart, but the map may be " +
                     std::to_string(std::llround(room)) +
                     " m wide; raise mapper.resolution_m or mapper.max_map_cells, or map the log again");
}

StampedMap stamped(const SavedMap& saved, const robot::RobotModel& model, const RobustConfig& config,
                   const std::string& name) {
  require_room(saved, config, name);
  StampedMap map(CountMap(config.map_cells, config.map_cells, config.resolution, config.max_map_cells),
                 model.T_base_laser, stamping(config));
  for (const SavedScan& scan : saved.scans) map.add(saved.frames, scan.frame, scan.T_frame_base, scan.scan, nullptr);
  map.lay_raster(saved.frames);
  return map;
}

/// Who sees far sees thinly: more of the drive makes up for it.
PlaceConfig place_config(const RobustConfig& config) {
  PlaceConfig places;
  places.path = kMatchedPath * config.tracker.path;
  return places;
}

GraphEdge shifted(GraphEdge edge, int by) {
  edge.from += by;
  edge.to += by;
  return edge;
}

/// Key frames along the way, evenly: to look from each of thousands takes minutes, and says little more.
std::vector<int> spread(const KeyFrames& frames) {
  std::vector<int> some;
  if (frames.empty()) return some;
  const double apart = std::clamp((frames[frames.last()].path - frames[0].path) / kLooks, kLeastApart, kMostApart);
  for (int i = 0; i < frames.size(); ++i)
    if (some.empty() || frames[i].path - frames[some.back()].path >= apart || i == frames.last()) some.push_back(i);
  return some;
}

/// All key frames along the way around some.
std::vector<int> around(const KeyFrames& frames, const std::vector<int>& some) {
  std::vector<int> close;
  for (int i = 0; i < frames.size(); ++i)
    if (std::any_of(some.begin(), some.end(),
                    [&](int k) { return std::abs(frames[i].path - frames[k].path) <= kAroundPlace; }))
      close.push_back(i);
  return close;
}

/// Where `drive` lies in the map of the finder; nothing when no places agree or `budget` is used up. First it is looked
/// for from a few of its key frames, then from all of those near a place.
std::optional<FoundPlace> find_in(PlaceFinder& finder, const KeyFrames& drive, Work budget,
                                  const MergeProgress& progress = {}) {
  std::vector<int> asked = spread(drive), placed;
  for (const char* const what : {"looks for a place that both show", "looks closer where one may be"}) {
    finder.begin();
    for (std::size_t k = 0; k < asked.size() && !finder.found() && budget > 0; ++k) {
      if (progress) progress(what, static_cast<double>(k) / static_cast<double>(asked.size()));
      const std::uint64_t believed = finder.counts().believed;
      finder.look(asked[k]);
      finder.work(drive, budget);
      if (finder.counts().believed > believed) placed.push_back(asked[k]);
    }
    if (finder.found()) break;
    asked = around(drive, placed);
  }
  return finder.found();
}

}  // namespace

KeyFrames joined(const KeyFrames& map, const KeyFrames& drive, const FoundPlace& place, double apart) {
  KeyFrames all = map;
  const int shift = map.size();
  double path = 0.0;
  for (int i = 0; i < map.size(); ++i) path = std::max(path, map[i].path);
  const auto moved = [&](int i) {
    KeyFrame frame = drive[i];
    frame.path += path + apart;
    return frame;
  };
  const GraphEdge& tie = place.ties.front();
  GraphEdge hold;
  hold.from = tie.from;
  hold.to = shift;
  const TPose2D T_map_first = place.T_map_drive + drive.pose(0);
  hold.T_from_to = T_map_first - map.pose(tie.from);
  hold.information = Eigen::Vector3d(1.0 / (kHeldDistance * kHeldDistance), 1.0 / (kHeldDistance * kHeldDistance),
                                     1.0 / (kHeldAngle * kHeldAngle))
                         .asDiagonal();
  all.add_start(moved(0), T_map_first, hold);
  for (const GraphEdge& edge : drive.graph().edges) {
    if (edge.loop) {
      all.add_loop(shifted(edge, shift));
      if (!edge.on) all.switch_off(all.graph().edges.size() - 1);
    } else if (drive.before(edge.to) < 0) {
      all.add_start(moved(edge.to), place.T_map_drive + drive.pose(edge.to), shifted(edge, shift));
    } else {
      all.add(moved(edge.to), place.T_map_drive + drive.pose(edge.to), shifted(edge, shift));
    }
  }
  for (GraphEdge edge : place.ties) {
    edge.to += shift;
    all.add_loop(edge);
  }
  return all;
}

namespace {

/// Two drives as one graph, their loops closed.
struct Agreement {
  KeyFrames frames;
  Eigen::Matrix3d covariance = Eigen::Matrix3d::Zero();  ///< of the newest key frame
};

/// Nothing when walls of one stand where the other looked through.
std::optional<Agreement> agreed(const KeyFrames& map, const KeyFrames& drive, const FoundPlace& place,
                                const RobustConfig& config, const MergeProgress& progress = {}) {
  if (progress) progress("joins both", 0.0);
  Agreement both{joined(map, drive, place, config.loop.least_path)};
  if (config.loops) {
    if (config.wall_compass) {
      WallCompass compass;
      compass.set_right(both.frames.graph());
      if (compass.direction()) both.frames.set_walls(*compass.direction(), compass.variance());
    }
    LoopCloser closer(config.loop, config.tracker.cell, both.frames);
    closer.begin_anew(std::nullopt);
    closer.finish();
    both.covariance = closer.covariance();
  }
  if (progress) progress("asks whether they contradict each other", 0.0);
  const std::size_t alone = doubled_in(map, config) + doubled_in(drive, config);
  const auto share = static_cast<std::size_t>(kMostDoubledShare * static_cast<double>(drive.size()));
  if (doubled_in(both.frames, config) > alone + std::max(kMostDoubled, share)) return std::nullopt;
  return both;
}

}  // namespace

MergedMap merged(const SavedMap& first, const SavedMap& second, const RobustConfig& config,
                 const MergeProgress& progress) {
  if (!same_mount(first.T_base_laser, second.T_base_laser)) return {MergeEnd::OtherMount, std::nullopt};
  PlaceFinder finder(first.frames, place_config(config), config.tracker.cell);
  const std::optional<FoundPlace> place = find_in(finder, second.frames, std::numeric_limits<Work>::max(), progress);
  if (!place) return {MergeEnd::NoPlace, std::nullopt};
  std::optional<Agreement> agreement = agreed(first.frames, second.frames, *place, config, progress);
  if (!agreement) return {MergeEnd::SeenThrough, std::nullopt};
  SavedMap both = second;
  both.frames = std::move(agreement->frames);
  both.frame_covariance = agreement->covariance;
  const int shift = first.frames.size();
  both.scans = first.scans;
  for (SavedScan scan : second.scans) {
    scan.frame += shift;
    both.scans.push_back(std::move(scan));
  }
  both.here += shift;
  both.path += both.frames[shift].path - second.frames[0].path;
  return {MergeEnd::Whole, std::move(both)};
}

ContinuedMapper::ContinuedMapper(const robot::RobotModel& model, const RobustConfig& config,
                                 std::shared_ptr<const MapBase> base)
    : model_(model),
      config_(suited_to(model.laser, config)),
      base_(std::move(base)),
      saved_(loaded(*base_, model)),
      map_(stamped(saved_, model, config_, base_->name)),
      finder_(saved_.frames, place_config(config_), config_.tracker.cell) {
  drive_ = std::make_unique<RobustMapper>(model_, config_, 0);
  records_.columns = drive_->scan_records()->columns;
  records_.columns.emplace_back(MapperFigure::kPlaceKnown);
  if (base_->start)
    finder_.begin_near(*base_->start, true);
  else if (base_->grows)
    finder_.begin_near(saved_.end(), false);
  else
    finder_.begin();
}

void ContinuedMapper::update(const robot::Inputs& inputs) {
  drive_->update(inputs);
  const KeyFrames& frames = drive_->key_frames();
  if (!joined_ && !frames.empty()) {
    if (frames.last() > looked_at_) finder_.look(frames.last());
    looked_at_ = frames.last();
    Work budget = inputs.scans.empty() ? 0 : static_cast<Work>(config_.budget_ms * 1e6);
    finder_.work(frames, budget);
    if (finder_.found()) join(*finder_.found());
  }
  take_news();
  if (joined_ && !base_->grows && off_time_ >= kOffTime) lose();
}

/// Takes over what the drive's last scans brought.
void ContinuedMapper::take_news() {
  const ScanRecords& news = *drive_->scan_records();
  const std::size_t columns = news.columns.size();
  for (; recorded_ < news.stamps.size(); ++recorded_) {
    const float* row = news.values.data() + recorded_ * columns;
    const Stamp stamp = news.stamps[recorded_];
    const double time = records_.stamps.empty() ? kMostScanTime : stamp - records_.stamps.back();
    records_.stamps.push_back(stamp);
    records_.values.insert(records_.values.end(), row, row + columns);
    records_.values.push_back(joined_ ? 1.0F : 0.0F);
    if (!joined_) continue;
    live_.push_back(drive_->live_trajectory()[recorded_]);
    if (row[kBeamsColumn] - row[kRejectedColumn] < kLeastHits) continue;
    const bool off = row[kInliersColumn] < kOffInliers || row[kContradictionColumn] > kOffContradiction;
    const double counts = std::clamp(time, 0.0, kMostScanTime);
    off_time_ = off ? off_time_ + counts : std::max(0.0, off_time_ - kAgreeing * counts);
    if (off_time_ == 0.0) agreed_ = stamp;
  }
  const MapperCounts& now = drive_->counts();
  counts_ = {ended_.scans + now.scans, ended_.mapped + now.mapped, ended_.out_of_order + now.out_of_order};
}

void ContinuedMapper::join(const FoundPlace& place) {
  take_news();  // what was seen before the place was known
  if (base_->grows)
    drive_->go_on_in(joined(saved_.frames, drive_->key_frames(), place, config_.loop.least_path), std::move(map_),
                     place.T_map_drive, true);
  else
    drive_->go_on_in(saved_.frames, map_, place.T_map_drive, false);
  joined_ = true;
  off_time_ = 0.0;
  ++joins_;
  ++revision_;
}

/// The robot is not where the drive thinks: what it did since its scans last agreed is forgotten, and a new drive
/// begins.
void ContinuedMapper::lose() {
  for (const StampedPose& pose : drive_->trajectory())
    if (pose.stamp <= agreed_) before_.push_back(pose);
  last_known_ = before_.empty() ? saved_.end() : before_.back().pose;
  const MapperCounts& now = drive_->counts();
  ended_ = {ended_.scans + now.scans, ended_.mapped + now.mapped, ended_.out_of_order + now.out_of_order};
  revision_ += drive_->revision() + 1;
  drive_ = std::make_unique<RobustMapper>(model_, config_, 0);
  joined_ = false;
  looked_at_ = -1;
  recorded_ = 0;
  ++carried_off_;
  finder_.begin();
}

void ContinuedMapper::finish() {
  const KeyFrames& frames = drive_->key_frames();
  if (!joined_ && !frames.empty()) {
    Work unlimited = std::numeric_limits<Work>::max();
    finder_.work(frames, unlimited);
    std::optional<FoundPlace> place = finder_.found();
    if (!place) {
      // A map as large as a building takes longer to search than the robot stays where both know the ground.
      place = find_in(finder_, frames, kFinishWork);
      if (place && !agreed(saved_.frames, frames, *place, config_)) place.reset();
    }
    if (place) join(*place);
  }
  if (joined_) return drive_->finish();
  if (config_.drop_gone) map_.drop_gone();
  if (config_.thin_walls) map_.thin();
}

const CountMap& ContinuedMapper::map() const { return joined_ ? drive_->map() : map_.map(); }

TPose2D ContinuedMapper::pose() const {
  if (joined_) return drive_->pose();
  return last_known_.value_or(base_->start.value_or(saved_.end()));
}

PoseCovariance ContinuedMapper::covariance() const {
  if (joined_) return drive_->covariance();
  const Eigen::Matrix3d anywhere =
      Eigen::Vector3d(kAnywhere * kAnywhere, kAnywhere * kAnywhere, kPi * kPi).asDiagonal();
  return PoseCovariance(anywhere);
}

std::uint64_t ContinuedMapper::revision() const { return revision_ + (joined_ ? drive_->revision() : 0); }

std::optional<TPose2D> ContinuedMapper::pose_at(Stamp stamp) const {
  if (const auto pose = rubble::pose_at(trajectory(), stamp)) return pose;
  return joined_ ? drive_->pose_at(stamp) : std::nullopt;
}

const Trajectory& ContinuedMapper::trajectory() const {
  if (!joined_) return before_;
  const Trajectory& drive = drive_->trajectory();
  if (before_.empty()) return drive;
  if (all_revision_ != revision()) all_ = before_;
  all_revision_ = revision();
  for (std::size_t k = all_.size() - before_.size(); k < drive.size(); ++k) all_.push_back(drive[k]);
  return all_;
}

const std::vector<mrpt::math::TPoint2D>& ContinuedMapper::last_hits() const {
  static const std::vector<mrpt::math::TPoint2D> none;
  return joined_ ? drive_->last_hits() : none;
}

std::vector<MapperFigure> ContinuedMapper::figures() const {
  std::vector<MapperFigure> figures = drive_->figures();
  const PlaceCounts& places = finder_.counts();
  figures.push_back({MapperFigure::kPlaceKnown, joined_ ? 1.0 : 0.0});
  figures.push_back({"places_found", static_cast<double>(joins_)});
  figures.push_back({"carried_off", static_cast<double>(carried_off_)});
  figures.push_back({"places_searched", static_cast<double>(places.searched)});
  figures.push_back({"places_nowhere", static_cast<double>(places.nowhere)});
  figures.push_back({"places_ambiguous", static_cast<double>(places.ambiguous)});
  figures.push_back({"places_contradicted", static_cast<double>(places.contradicted)});
  figures.push_back({"places_believed", static_cast<double>(places.believed)});
  return figures;
}

std::string ContinuedMapper::saved_map() const { return joined_ && base_->grows ? drive_->saved_map() : base_->bytes; }

}  // namespace rubble::slam
