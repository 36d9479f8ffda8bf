#include "robot/drivers/scip/scan_maker.h"

#include <algorithm>
#include <cmath>

#include "robot/drivers/scip/scip_text.h"

namespace rubble::robot::scip {
namespace {

constexpr double kMillisecond = 1e-3;

/// From step 0 to the arrival at the soonest: the device sends when the last step is measured.
double usual_delay(const Geometry& geometry) {
  const double last_of_turn = 0.75 * geometry.period();  // step 768 of 1024: the rest of the turn is blind
  return std::max(last_of_turn, geometry.after_sweep());
}

ClockMapConfig clock_config(const Geometry& geometry) {
  ClockMapConfig config;
  config.usual_delay = usual_delay(geometry);
  return config;
}

}  // namespace

ScanMaker::ScanMaker(const Geometry& geometry, bool has_clock, const RangeRules& rules)
    : geometry_(geometry),
      has_clock_(has_clock),
      rules_(rules),
      clock_(kClockWrap, kMillisecond),
      map_(clock_config(geometry)) {}

std::optional<MadeScan> ScanMaker::make(const Sweep& sweep, Stamp begun, Stamp ended) {
  const double period = geometry_.period();
  MadeScan made;
  Stamp turn = begun - usual_delay(geometry_);
  if (has_clock_) {
    const WrappingClock::Reading reading = clock_.read(sweep.clock_ms, begun);
    if (reading.restarted) {
      map_.clear();
      last_turn_ = -1.0;
    }
    // A doubled turn says nothing new; one that goes back would break the order that all readers count on.
    if (last_turn_ >= 0.0 && reading.time - last_turn_ < 0.5 * period) return std::nullopt;
    if (last_turn_ >= 0.0) made.missed = std::max(0.0, std::round((reading.time - last_turn_) / period) - 1.0);
    last_turn_ = reading.time;
    map_.add(reading.time, begun);
    turn = map_.host(reading.time);
  }
  made.scan = scan_of(sweep, geometry_, rules_, turn);
  made.latency = ended - (turn + geometry_.after_sweep());
  return made;
}

}  // namespace rubble::robot::scip
