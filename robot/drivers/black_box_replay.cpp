#include "robot/drivers/black_box_replay.h"

#include <algorithm>

#include "base/lists.h"

namespace rubble::robot {
namespace {

/// The turns of the thread that led the conversation with a device.
class Conversation {
 public:
  explicit Conversation(Device& device) : device_(device) {}

  void play(const BlackBoxEntry& entry) {
    if (entry.direction == Direction::Opened) {
      until_ = entry.stamp;
      return device_.opened(entry.stamp, line_kind(entry));
    }
    pass_time(entry.stamp);
    if (entry.direction == Direction::Lost) {
      until_ = Stamp::never();  // nobody turns before the next port is open
      return;
    }
    if (entry.direction == Direction::FromDevice) device_.receive(entry.bytes, entry.stamp);
    turn(entry.stamp);
  }

 private:
  /// What is due without a byte on the line, such as giving up to wait. A driver that asks again and again leaves bytes
  /// in the box; one that has only listened for a minute waits for nothing more, so no file takes longer than its
  /// bytes.
  void pass_time(Stamp to) {
    constexpr double kTurn = 0.02;       // a driver that always wants to be called is called as often as then [s]
    constexpr double kListening = 60.0;  // [s]
    if (until_ == Stamp::never()) return;
    const Stamp end = std::min(to, until_ + kListening);
    for (Stamp due = device_.deadline(); due < end; due = std::max(device_.deadline(), due + kTurn)) {
      due = std::max(due, until_);
      if (due < end) turn(due);
    }
    until_ = std::max(until_, to);
  }
  /// Bytes first, then what is due. What the driver would send is thrown away: the device has long answered what was
  /// sent then.
  void turn(Stamp now) {
    device_.advance(now);
    device_.take_output(now);
  }

  Device& device_;
  Stamp until_ = Stamp::never();  ///< time has passed
};

/// Whether the driver began by listening whether somebody else talks with the base: else its first question leaves as
/// soon as the line is open.
bool listened(const std::vector<BlackBoxEntry>& entries) {
  constexpr double kAtOnce = 0.2;  // [s]
  Stamp opened = Stamp::never();
  for (const BlackBoxEntry& entry : entries) {
    if (entry.device != "base") continue;
    if (opened == Stamp::never() && entry.direction == Direction::Opened) opened = entry.stamp;
    if (opened == Stamp::never() || entry.direction == Direction::Opened) continue;
    if (entry.direction == Direction::ToDevice) return entry.stamp - opened > kAtOnce;
    if (entry.stamp - opened > kAtOnce) return true;
  }
  return false;
}

}  // namespace

ReplayedBox replay_black_box(const std::vector<BlackBoxEntry>& entries, const std::string& driver,
                             const BaseSettings& base, const LevellingUnitSettings& levelling) {
  BaseSettings settings = base;
  settings.listen = listened(entries);
  const std::unique_ptr<BaseDriver> played = make_base(driver, settings);
  LevellingUnit unit(levelling);
  Conversation with_base(*played), with_unit(unit);
  ReplayedBox replayed;
  for (const BlackBoxEntry& entry : entries) {
    if (entry.device == "base") with_base.play(entry);
    if (entry.device == "levelling") with_unit.play(entry);
    append(replayed.odometry, played->take_odometry());
    append(replayed.accelerations, unit.take_accelerations());
    append(replayed.aims, unit.take_aims());
  }
  replayed.bad_sums = played->bad_sums();
  replayed.jumps = played->jumps();
  replayed.bad_lines = unit.bad_lines();
  return replayed;
}

}  // namespace rubble::robot
