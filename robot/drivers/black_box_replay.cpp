#include "robot/drivers/black_box_replay.h"

#include <algorithm>

#include "base/lists.h"

namespace rubble::robot {
namespace {

/// The turns of the thread that led the conversation with a device.
class Conversation {
 public:
  /// `turns_told`: the box has the turns in which there was nothing to read.
  Conversation(Device& device, bool turns_told) : device_(device), turns_told_(turns_told) {}

  void play(const BlackBoxEntry& entry) {
    if (entry.direction == Direction::Opened) {
      until_ = entry.stamp;
      return device_.opened(entry.stamp, line_kind(entry));
    }
    if (!turns_told_) pass_time(entry.stamp);
    if (entry.direction == Direction::Lost) {
      until_ = Stamp::never();  // nobody turns before the next port is open
      return;
    }
    if (entry.direction == Direction::FromDevice) device_.receive(entry.bytes, entry.stamp);
    // What was sent, and the rate it was sent at, came of a turn that stands before it.
    const bool came_of_turn = entry.direction == Direction::ToDevice || entry.direction == Direction::BitRate;
    if (!turns_told_ || !came_of_turn) turn(entry.stamp);
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
  bool turns_told_;
  Stamp until_ = Stamp::never();  ///< time has passed
};

bool tells_turns(const std::vector<BlackBoxEntry>& entries, const std::string& device) {
  return std::any_of(entries.begin(), entries.end(), [&](const BlackBoxEntry& entry) {
    return entry.device == device && entry.direction == Direction::Turn;
  });
}

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
  Conversation with_base(*played, tells_turns(entries, "base")), with_unit(unit, tells_turns(entries, "levelling"));
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
