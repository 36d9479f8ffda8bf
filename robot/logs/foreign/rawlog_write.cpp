#include <mrpt/io/CMemoryStream.h>
#include <mrpt/obs/CObservation2DRangeScan.h>
#include <mrpt/obs/CObservationComment.h>
#include <mrpt/obs/CObservationOdometry.h>
#include <mrpt/serialization/CArchive.h>

#include <algorithm>

#include "robot/logs/foreign/file_bytes.h"
#include "robot/logs/foreign/mrpt_bridge.h"
#include "robot/logs/foreign/mrpt_stamp.h"
#include "robot/logs/foreign/rawlog_own.h"
#include "robot/logs/log.h"

namespace rubble::robot {
namespace {

using mrpt::obs::CObservation;

/// All observations of a log in the order of their stamps; odometry before a scan of the same time.
std::vector<CObservation::Ptr> observations_of(ReplayRobot& replay) {
  std::vector<CObservation::Ptr> list;
  while (const auto inputs = replay.read()) {
    for (const Odometry& odometry : inputs->odometry) {
      auto observation = mrpt::obs::CObservationOdometry::Create();
      to_mrpt(odometry, *observation);
      if (odometry.v != 0.0 && odometry.w == 0.0) observation->velocityLocal.omega = kStraightTurnRate;
      observation->sensorLabel = "ODOMETRY";
      list.push_back(observation);
    }
    for (const LaserScan& scan : inputs->scans) {
      auto observation = mrpt::obs::CObservation2DRangeScan::Create();
      to_mrpt(scan, replay.model().T_base_laser, *observation);
      observation->sensorLabel = "LASER";
      list.push_back(observation);
    }
  }
  std::stable_sort(list.begin(), list.end(), [](const auto& a, const auto& b) { return a->timestamp < b->timestamp; });
  return list;
}

}  // namespace

void export_rawlog(const std::string& log_path, const std::string& rawlog_path) {
  ReplayRobot replay(log_path);
  const std::vector<CObservation::Ptr> observations = observations_of(replay);
  mrpt::io::CMemoryStream stream;
  stream.setAllocBlockSize(std::uint64_t{1} << 22);
  auto archive = mrpt::serialization::archiveFrom(stream);
  mrpt::obs::CObservationComment comment;
  comment.text = comment_of_model(replay.model());
  comment.sensorLabel = "COMMENT";
  comment.timestamp = observations.empty() ? to_mrpt_time(Stamp{0}) : observations.back()->timestamp;
  for (const CObservation::Ptr& observation : observations) archive << *observation;
  archive << comment;
  write_gzip(rawlog_path, std::string(static_cast<const char*>(stream.getRawBufferData()),
                                      static_cast<std::size_t>(stream.getTotalBytesCount())));
}

}  // namespace rubble::robot
