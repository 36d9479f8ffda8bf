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
#include <chrono>

#include "robot/logs/foreign/module/to_mrpt.h"
#include "robot/logs/foreign/mrpt_stamp.h"
#include "robot/logs/foreign/rawlog_own.h"

namespace rubble::robot {
namespace {

using mrpt::obs::CObservation;

/// The observations of a log, handed out in the order of their stamps; odometry before a scan of the same time.
class Sorted {
 public:
  void add(const Inputs& inputs, const mrpt::math::TPose3D& T_base_laser) {
    for (const Odometry& odometry : inputs.odometry) {
      auto observation = mrpt::obs::CObservationOdometry::Create();
      to_mrpt(odometry, *observation);
      if (odometry.v != 0.0 && odometry.w == 0.0) observation->velocityLocal.omega = kStraightTurnRate;
      observation->sensorLabel = "ODOMETRY";
      waiting_.push_back(observation);
    }
    for (const LaserScan& scan : inputs.scans) {
      auto observation = mrpt::obs::CObservation2DRangeScan::Create();
      to_mrpt(scan, T_base_laser, *observation);
      observation->sensorLabel = "LASER";
      waiting_.push_back(observation);
    }
  }

  /// Those before `end`, which wait no longer.
  std::vector<CObservation::Ptr> before(mrpt::Clock::time_point end) {
    std::stable_sort(waiting_.begin(), waiting_.end(),
                     [](const auto& a, const auto& b) { return a->timestamp < b->timestamp; });
    const auto first_left =
        std::partition_point(waiting_.begin(), waiting_.end(), [&](const auto& o) { return o->timestamp < end; });
    const std::vector<CObservation::Ptr> out(waiting_.begin(), first_left);
    waiting_.erase(waiting_.begin(), first_left);
    return out;
  }

 private:
  std::vector<CObservation::Ptr> waiting_;
};

std::string bytes_of(mrpt::io::CMemoryStream& stream) {
  return {static_cast<const char*>(stream.getRawBufferData()), static_cast<std::size_t>(stream.getTotalBytesCount())};
}

}  // namespace

void pack_rawlog(const std::function<std::optional<Inputs>()>& next, const mrpt::math::TPose3D& T_base_laser,
                 const std::string& text, const std::function<void(std::string_view)>& put) {
  constexpr mrpt::Clock::duration kLatest = std::chrono::minutes(1);  // from its stamp to its tick
  Sorted observations;
  auto last = to_mrpt_time(Stamp{0});
  const auto hand_over = [&](const CObservation& observation) {
    mrpt::io::CMemoryStream stream;
    mrpt::serialization::archiveFrom(stream) << observation;
    put(bytes_of(stream));
  };
  const auto hand_over_before = [&](mrpt::Clock::time_point end) {
    for (const CObservation::Ptr& observation : observations.before(end)) {
      hand_over(*observation);
      last = observation->timestamp;
    }
  };
  std::optional<mrpt::Clock::time_point> handed_over;
  while (const auto inputs = next()) {
    observations.add(*inputs, T_base_laser);
    const auto now = to_mrpt_time(inputs->now);
    if (!handed_over) handed_over = now;
    if (now - *handed_over < 2 * kLatest) continue;
    handed_over = now - kLatest;
    hand_over_before(*handed_over);
  }
  hand_over_before(mrpt::Clock::time_point::max());
  mrpt::obs::CObservationComment comment;
  comment.text = text;
  comment.sensorLabel = "COMMENT";
  comment.timestamp = last;
  hand_over(comment);
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
