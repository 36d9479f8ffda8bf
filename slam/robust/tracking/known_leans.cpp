#include "slam/robust/tracking/known_leans.h"

#include <algorithm>
#include <cmath>

#include "base/angle.h"
#include "base/planar.h"
#include "slam/robust/graph/known_ground.h"

namespace rubble::slam {

using mrpt::math::TPose2D;

namespace {

constexpr double kSamePlace = 0.02;      ///< the floor does not change within so little [m]
constexpr std::size_t kMostAround = 64;  ///< a key frame
constexpr Work kWorkPerLean = 10;

}  // namespace

Lean Lean::turned(double angle) const {
  const double c = std::cos(angle), s = std::sin(angle);
  return {c * pitch + s * roll, c * roll - s * pitch};
}

void KnownLeans::add(int frame, const TPose2D& T_frame_base, const Lean& lean) {
  const auto index = static_cast<std::size_t>(frame);
  if (index >= places_.size()) places_.resize(index + 1);
  Place& place = places_[index];
  place.reach = std::max(place.reach, length(T_frame_base.x, T_frame_base.y));
  for (Felt& felt : place.felt)
    if (distance(position(felt.T_frame_base), position(T_frame_base)) < kSamePlace) {
      felt = {T_frame_base, lean};
      return;
    }
  if (place.felt.size() < kMostAround) {
    place.felt.push_back({T_frame_base, lean});
    return;
  }
  place.felt[place.oldest] = {T_frame_base, lean};
  place.oldest = (place.oldest + 1) % kMostAround;
}

Lean KnownLeans::nearest(const KeyFrames& frames, const TPose2D& T_map_base, double distance, Work* work) const {
  double nearest = distance;
  Lean lean;
  if (work != nullptr) *work += static_cast<Work>(places_.size());
  for (std::size_t i = 0; i < places_.size(); ++i) {
    const Place& place = places_[i];
    const TPose2D& T_map_frame = frames.pose(static_cast<int>(i));
    if (length(T_map_frame.x - T_map_base.x, T_map_frame.y - T_map_base.y) >= nearest + place.reach) continue;
    if (work != nullptr) *work += kWorkPerLean * static_cast<Work>(place.felt.size());
    for (const Felt& felt : place.felt) {
      const TPose2D then = T_map_frame + felt.T_frame_base;
      const double away = length(then.x - T_map_base.x, then.y - T_map_base.y);
      if (away >= nearest) continue;
      nearest = away;
      lean = felt.lean.turned(wrap_angle(T_map_base.phi - then.phi));
    }
  }
  return lean;
}

void KnownLeans::shift(int by) { places_.insert(places_.begin(), static_cast<std::size_t>(by), Place{}); }

KnownLeans KnownLeans::on(const KeyFrames& map, const KeyFrames& drive, const TPose2D& T_map_drive) const {
  KnownLeans moved;
  for (std::size_t i = 0; i < places_.size(); ++i) {
    if (places_[i].felt.empty()) continue;
    const TPose2D T_map_frame = T_map_drive + drive.pose(static_cast<int>(i));
    const int frame = closest_frame(map, T_map_frame);
    for (const Felt& felt : places_[i].felt)
      moved.add(frame, T_map_frame + felt.T_frame_base - map.pose(frame), felt.lean);
  }
  return moved;
}

std::size_t KnownLeans::size() const {
  std::size_t all = 0;
  for (const Place& place : places_) all += place.felt.size();
  return all;
}

}  // namespace rubble::slam
