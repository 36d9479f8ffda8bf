#include "explore/caution/local_grids.h"

#include <cmath>
#include <utility>

namespace rubble::explore {
namespace {

constexpr double kTile = 4.0;  ///< places in a square of this size share a grid [m]

}  // namespace

const std::optional<PalletGrid>& LocalGrids::at(const mrpt::math::TPoint2D& p_map) {
  const auto tile = [](double x) { return static_cast<int>(std::floor(x / kTile)); };
  const std::pair<int, int> key{tile(p_map.x), tile(p_map.y)};
  if (last_grid_ == nullptr || key != last_key_) {
    last_grid_ = &of_square(key);
    last_key_ = key;
  }
  return *last_grid_;
}

const std::optional<PalletGrid>& LocalGrids::of_square(const std::pair<int, int>& key) {
  const auto known = grids_.find(key);
  if (known != grids_.end()) return known->second;
  const mrpt::math::TPoint2D middle{(key.first + 0.5) * kTile, (key.second + 0.5) * kTile};
  WallsAbout walls(cells_, middle);
  if (known_ == nullptr) return grids_.emplace(key, walls.pallets(pallet_)).first->second;
  KnownGrid& before = (*known_)[key];
  if (!(before.walls == walls)) {
    before.grid = walls.pallets(pallet_);
    before.walls = std::move(walls);
  }
  return grids_.emplace(key, before.grid).first->second;
}

const std::optional<PalletGrid>& LocalGrids::near(const mrpt::math::TPoint2D& p_map) {
  for (const mrpt::math::TPoint2D& off :
       {mrpt::math::TPoint2D{0.0, 0.0}, {kTile, 0.0}, {0.0, kTile}, {-kTile, 0.0}, {0.0, -kTile}})
    if (const std::optional<PalletGrid>& grid = at(p_map + off)) return grid;
  return at(p_map);
}

}  // namespace rubble::explore
