#pragma once

#include <mrpt/math/TPoint2D.h>
#include <mrpt/math/TPose2D.h>

#include <string>
#include <vector>

#include "robot/robot.h"
#include "scenarios/run/core.h"
#include "scenarios/run/packed_map.h"

namespace cv {
class Mat;
}

namespace rubble::scenarios {

/// What a run knew at one moment. All in the map frame [m].
struct FilmFrame {
  double time = 0.0;                      ///< since the first scan [s]
  PackedMap map;                          ///< a hundred frames of a large one would not fit into memory
  PackedMap searched;                     ///< occupied: searched for victims; of the same cells as the map, or empty
  std::vector<mrpt::math::TPoint2D> way;  ///< driven so far, as the mapper knows it now
  std::vector<mrpt::math::TPoint2D> plan;
  std::vector<mrpt::math::TPoint2D> victims;
  mrpt::math::TPose2D pose;
  std::string why;  ///< the last decision
};

/// Frames beside and below each other, all of the same ground, north (the map's y) up: explored ground white, pale
/// green where it was searched for victims, walls dark blue, the way violet, the plan green, victims red, the robot as
/// an orange arrow; time, area known and the last decision below. Frames of other cell sizes than the last one's are
/// not drawn. Empty without frames.
cv::Mat film_strip(const std::vector<FilmFrame>& frames);

/// The strip, and below it what its colours mean and a scale bar.
cv::Mat film_picture(const std::vector<FilmFrame>& frames);

/// Takes the frames of a film: `wanted` of them, at equal steps of the run's time, the last one at its end.
class Film {
 public:
  explicit Film(int wanted) : wanted_(wanted) {}

  /// Each tick, the core having seen it. `share`: of the run's time, 0..1; decides whether a frame is due.
  void see(const Core& core, const robot::Inputs& inputs, double share, double occupied_threshold);
  /// The mapper has ended what it put off: that is the last frame.
  void end(const Core& core, double occupied_threshold);

  const std::vector<FilmFrame>& frames() const { return frames_; }

 private:
  void take(const Core& core, double occupied_threshold);

  int wanted_;
  Stamp first_ = Stamp::never();
  Stamp now_ = Stamp::never();
  std::vector<FilmFrame> frames_;
};

}  // namespace rubble::scenarios
