#pragma once

#include <opencv2/core.hpp>

namespace rubble::scoring {

/// Turns words written on free ground in the walls' own colour into free ground. `classes`: Occupancy values, CV_8U.
/// Words are three or more small pieces of wall in one row (or column), alike in height and stroke, near each other and
/// away from all other walls, of which enough have more strokes than walls, corners and crossings have. Returns how
/// many pieces went.
int erase_lettering(cv::Mat& classes);

/// How many words stay in it that are too low, too much smoothed or joined for erase_lettering() to be sure of; 0
/// where most small pieces stand in none, as in ragged walls.
int perhaps_words(const cv::Mat& classes);

}  // namespace rubble::scoring
