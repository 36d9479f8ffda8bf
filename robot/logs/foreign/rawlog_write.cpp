#include "robot/logs/foreign/file_bytes.h"
#include "robot/logs/foreign/mrpt_bridge.h"
#include "robot/logs/foreign/mrpt_logs.h"
#include "robot/logs/foreign/rawlog_own.h"
#include "robot/logs/log.h"

namespace rubble::robot {

void export_rawlog(const std::string& log_path, const std::string& rawlog_path) {
  ReplayRobot replay(log_path);
  GzipFile file(rawlog_path);
  mrpt_logs().rawlog([&] { return replay.read(); }, replay.model().T_base_laser, comment_of_model(replay.model()),
                     [&](std::string_view bytes) { file.put(bytes); });
  file.keep();
}

void write_simplemap(const std::string& path, const std::vector<PosedScan>& scans,
                     const mrpt::math::TPose3D& T_base_laser) {
  write_gzip(path, mrpt_logs().simplemap(scans, T_base_laser));
}

}  // namespace rubble::robot
