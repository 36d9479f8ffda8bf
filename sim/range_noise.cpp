#include "sim/range_noise.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "base/angle.h"

namespace rubble::sim {
namespace {

constexpr std::size_t kQuantiles = 4096;
constexpr double kHalfBeam = 0.005;                ///< half the beam's divergence [rad]
constexpr float kEdge = 0.10f;                     ///< neighbours that differ by more lie on two surfaces [m]
constexpr double kErrorShare = 0.5;                ///< mixed echoes that the device reports as an error code
constexpr double kGrazingFrom = deg_to_rad(80.0);  ///< angle of incidence from which echoes get lost
constexpr double kGrazingTo = deg_to_rad(88.0);    ///< at which all are
constexpr float kNaN = std::numeric_limits<float>::quiet_NaN();
constexpr float kInf = std::numeric_limits<float>::infinity();

/// Inverse of the normal distribution by Newton's method on erfc, from a guess nearby.
double normal_quantile(double p, double guess) {
  double x = guess;
  for (int i = 0; i < 60; ++i) {
    const double error = 0.5 * std::erfc(-x / std::sqrt(2.0)) - p;
    const double density = std::exp(-0.5 * x * x) / std::sqrt(2.0 * kPi);
    const double step = std::clamp(error / density, -0.5, 0.5);
    x -= step;
    if (std::abs(step) < 1e-9) break;
  }
  return x;
}

}  // namespace

RangeNoise::RangeNoise(const robot::LaserModel& laser, double factor, std::uint64_t seed)
    : laser_(laser), factor_(factor), range_(seed, "range"), edge_(seed, "range_edge") {
  bias_ = static_cast<float>(factor * range_.uniform(-0.25, 0.25));
  quantiles_.reserve(kQuantiles);
  double x = 0.0;
  for (std::size_t i = 0; i < kQuantiles; ++i) {
    x = normal_quantile((static_cast<double>(i) + 0.5) / static_cast<double>(kQuantiles), x);
    quantiles_.push_back(static_cast<float>(x));
  }
}

/// Looks at the exact ranges of the neighbours, so that one mixed pixel does not make the next.
void RangeNoise::mix_edges(std::vector<float>& ranges) {
  clean_ = ranges;
  const double step = laser_.angle_step;
  for (std::size_t i = 0; i + 1 < clean_.size(); ++i) {
    const float jump = clean_[i + 1] - clean_[i];
    if (!(std::abs(jump) > kEdge)) continue;  // also when both are misses: inf - inf
    const float before = i > 0 ? clean_[i] - clean_[i - 1] : 0.0f;
    const float after = i + 2 < clean_.size() ? clean_[i + 2] - clean_[i + 1] : 0.0f;
    if (before * jump > 0.0f && after * jump > 0.0f && std::abs(before) > 0.3f * std::abs(jump) &&
        std::abs(after) > 0.3f * std::abs(jump)) {
      continue;  // one surface, seen edge on
    }
    // The edge lies somewhere between the two beams; a beam whose light reaches over it sees both sides.
    const double edge = edge_.uniform(0.0, step);
    const double error_first = edge_.uniform();
    const double error_second = edge_.uniform();
    const double shares[2] = {(kHalfBeam - edge) / (2.0 * kHalfBeam), (kHalfBeam - (step - edge)) / (2.0 * kHalfBeam)};
    const double errors[2] = {error_first, error_second};
    for (std::size_t k = 0; k < 2; ++k) {
      if (shares[k] <= 0.0) continue;
      const float own = clean_[i + k];
      const float other = clean_[i + 1 - k];
      if (errors[k] < kErrorShare) {
        ranges[i + k] = kNaN;
      } else if (own < kInf && other < kInf) {
        ranges[i + k] = own + static_cast<float>(shares[k]) * (other - own);
      }
    }
  }
  for (std::size_t i = 1; i + 1 < clean_.size(); ++i) {
    const float before = clean_[i] - clean_[i - 1];
    const float after = clean_[i + 1] - clean_[i];
    if (!(before * after > 0.0f) || !(clean_[i + 1] < kInf)) continue;
    // tan(incidence) = dr / (r dtheta), from the flatter side so that depth edges do not count.
    const float flatter = std::min(std::abs(before), std::abs(after));
    if (flatter < 5.0f * clean_[i] * static_cast<float>(step)) continue;  // below 78 deg
    const double incidence = std::atan(static_cast<double>(flatter / clean_[i]) / step);
    const double lost = (incidence - kGrazingFrom) / (kGrazingTo - kGrazingFrom);
    if (lost <= 0.0) continue;
    const double draw = edge_.uniform();
    if (draw < lost) ranges[i] = kNaN;
  }
}

void RangeNoise::apply(std::vector<float>& ranges) {
  if (factor_ > 0.0) mix_edges(ranges);
  const float sigma = static_cast<float>(0.25 * factor_);
  const float shortest = static_cast<float>(laser_.range_min);
  const float longest = static_cast<float>(laser_.range_max);
  std::uint32_t bits = 0;
  for (std::size_t i = 0; i < ranges.size(); ++i) {
    // 16 bits a beam, drawn whether it hits or not: the noise of one beam does not depend on the others.
    bits = i % 2 == 0 ? range_.next_u32() : bits >> 16;
    const float gauss = quantiles_[bits & (kQuantiles - 1)];
    float& r = ranges[i];
    if (!(r < kInf)) continue;
    const float noisy = factor_ > 0.0 ? r + accuracy_band(r) * (bias_ + sigma * gauss) : r;
    const float millimetres = std::floor(noisy * 1000.0f + 0.5f);
    r = millimetres * 0.001f;
    if (r < shortest) r = kNaN;
    if (r > longest) r = kInf;
  }
}

}  // namespace rubble::sim
