#pragma once

#include <mrpt/math/TPoint2D.h>
#include <mrpt/math/TPose2D.h>

#include <cstddef>
#include <cstdint>
#include <vector>

#include "base/angle.h"
#include "explore/plan/traversable.h"

namespace rubble::explore {

/// When faces are looked at squarely, once all else was searched. `Holes`: where a victim was found behind a hole in a
/// wall, for there will be more of them.
enum class SquareLook { Never, Holes, Always };

/// How far microphones and a CO2 probe make the robot drive: to what they may have told of only, or until all floor was
/// listened to and smelt as well.
enum class OtherSearch { Suspects, Everywhere };

/// What the explorer counts on from the robot's victim sensors.
struct SearchConfig {
  bool on = true;                           ///< look for victims everywhere before finishing
  bool faces = true;                        ///< of walls as well; false: floor alone, as the paper looks at it
  double field_of_view = deg_to_rad(50.0);  ///< full angle, ahead of the robot; less than the sensor's: poses err
  double range = 1.8;                       ///< [m]; likewise
  int min_cells = 8;                        ///< smaller unsearched places are left alone
  bool low_walls = true;                    ///< no look goes past what most scans pass over (`Traversable::seen_over`)
  double stare = 3.0;                       ///< a cue not yet confirmed holds the robot so long [s]
  int stares = 1;                           ///< cues in different places do, within four times that
  SquareLook squarely = SquareLook::Holes;  ///< in the end, look squarely at each face as well
  OtherSearch other_senses = OtherSearch::Suspects;  ///< what they make the robot drive to
  double dwell = 1.2;                                ///< time at a viewpoint, facing the place to search [s]
};

/// What has to be looked at in a cell of free floor, and what was: the floor itself, and the face of a wall at each of
/// its four sides.
using Faces = std::uint8_t;
constexpr Faces kFloor = 1;     ///< from anywhere
constexpr Faces kEastFace = 2;  ///< of a wall to the east: looked at towards the east, and so on
constexpr Faces kNorthFace = 4;
constexpr Faces kWestFace = 8;
constexpr Faces kSouthFace = 16;

/// From where a look at a face counts.
struct Inspection {
  double incidence = deg_to_rad(60.0);  ///< from within so much of its normal [rad]
  double nearest = 0.0;                 ///< [m]
  double farthest = 20.0;               ///< [m]
};
/// Squarely, and from not too near: what lies in a box behind a hole in the wall, 0.3 to 0.9 m up, shows to a camera at
/// 0.5 m within 20 to 30 deg of the hole's axis and up to 1.5 m away (boxed victims of the competition's arenas). The
/// highest hole shows its box from 0.56 m on; from the middle of a lane of one pallet, 0.5 to 0.6 m, all others do, and
/// asked for more a look from there would be made again and again. Viewpoints keep to 0.65 to 1.65 m.
constexpr Inspection kSquarely{deg_to_rad(27.0), 0.5, 1.75};

/// The faces that can be inspected along a direction (unit vector): those whose normal is within `incidence` of it.
Faces faces_along(double x, double y, double incidence = Inspection{}.incidence);
/// What there is to be looked at in a cell.
Faces faces_of(const Traversable& floor, Cell c);

/// The free floor in view from a pose: in the cone of the victim sensors, in range, nothing occupied or unknown
/// between, nor what most scans pass over.
struct FloorInView {
  struct Ray {
    double dx, dy;           ///< its direction
    std::size_t first, end;  ///< of its cells
  };
  double step = 0.0;  ///< between cells of a ray [m]; neighbours may be the same
  std::vector<Ray> rays;
  std::vector<Cell> cells;  ///< those of the rays; what is behind the last one's end is of no use
  Cell low, high;           ///< the corners of the rectangle that holds them
};

/// The floor and the wall faces the victim sensors have looked at. Places mapped from afar are known but not searched
/// ("inner exploration"); a wall passed by at a grazing angle is not either, for what hangs on it or stands behind its
/// holes was not to be seen. A single look may overlook something, so a place counts after two.
class SearchedArea {
 public:
  explicit SearchedArea(const SearchConfig& config, const Inspection& inspection = {})
      : config_(config), inspection_(inspection) {}

  /// Marks what is in view of `floor`. Says whether that changed the record.
  bool look(const Traversable& floor, const FloorInView& view);
  /// The same with what a look saw before, on a map that has this frame now; what lies beyond it is left out.
  bool look(const GridFrame& frame, const Grid<Faces>& seen);
  /// What the last look at a floor saw, in the rectangle that holds it.
  const Grid<Faces>& seen() const { return seen_; }
  /// Counts `faces` within `radius` of a place that turned out not to be visible as looked at.
  void give_up(const Traversable& floor, const mrpt::math::TPoint2D& place, double radius, Faces faces);
  /// Whether the floor at a place, or a cell beside it, was looked at [map frame, m]; what was given up after less than
  /// one look was not.
  bool saw(const mrpt::math::TPoint2D& place) const;
  /// What was looked at in a cell of a map.
  Faces looked_at(const GridFrame& frame, Cell c) const;
  /// What is left to be looked at in a cell of `floor`.
  Faces missing(const Traversable& floor, Cell c) const;
  /// The same of all free cells; the outermost cells are 0.
  Grid<Faces> unsearched(const Traversable& floor) const;
  /// Forgets everything, for the map was corrected.
  void clear() { once_ = twice_ = Grid<Faces>(); }

 private:
  /// What to add to a cell of `frame` to get the record's own.
  Cell shift_from(const GridFrame& frame) const;
  void cover(const GridFrame& frame);

  SearchConfig config_;
  Inspection inspection_;
  Grid<Faces> once_;
  Grid<Faces> twice_;
  Grid<Faces> seen_;
};

/// What the sensors see from T_map_base; `view` is written anew, and keeps its memory.
void see_floor(const Traversable& floor, const SearchConfig& config, const mrpt::math::TPose2D& T_map_base,
               FloorInView& view);

/// Whether a wall face of a cell is the back of a niche: walls stand to both sides of it, 0.2 to 0.55 m apart. A box
/// that is open on one side, as victims lie in (paper, section II.B), looks so from its open side.
bool in_niche(const Traversable& floor, Cell c, Faces faces);

/// Which places to find viewpoints for. `Squarely`: faces that were not looked at so.
enum class Subjects { All, Niches, Squarely };

constexpr int kDirections = 16;  ///< viewpoints tried around a subject
/// Steps in all directions from a place to those around it that are so far away and no farther than `range` [m].
std::vector<Cell> steps_around(const std::vector<double>& distances, double range, double cell,
                               int directions = kDirections);

constexpr double kAtViewpoint = 0.12;  ///< viewpoints this close are served from where the robot stands [m]

constexpr double kFaceStride = 0.20;  ///< subjects along a wall are so far apart, about [m]
/// The whole number of cells that is nearest to a length, one at least.
int cells_apart(double length, double cell);

/// A place from which something unsearched can be seen.
struct Viewpoint {
  Cell cell;
  mrpt::math::TPoint2D subject;  ///< what to face there [m]
  Faces faces = 0;               ///< what can be inspected of it from there
};

/// Viewpoints with at least `room` clearance for every unsearched cluster of free floor, in raster order; where a place
/// has none, as before a victim's box in a corridor, with at least `tight`. Those squarely before a face go first: what
/// is looked at so once need not be looked at again. `searched`: the record that belongs to `subjects`.
std::vector<Viewpoint> viewpoints(const Traversable& floor, const SearchedArea& searched, const SearchConfig& config,
                                  double room, double tight, Subjects subjects = Subjects::All);

/// The cells with the holes in walls as wall: gaps of 0.2 m at the most in a row of occupied cells. Where the scanner
/// looks through a hole its wall has no face, and what is behind the hole would be left out.
OccupancyGrid with_holes_shut(const OccupancyGrid& cells);

/// True when all cells between two cells of the floor are free (the last one included).
bool in_sight(const Traversable& floor, Cell from, Cell to);
/// The same, and nothing that most scans pass over hides the second from a camera.
bool in_view(const Traversable& floor, Cell from, Cell to);

}  // namespace rubble::explore
