#pragma once

#include <mrpt/math/TPoint2D.h>
#include <mrpt/math/TPose2D.h>

#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "scoring/alignment/feature_verdict.h"
#include "scoring/maps/pois.h"
#include "scoring/rooms/room_match.h"
#include "scoring/scorecard.h"

namespace rubble::scoring {

/// A place that is marked on a picture of one map.
struct Mark {
  mrpt::math::TPoint2D p;                                                    ///< in that map's own coordinates [m]
  std::string name;                                                          ///< may be empty
  std::optional<std::pair<mrpt::math::TPoint2D, mrpt::math::TPoint2D>> box;  ///< least and greatest corner
};

/// What two maps have in common and what only one of them has, as Fig. 12 shows it: victims, features or rooms.
struct Marks {
  std::string what;                          ///< "victims", "SURF", "corners", "rooms"
  std::vector<std::pair<Mark, Mark>> pairs;  ///< of the map and of the truth
  std::vector<Mark> map_only;                ///< outliers: of the map, without partner
  std::vector<Mark> truth_only;
  std::vector<Mark> unjudged{};  ///< of the map, where nobody says what the truth has
  /// Where a map came apart into two parts, in the truth [m].
  std::optional<std::pair<mrpt::math::TPoint2D, mrpt::math::TPoint2D>> seam{};
};

/// What a victim of the truth is called beside those that were reported: "true victim2", "true victim hall". The
/// truth's own names, as its arena file has them, are no numbers of reports.
std::string true_victim_name(const std::string& name);

/// "victim 3 = true victim2"; of a report without a name the other's alone.
std::string joined_name(const Mark& map, const Mark& truth);

Marks marks_of(const KindScore& features);
Marks marks_of(const Rooms& map, const Rooms& truth, const RoomMatch& match);
/// Victims reported and true, paired as victims are found: one to one within 1.2 m at the pose.
Marks marks_of(const std::vector<Poi>& reported, const std::vector<Poi>& victims,
               const mrpt::math::TPose2D& T_truth_map);

/// The victims, and the seam where the map came apart: what stands on the overlay of a map that was scored.
/// `listed`: there is a list of the true victims; without one nothing says which of the reported ones are.
Marks marks_on_overlay(const MapScore& score, const std::vector<Poi>& reported, const std::vector<Poi>& victims,
                       bool listed);

/// What a page shows of a map that was scored: victims first, then the features of eq. (7), where they were asked for;
/// of these `rooms` as room_marks() has them.
std::vector<Marks> marks_on_page(const MapScore& score, const Marks& victims, const Marks& rooms);

}  // namespace rubble::scoring
