#pragma once

#include "scoring/measures/sight.h"
#include "scoring/measures/sight_lines.h"

namespace rubble::scoring {

/// What a map says about one line.
struct SightWord {
  double known = 0.0;  ///< 0..1: how much of the question it answers
  double right = 0.0;  ///< -known..known
};

/// What the walls that a map draws on a blocked line are, and how near the best comes to the right one.
struct DrawnOnBlocked {
  /// `raster`: raster_of() the map.
  DrawnOnBlocked(const SightLines::Line& line, const Sight& sight, double raster);
  /// -1..1. A wall drawn twice is half wrong.
  double right() const;
  double all = 0.0;
  double best = 0.0;
  std::size_t nearest = 0;  ///< the wall that is best, where there is one
};

/// Of the walls that a map draws on an open line, 0..1.
double drawn_on_open(const Sight& sight);

/// A wall that is drawn answers in full, seen from one side or both; none does where its place is known.
SightWord word_on_blocked(const SightLines::Line& line, const Sight& sight, double raster);
/// An open line is known as far as the places are at which a wall might block it.
SightWord word_on_open(const SightLines::Line& line, const Sight& sight);

/// What drawing on a raster moves a wall by, which costs nothing [m].
double raster_of(const OccupancyGrid& map, SightLines::Credit credit);

}  // namespace rubble::scoring
