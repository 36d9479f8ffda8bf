#include "scenarios/run/first_seen.h"

#include <cstdint>
#include <limits>
#include <utility>

namespace rubble::scenarios {
namespace {

constexpr float kNever = std::numeric_limits<float>::infinity();

}  // namespace

/// The map grew, or begins anew elsewhere: places stay.
void FirstSeen::cover(const GridFrame& frame) {
  if (frame == first_.frame()) return;
  Grid<float> wider(frame, kNever);
  for (int y = 0; y < first_.height(); ++y)
    for (int x = 0; x < first_.width(); ++x) {
      const Cell c = wider.cell(first_.centre({x, y}));
      if (wider.inside(c)) wider[c] = first_[{x, y}];
    }
  first_ = std::move(wider);
}

void FirstSeen::note(const slam::CountMap& map, double time) {
  cover(map.frame());
  const auto now = static_cast<float>(time);
  for (int y = 0; y < first_.height(); ++y) {
    float* const row = first_.row(y);
    map.for_seen(y, 0, first_.width(), [&](int x, int count, const std::uint16_t* seen, const std::uint16_t*) {
      float* const first = row + x;
      // A cell that stays is written as well: free of branches, so that compilers use vector code.
      for (int i = 0; i < count; ++i) first[i] = seen[i] != 0 && first[i] == kNever ? now : first[i];
    });
  }
}

double FirstSeen::at(const mrpt::math::TPoint2D& p_map) const {
  const Cell c = first_.cell(p_map);
  return first_.inside(c) ? static_cast<double>(first_[c]) : static_cast<double>(kNever);
}

}  // namespace rubble::scenarios
