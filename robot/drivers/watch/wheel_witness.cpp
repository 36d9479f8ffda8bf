#include "robot/drivers/watch/wheel_witness.h"

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "base/angle.h"

namespace rubble::robot {
namespace {

constexpr Drive kToldFar{0.15, deg_to_rad(15.0)};     ///< so far must it be told to go [m], [rad]
constexpr Drive kWheelsStill{0.03, deg_to_rad(3.0)};  ///< who went less by its places says that it stands [m], [rad]
constexpr Drive kSpeedsStill{0.01, 0.02};             ///< who is slower says so [m/s], [rad/s]
constexpr double kShortest = 0.6;     ///< longer than reports may be late behind scans, and scans behind them [s]
constexpr double kLongest = 3.0;      ///< [s]
constexpr double kReportsGap = 0.35;  ///< so long without a report nobody knows what the wheels say [s]
constexpr double kLongestStep = 0.1;  ///< from one call to the next [s]
constexpr int kDenials = 2;           ///< in a row: what one window misses is in the next one

}  // namespace

void WheelWitness::pause() {
  since_.reset();
  last_.reset();
  expected_ = {};
  told_ = looked_ = Stamp::never();
  denied_ = 0;
  denial_.clear();
}

void WheelWitness::tell(const Drive& told, const Drive& ramp, Stamp now) {
  const double dt = told_ == Stamp::never() ? 0.0 : std::clamp(now - told_, 0.0, kLongestStep);
  told_ = now;
  expected_ = {approach(expected_.v, told.v, ramp.v * dt), approach(expected_.w, told.w, ramp.w * dt)};
  if (!since_) return;
  since_->told = {since_->told.v + expected_.v * dt, since_->told.w + expected_.w * dt};
}

void WheelWitness::look(const Odometry& odometry, Stamp now) {
  tells_speeds_ = tells_speeds_ || std::abs(odometry.v) > kSpeedsStill.v || std::abs(odometry.w) > kSpeedsStill.w;
  const bool gap = looked_ != Stamp::never() && now - looked_ > kReportsGap;
  looked_ = now;
  if (gap || odometry.stalled) {
    since_.reset();
    denied_ = 0;
  }
  if (since_ && last_) {
    const mrpt::math::TPose2D step = odometry.pose - last_->pose;
    since_->gone = {since_->gone.v + std::hypot(step.x, step.y), since_->gone.w + std::abs(wrap_angle(step.phi))};
    since_->fastest = std::max(since_->fastest, std::abs(odometry.v));
    since_->quickest = std::max(since_->quickest, std::abs(odometry.w));
    ++since_->reports;
  }
  last_ = odometry;
}

void WheelWitness::start(const LaserScan& scan, Stamp now) { since_.emplace(scan, now); }

void WheelWitness::see(const LaserScan& scan, Stamp now) {
  if (told_ == Stamp::never() || looked_ == Stamp::never() || now - looked_ > kReportsGap) {
    since_.reset();
    denied_ = 0;
    return;
  }
  const bool other = since_ && scan.ranges.size() != since_->scan.ranges.size();
  if (!since_ || other || now - since_->when > kLongest) return start(scan, now);
  const bool far = std::abs(since_->told.v) >= kToldFar.v || std::abs(since_->told.w) >= kToldFar.w;
  if (!far || now - since_->when < kShortest || since_->reports == 0) return;
  judge(*since_, scan, now);
  start(scan, now);
}

void WheelWitness::judge(const Since& since, const LaserScan& scan, Stamp now) {
  const bool by_place = since.gone.v < kWheelsStill.v && since.gone.w < kWheelsStill.w;
  const bool by_speed = tells_speeds_ && since.fastest < kSpeedsStill.v && since.quickest < kSpeedsStill.w;
  if (!by_place && !by_speed) {
    denied_ = 0;
    return;
  }
  const ScanMotion seen = motion_between(since.scan, scan, T_base_laser_);
  if (seen.stood()) denied_ = 0;
  if (!seen.moved()) return;
  if (++denied_ < kDenials || !denial_.empty()) return;
  char text[200];
  std::snprintf(text, sizeof text,
                "encoders and scans disagree: its wheels report that they stand%s, scans show %.2f m and %.0f deg in "
                "%.1f s; its motors are being switched off",
                by_place ? "" : " (by their speeds)", seen.ahead, rad_to_deg(seen.turn), now - since.when);
  denial_ = text;
}

}  // namespace rubble::robot
