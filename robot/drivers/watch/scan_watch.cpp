#include "robot/drivers/watch/scan_watch.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>

#include "base/angle.h"
#include "robot/drivers/watch/freshness.h"

namespace rubble::robot {
namespace {

/// Bit by bit: beams that could not be measured are the same too.
bool same(const std::vector<float>& a, const std::vector<float>& b) {
  return a.size() == b.size() && std::memcmp(a.data(), b.data(), a.size() * sizeof(float)) == 0;
}

}  // namespace

void ScanWatch::see(const LaserScan& scan, Stamp now) {
  const auto ranges = static_cast<std::size_t>(
      std::count_if(scan.ranges.begin(), scan.ranges.end(), [](float r) { return std::isfinite(r) && r > kCover; }));
  const std::lock_guard<std::mutex> lock(mutex_);
  mind_walls(scan, ranges);
  blind_scans_ = ranges == 0 ? blind_scans_ + 1 : 0;
  if (blind_scans_ == 1) blind_since_ = now;
  const bool repeated = ranges >= kEnough && same(scan.ranges, ranges_);
  same_scans_ = repeated ? same_scans_ + 1 : 0;
  if (!repeated) {
    same_since_ = now;
    gone_ = {};
    ranges_ = scan.ranges;
  }
  const Kind kind = kind_of(now);
  if (kind != Kind::Well) {
    trouble_ = kind;
    wrong_at_ = now;
  } else if (blind_scans_ > 0 || same_scans_ > 0) {
    wrong_at_ = now;  // may be the beginning of it
  } else if (wrong_at_ == Stamp::never() || now - wrong_at_ >= kKeepsUp) {
    trouble_ = Kind::Well;
  }
}

/// What of this scan the next ones must show, and whether this one looks like an empty hall.
void ScanWatch::mind_walls(const LaserScan& scan, std::size_t ranges) {
  const auto no_echo = [&](std::size_t i) {
    return std::isinf(scan.ranges[i]) || (std::isnan(scan.ranges[i]) && i < scan.codes.size() && scan.codes[i] == 0);
  };
  const double edge = scan.range_max > 0.0 ? scan.range_max - kEdge : std::numeric_limits<double>::infinity();
  std::size_t without = 0, walls = 0;
  const std::size_t n = scan.ranges.size();
  const auto margin = scan.angle_step > 0.0 ? static_cast<std::size_t>(kEdgeAngle / scan.angle_step) : 0;
  for (std::size_t i = 0; i < n; ++i) {
    without += no_echo(i) ? 1 : 0;
    const float range = scan.ranges[i];
    const bool inside = i >= margin && i + margin < n;
    walls += inside && std::isfinite(range) && range > kCover && range < edge ? 1 : 0;
  }
  no_echo_ = n > 0 && static_cast<double>(without) >= kNoEchoShare * static_cast<double>(n);
  if (ranges < kFew) return;  // a stray range, through a cover too
  unseen_way_ = 0.0;
  seen_ = true;
  walls_ = walls;
}

ScanWatch::Kind ScanWatch::kind_of(Stamp now) const {
  const bool out_of_reach = seen_ && walls_ < kFew && no_echo_ && unseen_way_ <= settings_.nothing_way;
  if (!out_of_reach && blind_scans_ >= kScans && now - blind_since_ >= kBlind) return Kind::Blind;
  if (same_scans_ < kScans) return Kind::Well;
  const bool moved = gone_.v >= kMoved.v || gone_.w >= kMoved.w;
  return now - same_since_ >= (moved ? kRepeatsSoon : kRepeats) ? Kind::Repeats : Kind::Well;
}

void ScanWatch::look(const std::vector<Odometry>& reports) {
  const std::lock_guard<std::mutex> lock(mutex_);
  for (const Odometry& report : reports) {
    if (last_) {
      const mrpt::math::TPose2D step = report.pose - last_->pose;
      unseen_way_ += std::hypot(step.x, step.y);
      gone_ = {gone_.v + std::hypot(step.x, step.y), gone_.w + std::abs(wrap_angle(step.phi))};
    }
    last_ = report;
  }
}

bool ScanWatch::is_well() const {
  const std::lock_guard<std::mutex> lock(mutex_);
  return trouble_ == Kind::Well;
}

bool ScanWatch::holds() const {
  const std::lock_guard<std::mutex> lock(mutex_);
  return trouble_ == Kind::Repeats || (trouble_ == Kind::Blind && settings_.nothing_holds);
}

std::string ScanWatch::trouble() const {
  const std::lock_guard<std::mutex> lock(mutex_);
  switch (trouble_) {
    case Kind::Blind:
      return "sees nothing, no beam of it gives a range; is it covered or dirty, or is everything out of its reach?";
    case Kind::Repeats:
      return "repeats the same scan again and again; switch it off and on";
    case Kind::Well:
      break;
  }
  return "";
}

}  // namespace rubble::robot
