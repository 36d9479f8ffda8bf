#pragma once

#include <mrpt/math/TPose2D.h>

#include "robot/measurements.h"

namespace rubble::robot {

/// How a robot moved from one scan to a later one, by these two alone.
struct ScanMotion {
  double ahead = 0.0;  ///< along an arc [m]
  double turn = 0.0;   ///< [rad]
  double fit = 0.0;    ///< share of the earlier scan's points that the later one has where this motion puts them
  double still = 0.0;  ///< the same, had it not moved
  /// The later scan is explained by the motion, clearly better than by none. People and doors that move change a part
  /// of a scan, which no motion explains.
  bool moved() const;
  /// It is explained by a robot that stood.
  bool stood() const;
};

/// The best of the motions of a robot on wheels, up to 0.7 m and 66 deg. `T_base_laser`: where the scanner sits on the
/// robot. Where walls are out of reach, or look alike wherever one stands, neither moved() nor stood() may hold.
ScanMotion motion_between(const LaserScan& before, const LaserScan& after, const mrpt::math::TPose2D& T_base_laser);

/// Which way a robot went, whichever way its scanner looks. All angles are from the way that its wheels say.
struct ScanWay {
  double way = 0.0;      ///< [m]
  double aside = 0.0;    ///< counter-clockwise [rad]
  double fit = 0.0;      ///< as of ScanMotion
  double as_told = 0.0;  ///< the best fit of a robot that went (nearly) the way that its wheels say, or stood
};

/// The best of the ways up to 0.7 m of a robot that turned by about `turn` [rad] meanwhile.
ScanWay way_between(const LaserScan& before, const LaserScan& after, const mrpt::math::TPose2D& T_base_laser,
                    double turn, bool backwards);

}  // namespace rubble::robot
