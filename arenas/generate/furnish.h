#pragma once

#include <string>
#include <vector>

#include "arenas/generate/maze.h"
#include "arenas/model/arena.h"
#include "arenas/model/relief.h"

namespace rubble::arenas {

/// A victim of a generated arena; its box stands in `cell`.
struct PlacedVictim {
  Cell cell;
  mrpt::math::TPoint2D position;  ///< middle of the box [m]
  int facing = 0;                 ///< quarter turns from east
  bool appearance = true, heat = true, sound = false, co2 = false;
};

/// What lies and stands about in a generated arena.
struct Furniture {
  std::vector<PlacedVictim> victims;
  std::vector<Outline> sheets;
  std::vector<PaperBall> balls;
};

/// Puts `count` victims into boxes against walls, one a pallet, never in a `taken` one (the start's, obstacles'); dead
/// ends and corners come first, flat ones before ramps. Beside a box 0.8 m stay free.
std::vector<PlacedVictim> place_victims(const Relief& relief, const Maze& maze, const std::vector<Cell>& taken,
                                        int count, Rng& rng);

/// Leaves of `sound` victims the sound alone and of `co2` others the CO2 alone, drawn among all.
void hide_victims(int sound, int co2, Rng& rng, std::vector<PlacedVictim>& victims);

/// Adds loose sheets (and in about half of the pallets crumpled balls) to `cells` random pallets that are neither
/// `taken` nor a victim's.
void scatter_paper(const Relief& relief, std::vector<Cell> taken, int cells, Rng& rng, Furniture& furniture);

}  // namespace rubble::arenas
