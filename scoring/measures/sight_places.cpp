#include "scoring/measures/sight_places.h"

#include <algorithm>

#include "scoring/measures/sight.h"
#include "scoring/measures/sight_words.h"

namespace rubble::scoring {
namespace {

using mrpt::math::TPoint2D;

TPoint2D point_on(const SightLines::Line& line, double at) {
  const TPoint2D along = line.to - line.from;
  return line.from + along * (at / along.norm());
}

/// What is wrong with the wall lies where it stands; other walls drawn on the line lie where they are drawn.
void answer_blocked(const SightLines::Line& line, const Sight& sight, double raster, std::vector<SightPlace>& out) {
  const double known = word_on_blocked(line, sight, raster).known;
  const DrawnOnBlocked drawn(line, sight, raster);
  const double again = drawn.best * (1.0 - 1.0 / std::max(1.0, drawn.all));
  double others = 0.0;
  for (std::size_t i = 0; i < sight.walls.size(); ++i) others += i == drawn.nearest ? 0.0 : sight.walls[i].strength;
  SightPlace at_wall{point_on(line, line.middle), line.weight, 0.0, 0.0, 0.0};
  at_wall.missed = line.weight * known * (1.0 - drawn.best);
  at_wall.unknown = line.weight * (1.0 - known);
  for (std::size_t i = 0; i < sight.walls.size() && others > 0.0; ++i) {
    const double weight = line.weight * known * again * (i == drawn.nearest ? 0.0 : sight.walls[i].strength / others);
    if (weight <= 0.0) continue;
    at_wall.asked -= weight;
    out.push_back({point_on(line, sight.walls[i].middle()), weight, weight, 0.0, 0.0});
  }
  out.push_back(at_wall);
}

void answer_open(const SightLines::Line& line, const Sight& sight, std::vector<SightPlace>& out) {
  const double drawn = drawn_on_open(sight);
  const double known = word_on_open(line, sight).known;
  double all = 0.0;
  for (const Crossing& wall : sight.walls) all += wall.strength;
  for (const Crossing& wall : sight.walls) {
    const double weight = line.weight * drawn * wall.strength / all;
    out.push_back({point_on(line, wall.middle()), weight, weight, 0.0, 0.0});
  }
  // Of what is left, the places that the map does not see are unknown, as far as the line is.
  const auto is_seen = [&](float at) { return sight.sees(static_cast<double>(at)); };
  const auto seen = static_cast<double>(std::count_if(line.doubts.begin(), line.doubts.end(), is_seen));
  const double unseen = static_cast<double>(line.doubts.size()) - seen;
  for (const float at : line.doubts) {
    const double weight = line.weight * (is_seen(at) ? (known - drawn) / std::max(1.0, seen) : (1.0 - known) / unseen);
    if (weight <= 0.0) continue;
    out.push_back({point_on(line, static_cast<double>(at)), weight, 0.0, 0.0, is_seen(at) ? 0.0 : weight});
  }
}

}  // namespace

std::vector<SightPlace> sight_places(const SightLines& lines, const SightMap& map, const PlanarTransform& T_truth_map) {
  const SightGround ground(map);
  const double raster = raster_of(map.grid, SightLines::Credit::Located);
  std::vector<SightPlace> out;
  Sight sight;
  for (const SightLines::Line& line : lines.lines()) {
    const double length = (line.to - line.from).norm();
    ground.look(T_truth_map.inverse(line.from), T_truth_map.inverse(line.to), length, sight, line.unjudged);
    sight.close_holes(length);
    if (line.blocked)
      answer_blocked(line, sight, raster, out);
    else
      answer_open(line, sight, out);
  }
  return out;
}

}  // namespace rubble::scoring
