#pragma once

#include "slam/mapper.h"

namespace cv {
class Mat;
}

namespace rubble::scenarios {

/// What became of the places that a search for loops found: the map with the way driven and a line from the newer to
/// the older place of each, coloured by its end, with axes and a legend that counts them; below it the tests of each
/// over the time of the newer place: share of inliers, and what one would have seen through, there and where the robot
/// was expected. `loops`: one or more.
cv::Mat loop_picture(const slam::Mapper& mapper, const std::vector<slam::FoundLoop>& loops);

}  // namespace rubble::scenarios
