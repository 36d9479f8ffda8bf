#include "robot/logs/foreign/file_bytes.h"
#include "robot/logs/foreign/mrpt_bridge.h"
#include "robot/logs/foreign/mrpt_logs.h"
#include "robot/logs/foreign/rawlog_own.h"
#include "robot/logs/log.h"

namespace rubble::robot {

ExportedScans export_rawlog(const std::string& log_path, const std::string& rawlog_path) {
  ReplayRobot replay(log_path);
  GzipFile file(rawlog_path);
  ExportedScans exported;
  const auto next = [&] {
    std::optional<Inputs> inputs = replay.read();
    if (!inputs) return inputs;
    exported.scans += inputs->scans.size();
    for (const LaserScan& scan : inputs->scans)
      if (replay.own_stamp(scan.stamp) != scan.stamp) ++exported.renamed;
    return inputs;
  };
  mrpt_logs().rawlog(next, replay.model().T_base_laser, comment_of_model(replay.model()),
                     [&](std::string_view bytes) { file.put(bytes); });
  file.keep();
  return exported;
}

void write_simplemap(const std::string& path, const std::vector<PosedScan>& scans,
                     const mrpt::math::TPose3D& T_base_laser) {
  write_gzip(path, mrpt_logs().simplemap(scans, T_base_laser));
}

}  // namespace rubble::robot
