#include "robot/logs/foreign/rawlog_facts.h"

#include <optional>

#include "base/bytes.h"
#include "base/error.h"
#include "robot/logs/foreign/guarded_child.h"
#include "robot/logs/foreign/mrpt_logs.h"
#include "robot/logs/foreign/mrpt_stamp.h"

namespace rubble::robot {
namespace {

using mrpt::math::TPose2D;

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

MrptScan scan_of(ByteReader& reader) {
  MrptScan scan;
  scan.time = time_of(reader);
  double pose[6];
  for (double& value : pose) value = reader.f64();
  scan.T_base_sensor = mrpt::poses::CPose3D(pose[0], pose[1], pose[2], pose[3], pose[4], pose[5]);
  scan.aperture = reader.f32();
  scan.range_max = reader.f32();
  scan.right_to_left = reader.u8() != 0;
  scan.label = std::string(reader.bytes(reader.varint()));
  const std::uint64_t beams = reader.varint();
  if (beams > kMostBeams) throw BadPayload("a scan of " + std::to_string(beams) + " beams, more than 100,000");
  scan.ranges.resize(static_cast<std::size_t>(beams));
  scan.valid.resize(static_cast<std::size_t>(beams));
  for (std::size_t i = 0; i < beams; ++i) {
    scan.ranges[i] = reader.f32();
    scan.valid[i] = reader.u8() != 0;
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
      MrptOdometry odometry;
      odometry.time = time_of(reader);
      odometry.pose = mrpt::poses::CPose2D(pose_of(reader));
      odometry.v = reader.f64();
      odometry.w = reader.f64();
      visitor_.odometry(entry, from_mrpt(odometry));
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
  const MrptLogs& mrpt = mrpt_logs();  // loaded here: the child's memory is bounded
  const std::string failure = run_guarded(
      limits, [&](const auto& send) { mrpt.tell(bytes, path, send); },
      [&](std::string_view record) { listener.hear(record); });
  if (!failure.empty())
    throw InputError(path + ": entry " + std::to_string(listener.next()) + ": is damaged (it " + failure +
                     "); copy the file again, or cut it there with: rawlog-edit --cut");
}

}  // namespace rubble::robot
