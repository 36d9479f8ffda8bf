#include "scoring/figures/rooms_entered.h"

#include <vector>

#include "scoring/rooms/rooms.h"

namespace rubble::scoring {
namespace {

constexpr double kFloorToStandOn = 0.25;  ///< of the robot's middle [m^2]

}  // namespace

RoomsEntered rooms_entered(const OccupancyGrid& truth, const Grid<std::uint8_t>& reachable, const Trajectory& path) {
  const Rooms found = extract_rooms(truth);
  std::vector<double> floor(found.rooms.size() + 1, 0.0);
  std::vector<bool> was_in(floor.size(), false);
  const auto room_at = [&](const mrpt::math::TPoint2D& p) -> std::size_t {
    if (found.rooms.empty()) return 0;
    const Cell c = found.labels.cell(p);
    return found.labels.inside(c) ? found.labels[c] : 0;
  };
  const double cell_area = truth.resolution() * truth.resolution();
  for (int y = 0; y < truth.height(); ++y)
    for (int x = 0; x < truth.width(); ++x)
      if (reachable[{x, y}] != 0) floor[room_at(truth.centre({x, y}))] += cell_area;
  for (const StampedPose& at : path) was_in[room_at({at.pose.x, at.pose.y})] = true;
  RoomsEntered out;
  for (std::size_t room = 1; room < floor.size(); ++room) {
    if (floor[room] < kFloorToStandOn) continue;
    ++out.reachable;
    if (was_in[room]) ++out.entered;
  }
  return out;
}

}  // namespace rubble::scoring
