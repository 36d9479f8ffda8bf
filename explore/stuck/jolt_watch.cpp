#include "explore/stuck/jolt_watch.h"

#include <algorithm>
#include <cmath>
#include <optional>

namespace rubble::explore {
namespace {

constexpr double kDeaf = 0.5;  ///< after a blow [s]

}  // namespace

void JoltWatch::update(const robot::Inputs& inputs) {
  struck_ = shaken_ = false;
  if (!inputs.odometry.empty()) speed_ = inputs.odometry.back().v;
  for (const robot::Acceleration& sample : inputs.accelerations) {
    const std::optional<double> dt = rest_.update(sample);
    if (!dt) felt_.clear();
    felt_.push_back({sample.stamp, rest_.felt()});
    while (sample.stamp - felt_.front().stamp > config_.window) felt_.pop_front();
    if (std::abs(speed_) < config_.slowest || !dt || *dt <= 0.0) continue;
    if (deaf_until_ != Stamp::never() && sample.stamp < deaf_until_) continue;
    const double against = speed_ > 0.0 ? -1.0 : 1.0;
    double lost = 0.0, peak = 0.0;
    for (const Felt& felt : felt_) {
      lost += against * felt.x * *dt;
      peak = std::max(peak, against * felt.x);
    }
    if (peak < config_.peak || lost < config_.weak * std::abs(speed_)) continue;
    shaken_ = true;
    if (lost < config_.share * std::abs(speed_)) continue;
    struck_ = true;
    deaf_until_ = sample.stamp + kDeaf;
  }
}

void JoltWatch::braked(Stamp now) { deaf_until_ = now + kDeaf; }

}  // namespace rubble::explore
