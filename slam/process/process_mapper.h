#pragma once

#include <deque>
#include <memory>
#include <string>
#include <vector>

#include "robot/model.h"
#include "slam/mapper.h"
#include "slam/mappers.h"
#include "slam/process/answer.h"
#include "slam/process/child_process.h"
#include "slam/scan/level_scan.h"

namespace rubble::slam {

/// How a mapper's process is started.
struct MapperProcess {
  std::string name;               ///< for messages: the command, or the kind
  std::vector<std::string> argv;  ///< argv[0] is a path
  std::string log;                ///< takes its standard error; empty: goes where ours goes
  std::string parameters;         ///< lines of text for it
  double timeout = 10.0;          ///< for each answer, and for starting [s]
};

/// A mapper that is another process: it is told what the robot measured, tick by tick, and answers with a pose and,
/// when it changed, a map (docs/mapper_protocol.md). It starts with the first tick and ends with this object.
/// Deterministic when the process is. Whatever goes wrong with it is a MapperLost.
class ProcessMapper : public Mapper {
 public:
  ProcessMapper(const robot::RobotModel& model, const MapperProcess& process, std::uint64_t seed);
  ~ProcessMapper() override;

  void update(const robot::Inputs& inputs) override;
  void finish() override;

  const CountMap& map() const override { return map_; }
  mrpt::math::TPose2D pose() const override { return pose_; }
  PoseCovariance covariance() const override { return covariance_; }
  std::uint64_t revision() const override { return revision_; }
  std::optional<mrpt::math::TPose2D> pose_at(Stamp stamp) const override;
  const Trajectory& trajectory() const override { return trajectory_; }
  const Trajectory& live_trajectory() const override { return live_; }
  const std::vector<mrpt::math::TPoint2D>& last_hits() const override { return last_hits_; }
  bool settled() const override { return settled_; }
  double blind_way() const override { return blind_way_; }
  const MapperCounts& counts() const override { return counts_; }
  /// What the process says, with `mapper_` before each name.
  std::vector<MapperFigure> figures() const override { return figures_; }

 private:
  void start();
  void exchange(const std::string& request);
  void receive(const robot::Inputs& inputs);
  void take(const MapperAnswer& answer);
  void take_map(const AnsweredMap& map);
  void add_pose(const StampedPose& pose);
  void place_waiting(bool last);
  void remember_hits();
  [[noreturn]] void lose(const std::string& why);

  const robot::RobotModel model_;
  const MapperProcess process_;
  const std::uint64_t seed_;
  std::unique_ptr<ChildProcess> child_;
  std::unique_ptr<MessageReader> reader_;
  bool over_ = false;
  Stamp now_ = Stamp::never();

  CountMap map_;
  bool has_map_ = false;
  mrpt::math::TPose2D pose_;
  PoseCovariance covariance_;
  std::uint64_t revision_ = 0;
  bool settled_ = true;
  double blind_way_ = 0.0;
  Trajectory trajectory_;
  Trajectory live_;
  MapperCounts counts_;
  std::vector<MapperFigure> figures_;

  // A process that tells its pose but not where its scans were is helped: the poses of the ticks are interpolated.
  bool tells_scans_ = false;
  Trajectory poses_;               ///< at the newest odometry of each tick
  Stamp newest_ = Stamp::never();  ///< what pose_ is about
  bool has_odometry_ = false;
  std::deque<Stamp> waiting_;  ///< scans without a pose yet

  LevelScan level_scan_;
  std::optional<robot::LaserScan> last_scan_;
  std::vector<mrpt::math::TPoint2D> last_hits_;
};

/// `mapper.kind: process`.
std::unique_ptr<MapperParameters> process_parameters();

/// The configuration that runs `command`: overrides of a scenario, for the command line.
std::string process_mapper_yaml(const std::string& command);

}  // namespace rubble::slam
