#include "slam/grid/count_tiles.h"

#include <algorithm>
#include <new>
#include <utility>

namespace rubble::slam {

namespace {

/// Tiles that fill a page of 2 MB.
constexpr std::size_t kSlab = (std::size_t{1} << 21U) / sizeof(CountTiles::Tile);
const CountTiles::Tile kNothing{};

int tiles_over(int cells) { return (cells + CountTiles::kSide - 1) / CountTiles::kSide; }

}  // namespace

CountTiles::CountTiles(int width, int height) {
  lay_out(width, height);
  take_slab(std::min(tiles_.size(), kSlab));
}

CountTiles::CountTiles(const CountTiles& other)
    : across_(other.across_),
      down_(other.down_),
      tiles_(other.tiles_.size(), nullptr),
      shown_(other.tiles_.size(), &kNothing) {
  for (std::size_t i = 0; i < tiles_.size(); ++i)
    if (other.tiles_[i] != nullptr) open(i) = *other.tiles_[i];
}

CountTiles& CountTiles::operator=(const CountTiles& other) {
  CountTiles copy(other);
  return *this = std::move(copy);
}

void CountTiles::lay_out(int width, int height) {
  across_ = tiles_over(width);
  down_ = tiles_over(height);
  const std::size_t count = static_cast<std::size_t>(across_) * static_cast<std::size_t>(down_);
  tiles_.assign(count, nullptr);
  shown_.assign(count, &kNothing);
}

CountTiles::Tile& CountTiles::open(std::size_t number) {
  void* place = nullptr;
  if (!given_back_.empty()) {
    place = given_back_.back();
    given_back_.pop_back();
  } else {
    if (left_ == 0) take_slab(kSlab);
    place = slabs_.back().data() + (slab_ - left_--) * sizeof(Tile);
  }
  Tile* const tile = new (place) Tile{};  // zeros: touched tile by tile, not a slab at once
  tiles_[number] = tile;
  shown_[number] = tile;
  return *tile;
}

void CountTiles::swap(CountTiles& other) noexcept {
  std::swap(across_, other.across_);
  std::swap(down_, other.down_);
  std::swap(tiles_, other.tiles_);
  std::swap(shown_, other.shown_);
  std::swap(slabs_, other.slabs_);
  std::swap(slab_, other.slab_);
  std::swap(left_, other.left_);
  std::swap(given_back_, other.given_back_);
}

void CountTiles::take_slab(std::size_t tiles) {
  slabs_.emplace_back(tiles * sizeof(Tile));
  slab_ = left_ = tiles;
}

void CountTiles::clear(int width, int height) {
  for (Tile* const tile : tiles_)
    if (tile != nullptr) given_back_.push_back(tile);
  lay_out(width, height);
}

void CountTiles::grow(int dx, int dy, int width, int height) {
  const std::vector<Tile*> before = std::move(tiles_);
  const int across = across_, down = down_;
  lay_out(width, height);
  for (int y = 0; y < down; ++y)
    for (int x = 0; x < across; ++x) {
      Tile* const tile = before[static_cast<std::size_t>(y * across + x)];
      if (tile == nullptr) continue;
      const std::size_t now = number({x * kSide + dx, y * kSide + dy});
      tiles_[now] = tile;
      shown_[now] = tile;
    }
}

}  // namespace rubble::slam
