#include "robot/logs/foreign/rawlog_facts.h"

#include <mrpt/obs/CActionCollection.h>
#include <mrpt/obs/CActionRobotMovement2D.h>
#include <mrpt/obs/CActionRobotMovement3D.h>
#include <mrpt/obs/CObservationComment.h>
#include <mrpt/obs/CObservationOdometry.h>
#include <mrpt/obs/CSensoryFrame.h>

#include <cstring>
#include <optional>

#include "base/bytes.h"
#include "base/error.h"
#include "robot/logs/foreign/guarded_child.h"
#include "robot/logs/foreign/mrpt_bridge.h"
#include "robot/logs/foreign/mrpt_stamp.h"
#include "robot/logs/foreign/rawlog_entries.h"

namespace rubble::robot {
namespace {

using namespace mrpt::obs;
using mrpt::math::TPose2D;

constexpr std::size_t kMostBeams = 100000;  // the finest scanners give 7200

/// What the child says of an entry; the first byte of a record, the entry's number follows.
enum class Fact : std::uint8_t { Entry, Comment, Scan, Odometry, Movement, Unreadable };

/// A flag as the file has it: any byte but 0 is true, where a bool may only be 0 or 1.
bool flag(const bool& from_file) {
  std::uint8_t byte = 0;
  std::memcpy(&byte, &from_file, 1);
  return byte != 0;
}

// ---- in the child

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

// ---- in the parent

mrpt::Clock::time_point time_of(ByteReader& reader) {
  const mrpt::Clock::time_point time{mrpt::Clock::duration(reader.svarint())};
  if (!is_plausible(time)) throw BadPayload("a time that is not between the years 1824 and 2116");
  return time;
}

TPose2D pose_of(ByteReader& reader) {
  TPose2D pose;
  for (double* value : {&pose.x, &pose.y, &pose.phi}) *value = reader.f64();
  return pose;
}

CObservation2DRangeScan::Ptr scan_of(ByteReader& reader) {
  auto scan = CObservation2DRangeScan::Create();
  scan->timestamp = time_of(reader);
  double pose[6];
  for (double& value : pose) value = reader.f64();
  scan->sensorPose = mrpt::poses::CPose3D(pose[0], pose[1], pose[2], pose[3], pose[4], pose[5]);
  scan->aperture = reader.f32();
  scan->maxRange = reader.f32();
  scan->rightToLeft = reader.u8() != 0;
  scan->sensorLabel = std::string(reader.bytes(reader.varint()));
  const std::uint64_t beams = reader.varint();
  if (beams > kMostBeams) throw BadPayload("a scan of " + std::to_string(beams) + " beams, more than 100,000");
  scan->resizeScan(static_cast<std::size_t>(beams));
  for (std::size_t i = 0; i < beams; ++i) {
    scan->setScanRange(i, reader.f32());
    scan->setScanRangeValidity(i, reader.u8() != 0);
  }
  return scan;
}

class Listener {
 public:
  Listener(const std::string& path, RawlogVisitor& visitor) : path_(path), visitor_(visitor) {}

  void hear(std::string_view record) {
    ByteReader reader(record);
    const auto fact = static_cast<Fact>(reader.u8());
    const auto entry = static_cast<std::size_t>(reader.varint());
    if (fact == Fact::Unreadable) throw InputError(std::string(reader.bytes(reader.left())));
    next_ = fact == Fact::Entry ? entry + 1 : entry;
    try {
      visit(fact, entry, reader);
    } catch (const BadPayload& e) {
      throw InputError(path_ + ": entry " + std::to_string(entry) + ": is damaged (" + e.what() +
                       "); cut the rawlog there with: rawlog-edit --cut");
    }
  }

  /// The first entry of which nothing was heard.
  std::size_t next() const { return next_; }

 private:
  void visit(Fact fact, std::size_t entry, ByteReader& reader) {
    if (fact == Fact::Comment) visitor_.comment(entry, std::string(reader.bytes(reader.left())));
    if (fact == Fact::Scan) visitor_.scan(entry, scan_of(reader));
    if (fact == Fact::Movement) {
      Movement movement{pose_of(reader)};
      movement.v = reader.f64();
      movement.w = reader.f64();
      visitor_.movement(entry, movement);
    }
    if (fact == Fact::Odometry) {
      mrpt::obs::CObservationOdometry observation;
      observation.timestamp = time_of(reader);
      observation.odometry = mrpt::poses::CPose2D(pose_of(reader));
      observation.hasVelocities = true;
      observation.velocityLocal.vx = reader.f64();
      observation.velocityLocal.omega = reader.f64();
      visitor_.odometry(entry, from_mrpt(observation));
    }
  }

  const std::string& path_;
  RawlogVisitor& visitor_;
  std::size_t next_ = 0;
};

}  // namespace

void visit_rawlog(std::string_view bytes, const std::string& path, RawlogVisitor& visitor) {
  ChildLimits limits;
  limits.memory += 4 * bytes.size();
  limits.cpu_s += static_cast<unsigned>(bytes.size() >> 20);
  Listener listener(path, visitor);
  const std::string failure = run_guarded(
      limits,
      [&](const auto& send) {
        Teller teller(send);
        try {
          each_rawlog_entry(bytes, path, [&](std::size_t entry, const auto& object) { teller.visit(entry, object); });
        } catch (const InputError& e) {
          teller.unreadable(e.what());
        }
      },
      [&](std::string_view record) { listener.hear(record); });
  if (!failure.empty())
    throw InputError(path + ": entry " + std::to_string(listener.next()) + ": is damaged (it " + failure +
                     "); copy the file again, or cut it there with: rawlog-edit --cut");
}

}  // namespace rubble::robot
