#pragma once

#include <mrpt/math/TPose2D.h>

#include <string>
#include <utility>
#include <vector>

#include "scoring/proposals/pose_guess.h"
#include "scoring/rooms/rooms.h"

namespace rubble::scoring {

/// A rigid transform that something in the two maps speaks for.
struct RigidHypothesis {
  mrpt::math::TPose2D T_truth_map;
  double score = 0.0;  ///< 1 - E / C, at most 1; comparable within one list, higher is better
  std::vector<std::pair<std::size_t, std::size_t>> matches;  ///< rooms of the map and of the truth that belong together
};

struct RoomMatchConfig {
  double distance_tolerance = 1.5;  ///< two rooms of one map are as far apart as in the other, to this [m]
  double least_baseline = 2.0;      ///< rooms nearer to each other do not fix a rotation [m]
  double most_difference = 2.0;     ///< rooms that differ by more are never a pair: d(f, g) of eq. (7)
  double lambda = 1.0;              ///< of eq. (7) [m^2]
  double cap = 2.0;                 ///< C: cost of a room without partner [m^2]
  std::size_t examined = 200;       ///< of all pairs of rooms, those that get the optimal association
  std::size_t most = 24;            ///< hypotheses returned
  std::size_t most_rooms = 100;     ///< in either map, and a fifth of its square in pairs of rooms
  double distinct_shift = 0.6;      ///< poses nearer than this and ...
  double distinct_turn = 0.05;      ///< ... turned by less are one [m, rad]
};

/// The rooms that belong together at a pose: eq. (7) (scoring/measures/association.h) with
/// c = squared distance + lambda d(f, g).
RigidHypothesis match_rooms(const std::vector<Room>& map, const std::vector<Room>& truth,
                            const mrpt::math::TPose2D& T_truth_map, const RoomMatchConfig& config = {});

/// More rooms than the time for all their pairs allows.
bool too_many(const std::vector<Room>& map, const std::vector<Room>& truth, const RoomMatchConfig& config = {});

/// Poses that lay two rooms of the map on two similar rooms of the truth, all such pairs tried, refitted to every room
/// that then has a partner; best first. Needs two rooms in either map and not too many, else none.
std::vector<RigidHypothesis> room_hypotheses(const std::vector<Room>& map, const std::vector<Room>& truth,
                                             const RoomMatchConfig& config = {});

struct RoomGuesses {
  std::vector<PoseGuess> guesses;
  std::string note;  ///< why rooms were not compared; empty: they were
};

/// The same from the maps themselves, cut into smaller pieces than rooms, which partial maps share more often; as
/// guesses for the alignment.
RoomGuesses propose_by_rooms(const OccupancyGrid& map, const OccupancyGrid& truth);

}  // namespace rubble::scoring
