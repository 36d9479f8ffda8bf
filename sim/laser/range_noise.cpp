#include "sim/laser/range_noise.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "base/angle.h"
#include "sim/laser/simd.h"

namespace rubble::sim {
namespace {

constexpr std::size_t kQuantiles = 4096;
constexpr double kHalfBeam = 0.005;                ///< half the beam's divergence [rad]
constexpr float kEdge = 0.10f;                     ///< neighbours that differ by more lie on two surfaces [m]
constexpr double kErrorShare = 0.5;                ///< mixed echoes that the device reports as an error code
constexpr double kGrazingFrom = deg_to_rad(80.0);  ///< angle of incidence from which echoes get lost
constexpr double kGrazingTo = deg_to_rad(88.0);    ///< at which all are
constexpr float kNaN = std::numeric_limits<float>::quiet_NaN();

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

/// A depth edge between beams i and i + 1.
void RangeNoise::mix_edge(std::size_t i, std::vector<float>& ranges) {
  const float* clean = clean_.data() + 1;
  const double step = laser_.angle_step;
  const float jump = clean[i + 1] - clean[i];
  const float before = i > 0 ? clean[i] - clean[i - 1] : 0.0f;
  const float after = i + 2 < ranges.size() ? clean[i + 2] - clean[i + 1] : 0.0f;
  if (before * jump > 0.0f && after * jump > 0.0f && std::abs(before) > 0.3f * std::abs(jump) &&
      std::abs(after) > 0.3f * std::abs(jump)) {
    return;  // one surface, seen edge on
  }
  // The edge lies somewhere between the two beams; a beam whose light reaches over it sees both sides.
  const double edge = edge_.uniform(0.0, step);
  const double error_first = edge_.uniform();
  const double error_second = edge_.uniform();
  const double shares[2] = {(kHalfBeam - edge) / (2.0 * kHalfBeam), (kHalfBeam - (step - edge)) / (2.0 * kHalfBeam)};
  const double errors[2] = {error_first, error_second};
  for (std::size_t k = 0; k < 2; ++k) {
    if (shares[k] <= 0.0) continue;
    const float own = clean[i + k];
    const float other = clean[i + 1 - k];
    if (errors[k] < kErrorShare) {
      ranges[i + k] = kNaN;
    } else if (own < kInf && other < kInf) {
      ranges[i + k] = own + static_cast<float>(shares[k]) * (other - own);
    }
  }
}

/// Beam i meets a surface nearly edge on.
void RangeNoise::lose_grazing(std::size_t i, std::vector<float>& ranges) {
  const float* clean = clean_.data() + 1;
  const float flatter = std::min(std::abs(clean[i] - clean[i - 1]), std::abs(clean[i + 1] - clean[i]));
  const double incidence = std::atan(static_cast<double>(flatter / clean[i]) / laser_.angle_step);
  const double lost = (incidence - kGrazingFrom) / (kGrazingTo - kGrazingFrom);
  if (lost <= 0.0) return;
  const double draw = edge_.uniform();
  if (draw < lost) ranges[i] = kNaN;
}

/// Looks at the exact ranges of the neighbours, so that one mixed pixel does not make the next. Few beams lie at an
/// edge or graze: groups of four without any are passed over.
void RangeNoise::mix_edges(std::vector<float>& ranges) {
  const std::size_t n = ranges.size();
  if (n < 2) return;
  clean_.resize(n + 5);
  clean_[0] = ranges[0];
  std::copy(ranges.begin(), ranges.end(), clean_.begin() + 1);
  std::fill(clean_.begin() + static_cast<std::ptrdiff_t>(n) + 1, clean_.end(), ranges[n - 1]);
  // tan(incidence) = dr / (r dtheta), from the flatter side so that depth edges do not count; 5: below 78 deg.
  const Float4 edge = splat(kEdge), slope = splat(5.0f * static_cast<float>(laser_.angle_step));
  const Float4 zero = splat(0.0f), miss = splat(kInf);
  for (std::size_t i = 0; i < n; i += 4) {
    const Float4 own = load4(&clean_[i + 1]), next = load4(&clean_[i + 2]);
    const Float4 before = own - load4(&clean_[i]);
    const Float4 after = next - own;  // NaN between two misses: no edge
    const Int4 jumps = abs4(after) > edge;
    const Int4 grazes = (before * after > zero) & (next < miss) & (min4(abs4(before), abs4(after)) >= slope * own);
    for (int lanes = bits4(jumps); lanes != 0; lanes &= lanes - 1) {
      edges_.push_back(static_cast<std::uint32_t>(i) + lowest4(lanes));
    }
    for (int lanes = bits4(grazes); lanes != 0; lanes &= lanes - 1) {
      grazing_.push_back(static_cast<std::uint32_t>(i) + lowest4(lanes));
    }
  }
  for (const std::uint32_t i : edges_) mix_edge(i, ranges);
  for (const std::uint32_t i : grazing_) lose_grazing(i, ranges);
}

/// Bias and noise on all ranges; misses and lost beams stay what they are. `ranges`: whole groups of four.
void RangeNoise::blur(std::vector<float>& ranges) {
  // 16 bits a beam, drawn whether it hits or not: the noise of one beam does not depend on the others.
  bits_.resize(ranges.size() / 2);
  range_.fill(bits_.data(), bits_.size());
  const Float4 sigma = splat(0.25 * factor_), bias = splat(bias_);
  const Float4 miss = splat(kInf), near_to = splat(laser_.accuracy_near_to), near = splat(laser_.accuracy_near);
  const Float4 far = splat(laser_.accuracy_far), far_share = splat(laser_.accuracy_far_share);
  for (std::size_t i = 0; i < ranges.size(); i += 4) {
    const Float4 exact = load4(&ranges[i]);
    const std::uint32_t low = bits_[i / 2], high = bits_[i / 2 + 1];
    const Float4 gauss{quantiles_[low & (kQuantiles - 1)], quantiles_[low >> 16 & (kQuantiles - 1)],
                       quantiles_[high & (kQuantiles - 1)], quantiles_[high >> 16 & (kQuantiles - 1)]};
    const Float4 band = exact < near_to ? near : far + far_share * exact;
    const Float4 noisy = exact + band * (bias + sigma * gauss);
    store4(&ranges[i], exact < miss ? noisy : exact);
  }
}

/// Codes of the beams that mix_edges() has lost. The URG's manual: 1..5 too little light comes back, 7 neighbours in
/// error.
void RangeNoise::tell_lost(const std::vector<float>& ranges, std::vector<std::uint8_t>& codes) const {
  constexpr std::uint8_t kWeak = 1, kNeighbours = 7;
  codes.assign(ranges.size(), 0);
  if (factor_ <= 0.0) return;
  for (const std::uint32_t i : edges_)
    for (const std::size_t beam : {std::size_t{i}, std::size_t{i} + 1})
      if (beam < ranges.size() && std::isnan(ranges[beam])) codes[beam] = kNeighbours;
  for (const std::uint32_t i : grazing_)
    if (i < ranges.size() && std::isnan(ranges[i])) codes[i] = kWeak;
}

void RangeNoise::tell_too_near(const std::vector<float>& ranges, std::vector<std::uint8_t>& codes) {
  constexpr std::uint8_t kOther = 10;  // 10..17 are "other" in the manual
  for (std::size_t i = 0; i < ranges.size(); ++i)
    if (std::isnan(ranges[i]) && codes[i] == 0) codes[i] = kOther;
}

void RangeNoise::apply(std::vector<float>& ranges, std::vector<std::uint8_t>* codes) {
  edges_.clear();
  grazing_.clear();
  if (factor_ > 0.0) mix_edges(ranges);
  if (codes) tell_lost(ranges, *codes);
  const std::size_t n = ranges.size();
  ranges.resize((n + 3) / 4 * 4, kInf);
  if (factor_ > 0.0) blur(ranges);
  const Float4 shortest = splat(laser_.range_min), longest = splat(laser_.range_max);
  const Float4 zero = splat(0.0f), miss = splat(kInf), none = splat(kNaN), most = splat(1e6f);
  for (std::size_t i = 0; i < ranges.size(); i += 4) {
    const Float4 exact = load4(&ranges[i]);
    const Float4 millimetres = truncate4(min4(exact, most) * splat(1000.0f) + splat(0.5f));
    const Float4 r = millimetres * splat(0.001f);
    const Int4 measured = (exact >= zero) & (r >= shortest);  // not so NaN: a lost beam stays lost
    store4(&ranges[i], measured ? (r > longest ? miss : r) : none);
  }
  ranges.resize(n);
  if (codes) tell_too_near(ranges, *codes);
}

}  // namespace rubble::sim
