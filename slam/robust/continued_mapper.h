#pragma once

#include <memory>
#include <optional>

#include "slam/map_base.h"
#include "slam/robust/graph/place_finder.h"
#include "slam/robust/map/saved_map.h"
#include "slam/robust/robust_mapper.h"

namespace rubble::slam {

/// The key frames of a map followed by those of a drive that lies in it, with all edges; the drive's path goes on
/// `apart` behind the map's [m].
KeyFrames joined(const KeyFrames& map, const KeyFrames& drive, const FoundPlace& place, double apart);

/// The maps of two robots, or of two runs, as one in the frame of the first, with a graph that holds both; the robot is
/// where it was at the end of the second.
struct MergedMap {
  MergeEnd end;
  std::optional<SavedMap> map;  ///< of MergeEnd::Whole
};

/// `config` as suited_to() gives it.
MergedMap merged(const SavedMap& first, const SavedMap& second, const RobustConfig& config,
                 const MergeProgress& progress = {});

/// The robust mapper on a map of an earlier run. A drive begins as one of its own, in its own frame, until it is known
/// where it lies in the map; then it goes on there, from its first scan. Where the map grows, its key frames join those
/// of the map, and one graph holds both. Where it does not, the robot is followed on the key frames that are there, and
/// once it does not find what they saw (it was carried off), a new drive begins.
///
/// The map's frame is that of the earlier run. While the place is not known, pose() and map() show the end of that run,
/// covariance() a robot that may be anywhere, and the trajectories wait.
class ContinuedMapper : public Mapper {
 public:
  /// Throws InputError for a map that is damaged, or made with another mount of the laser.
  ContinuedMapper(const robot::RobotModel& model, const RobustConfig& config, std::shared_ptr<const MapBase> base);

  void update(const robot::Inputs& inputs) override;
  void finish() override;
  const CountMap& map() const override;
  mrpt::math::TPose2D pose() const override;
  PoseCovariance covariance() const override;
  std::uint64_t revision() const override;
  bool settled() const override { return !joined_ || drive_->settled(); }
  std::optional<mrpt::math::TPose2D> pose_at(Stamp stamp) const override;
  const Trajectory& trajectory() const override;
  const Trajectory& live_trajectory() const override { return live_; }
  const std::vector<mrpt::math::TPoint2D>& last_hits() const override;
  double blind_way() const override { return drive_->blind_way(); }
  const MapperCounts& counts() const override { return counts_; }
  std::vector<MapperFigure> figures() const override;
  const ScanRecords* scan_records() const override { return &records_; }
  std::string loop_table(const StampName& name) const override { return drive_->loop_table(name); }
  /// None while the place is not known: where they lie in the map is not known either.
  std::vector<FoundLoop> found_loops() const override {
    return joined_ ? drive_->found_loops() : std::vector<FoundLoop>();
  }
  std::string saved_map() const override;

 private:
  void join(const FoundPlace& place);
  void lose();
  void take_news();

  const robot::RobotModel model_;
  const RobustConfig config_;
  const std::shared_ptr<const MapBase> base_;
  const SavedMap saved_;
  StampedMap map_;  ///< of saved_; moves on into the drive that joins it and lets it grow
  PlaceFinder finder_;
  std::unique_ptr<RobustMapper> drive_;
  int looked_at_ = -1;  ///< newest key frame of the drive that the finder was told of
  bool joined_ = false;
  double off_time_ = 0.0;          ///< for which scans did not show what the map does, less that for which they did [s]
  Stamp agreed_ = Stamp::never();  ///< the last scan while none was off
  std::optional<mrpt::math::TPose2D> last_known_;
  Trajectory before_;       ///< of drives that ended
  Trajectory live_;         ///< once the place was known
  mutable Trajectory all_;  ///< both
  mutable std::uint64_t all_revision_ = ~std::uint64_t{0};
  std::uint64_t revision_ = 0;  ///< of joins and drives that ended
  MapperCounts counts_;
  MapperCounts ended_;  ///< of drives that ended
  ScanRecords records_;
  std::size_t recorded_ = 0;  ///< of the drive's
  std::uint64_t joins_ = 0;
  std::uint64_t carried_off_ = 0;
};

}  // namespace rubble::slam
