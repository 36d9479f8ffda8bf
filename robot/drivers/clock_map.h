#pragma once

#include <cstdint>
#include <deque>
#include <optional>

#include "base/stamp.h"

namespace rubble::robot {

struct ClockMapConfig {
  double window = 150.0;      ///< so much of the past decides [s]
  double max_drift = 300e-6;  ///< clocks of quartz differ by less [s/s]
  double resolution = 1e-3;   ///< the device cuts its time off to multiples of this [s]
  double usual_delay = 0.0;   ///< least time from the stamped moment to the arrival, where no anchor measured it [s]
};

/// Maps a device's clock to the computer's. A message stamped by the device arrives a while later: never earlier than
/// the least delay, often later. The line below all (device time, delay) that lies closest to them gives offset and
/// drift whatever the delays above it are (Moon, Skelly and Towsley 1999, "Estimation and removal of clock skew from
/// network delay measurements"). The least delay itself cannot be told from an offset: questions of the time that the
/// device answers (`anchor`) tell it, else `usual_delay` stands for it.
class ClockMap {
 public:
  explicit ClockMap(const ClockMapConfig& config) : config_(config) {}

  /// A message stamped `device` [s, by the device's clock, unwrapped, rising] has arrived.
  void add(double device, Stamp arrived);
  /// The device said `device` [s] when asked: asked at `asked`, the answer came at `answered`. Several narrow it down.
  void anchor(double device, Stamp asked, Stamp answered);
  /// Forgets all: the device was restarted.
  void clear();

  bool empty() const { return points_.empty(); }
  /// The computer's time at a device time. Without any message or anchor: meaningless.
  Stamp host(double device) const;
  /// How much slower the device's clock runs than the computer's [s/s].
  double drift() const { return slope_; }
  /// Least time from the stamped moment to the arrival [s].
  double least_delay() const;
  /// The constant part of host() is known to +- so much [s]; nothing without an anchor.
  std::optional<double> doubt() const;

 private:
  struct Point {
    double x;  ///< device time [s]
    double y;  ///< arrival minus device time, from the first arrival on [s]
  };
  struct Anchor {
    double x;
    double low, high;  ///< bounds of the true offset there [s]
  };

  double relative(Stamp host, double device) const { return (host - origin_) - (device - device_origin_); }
  double line(double device) const { return level_ + slope_ * (device - device_origin_); }
  void start(double device, Stamp host);
  void fit();
  void forget_old();

  ClockMapConfig config_;
  Stamp origin_ = Stamp::never();
  double device_origin_ = 0.0;
  std::deque<Point> points_;
  std::optional<Anchor> anchor_;
  std::optional<double>
      fixed_delay_;  ///< least delay as the anchor told it, once the window has left the anchor behind
  double level_ = 0.0;
  double slope_ = 0.0;
};

/// Joins the readings of a counter that wraps to a time that does not. Which turn it is follows from the time gone by.
class WrappingClock {
 public:
  /// Counts to `wrap` in units of `unit` [s].
  WrappingClock(std::uint32_t wrap, double unit) : wrap_(wrap), unit_(unit) {}

  struct Reading {
    double time = 0.0;       ///< since the first reading's zero [s]
    bool restarted = false;  ///< the clock does not fit to the time gone by: the device was restarted
  };
  Reading read(std::uint32_t count, Stamp arrived);
  void clear() { last_.reset(); }

 private:
  std::uint32_t wrap_;
  double unit_;
  struct Last {
    std::int64_t ticks;
    Stamp arrived;
  };
  std::optional<Last> last_;
};

}  // namespace rubble::robot
