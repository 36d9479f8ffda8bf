#include "scenarios/config/viewer.h"

#include "robot/body.h"

namespace rubble::scenarios {

arenas::Viewer viewer_of(const robot::RobotModel& model) {
  arenas::Viewer viewer;
  viewer.radius = 0.5 * model.width;
  viewer.height = robot::body_height(model);
  viewer.laser_height = model.T_base_laser.z;
  viewer.climbable_step = model.climbable_step;
  viewer.range = model.laser.range_max;
  return viewer;
}

}  // namespace rubble::scenarios
