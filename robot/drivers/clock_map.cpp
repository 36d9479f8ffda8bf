#include "robot/drivers/clock_map.h"

#include <algorithm>
#include <cmath>
#include <vector>

namespace rubble::robot {
namespace {

constexpr double kRestartJump = 1.0;  // a counter that is off by more was set anew [s]

}  // namespace

void ClockMap::start(double device, Stamp host) {
  if (origin_ != Stamp::never()) return;
  origin_ = host;
  device_origin_ = device;
}

void ClockMap::add(double device, Stamp arrived) {
  start(device, arrived);
  points_.push_back({device - device_origin_, relative(arrived, device)});
  forget_old();
  fit();
}

void ClockMap::anchor(double device, Stamp asked, Stamp answered) {
  start(device, asked);
  // The device's true time lies in [device, device + resolution), and it was read between question and answer.
  const double low = relative(asked, device) - config_.resolution, high = relative(answered, device);
  const double x = device - device_origin_;
  if (!anchor_ || low > anchor_->high || high < anchor_->low) {
    if (!anchor_ || high - low < anchor_->high - anchor_->low) anchor_ = Anchor{x, low, high};
    return;
  }
  anchor_ = Anchor{x, std::max(low, anchor_->low), std::min(high, anchor_->high)};
}

void ClockMap::clear() {
  origin_ = Stamp::never();
  points_.clear();
  anchor_.reset();
  fixed_delay_.reset();
  level_ = slope_ = 0.0;
}

void ClockMap::forget_old() {
  const double oldest = points_.back().x - config_.window;
  if (anchor_ && !fixed_delay_ && anchor_->x < oldest) fixed_delay_ = least_delay();
  while (points_.front().x < oldest) points_.pop_front();
}

void ClockMap::fit() {
  // Lower convex hull; of all lines below the points the one through the hull's edge above which their mean lies is
  // closest to them in sum.
  std::vector<Point> hull;
  double mean = 0.0;
  for (const Point& p : points_) {
    mean += p.x / static_cast<double>(points_.size());
    while (hull.size() >= 2) {
      const Point &a = hull[hull.size() - 2], &b = hull.back();
      if ((b.y - a.y) * (p.x - a.x) < (p.y - a.y) * (b.x - a.x)) break;
      hull.pop_back();
    }
    hull.push_back(p);
  }
  slope_ = 0.0;
  for (std::size_t i = 0; i + 1 < hull.size(); ++i) {
    if (hull[i + 1].x < mean) continue;
    const double width = hull[i + 1].x - hull[i].x;
    if (width > 0.0) slope_ = (hull[i + 1].y - hull[i].y) / width;
    break;
  }
  slope_ = std::clamp(slope_, -config_.max_drift, config_.max_drift);
  level_ = hull.front().y - slope_ * hull.front().x;
  for (const Point& p : hull) level_ = std::min(level_, p.y - slope_ * p.x);
}

double ClockMap::least_delay() const {
  if (fixed_delay_) return *fixed_delay_;
  if (!anchor_ || points_.empty()) return config_.usual_delay;
  // The line touches messages whose time was cut off the least, the anchor's middle is the time as it is: both stand
  // for the moment at which the counter steps.
  const double offset = 0.5 * (anchor_->low + anchor_->high);
  return level_ + slope_ * anchor_->x - offset;
}

std::optional<double> ClockMap::doubt() const {
  if (!anchor_) return std::nullopt;
  return 0.5 * (anchor_->high - anchor_->low);
}

Stamp ClockMap::host(double device) const {
  const double offset =
      points_.empty() && anchor_ ? 0.5 * (anchor_->low + anchor_->high) : line(device) - least_delay();
  // Half a resolution: the device cuts off, on average that much.
  return origin_ + ((device - device_origin_) + offset + 0.5 * config_.resolution);
}

WrappingClock::Reading WrappingClock::read(std::uint32_t count, Stamp arrived) {
  const auto ticks = static_cast<std::int64_t>(count);
  if (!last_) {
    last_ = Last{ticks, arrived};
    return {static_cast<double>(ticks) * unit_, false};
  }
  const double gone = (arrived - last_->arrived) / unit_;
  const double expected = static_cast<double>(last_->ticks) + gone;
  const double turns = std::round((expected - static_cast<double>(ticks)) / wrap_);
  const std::int64_t joined = ticks + static_cast<std::int64_t>(turns) * wrap_;
  const bool restarted = std::abs(static_cast<double>(joined) - expected) * unit_ > kRestartJump;
  last_ = Last{restarted ? ticks : joined, arrived};
  return {static_cast<double>(last_->ticks) * unit_, restarted};
}

}  // namespace rubble::robot
