#pragma once

#include <cstdint>
#include <vector>

#include "base/rng.h"
#include "robot/model.h"

namespace rubble::sim {

/// From exact distances to what a scanner reports. The data sheet's band A(r) (URG-04LX: +-10 mm up to 1 m and +-1 %
/// beyond) holds a device's own bias (at most A/4, drawn once) and three sigma of noise (sigma = A/4). At depth edges a
/// beam of 10 mrad lights both surfaces and reports something between, or an error code; so does a wall seen nearly
/// edge on.
class RangeNoise {
 public:
  /// `factor` scales bias and sigma; 0 also turns mixed pixels and grazing losses off.
  RangeNoise(const robot::LaserModel& laser, double factor, std::uint64_t seed);

  /// `ranges` [m], +inf: nothing met. On return in whole mm; +inf: a miss; NaN: no measurement (too near, mixed,
  /// grazing).
  /// `codes`, where given: the URG-04LX's code of each beam, 0 where it has a range or met nothing.
  void apply(std::vector<float>& ranges, std::vector<std::uint8_t>* codes = nullptr);

 private:
  void mix_edges(std::vector<float>& ranges);
  void mix_edge(std::size_t i, std::vector<float>& ranges);
  void lose_grazing(std::size_t i, std::vector<float>& ranges);
  void blur(std::vector<float>& ranges);
  void tell_lost(const std::vector<float>& ranges, std::vector<std::uint8_t>& codes) const;
  /// What is left without a range, and not for want of an echo, is nearer than the scanner measures.
  static void tell_too_near(const std::vector<float>& ranges, std::vector<std::uint8_t>& codes);

  robot::LaserModel laser_;
  double factor_;
  Rng range_;
  Rng edge_;
  float bias_ = 0.0f;                           ///< share of the accuracy band
  std::vector<float> quantiles_;                ///< of the standard normal, at the centres of 4096 equal shares
  std::vector<float> clean_;                    ///< scratch: the exact ranges, with a margin of repeated ends
  std::vector<std::uint32_t> bits_;             ///< scratch: 16 bits a beam
  std::vector<std::uint32_t> edges_, grazing_;  ///< scratch: beams to look at closely
};

}  // namespace rubble::sim
