#pragma once

#include <opencv2/core.hpp>

namespace rubble::scoring {

/// Turns words written on free ground in the walls' own colour into free ground. `classes`: Occupancy values, CV_8U.
/// Words are three or more small pieces of wall in one row (or column), alike in height and stroke, near each other and
/// away from all other walls, of which enough have more strokes than walls, corners and crossings have. Returns how
/// many pieces went.
int erase_lettering(cv::Mat& classes);

}  // namespace rubble::scoring
