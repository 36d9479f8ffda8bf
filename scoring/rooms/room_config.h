#pragma once

#include <cstddef>

namespace rubble::scoring {

enum class RoomMethod {
  Passages,   ///< rooms are what remains when doors and other narrow places are closed
  Visibility  ///< wall control points clustered by what they see, as the paper has it (section IV.E)
};

/// Lengths in metres. The defaults were chosen on half of the public floor maps: docs/rooms.md.
struct RoomConfig {
  RoomMethod method = RoomMethod::Passages;

  double clutter_area = 0.45;         ///< obstacles smaller than this [m^2] ...
  double clutter_extent = 1.1;        ///< ... and than this across, that touch no wall, are furniture and taken away
  double dots_reach = 0.05;           ///< but a row of them, each nearer to the next than twice this, is a dotted wall
  double slit = 0.2;                  ///< holes in walls and gaps behind furniture narrower than this are closed
  double least_area = 1.5;            ///< smaller rooms join the neighbour with the widest passage [m^2]
  double least_isolated = 0.3;        ///< smaller free areas without any passage are no rooms [m^2]
  double niche_area = 2.5;            ///< furniture at a wall up to this size [m^2] ...
  double niche_least = 0.3;           ///< ... and between this ...
  double niche_depth = 0.9;           ///< ... and this deep belongs to the room's area
  double niche_core = 0.6;            ///< parts of a room narrower than twice this do not decide what lies inside it
  double finest = 0.05;               ///< finer maps are reduced to cells of this size
  std::size_t most_cells = 1u << 24;  ///< larger maps are reduced until they have fewer cells

  // Passages
  double turn_scale = 0.3;          ///< a wall's direction is taken over this length on both sides of a corner
  double least_turn = 0.6;          ///< corners that turn less into the room are none [rad]
  std::size_t most_corners = 2000;  ///< floors with more are no floor plans: they have no rooms
  double narrowest = 0.09;          ///< passages are between this ...
  double widest = 4.5;              ///< ... and this wide
  double openness = 0.69;     ///< share of the half disc, as wide as the passage, that is seen from it on either side
  double least_reach = 0.8;   ///< radius of that half disc at the least
  double hall_ratio = 2.1;    ///< a corridor ends where a hall this many times as wide begins
  double hall_reach = 2.5;    ///< how far to look for the hall, in widths of the corridor
  double corridor_min = 0.8;  ///< widths of corridors
  double corridor_max = 4.0;
  double corridor_depth = 1.2;  ///< a corridor is at least so many widths long

  // Visibility
  double spacing = 0.25;           ///< of wall control points along the wall
  double offset = 0.15;            ///< of wall control points from the wall
  std::size_t most_points = 1500;  ///< the spacing grows until there are no more
  double sight = 6.0;              ///< points see each other up to here
  int phantom_cells = 1;           ///< so many occupied cells do not stop the view
  double similarity = 0.2;         ///< clusters of which less is seen in common (Jaccard) stay apart
};

}  // namespace rubble::scoring
