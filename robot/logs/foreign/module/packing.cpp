#include "robot/logs/foreign/module/packing.h"

#include <mrpt/io/CMemoryStream.h>
#include <mrpt/maps/CSimpleMap.h>
#include <mrpt/obs/CObservation2DRangeScan.h>
#include <mrpt/obs/CObservationComment.h>
#include <mrpt/obs/CObservationOdometry.h>
#include <mrpt/obs/CSensoryFrame.h>
#include <mrpt/poses/CPose3DPDFGaussian.h>
#include <mrpt/serialization/CArchive.h>

#include <algorithm>

#include "robot/logs/foreign/module/to_mrpt.h"
#include "robot/logs/foreign/mrpt_stamp.h"
#include "robot/logs/foreign/rawlog_own.h"

namespace rubble::robot {
namespace {

using mrpt::obs::CObservation;

/// All observations of a log in the order of their stamps; odometry before a scan of the same time.
std::vector<CObservation::Ptr> observations_of(const std::function<std::optional<Inputs>()>& next,
                                               const mrpt::math::TPose3D& T_base_laser) {
  std::vector<CObservation::Ptr> list;
  while (const auto inputs = next()) {
    for (const Odometry& odometry : inputs->odometry) {
      auto observation = mrpt::obs::CObservationOdometry::Create();
      to_mrpt(odometry, *observation);
      if (odometry.v != 0.0 && odometry.w == 0.0) observation->velocityLocal.omega = kStraightTurnRate;
      observation->sensorLabel = "ODOMETRY";
      list.push_back(observation);
    }
    for (const LaserScan& scan : inputs->scans) {
      auto observation = mrpt::obs::CObservation2DRangeScan::Create();
      to_mrpt(scan, T_base_laser, *observation);
      observation->sensorLabel = "LASER";
      list.push_back(observation);
    }
  }
  std::stable_sort(list.begin(), list.end(), [](const auto& a, const auto& b) { return a->timestamp < b->timestamp; });
  return list;
}

std::string bytes_of(mrpt::io::CMemoryStream& stream) {
  return {static_cast<const char*>(stream.getRawBufferData()), static_cast<std::size_t>(stream.getTotalBytesCount())};
}

}  // namespace

std::string packed_rawlog(const std::function<std::optional<Inputs>()>& next, const mrpt::math::TPose3D& T_base_laser,
                          const std::string& text) {
  const std::vector<CObservation::Ptr> observations = observations_of(next, T_base_laser);
  mrpt::io::CMemoryStream stream;
  stream.setAllocBlockSize(std::uint64_t{1} << 22);
  auto archive = mrpt::serialization::archiveFrom(stream);
  mrpt::obs::CObservationComment comment;
  comment.text = text;
  comment.sensorLabel = "COMMENT";
  comment.timestamp = observations.empty() ? to_mrpt_time(Stamp{0}) : observations.back()->timestamp;
  for (const CObservation::Ptr& observation : observations) archive << *observation;
  archive << comment;
  return bytes_of(stream);
}

std::string packed_simplemap(const std::vector<PosedScan>& scans, const mrpt::math::TPose3D& T_base_laser) {
  mrpt::maps::CSimpleMap simple;
  for (const PosedScan& kept : scans) {
    auto observation = mrpt::obs::CObservation2DRangeScan::Create();
    to_mrpt(kept.scan, T_base_laser, *observation);
    auto frame = mrpt::obs::CSensoryFrame::Create();
    frame->insert(observation);
    auto pose = mrpt::poses::CPose3DPDFGaussian::Create();
    pose->mean = mrpt::poses::CPose3D(mrpt::math::TPose3D(kept.T_map_base));
    simple.insert(pose, frame);
  }
  mrpt::io::CMemoryStream memory;
  mrpt::serialization::archiveFrom(memory) << simple;  // what its saveToFile() packs with gzip
  return bytes_of(memory);
}

}  // namespace rubble::robot
