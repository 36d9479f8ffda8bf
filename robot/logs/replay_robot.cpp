#include <array>
#include <cstdio>
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

/// Our own log: checked whole, then read again and decoded as it is played.
class OwnLog {
 public:
  OwnLog(std::unique_ptr<LogBytes> bytes, const std::string& path)
      : path_(path), bytes_(std::move(bytes)), reader_(*bytes_, path) {
    FrameReader check(*bytes_, path);
    while (check.next()) {
    }
    end_ = check.end();
    torn_ = check.torn();
    if (end_ == kLogMagic.size())
      throw InputError(path + ": the log ends at byte " + std::to_string(bytes_->size()) +
                       " before its header is complete; the run died at its start, record it again");
    advance();
    if (kind_of(*frame_) != FrameKind::Header) fail("the header is missing");
    decode([&] { header_ = decode_header(*frame_); });
    advance();
    take_commands();
  }

  std::optional<Inputs> read() {
    if (!frame_) return std::nullopt;
    Inputs inputs;
    decode([&] { inputs = decode_tick(*frame_, context_); });
    inputs.command = commands_;  // the answers to the ticks before
    hand_out_codes(inputs);
    inputs.battery = std::exchange(battery_, std::nullopt);
    advance();
    take_commands();
    return inputs;
  }

  const LogHeader& header() const { return header_; }
  const Commands& commands() const { return commands_; }
  bool torn() const { return torn_; }
  double progress() const { return static_cast<double>(frame_ ? reader_.begin() : end_) / static_cast<double>(end_); }

 private:
  void advance() {
    frame_.reset();
    if (reader_.end() == end_) return;
    frame_ = reader_.next();
    if (!frame_) throw InputError(path_ + ": was changed while it was read; copy the log and give the copy");
  }

  // Between two ticks stand the commands that answer the first, then the codes of the second's scans.
  void take_commands() {
    for (; frame_ && kind_of(*frame_) != FrameKind::Tick; advance()) {
      if (kind_of(*frame_) == FrameKind::Commands) decode([&] { commands_ = decode_commands(*frame_); });
      if (kind_of(*frame_) == FrameKind::Codes) decode([&] { codes_ = decode_codes(*frame_); });
      if (kind_of(*frame_) == FrameKind::Battery) decode([&] { battery_ = decode_battery(*frame_); });
    }
  }

  void hand_out_codes(Inputs& inputs) {
    if (!codes_.empty() && codes_.size() != inputs.scans.size()) fail("the codes before it are of other scans");
    for (std::size_t i = 0; i < codes_.size(); ++i) {
      if (!codes_[i].empty() && codes_[i].size() != inputs.scans[i].ranges.size())
        fail("a scan's codes are not as many as its beams");
      inputs.scans[i].codes = std::move(codes_[i]);
    }
    codes_.clear();
  }

  template <class Decode>
  void decode(Decode&& work) const {
    try {
      work();
    } catch (const BadPayload& e) {
      fail(e.what());
    }
  }

  [[noreturn]] void fail(const std::string& what) const {
    throw InputError(path_ + ": byte " + std::to_string(reader_.begin()) + ": the frame cannot be understood (" + what +
                     "); copy the log again, or replay it with the release that recorded it");
  }

  std::string path_;
  std::unique_ptr<LogBytes> bytes_;
  FrameReader reader_;
  std::optional<std::string_view> frame_;  ///< to be taken next, of reader_
  std::size_t end_ = 0;                    ///< of the whole frames
  bool torn_ = false;
  LogHeader header_;
  TickContext context_;
  Commands commands_;
  std::vector<std::vector<std::uint8_t>> codes_;  ///< of the scans of the next tick
  std::optional<BatteryState> battery_;           ///< of the next tick
};

bool is_own(std::string_view bytes) { return bytes.substr(0, kLogMagicStem.size()) == kLogMagicStem; }

/// Whether the file can be read piece by piece, and is a log of ours that is not packed.
bool is_own_file(const InputFile& file) {
  std::string start(kLogMagicStem.size(), '\0');
  return file.size() && *file.size() >= start.size() && file.read_at(0, start.data(), start.size()) == start.size() &&
         is_own(start);
}

ForeignLog read_foreign(const std::string& bytes, const std::string& path) {
  if (is_rawlog(bytes)) return read_rawlog_bytes(bytes, path);
  if (is_coreslam(bytes)) return read_coreslam(bytes, path);
  if (is_carmen(bytes)) return read_carmen(bytes, path);
  throw InputError(path + ": byte 0: not a log of a known format; give a log recorded by rubble, an MRPT .rawlog, " +
                   "a CARMEN .log (.gz, .bz2), or a CoreSLAM .dat");
}

/// Stamps of few digits tell no two scans apart: such a log's own names are of no use.
bool tell_scans_apart(const std::vector<OwnStamp>& names) {
  constexpr std::size_t kMostLost = 100;  // one in so many
  std::vector<Stamp> own;
  own.reserve(names.size());
  for (const OwnStamp& name : names) own.push_back(name.in_log);
  std::sort(own.begin(), own.end());
  const auto lost = own.end() - std::unique(own.begin(), own.end());
  return static_cast<std::size_t>(lost) <= names.size() / kMostLost;
}

/// Of a log whose scans come faster than any scanner scans, or a minute apart; nothing of others, nor of a clock that
/// stands, whose equal stamps sorted_stamps() set apart.
std::optional<std::string> odd_times(const ForeignLog& log, const std::string& path) {
  constexpr double kStandingClock = 2e-6;    // [s]
  constexpr double kShortestPeriod = 0.002;  // [s]
  constexpr double kLongestPeriod = 60.0;    // [s]
  const double period = log.model.laser.scan_period;
  if (log.ticks.size() < 3 || period < kStandingClock || (period >= kShortestPeriod && period <= kLongestPeriod))
    return std::nullopt;
  std::array<char, 80> apart{};
  std::snprintf(apart.data(), apart.size(), ": its scans are %.3g s apart (median): ", period);
  return path + apart.data() + "are its stamps in another unit than a " + log.format + " has them in?";
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
  auto file = std::make_unique<InputFile>(path, log_rules(Pipes::Named));
  std::unique_ptr<LogBytes> own;
  std::string bytes;
  if (is_own_file(*file)) {
    own = std::make_unique<FileBytes>(std::move(file));
  } else {
    bytes = unpacked(read_file(*file), path);
    if (is_own(bytes)) own = std::make_unique<HeldBytes>(std::move(bytes));
  }
  if (own) {
    impl_->own = std::make_unique<OwnLog>(std::move(own), path);
    impl_->format = "rubble log";
    impl_->model = impl_->own->header().model;
    impl_->note = impl_->own->header().note;
    return;
  }
  impl_->foreign = read_foreign(bytes, path);
  if (!tell_scans_apart(impl_->foreign.own_stamps)) impl_->foreign.own_stamps.clear();
  if (const auto note = odd_times(impl_->foreign, path)) impl_->foreign.notes.push_back(*note);
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
  Trajectory renamed = trajectory;
  for (StampedPose& stamped : renamed) stamped.stamp = own_stamp(stamped.stamp);
  const auto earlier = [](const StampedPose& a, const StampedPose& b) { return a.stamp < b.stamp; };
  const auto same = [](const StampedPose& a, const StampedPose& b) { return a.stamp == b.stamp; };
  std::stable_sort(renamed.begin(), renamed.end(), earlier);
  renamed.erase(std::unique(renamed.begin(), renamed.end(), same), renamed.end());
  return renamed;
}

Stamp ReplayRobot::own_stamp(Stamp delivered) const {
  const std::vector<OwnStamp>& names = impl_->foreign.own_stamps;
  const auto name = std::lower_bound(names.begin(), names.end(), delivered,
                                     [](const OwnStamp& n, Stamp s) { return n.delivered < s; });
  return name != names.end() && name->delivered == delivered ? name->in_log : delivered;
}

const std::vector<std::string>& ReplayRobot::notes() const { return impl_->foreign.notes; }

bool ReplayRobot::was_torn() const { return impl_->own && impl_->own->torn(); }

double ReplayRobot::progress() const {
  if (impl_->own) return impl_->own->progress();
  const std::size_t ticks = impl_->foreign.ticks.size();
  return ticks == 0 ? 1.0 : static_cast<double>(impl_->next_tick) / static_cast<double>(ticks);
}

}  // namespace rubble::robot
