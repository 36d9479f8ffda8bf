#include <utility>

#include "base/bytes.h"
#include "base/error.h"
#include "robot/logs/foreign/carmen.h"
#include "robot/logs/foreign/coreslam.h"
#include "robot/logs/foreign/file_bytes.h"
#include "robot/logs/foreign/mrpt_bridge.h"
#include "robot/logs/log.h"
#include "robot/logs/own/log_codec.h"
#include "robot/logs/own/log_frames.h"

namespace rubble::robot {
namespace {

FrameKind kind_of(std::string_view payload) { return static_cast<FrameKind>(payload.empty() ? '\0' : payload.front()); }

/// Our own log, decoded as it is played.
class OwnLog {
 public:
  OwnLog(std::string bytes, const std::string& path)
      : path_(path), bytes_(std::move(bytes)), frames_(split_frames(bytes_, path)) {
    if (frames_.payloads.empty())
      throw InputError(path + ": the log ends at byte " + std::to_string(bytes_.size()) +
                       " before its header is complete; the run died at its start, record it again");
    if (kind_of(frames_.payloads.front()) != FrameKind::Header) fail(0, "the header is missing");
    decode(0, [&] { header_ = decode_header(frames_.payloads[0]); });
    next_ = 1;
    take_commands();
  }

  std::optional<Inputs> read() {
    if (next_ == frames_.payloads.size()) return std::nullopt;
    Inputs inputs;
    decode(next_, [&] { inputs = decode_tick(frames_.payloads[next_], context_); });
    inputs.command = commands_;  // the answers to the ticks before
    hand_out_codes(inputs);
    inputs.battery = std::exchange(battery_, std::nullopt);
    ++next_;
    take_commands();
    return inputs;
  }

  const LogHeader& header() const { return header_; }
  const Commands& commands() const { return commands_; }
  bool torn() const { return frames_.torn; }
  double progress() const {
    return static_cast<double>(frames_.ends[next_ - 1]) / static_cast<double>(frames_.ends.back());
  }

 private:
  // Between two ticks stand the commands that answer the first, then the codes of the second's scans.
  void take_commands() {
    for (; next_ < frames_.payloads.size() && kind_of(frames_.payloads[next_]) != FrameKind::Tick; ++next_) {
      if (kind_of(frames_.payloads[next_]) == FrameKind::Commands)
        decode(next_, [&] { commands_ = decode_commands(frames_.payloads[next_]); });
      if (kind_of(frames_.payloads[next_]) == FrameKind::Codes)
        decode(next_, [&] { codes_ = decode_codes(frames_.payloads[next_]); });
      if (kind_of(frames_.payloads[next_]) == FrameKind::Battery)
        decode(next_, [&] { battery_ = decode_battery(frames_.payloads[next_]); });
    }
  }

  void hand_out_codes(Inputs& inputs) {
    if (!codes_.empty() && codes_.size() != inputs.scans.size()) fail(next_, "the codes before it are of other scans");
    for (std::size_t i = 0; i < codes_.size(); ++i) {
      if (!codes_[i].empty() && codes_[i].size() != inputs.scans[i].ranges.size())
        fail(next_, "a scan's codes are not as many as its beams");
      inputs.scans[i].codes = std::move(codes_[i]);
    }
    codes_.clear();
  }

  template <class Decode>
  void decode(std::size_t frame, Decode&& work) const {
    try {
      work();
    } catch (const BadPayload& e) {
      fail(frame, e.what());
    }
  }

  [[noreturn]] void fail(std::size_t frame, const std::string& what) const {
    const std::size_t start = frame == 0 ? kLogMagic.size() : frames_.ends[frame - 1];
    throw InputError(path_ + ": byte " + std::to_string(start) + ": the frame cannot be understood (" + what +
                     "); copy the log again, or replay it with the release that recorded it");
  }

  std::string path_;
  std::string bytes_;
  Frames frames_;  // views into bytes_
  LogHeader header_;
  std::size_t next_ = 0;
  TickContext context_;
  Commands commands_;
  std::vector<std::vector<std::uint8_t>> codes_;  ///< of the scans of the next tick
  std::optional<BatteryState> battery_;           ///< of the next tick
};

ForeignLog read_foreign(const std::string& bytes, const std::string& path) {
  if (is_rawlog(bytes)) return read_rawlog_bytes(bytes, path);
  if (is_coreslam(bytes)) return read_coreslam(bytes, path);
  if (is_carmen(bytes)) return read_carmen(bytes, path);
  throw InputError(path + ": byte 0: not a log of a known format; give a log recorded by rubble, an MRPT .rawlog, " +
                   "a CARMEN .log (.gz, .bz2), or a CoreSLAM .dat");
}

}  // namespace

struct ReplayRobot::Impl {
  std::string format;
  RobotModel model;
  std::string note;
  Commands no_commands;
  std::unique_ptr<OwnLog> own;
  ForeignLog foreign;
  std::size_t next_tick = 0;
};

ReplayRobot::ReplayRobot(const std::string& path) : impl_(std::make_unique<Impl>()) {
  std::string bytes = unpacked(read_file(path), path);
  if (std::string_view(bytes).substr(0, kLogMagicStem.size()) == kLogMagicStem) {
    impl_->own = std::make_unique<OwnLog>(std::move(bytes), path);
    impl_->format = "rubble log";
    impl_->model = impl_->own->header().model;
    impl_->note = impl_->own->header().note;
    return;
  }
  impl_->foreign = read_foreign(bytes, path);
  impl_->format = impl_->foreign.format;
  impl_->model = impl_->foreign.model;
}

ReplayRobot::~ReplayRobot() = default;

const RobotModel& ReplayRobot::model() const { return impl_->model; }

std::optional<Inputs> ReplayRobot::read() {
  if (impl_->own) return impl_->own->read();
  if (impl_->next_tick == impl_->foreign.ticks.size()) return std::nullopt;
  return impl_->foreign.ticks[impl_->next_tick++];
}

void ReplayRobot::command(const Commands&) {}

const std::string& ReplayRobot::format() const { return impl_->format; }
const std::string& ReplayRobot::note() const { return impl_->note; }
const Commands& ReplayRobot::recorded_commands() const {
  return impl_->own ? impl_->own->commands() : impl_->no_commands;
}
const Trajectory& ReplayRobot::reference() const { return impl_->foreign.reference; }
Trajectory ReplayRobot::in_own_stamps(const Trajectory& trajectory) const {
  const std::vector<OwnStamp>& names = impl_->foreign.own_stamps;
  Trajectory renamed = trajectory;
  for (StampedPose& stamped : renamed) {
    const auto name = std::lower_bound(names.begin(), names.end(), stamped.stamp,
                                       [](const OwnStamp& n, Stamp s) { return n.delivered < s; });
    if (name != names.end() && name->delivered == stamped.stamp) stamped.stamp = name->in_log;
  }
  const auto earlier = [](const StampedPose& a, const StampedPose& b) { return a.stamp < b.stamp; };
  const auto same = [](const StampedPose& a, const StampedPose& b) { return a.stamp == b.stamp; };
  std::stable_sort(renamed.begin(), renamed.end(), earlier);
  // Stamps of few digits tell no two scans apart: such a log's own names are of no use.
  constexpr std::size_t kMostLost = 100;  // one in so many
  const auto end = std::unique(renamed.begin(), renamed.end(), same);
  if (static_cast<std::size_t>(renamed.end() - end) > trajectory.size() / kMostLost) return trajectory;
  renamed.erase(end, renamed.end());
  return renamed;
}

bool ReplayRobot::was_torn() const { return impl_->own && impl_->own->torn(); }

double ReplayRobot::progress() const {
  if (impl_->own) return impl_->own->progress();
  const std::size_t ticks = impl_->foreign.ticks.size();
  return ticks == 0 ? 1.0 : static_cast<double>(impl_->next_tick) / static_cast<double>(ticks);
}

}  // namespace rubble::robot
