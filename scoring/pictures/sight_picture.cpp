#include "scoring/pictures/sight_picture.h"

#include <algorithm>

#include "base/image/png.h"
#include "base/text/text_file.h"
#include "scoring/measures/sight_places.h"
#include "scoring/pictures/canvas.h"
#include "scoring/walls/resample.h"
#include "scoring/walls/wall_field.h"

namespace rubble::scoring {
namespace {

using mrpt::math::TPoint2D;
using mrpt::math::TPose2D;

constexpr double kLeastTile = 0.15;  // [m]
constexpr double kTilesASide = 60.0;
constexpr double kSameWall = 0.15;  // of the map and of the truth [m]
constexpr double kFaint = 0.25;     // of the mean weight of a tile: what is asked less than that is drawn paler

const Colour kRight(185, 225, 185);
const Colour kNotSaid(110, 215, 250);
const Colour kMapWall(130, 130, 130);

/// What the lines say that are answered in a tile, by weight.
struct Tile {
  double asked = 0.0;
  double drawn = 0.0;
  double missed = 0.0;
  double unknown = 0.0;

  void add(const SightPlace& place) {
    asked += place.asked;
    drawn += place.drawn;
    missed += place.missed;
    unknown += place.unknown;
  }
  Colour colour() const {
    const double right = std::max(0.0, asked - drawn - missed - unknown);
    Colour out;
    for (int i = 0; i < 3; ++i)
      out[i] = cv::saturate_cast<unsigned char>(
          (right * kRight[i] + drawn * kMapOnly[i] + missed * kTruthOnly[i] + unknown * kNotSaid[i]) / asked);
    return out;
  }
};

/// The frame of the tiles over all that the truth knows.
GridFrame tile_frame(const OccupancyGrid& truth) {
  GridFrame f = known_frame(truth, kLeastTile).value_or(truth.frame());
  const double side = f.resolution * std::max(f.width, f.height);
  const double tile = std::max(kLeastTile, side / kTilesASide);
  f.width = static_cast<int>(f.width * f.resolution / tile) + 1;
  f.height = static_cast<int>(f.height * f.resolution / tile) + 1;
  f.resolution = tile;
  return f;
}

Grid<Tile> tiles_of(const OccupancyGrid& truth, const std::vector<SightPlace>& places) {
  Grid<Tile> tiles(tile_frame(truth));
  for (const SightPlace& place : places)
    if (const Cell c = tiles.cell(place.p); tiles.inside(c)) tiles[c].add(place);
  return tiles;
}

double mean_asked(const Grid<Tile>& tiles) {
  double sum = 0.0;
  double count = 0.0;
  for (const Tile& tile : tiles.cells()) {
    sum += tile.asked;
    count += tile.asked > 0.0 ? 1.0 : 0.0;
  }
  return count > 0.0 ? sum / count : 0.0;
}

}  // namespace

std::string sight_map_png(const OccupancyGrid& map, const OccupancyGrid& truth, const TPose2D& T_truth_map) {
  const SightLines lines(truth);
  const PlanarTransform T(T_truth_map);
  const Grid<Tile> tiles = tiles_of(truth, sight_places(lines, SightMap(map), T));
  const double enough = kFaint * mean_asked(tiles);
  const WallField walls(truth, 0.5);
  Canvas canvas(common_frame(map, truth, T_truth_map, 0.5));
  for (int row = 0; row < canvas.map_rows(); ++row)
    for (int column = 0; column < canvas.map_columns(); ++column) {
      const TPoint2D p_truth = canvas.point(column, row);
      const Occupancy in_truth = occupancy_at(truth, p_truth);
      Colour& colour = canvas.image.at<Colour>(row, column);
      colour = in_truth == Occupancy::Unknown ? kUnknown : kBothFree;
      if (const Cell c = tiles.cell(p_truth); tiles.inside(c) && tiles[c].asked > 0.0)
        colour = mixed(colour, tiles[c].colour(), std::min(1.0, tiles[c].asked / enough));
      if (in_truth == Occupancy::Occupied)
        colour = kInk;
      else if (in_truth == Occupancy::Free && walls.distance(p_truth) > kSameWall &&
               occupancy_at(map, T.inverse(p_truth)) == Occupancy::Occupied)
        colour = kMapWall;
    }
  if (!lines.usable()) draw_warning(canvas, "too few lines of sight: the score is the overlap");
  draw_legend(canvas.image,
              {{kRight, "lines of sight: right"},
               {kMapOnly, "blocked on the map, open in truth"},
               {kTruthOnly, "wall missing or elsewhere"},
               {kNotSaid, "not known to the map"},
               {kBothFree, "not asked"},
               {kInk, "wall of the truth"},
               {kMapWall, "of the map alone"}},
              canvas.frame, canvas.scale);
  return png_bytes(canvas.image);
}

void write_sight_map(const std::string& path, const OccupancyGrid& map, const OccupancyGrid& truth,
                     const TPose2D& T_truth_map) {
  write_text_file(path, sight_map_png(map, truth, T_truth_map));
}

}  // namespace rubble::scoring
