#include <mrpt/obs/CActionCollection.h>
#include <mrpt/obs/CActionRobotMovement2D.h>
#include <mrpt/obs/CActionRobotMovement3D.h>
#include <mrpt/obs/CObservation2DRangeScan.h>
#include <mrpt/obs/CObservationComment.h>
#include <mrpt/obs/CObservationOdometry.h>
#include <mrpt/obs/CSensoryFrame.h>

#include <cstring>

#include "base/bytes.h"
#include "base/error.h"
#include "robot/logs/foreign/module/packing.h"
#include "robot/logs/foreign/module/rawlog_entries.h"
#include "robot/logs/foreign/mrpt_logs.h"

namespace rubble::robot {
namespace {

using namespace mrpt::obs;

/// A flag as the file has it: any byte but 0 is true, where a bool may only be 0 or 1.
bool flag(const bool& from_file) {
  std::uint8_t byte = 0;
  std::memcpy(&byte, &from_file, 1);
  return byte != 0;
}

class Teller {
 public:
  explicit Teller(const std::function<void(std::string_view)>& send) : send_(send) {}

  void visit(std::size_t entry, const mrpt::serialization::CSerializable::Ptr& object) {
    entry_ = entry;
    if (const auto actions = std::dynamic_pointer_cast<CActionCollection>(object)) {
      tell_movement(*actions);
    } else if (const auto frame = std::dynamic_pointer_cast<CSensoryFrame>(object)) {
      for (const auto& observation : *frame) tell(observation);
    } else if (const auto observation = std::dynamic_pointer_cast<CObservation>(object)) {
      tell(observation);
    }
    begin(Fact::Entry);
    end();
  }

  void unreadable(const std::string& message) {
    begin(Fact::Unreadable).bytes(message);
    end();
  }

 private:
  ByteWriter& begin(Fact fact) {
    record_.clear();
    writer_.u8(static_cast<std::uint8_t>(fact));
    writer_.varint(entry_);
    return writer_;
  }
  void end() { send_(record_); }

  void tell(const CObservation::Ptr& observation) {
    if (const auto comment = std::dynamic_pointer_cast<CObservationComment>(observation)) {
      begin(Fact::Comment).bytes(comment->text);
      end();
    }
    if (const auto scan = std::dynamic_pointer_cast<CObservation2DRangeScan>(observation)) tell_scan(*scan);
    if (const auto odometry = std::dynamic_pointer_cast<CObservationOdometry>(observation)) {
      begin(Fact::Odometry).svarint(odometry->timestamp.time_since_epoch().count());
      tell(odometry->odometry);
      tell_velocity(flag(odometry->hasVelocities), odometry->velocityLocal);
      end();
    }
  }

  void tell(const mrpt::poses::CPose2D& pose) {
    for (const double value : {pose.x(), pose.y(), pose.phi()}) writer_.f64(value);
  }

  void tell_velocity(bool known, const mrpt::math::TTwist2D& twist) {
    writer_.f64(known ? twist.vx : 0.0);
    writer_.f64(known ? twist.omega : 0.0);
  }

  void tell_scan(const CObservation2DRangeScan& scan) {
    begin(Fact::Scan).svarint(scan.timestamp.time_since_epoch().count());
    const mrpt::math::TPose3D pose = scan.sensorPose.asTPose();
    for (const double value : {pose.x, pose.y, pose.z, pose.yaw, pose.pitch, pose.roll}) writer_.f64(value);
    writer_.f32(scan.aperture);
    writer_.f32(scan.maxRange);
    writer_.u8(flag(scan.rightToLeft) ? 1 : 0);
    writer_.varint(scan.sensorLabel.size());
    writer_.bytes(scan.sensorLabel);
    const std::size_t beams = scan.getScanSize();
    writer_.varint(beams);
    for (std::size_t i = 0; i < beams && beams <= kMostBeams; ++i) {
      writer_.f32(scan.getScanRange(i));
      writer_.u8(scan.getScanRangeValidity(i) ? 1 : 0);
    }
    end();
  }

  void tell_movement(const CActionCollection& actions) {
    const CActionRobotMovement2D* planar = nullptr;
    const CActionRobotMovement3D* spatial = nullptr;
    for (const auto& action : actions) {
      const auto* candidate = dynamic_cast<const CActionRobotMovement2D*>(action.get_ptr().get());
      const bool better = candidate != nullptr &&
                          (planar == nullptr || (planar->estimationMethod != CActionRobotMovement2D::emOdometry &&
                                                 candidate->estimationMethod == CActionRobotMovement2D::emOdometry));
      if (better) planar = candidate;
      if (spatial == nullptr) spatial = dynamic_cast<const CActionRobotMovement3D*>(action.get_ptr().get());
    }
    if (planar == nullptr && spatial == nullptr) return;
    begin(Fact::Movement);
    if (planar != nullptr) {
      const bool raw = planar->estimationMethod == CActionRobotMovement2D::emOdometry;
      tell(raw ? planar->rawOdometryIncrementReading : planar->poseChange->getMeanVal());
      tell_velocity(flag(planar->hasVelocities), planar->velocityLocal);
    } else {
      tell(mrpt::poses::CPose2D(spatial->poseChange.getMeanVal()));
      tell_velocity(false, {});
    }
    end();
  }

  const std::function<void(std::string_view)>& send_;
  std::string record_;
  ByteWriter writer_{record_};
  std::size_t entry_ = 0;
};

}  // namespace

void tell_rawlog(std::string_view bytes, const std::string& path, const std::function<void(std::string_view)>& send) {
  Teller teller(send);
  try {
    each_rawlog_entry(bytes, path, [&](std::size_t entry, const auto& object) { teller.visit(entry, object); });
  } catch (const InputError& e) {
    teller.unreadable(e.what());
  }
}

}  // namespace rubble::robot
