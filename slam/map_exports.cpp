#include "slam/map_exports.h"

#include <utility>

#include "slam/robust/continued_mapper.h"
#include "slam/robust/graph/g2o.h"
#include "slam/robust/map/saved_map.h"

namespace rubble::slam {

MapContent content_of(const MapBase& map) {
  const SavedMap saved = decode_map(map.bytes, map.name);
  MapContent content{saved.T_base_laser, {}};
  for (const SavedScan& kept : saved.scans) {
    MapScan scan{saved.frames.pose(kept.frame) + kept.T_frame_base, unpacked(kept.scan)};
    scan.scan.stamp = saved.frames[kept.frame].stamp;
    content.scans.push_back(std::move(scan));
  }
  return content;
}

std::string graph_as_g2o(const MapBase& map) { return to_g2o(decode_map(map.bytes, map.name).frames.graph()); }

MergedBytes merged_maps(const MapBase& first, const MapBase& second, const robot::RobotModel& model,
                        const MapperConfig& mapper, const MergeProgress& progress) {
  const RobustConfig config = suited_to(model.laser, mapper.as<RobustConfig>());
  const MergedMap both =
      merged(decode_map(first.bytes, first.name), decode_map(second.bytes, second.name), config, progress);
  return {both.end, both.map ? encode_map(*both.map) : ""};
}

}  // namespace rubble::slam
