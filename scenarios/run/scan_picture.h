#pragma once

#include "slam/mapper.h"

namespace cv {
class Mat;
}

namespace rubble::scenarios {

/// What a mapper made of each scan, over time: panels of columns that have a unit in common, each with what it shows,
/// its unit, a scale and the names of its columns; of many scans in a pixel a pale band from the least to the greatest
/// value, and a line for their mean; doubts as ticks. Columns that no panel knows have one each. `records`: of one scan
/// or more.
cv::Mat scan_picture(const slam::ScanRecords& records);

}  // namespace rubble::scenarios
