#pragma once

#include <optional>
#include <vector>

#include "arenas/model/arena.h"
#include "robot/measurements.h"
#include "sim/laser/plane_cast.h"
#include "sim/laser/range_noise.h"
#include "sim/laser/ray_walk.h"
#include "sim/laser/rays.h"
#include "sim/laser/scan_faces.h"
#include "sim/laser/sweep_cast.h"

namespace rubble::sim {

/// When a rotating scanner measures: its rotor passes zero every scan_period; zero is 135 deg to the right of the front
/// (URG-04LX: step 0), and the scan is sent when the rotor has passed 135 deg to the left (step 768, 75 ms later).
struct SweepTimes {
  explicit SweepTimes(const robot::LaserModel& laser);
  double first_beam = 0.0;  ///< after rotor zero [s]
  double sent = 0.0;        ///< after rotor zero [s]
};

/// The scanner on its levelled platform. Phantom walls, walls missed and stretched ranges come out of the geometry.
/// While the robot moves every beam starts from its own pose; standing still, or without sweep, the whole scan is drawn
/// from one.
class Laser {
 public:
  Laser(const arenas::Arena& arena, const robot::RobotModel& model, double noise, bool sweep, std::uint64_t seed);
  Laser(const std::vector<arenas::Face>& faces, const robot::RobotModel& model, double noise, bool sweep,
        std::uint64_t seed);
  Laser(const Laser&) = delete;
  Laser& operator=(const Laser&) = delete;

  /// The scan whose beam 0 leaves at `first`; `states` cover the sweep. `balls`: where they are now. `moving`: faces
  /// of other robots and of loose objects, where they are now.
  robot::LaserScan scan(Stamp first, const std::vector<WorldState>& states, const std::vector<Sphere>& balls,
                        const std::vector<arenas::Face>& moving = {});

  const SweepTimes& times() const { return times_; }
  /// The exact caster on the same faces, for single lines of sight.
  const RayWalk& walk() const { return walk_; }

 private:
  robot::RobotModel model_;
  bool sweep_;
  SweepTimes times_;
  BeamTable table_;
  RayWalk walk_;
  ScanFaces faces_;
  PlaneCast plane_cast_;
  SweepCast sweep_cast_;
  RangeNoise noise_;
  Beams beams_;
};

}  // namespace rubble::sim
