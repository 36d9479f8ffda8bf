#include "explore/stuck/jolt_watch.h"

#include <algorithm>
#include <cmath>

namespace rubble::explore {
namespace {

constexpr double kDeaf = 0.5;         ///< after a blow [s]
constexpr double kLongestStep = 0.1;  ///< between two samples; after a longer gap they do not belong together [s]

}  // namespace

void JoltWatch::update(const robot::Inputs& inputs) {
  struck_ = shaken_ = false;
  if (!inputs.odometry.empty()) speed_ = inputs.odometry.back().v;
  for (const robot::Acceleration& sample : inputs.accelerations) {
    const double dt = last_ == Stamp::never() ? 0.0 : sample.stamp - last_;
    if (last_ == Stamp::never() || dt > kLongestStep) {
      rest_ = sample.x;
      felt_.clear();
    }
    last_ = sample.stamp;
    felt_.push_back({sample.stamp, sample.x - rest_});
    rest_ += std::min(1.0, dt / config_.settling) * (sample.x - rest_);
    while (sample.stamp - felt_.front().stamp > config_.window) felt_.pop_front();
    if (std::abs(speed_) < config_.slowest || dt <= 0.0 || dt > kLongestStep) continue;
    if (deaf_until_ != Stamp::never() && sample.stamp < deaf_until_) continue;
    const double against = speed_ > 0.0 ? -1.0 : 1.0;
    double lost = 0.0, peak = 0.0;
    for (const Felt& felt : felt_) {
      lost += against * felt.x * dt;
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
