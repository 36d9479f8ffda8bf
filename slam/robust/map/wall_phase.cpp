#include "slam/robust/map/wall_phase.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <tuple>

#include "base/angle.h"

namespace rubble::slam {

namespace {

constexpr double kLeastWallHits = 20.0;  ///< tell where walls lie
constexpr double kSure = 6.0;            ///< n R^2 of Rayleigh's test: by chance in one of 400
constexpr double kStrip = 4.0;           ///< cells along a wall in which both faces are looked for
constexpr double kLeastShare = 0.05;     ///< of the hits, on boards: a single one does not tell where the others stand
constexpr float kThickest = 1.0F;        ///< cells between the faces of a wall that counts by its middle

}  // namespace

void WallPhase::Mean::add(double place) {
  cosine_ += std::cos(2.0 * kPi * place);
  sine_ += std::sin(2.0 * kPi * place);
  count_ += 1.0;
}

bool WallPhase::Mean::sure() const {
  return count_ >= kLeastWallHits && cosine_ * cosine_ + sine_ * sine_ >= kSure * count_;
}

double WallPhase::Mean::place() const { return std::atan2(sine_, cosine_) / (2.0 * kPi); }

void WallPhase::add(double across, double along, bool up) {
  faces_.add(across);
  hits_.push_back({static_cast<int>(std::floor(along / kStrip)), static_cast<float>(across), up});
}

/// Of each hit and the mean of those on the other face.
WallPhase::Mean WallPhase::middles() const {
  struct Face {
    double sum = 0.0;
    double count = 0.0;
  };
  const auto before = [](const Hit& a, const Hit& b) {
    return std::tie(a.strip, a.across) < std::tie(b.strip, b.across);
  };
  std::vector<Hit> hits = hits_;
  std::sort(hits.begin(), hits.end(), [](const Hit& a, const Hit& b) {
    return std::tie(a.strip, a.across, a.up) < std::tie(b.strip, b.across, b.up);
  });
  Mean out;
  std::array<Face, 2> near;  // down and up: of the hits from `low` to `high`
  std::size_t low = 0;
  std::size_t high = 0;
  const auto count = [&](const Hit& hit, double by) {
    near[hit.up ? 1 : 0].sum += by * static_cast<double>(hit.across);
    near[hit.up ? 1 : 0].count += by;
  };
  for (const Hit& hit : hits) {
    for (; high < hits.size() && before(hits[high], {hit.strip, hit.across + kThickest, hit.up}); ++high)
      count(hits[high], 1.0);
    for (; before(hits[low], {hit.strip, hit.across - kThickest, hit.up}); ++low) count(hits[low], -1.0);
    const Face& other = near[hit.up ? 0 : 1];
    if (other.count > 0.0) out.add(0.5 * (static_cast<double>(hit.across) + other.sum / other.count));
  }
  return out;
}

double WallPhase::shift(double origin) const {
  const Mean middle = middles();
  const bool boards = middle.sure() && middle.count() >= kLeastShare * static_cast<double>(hits_.size());
  const Mean& walls = boards ? middle : faces_;
  if (!walls.sure()) return 0.0;
  const double off = walls.place() - 0.5 - origin;
  return off - std::round(off);
}

}  // namespace rubble::slam
