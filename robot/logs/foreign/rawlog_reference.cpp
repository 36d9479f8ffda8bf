#include <filesystem>

#include "base/angle.h"
#include "base/error.h"
#include "robot/logs/foreign/file_bytes.h"
#include "robot/logs/foreign/mrpt_bridge.h"
#include "robot/logs/foreign/text_fields.h"

namespace rubble::robot {

Trajectory read_rawlog_reference(const std::string& path) {
  const std::string truth = path + ".GT.txt";
  std::error_code error;
  if (!std::filesystem::exists(truth, error)) return {};
  const std::string text = read_file(truth);
  Trajectory reference;
  TextLines lines(text);
  while (lines.next()) {
    TextFields fields(truth, lines);
    if (fields.peek().empty() || fields.peek()[0] == '#' || fields.peek()[0] == '%') continue;
    StampedPose stamped;
    stamped.stamp = fields.stamp("time");
    stamped.pose.x = fields.number("x");
    stamped.pose.y = fields.number("y");
    stamped.pose.phi = wrap_angle(fields.number("phi"));
    if (!reference.empty() && stamped.stamp <= reference.back().stamp)
      throw InputError(at(truth, lines.number(), 1, "the time does not increase; sort the file by time"));
    reference.push_back(stamped);
  }
  return reference;
}

}  // namespace rubble::robot
