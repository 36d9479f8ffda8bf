#include "scoring/walls/wall_errors.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <utility>

namespace rubble::scoring {
namespace {

constexpr double kWindow = 1.2;       // a pallet [m]
constexpr double kWorthSaying = 0.1;  // [m]

using Windows = std::map<std::pair<long, long>, WrongPlace>;

/// Adds what is wrong to its window; returns the length in all [m].
double collect(const std::vector<WallOverlap::Hit>& hits, double cell_length, double WrongPlace::*kind,
               Windows& windows) {
  double total = 0.0;
  for (const WallOverlap::Hit& hit : hits) {
    const double wrong = (1.0 - hit.k) * cell_length;
    if (wrong <= 0.0) continue;
    total += wrong;
    WrongPlace& place =
        windows[{std::lround(std::floor(hit.p_truth.y / kWindow)), std::lround(std::floor(hit.p_truth.x / kWindow))}];
    const double before = place.wrong_m();
    place.*kind += wrong;
    place.p_truth += (hit.p_truth - place.p_truth) * (wrong / (before + wrong));
  }
  return total;
}

}  // namespace

WallErrors wall_errors(const WallOverlap& walls, const PlanarTransform& T_truth_map, std::size_t places) {
  WallErrors out;
  Windows windows;
  for (const WallOverlap::Hit& hit : walls.ignored_hits(T_truth_map))
    out.ignored_m += (1.0 - hit.k) * walls.map_length_of_cell();
  out.phantom_m = collect(walls.map_hits(T_truth_map), walls.map_length_of_cell(), &WrongPlace::phantom_m, windows);
  out.missing_m = collect(walls.truth_hits(T_truth_map), walls.truth_length_of_cell(), &WrongPlace::missing_m, windows);
  constexpr double kLeastGap = kWindow / 3.0;  // of a pallet between two others tau takes most of the rest
  for (const auto& [window, place] : windows)
    if (place.missing_m >= kLeastGap) out.gaps_m += place.missing_m;
  for (const auto& [window, place] : windows)
    if (place.wrong_m() >= kWorthSaying) out.worst.push_back(place);
  std::stable_sort(out.worst.begin(), out.worst.end(),
                   [](const WrongPlace& a, const WrongPlace& b) { return a.wrong_m() > b.wrong_m(); });
  if (out.worst.size() > places) out.worst.resize(places);
  return out;
}

}  // namespace rubble::scoring
