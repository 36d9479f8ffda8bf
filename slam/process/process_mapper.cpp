#include "slam/process/process_mapper.h"

#include <algorithm>
#include <cmath>
#include <fstream>

#include "base/planar.h"
#include "base/text/number_text.h"
#include "base/text/words.h"
#include "base/yaml/binder.h"
#include "slam/process/request.h"

namespace rubble::slam {
namespace {

using mrpt::math::TPose2D;

constexpr int kFirstCells = 2;               ///< of the map before the first one has come
constexpr double kResolution = 0.05;         ///< of that map [m]
constexpr double kRemembered = 10.0;         ///< so long poses of ticks are kept [s]
constexpr std::streamoff kLastWords = 4096;  ///< the end of the log that is looked at [bytes]
constexpr std::size_t kQuoted = 400;         ///< of its last line: a path, a cause and a remedy [bytes]

/// The last line of a log that says anything: of a Python program, what was wrong.
std::string last_words(const std::string& log) {
  std::ifstream in(log, std::ios::binary | std::ios::ate);
  if (!in) return "";
  const auto size = in.tellg();
  in.seekg(std::max<std::streamoff>(0, std::streamoff(size) - kLastWords));
  std::string line, last;
  while (std::getline(in, line))
    if (line.find_first_not_of(" \t\r") != std::string::npos) last = line;
  return last.empty() ? "" : ", its last words: " + in_quotes(last, kQuoted);
}

}  // namespace

ProcessMapper::ProcessMapper(const robot::RobotModel& model, const MapperProcess& process, std::uint64_t seed)
    : model_(model),
      process_(process),
      seed_(seed),
      map_(kFirstCells, kFirstCells, kResolution),
      level_scan_(model.T_base_laser, {}) {}

ProcessMapper::~ProcessMapper() = default;

void ProcessMapper::start() {
  child_ = std::make_unique<ChildProcess>(process_.argv, process_.log);
  reader_ = std::make_unique<MessageReader>(*child_);
  std::string text;
  append_header(text, {model_, seed_, process_.parameters});
  child_->give_time(process_.timeout);
  child_->send(text);
  read_ready(*reader_);
}

void ProcessMapper::exchange(const std::string& request) {
  try {
    if (!child_) start();
    child_->give_time(process_.timeout);
    child_->send(request);
    take(read_answer(*reader_));
  } catch (const ChildProcess::Lost& lost) {
    lose(lost.what());
  } catch (const BadMessage& bad) {
    lose(std::string("answered nonsense: ") + bad.what() + " (its standard output is for answers only)");
  }
}

void ProcessMapper::lose(const std::string& why) {
  over_ = true;
  child_.reset();
  std::string where = now_ == Stamp::never() ? "" : " at " + number_text(std::round(1e3 * now_.seconds()) / 1e3) + " s";
  throw MapperLost("mapper " + in_quotes(process_.name, 120) + " " + why + where + last_words(process_.log) +
                   (process_.log.empty() ? "" : "; see " + process_.log));
}

void ProcessMapper::update(const robot::Inputs& inputs) {
  if (over_) return;
  receive(inputs);
  std::string request;
  append_tick(request, inputs);
  exchange(request);
  place_waiting(false);
  remember_hits();
}

void ProcessMapper::finish() {
  if (over_ || !child_) return;
  std::string request;
  append_finish(request);
  exchange(request);
  over_ = true;
  place_waiting(true);
  child_->give_time(process_.timeout);
  child_->close_input();
  child_.reset();
}

void ProcessMapper::receive(const robot::Inputs& inputs) {
  now_ = inputs.now;
  for (const robot::Odometry& odometry : inputs.odometry) {
    has_odometry_ = true;
    newest_ = std::max(newest_, odometry.stamp, [](Stamp a, Stamp b) { return a < b; });
  }
  for (const robot::LaserScan& scan : inputs.scans) {
    ++counts_.scans;
    const Stamp middle = scan.middle();
    if (scan.ranges.empty() || (last_scan_ && middle <= last_scan_->middle())) {
      ++counts_.out_of_order;
      continue;
    }
    last_scan_ = scan;
    waiting_.push_back(middle);
    if (!has_odometry_) newest_ = middle;
  }
}

void ProcessMapper::take(const MapperAnswer& answer) {
  if (answer.pose) pose_ = *answer.pose;
  if (answer.covariance) covariance_ = *answer.covariance;
  if (!answer.at.empty() && !tells_scans_) {
    tells_scans_ = true;
    trajectory_.clear();
    live_.clear();
  }
  for (const StampedPose& pose : answer.at) add_pose(pose);
  if (answer.corrected) {
    trajectory_ = *answer.corrected;
    ++revision_;
  }
  if (!tells_scans_ && newest_ != Stamp::never() && (poses_.empty() || poses_.back().stamp < newest_))
    poses_.push_back({newest_, pose_});
  if (answer.mapped) counts_.mapped = *answer.mapped;
  if (answer.settled) settled_ = *answer.settled;
  if (answer.blind_way) blind_way_ = *answer.blind_way;
  for (const MapperFigure& figure : answer.figures) {
    const std::string key = "mapper_" + figure.key;
    const auto known = std::find_if(figures_.begin(), figures_.end(), [&](const auto& f) { return f.key == key; });
    if (known != figures_.end()) {
      known->value = figure.value;
    } else {
      figures_.push_back({key, figure.value});
    }
  }
  if (answer.map) take_map(*answer.map);
}

void ProcessMapper::take_map(const AnsweredMap& map) {
  if (has_map_ && map.frame.resolution != map_.frame().resolution)
    throw BadMessage("the map's resolution changed within the run");
  has_map_ = true;
  map_.assign(map.frame, map.seen, map.occupied);
}

void ProcessMapper::add_pose(const StampedPose& pose) {
  if (!live_.empty() && pose.stamp <= live_.back().stamp) throw BadMessage("the stamps of 'at' do not rise");
  live_.push_back(pose);
  if (trajectory_.empty() || trajectory_.back().stamp < pose.stamp) trajectory_.push_back(pose);
}

/// Scans get their poses once those of the ticks reach over them; at the end the rest get the last one.
void ProcessMapper::place_waiting(bool last) {
  if (tells_scans_) waiting_.clear();
  while (!waiting_.empty() && !poses_.empty()) {
    const Stamp stamp = waiting_.front();
    if (stamp > poses_.back().stamp && !last) break;
    waiting_.pop_front();
    const TPose2D pose = stamp < poses_.front().stamp  ? poses_.front().pose
                         : stamp > poses_.back().stamp ? poses_.back().pose
                                                       : *rubble::pose_at(poses_, stamp);
    if (!live_.empty() && stamp <= live_.back().stamp) continue;
    live_.push_back({stamp, pose});
    if (trajectory_.empty() || trajectory_.back().stamp < stamp) trajectory_.push_back({stamp, pose});
  }
  const auto old = std::find_if(poses_.begin(), poses_.end(),
                                [&](const StampedPose& p) { return poses_.back().stamp - p.stamp < kRemembered; });
  if (old - poses_.begin() > 1000) poses_.erase(poses_.begin(), old);
}

void ProcessMapper::remember_hits() {
  last_hits_.clear();
  if (!last_scan_) return;
  const TPose2D T_map_base = pose_at(last_scan_->middle()).value_or(pose_);
  const PlanarTransform to_map(T_map_base);
  for (const auto& p_base : level_scan_.points(*last_scan_).hits) last_hits_.push_back(to_map(p_base));
}

std::optional<TPose2D> ProcessMapper::pose_at(Stamp stamp) const { return rubble::pose_at(trajectory_, stamp); }

namespace {

/// Keys of `mapper.kind: process`.
class ProcessParameters : public MapperParameters {
 public:
  void bind(Binder& binder) override {
    binder.text("command", command_);
    binder.number("timeout_s", timeout_, 0.01, 86400.0);
  }
  std::unique_ptr<Mapper> make(const robot::RobotModel& model, const MapperSetting& setting) const override {
    if (command_.find_first_not_of(" \t\n") == std::string::npos)
      throw InputError(
          "mapper.command: is missing; give the program to run, as in --mapper-command \"python3 my_slam.py\"");
    MapperProcess process;
    process.name = command_;
    process.argv = {"/bin/sh", "-c", command_};
    process.timeout = timeout_;
    if (!setting.run_folder.empty()) process.log = setting.run_folder + "/mapper.log";
    return std::make_unique<ProcessMapper>(model, process, setting.seed);
  }
  std::unique_ptr<MapperParameters> copy() const override { return std::make_unique<ProcessParameters>(*this); }
  std::string command() const override { return command_; }

 private:
  std::string command_;
  double timeout_ = 10.0;
};

}  // namespace

std::unique_ptr<MapperParameters> process_parameters() { return std::make_unique<ProcessParameters>(); }

std::string process_mapper_yaml(const std::string& command) {
  return "{kind: process, command: " + yaml_quoted(command) + "}";
}

}  // namespace rubble::slam
