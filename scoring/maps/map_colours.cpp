#include "scoring/maps/map_colours.h"

#include <opencv2/imgproc.hpp>

#include "scoring/maps/canvas_corners.h"
#include "scoring/maps/grey_levels.h"
#include "scoring/maps/league_colours.h"

namespace rubble::scoring {

ClassImage classify(const RgbImage& image) {
  ClassImage out;
  out.is_league = is_league_map(image);
  const LabelImage labels = out.is_league ? classify_league(image) : classify_grey(image);
  out.recognised = labels.recognised;
  if (image.white > 0)
    out.recognised += ", scaled so that the brightest sample, " + std::to_string(image.white) + ", is white";
  cv::Mat classes = labels.classes;
  if (!image.alpha.empty()) classes.setTo(static_cast<int>(Occupancy::Unknown), transparent_pixels(image));
  clear_canvas_corners(classes);
  out.classes = Grid<Occupancy>(GridFrame{image.width, image.height, 1.0, 0.0, 0.0});
  for (int y = 0; y < image.height; ++y) {
    const unsigned char* row = classes.ptr<unsigned char>(image.height - 1 - y);
    for (int x = 0; x < image.width; ++x) out.classes[{x, y}] = static_cast<Occupancy>(row[x]);
  }
  return out;
}

}  // namespace rubble::scoring
