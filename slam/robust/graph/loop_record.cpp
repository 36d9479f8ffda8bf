#include "slam/robust/graph/loop_record.h"

#include <cstdio>

#include "base/angle.h"
#include "base/trajectory.h"

namespace rubble::slam {

const char* name_of(LoopRecord::End end) {
  switch (end) {
    case LoopRecord::End::Ambiguous:
      return "ambiguous";
    case LoopRecord::End::Unfit:
      return "unfit";
    case LoopRecord::End::Contradicted:
      return "contradicted";
    case LoopRecord::End::Needless:
      return "needless";
    case LoopRecord::End::Waits:
      return "waits";
    case LoopRecord::End::Closed:
      return "closed";
    case LoopRecord::End::Removed:
      return "removed";
  }
  return "";
}

std::string csv_of(const std::vector<LoopRecord>& records, const std::function<Stamp(Stamp)>& name) {
  std::string text =
      "stamp_s,old_stamp_s,path_m,window_m,score,inliers,contradiction,expected_contradiction,moves_m,turns_deg,"
      "x_m,y_m,heading_deg,end\n";
  char number[160];
  const auto share = [&](const std::optional<double>& value) {
    if (value) {
      std::snprintf(number, sizeof number, "%.4f", *value);
      text += number;
    }
    text += ',';
  };
  for (const LoopRecord& record : records) {
    text += stamp_text(name(record.stamp)) + "," + stamp_text(name(record.old_stamp));
    std::snprintf(number, sizeof number, ",%.3f,%.3f,%.4f,", record.path, record.window, record.score);
    text += number;
    share(record.inliers);
    share(record.contradiction);
    share(record.expected_contradiction);
    std::snprintf(number, sizeof number, "%.4f,%.3f,", record.moves, rad_to_deg(record.turns));
    text += number;
    const mrpt::math::TPose2D& place = record.T_old_new;
    std::snprintf(number, sizeof number, "%.4f,%.4f,%.3f,", place.x, place.y, rad_to_deg(wrap_angle(place.phi)));
    text += number + std::string(name_of(record.end)) + "\n";
  }
  return text;
}

}  // namespace rubble::slam
