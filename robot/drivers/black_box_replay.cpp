#include "robot/drivers/black_box_replay.h"

#include <iterator>

namespace rubble::robot {
namespace {

template <class T>
void append(std::vector<T>& to, std::vector<T>&& from) {
  to.insert(to.end(), std::make_move_iterator(from.begin()), std::make_move_iterator(from.end()));
}

/// One turn of the thread that led the conversation: bytes first, then what is due. What the driver would send is
/// thrown away: the device has long answered what was sent then.
void play(Device& device, const BlackBoxEntry& entry) {
  if (entry.direction == Direction::Opened) return device.opened(entry.stamp, line_kind(entry));
  if (entry.direction == Direction::FromDevice) device.receive(entry.bytes, entry.stamp);
  device.advance(entry.stamp);
  device.take_output(entry.stamp);
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
  ReplayedBox replayed;
  for (const BlackBoxEntry& entry : entries) {
    if (entry.device == "base") play(*played, entry);
    if (entry.device == "levelling") play(unit, entry);
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
