#include "scoring/room_report.h"

#include "scoring/pictures/room_picture.h"
#include "scoring/scorecard.h"

namespace rubble::scoring {

Rooms rooms_of_map(const OccupancyGrid& map, bool by_sight) {
  RoomConfig config;
  if (by_sight) config.method = RoomMethod::Visibility;
  return extract_rooms(map, config);
}

void draw_rooms(const std::string& path, const OccupancyGrid& map, const Rooms& rooms) {
  write_rooms_png(path, map, rooms);
}

RoomVerdict judge_rooms(const OccupancyGrid& map, const OccupancyGrid& truth, const Rooms& of_truth, bool by_sight,
                        const std::optional<mrpt::math::TPose2D>& T_truth_map) {
  RoomVerdict out;
  if (T_truth_map) {
    out.aligned = true;
    out.T_truth_map = *T_truth_map;
  } else {
    const MapScore found = score_map(map, truth);
    out.aligned = found.aligned;
    out.note = found.note;
    out.T_truth_map = found.T_truth_map;
  }
  out.of_map =
      out.aligned && !by_sight ? extract_rooms_as(map, of_truth, out.T_truth_map) : rooms_of_map(map, by_sight);
  if (out.aligned) out.match = match_rooms(out.of_map, of_truth, out.T_truth_map);
  return out;
}

Marks room_marks(const OccupancyGrid& map, const OccupancyGrid& truth, const Rooms& of_truth,
                 const mrpt::math::TPose2D& T_truth_map) {
  const RoomVerdict found = judge_rooms(map, truth, of_truth, false, T_truth_map);
  return marks_of(found.of_map, of_truth, found.match);
}

}  // namespace rubble::scoring
