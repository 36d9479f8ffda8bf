#include "slam/robust/map/saved_map.h"

#include <zlib.h>

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <utility>

#include "base/bytes.h"
#include "base/digest.h"
#include "base/error.h"

namespace rubble::slam {

using mrpt::math::TPose2D;

namespace {

constexpr std::string_view kStem = "RUBBLE MAP ";
constexpr std::string_view kMagic = "RUBBLE MAP 2\n";
constexpr std::size_t kHead = 24;  ///< behind the magic: lengths of the payload, plain and packed, and two sums
constexpr int kPacking = 1;        ///< of 9: ranges shrink by 3 % more at the usual 6, for 1.6 times the work
// A file may unpack to no more than this: maps pack three to ten times, a bomb a thousand times.
constexpr std::uint64_t kMostUnpacked = std::uint64_t{2} << 30;
constexpr std::uint64_t kFreeUnpacked = std::uint64_t{64} << 20;  ///< however small the file ...
constexpr std::uint64_t kMostPacking = 40;                        ///< ... and so many times its size
// Numbers beyond these are damage; what the mapper writes stays far within them.
constexpr double kFarthestPose = 1e7;                     ///< [m]
constexpr double kLongestPath = 1e9;                      ///< [m]
constexpr double kFarthestMount = 1e3;                    ///< of the laser on its robot [m]
constexpr double kFarthestPoint = 2.0 * kFarthestReturn;  ///< of a scan, seen from the robot [m]
constexpr double kMostNormal = 1.01;                      ///< parts of a unit vector
constexpr double kMostCertain = 1e18;                     ///< entries of covariances and informations
constexpr double kRounding = 1e-6;                        ///< of the largest entry

void put_u64(ByteWriter& out, std::uint64_t value) {
  out.u32(static_cast<std::uint32_t>(value));
  out.u32(static_cast<std::uint32_t>(value >> 32U));
}

std::uint64_t take_u64(ByteReader& in) {
  const std::uint64_t low = in.u32();
  return low | static_cast<std::uint64_t>(in.u32()) << 32U;
}

double take_finite(ByteReader& in) {
  const double value = in.f64();
  if (!std::isfinite(value)) throw BadPayload("a number that is none");
  return value;
}

double within(double value, double least, double most, const char* otherwise) {
  if (!std::isfinite(value)) throw BadPayload("a number that is none");
  if (!(value >= least && value <= most)) throw BadPayload(otherwise);
  return value;
}

double take_angle(ByteReader& in) { return within(in.f64(), -kMostAngle, kMostAngle, "an angle far off"); }

double take_path(ByteReader& in) { return within(in.f64(), 0.0, kLongestPath, "a path of no possible length"); }

float take_range(ByteReader& in) {
  return static_cast<float>(within(static_cast<double>(in.f32()), 0.0, kFarthestReturn, "a range that no scanner has"));
}

int take_index(ByteReader& in, int end) {
  const std::uint64_t value = in.varint();
  if (value >= static_cast<std::uint64_t>(end)) throw BadPayload("a key frame that is not there");
  return static_cast<int>(value);
}

void put(ByteWriter& out, const TPose2D& T) {
  out.f64(T.x);
  out.f64(T.y);
  out.f64(T.phi);
}

TPose2D take_pose(ByteReader& in) {
  const double x = take_finite(in);
  const double y = take_finite(in);
  const double phi = take_angle(in);
  if (std::abs(x) > kFarthestPose || std::abs(y) > kFarthestPose) throw BadPayload("a pose far off");
  return {x, y, phi};
}

void put(ByteWriter& out, const Eigen::Matrix3d& m) {
  for (int row = 0; row < 3; ++row)
    for (int column = 0; column < 3; ++column) out.f64(m(row, column));
}

Eigen::Matrix3d take_matrix(ByteReader& in) {
  Eigen::Matrix3d m;
  for (int row = 0; row < 3; ++row)
    for (int column = 0; column < 3; ++column)
      m(row, column) = within(in.f64(), -kMostCertain, kMostCertain, "a matrix far off");
  const double scale = m.cwiseAbs().maxCoeff();
  if ((m - m.transpose()).cwiseAbs().maxCoeff() > kRounding * scale) throw BadPayload("a matrix that is not symmetric");
  if (Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d>(m, Eigen::EigenvaluesOnly).eigenvalues().minCoeff() <
      -kRounding * scale)
    throw BadPayload("a matrix below zero");
  return m;
}

void put(ByteWriter& out, const std::vector<OrientedPoint>& points) {
  out.varint(points.size());
  for (const OrientedPoint& p : points)
    for (const float value : {p.x, p.y, p.nx, p.ny}) out.f32(value);
}

std::vector<OrientedPoint> take_points(ByteReader& in) {
  std::vector<OrientedPoint> points(in.count(16));
  for (OrientedPoint& p : points)
    for (const auto& [value, most] : {std::pair(&p.x, kFarthestPoint), std::pair(&p.y, kFarthestPoint),
                                      std::pair(&p.nx, kMostNormal), std::pair(&p.ny, kMostNormal)})
      *value = static_cast<float>(within(static_cast<double>(in.f32()), -most, most, "a point far off"));
  return points;
}

void put(ByteWriter& out, const KeyFrame& frame) {
  out.svarint(frame.stamp.ns);
  out.f64(frame.path);
  out.f64(frame.cloud.laser.x);
  out.f64(frame.cloud.laser.y);
  put(out, frame.cloud.points);
  put(out, frame.cloud.filled);
  for (const auto& [nearest, farthest] : frame.cloud.sight.bins()) {
    out.varint(nearest);
    out.varint(farthest);
  }
}

KeyFrame take_frame(ByteReader& in) {
  KeyFrame frame;
  frame.stamp.ns = in.svarint();
  frame.path = take_path(in);
  for (double* value : {&frame.cloud.laser.x, &frame.cloud.laser.y})
    *value = within(in.f64(), -kFarthestPoint, kFarthestPoint, "a laser far off");
  frame.cloud.points = take_points(in);
  frame.cloud.filled = take_points(in);
  SightFan::Bins bins;
  for (auto& [nearest, farthest] : bins)
    for (std::uint16_t* value : {&nearest, &farthest}) *value = static_cast<std::uint16_t>(in.varint());
  frame.cloud.sight = SightFan(bins);
  frame.walls = wall_direction(frame.cloud);
  return frame;
}

void put(ByteWriter& out, const GraphEdge& edge) {
  out.varint(static_cast<std::uint64_t>(edge.from));
  out.varint(static_cast<std::uint64_t>(edge.to));
  put(out, edge.T_from_to);
  put(out, edge.information);
  out.u8(static_cast<std::uint8_t>((edge.loop ? 1 : 0) | (edge.on ? 2 : 0)));
}

GraphEdge take_edge(ByteReader& in, int frames) {
  GraphEdge edge;
  edge.from = take_index(in, frames);
  edge.to = take_index(in, frames);
  if (edge.from == edge.to) throw BadPayload("an edge from a key frame to itself");
  edge.T_from_to = take_pose(in);
  edge.information = take_matrix(in);
  const std::uint8_t flags = in.u8();
  edge.loop = (flags & 1U) != 0;
  edge.on = (flags & 2U) != 0;
  return edge;
}

void put(ByteWriter& out, const PackedScan& scan) {
  out.f64(scan.angle_min);
  out.f64(scan.angle_step);
  out.f32(scan.range_min);
  out.f32(scan.range_max);
  out.f32(scan.quantum);
  out.u8(static_cast<std::uint8_t>((scan.motion ? 1 : 0) | (scan.tilt ? 2 : 0)));
  if (scan.motion) {
    put(out, scan.motion->T_ref_first);
    put(out, scan.motion->T_ref_last);
  }
  if (scan.tilt)
    for (const double value : {scan.tilt->pitch, scan.tilt->roll, scan.tilt->body_pitch, scan.tilt->body_roll})
      out.f64(value);
  out.varint(scan.ranges.size());
  std::int64_t last = 0;
  for (const std::uint16_t range : scan.ranges) {
    out.svarint(range - last);
    last = range;
  }
}

PackedScan take_scan(ByteReader& in) {
  PackedScan scan;
  scan.angle_min = take_angle(in);
  scan.angle_step = take_angle(in);
  scan.range_min = take_range(in);
  scan.range_max = take_range(in);
  scan.quantum = take_range(in);
  if (!(scan.quantum > 0.0F && scan.quantum <= 1.0F)) throw BadPayload("ranges without a step");
  const std::uint8_t flags = in.u8();
  if ((flags & 1U) != 0) {
    const TPose2D first = take_pose(in);
    scan.motion = SweepMotion{first, take_pose(in)};
  }
  if ((flags & 2U) != 0) {
    scan.tilt.emplace();
    for (double* value : {&scan.tilt->pitch, &scan.tilt->roll, &scan.tilt->body_pitch, &scan.tilt->body_roll})
      *value = take_angle(in);
  }
  scan.ranges.resize(in.count(1));
  if (!has_directions(scan.angle_min, scan.angle_step, scan.ranges.size()))
    throw BadPayload("a scan without an angle between its beams");
  std::int64_t last = 0;
  for (std::uint16_t& range : scan.ranges) {
    last = wrapped_sum(last, in.svarint());
    if (last < 0 || last > std::numeric_limits<std::uint16_t>::max()) throw BadPayload("a range out of bounds");
    range = static_cast<std::uint16_t>(last);
  }
  return scan;
}

std::string payload_of(const SavedMap& map) {
  std::string bytes;
  ByteWriter out(bytes);
  for (const double value : {map.T_base_laser.x, map.T_base_laser.y, map.T_base_laser.z, map.T_base_laser.yaw,
                             map.T_base_laser.pitch, map.T_base_laser.roll})
    out.f64(value);
  out.varint(static_cast<std::uint64_t>(map.frames.size()));
  for (int i = 0; i < map.frames.size(); ++i) {
    put(out, map.frames.pose(i));
    out.varint(static_cast<std::uint64_t>(map.frames.before(i) + 1));
    put(out, map.frames[i]);
  }
  out.varint(map.frames.graph().edges.size());
  for (const GraphEdge& edge : map.frames.graph().edges) put(out, edge);
  out.varint(map.scans.size());
  for (const SavedScan& scan : map.scans) {
    out.varint(static_cast<std::uint64_t>(scan.frame));
    put(out, scan.T_frame_base);
    put(out, scan.scan);
  }
  out.varint(static_cast<std::uint64_t>(map.here));
  put(out, map.T_frame_base);
  out.f64(map.path);
  put(out, map.frame_covariance);
  put(out, map.scan_covariance);
  return bytes;
}

SavedMap map_of(std::string_view payload) {
  ByteReader in(payload);
  SavedMap map;
  for (double* value : {&map.T_base_laser.x, &map.T_base_laser.y, &map.T_base_laser.z})
    *value = within(in.f64(), -kFarthestMount, kFarthestMount, "a laser far off its robot");
  for (double* value : {&map.T_base_laser.yaw, &map.T_base_laser.pitch, &map.T_base_laser.roll})
    *value = take_angle(in);
  const auto frames = static_cast<int>(in.count(50));
  if (frames == 0) throw BadPayload("no key frame");
  std::vector<KeyFrame> kept;
  std::vector<int> before;
  PoseGraph graph;
  for (int i = 0; i < frames; ++i) {
    graph.nodes.push_back(take_pose(in));
    before.push_back(take_index(in, i + 1) - 1);
    kept.push_back(take_frame(in));
  }
  const std::size_t edges = in.count(99);
  for (std::size_t k = 0; k < edges; ++k) graph.edges.push_back(take_edge(in, frames));
  map.frames = KeyFrames(std::move(kept), std::move(before), std::move(graph));
  const std::size_t scans = in.count(56);
  for (std::size_t k = 0; k < scans; ++k) {
    SavedScan scan;
    scan.frame = take_index(in, frames);
    scan.T_frame_base = take_pose(in);
    scan.scan = take_scan(in);
    map.scans.push_back(std::move(scan));
  }
  map.here = take_index(in, frames);
  map.T_frame_base = take_pose(in);
  map.path = take_path(in);
  map.frame_covariance = take_matrix(in);
  map.scan_covariance = take_matrix(in);
  if (in.left() != 0) throw BadPayload("more bytes than a map has");
  return map;
}

[[noreturn]] void fail(const std::string& name, const std::string& what) {
  throw InputError(name + ": " + what + "; copy the file again, or map the log again");
}

}  // namespace

std::string encode_map(const SavedMap& map) {
  const std::string payload = payload_of(map);
  uLongf packed_size = compressBound(static_cast<uLong>(payload.size()));
  std::string packed(packed_size, '\0');
  compress2(reinterpret_cast<Bytef*>(packed.data()), &packed_size, reinterpret_cast<const Bytef*>(payload.data()),
            static_cast<uLong>(payload.size()), kPacking);
  packed.resize(packed_size);
  std::string head;
  ByteWriter out(head);
  put_u64(out, payload.size());
  put_u64(out, packed.size());
  out.u32(crc32_of(packed));
  out.u32(crc32_of(head));
  return std::string(kMagic) + head + packed;
}

SavedMap decode_map(std::string_view bytes, const std::string& name) {
  if (bytes.substr(0, kMagic.size()) != kMagic) {
    const std::size_t line = bytes.substr(0, 40).find('\n');
    if (line != std::string_view::npos && bytes.substr(0, kStem.size()) == kStem)
      throw InputError(name + ": a map of version '" + std::string(bytes.substr(kStem.size(), line - kStem.size())) +
                       "', but this program reads version 2; map the log again");
    throw InputError(name + ": is no map with a graph; give a map.rmap that 'rubble map' or 'rubble run' wrote");
  }
  bytes.remove_prefix(kMagic.size());
  if (bytes.size() < kHead) fail(name, "is cut");
  const std::string_view head = bytes.substr(0, kHead);
  ByteReader in(head);
  const std::uint64_t size = take_u64(in);
  const std::uint64_t packed_size = take_u64(in);
  const std::uint32_t sum = in.u32();
  if (in.u32() != crc32_of(head.substr(0, kHead - 4))) fail(name, "is damaged in its head");
  const std::string_view packed = bytes.substr(kHead);
  if (packed.size() != packed_size)
    fail(name, "holds " + std::to_string(packed.size()) + " bytes instead of " + std::to_string(packed_size));
  if (crc32_of(packed) != sum) fail(name, "is damaged");
  if (size > std::min(kMostUnpacked, kFreeUnpacked + kMostPacking * packed_size))
    fail(name, "would unpack to " + std::to_string(size >> 20U) + " MB, more than a map of its size");
  std::string payload(static_cast<std::size_t>(size), '\0');
  auto got = static_cast<uLongf>(size);
  if (uncompress(reinterpret_cast<Bytef*>(payload.data()), &got, reinterpret_cast<const Bytef*>(packed.data()),
                 static_cast<uLong>(packed.size())) != Z_OK ||
      got != size)
    fail(name, "is damaged");
  try {
    return map_of(payload);
  } catch (const BadPayload& bad) {
    fail(name, std::string("is damaged (") + bad.what() + ")");
  }
}

}  // namespace rubble::slam
