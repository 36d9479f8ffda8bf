#include "robot/logs/own/log_codec.h"

#include <algorithm>
#include <cstring>
#include <utility>

#include "base/bytes.h"
#include "robot/logs/own/log_frames.h"
#include "robot/logs/own/model_json.h"
#include "robot/logs/own/range_codec.h"

namespace rubble::robot {
namespace {

// Bits, not values: 0.0 and -0.0 differ, a NaN equals itself.
bool same_bits(double a, double b) { return std::memcmp(&a, &b, sizeof a) == 0; }

bool same_geometry(const LaserScan& a, const LaserScan& b) {
  return same_bits(a.angle_min, b.angle_min) && same_bits(a.angle_step, b.angle_step) &&
         same_bits(a.beam_period, b.beam_period) && same_bits(a.range_min, b.range_min) &&
         same_bits(a.range_max, b.range_max);
}

void copy_geometry(const LaserScan& from, LaserScan& to) {
  to.angle_min = from.angle_min;
  to.angle_step = from.angle_step;
  to.beam_period = from.beam_period;
  to.range_min = from.range_min;
  to.range_max = from.range_max;
}

ByteReader open_payload(std::string_view payload) {
  ByteReader bytes(payload);
  bytes.u8();
  return bytes;
}

void expect_end(const ByteReader& bytes) {
  if (bytes.left() != 0) throw BadPayload("bytes are left over");
}

void put_scan(ByteWriter& bytes, std::string& out, const LaserScan& scan, LaserScan& last) {
  const bool repeated = same_geometry(scan, last);
  bytes.u8(repeated ? 0 : 1);
  if (!repeated) {
    for (const double value : {scan.angle_min, scan.angle_step, scan.beam_period, scan.range_min, scan.range_max})
      bytes.f64(value);
    copy_geometry(scan, last);
  }
  bytes.varint(scan.ranges.size());
  encode_ranges(scan.ranges, out);
}

LaserScan take_scan(ByteReader& bytes, LaserScan& last) {
  LaserScan scan;
  const std::uint8_t repeated = bytes.u8();
  if (repeated > 1) throw BadPayload("an unknown scan form");
  if (repeated == 1)
    for (double* value : {&last.angle_min, &last.angle_step, &last.beam_period, &last.range_min, &last.range_max})
      *value = bytes.f64();
  copy_geometry(last, scan);
  const std::uint64_t beams = bytes.varint();
  scan.ranges = decode_ranges(bytes, static_cast<std::size_t>(beams));
  return scan;
}

// A list: its length, then each entry's age (now - stamp) and what `put` writes.
template <class T, class Put>
void put_list(ByteWriter& bytes, Stamp now, const std::vector<T>& list, Put&& put) {
  bytes.varint(list.size());
  for (const T& entry : list) {
    bytes.svarint(wrapped_difference(now.ns, entry.stamp.ns));
    put(entry);
  }
}

template <class T, class Take>
void take_list(ByteReader& bytes, Stamp now, std::vector<T>& list, Take&& take) {
  const std::size_t count = bytes.count(2);
  list.reserve(count);
  for (std::size_t i = 0; i < count; ++i) {
    const std::int64_t age = bytes.svarint();
    T entry = take();
    entry.stamp.ns = wrapped_difference(now.ns, age);
    list.push_back(std::move(entry));
  }
}

}  // namespace

void append_header_frame(std::string& out, const LogHeader& header) {
  const std::size_t start = open_frame(out);
  ByteWriter bytes(out);
  const std::string model = model_to_json(header.model);
  bytes.u8(static_cast<std::uint8_t>(FrameKind::Header));
  bytes.varint(model.size());
  bytes.bytes(model);
  bytes.bytes(header.note);
  close_frame(out, start);
}

LogHeader decode_header(std::string_view payload) {
  ByteReader bytes = open_payload(payload);
  const std::uint64_t size = bytes.varint();
  LogHeader header;
  header.model = model_from_json(std::string(bytes.bytes(size)));
  header.note = std::string(bytes.bytes(bytes.left()));
  return header;
}

void append_commands_frame(std::string& out, const Commands& commands) {
  const std::size_t start = open_frame(out);
  ByteWriter bytes(out);
  bytes.u8(static_cast<std::uint8_t>(FrameKind::Commands));
  for (const double value : {commands.drive.v, commands.drive.w, commands.aim.pitch, commands.aim.roll})
    bytes.f64(value);
  if (commands.brake) bytes.u8(1);  // logs from before it could be asked for end here
  close_frame(out, start);
}

Commands decode_commands(std::string_view payload) {
  ByteReader bytes = open_payload(payload);
  Commands commands;
  for (double* value : {&commands.drive.v, &commands.drive.w, &commands.aim.pitch, &commands.aim.roll})
    *value = bytes.f64();
  if (bytes.left() > 0) commands.brake = bytes.u8() != 0;
  expect_end(bytes);
  return commands;
}

void append_codes_frame(std::string& out, const Inputs& inputs) {
  if (std::all_of(inputs.scans.begin(), inputs.scans.end(), [](const LaserScan& s) { return s.codes.empty(); })) return;
  const std::size_t start = open_frame(out);
  ByteWriter bytes(out);
  bytes.u8(static_cast<std::uint8_t>(FrameKind::Codes));
  bytes.varint(inputs.scans.size());
  for (const LaserScan& scan : inputs.scans) {
    bytes.varint(scan.codes.size());
    for (std::size_t first = 0, end = 0; first < scan.codes.size(); first = end) {
      while (end < scan.codes.size() && scan.codes[end] == scan.codes[first]) ++end;
      bytes.u8(scan.codes[first]);
      bytes.varint(end - first);
    }
  }
  close_frame(out, start);
}

std::vector<std::vector<std::uint8_t>> decode_codes(std::string_view payload) {
  constexpr std::uint64_t kMostBeams = 1000000;
  ByteReader bytes = open_payload(payload);
  std::vector<std::vector<std::uint8_t>> scans(bytes.count(1));
  for (auto& codes : scans) {
    const std::uint64_t beams = bytes.varint();
    if (beams > kMostBeams) throw BadPayload("a scan of " + std::to_string(beams) + " beams");
    while (codes.size() < beams) {
      const std::uint8_t code = bytes.u8();
      const std::uint64_t run = bytes.varint();
      if (run == 0 || run > beams - codes.size()) throw BadPayload("a run of codes that does not fit its scan");
      codes.insert(codes.end(), static_cast<std::size_t>(run), code);
    }
  }
  expect_end(bytes);
  return scans;
}

void append_battery_frame(std::string& out, const Inputs& inputs) {
  if (!inputs.battery) return;
  const std::size_t start = open_frame(out);
  ByteWriter bytes(out);
  bytes.u8(static_cast<std::uint8_t>(FrameKind::Battery));
  bytes.f64(inputs.battery->volts);
  bytes.f64(inputs.battery->low);
  close_frame(out, start);
}

BatteryState decode_battery(std::string_view payload) {
  ByteReader bytes = open_payload(payload);
  BatteryState battery;
  for (double* value : {&battery.volts, &battery.low}) {
    *value = bytes.f64();
    if (!(*value >= 0.0)) throw BadPayload("a battery without a voltage");
  }
  expect_end(bytes);
  return battery;
}

void append_tick_frame(std::string& out, const Inputs& inputs, TickContext& context) {
  const std::size_t start = open_frame(out);
  ByteWriter bytes(out);
  bytes.u8(static_cast<std::uint8_t>(FrameKind::Tick));
  bytes.svarint(wrapped_difference(inputs.now.ns, context.last_now.ns));
  context.last_now = inputs.now;
  put_list(bytes, inputs.now, inputs.scans,
           [&](const LaserScan& s) { put_scan(bytes, out, s, context.last_geometry); });
  put_list(bytes, inputs.now, inputs.odometry, [&](const Odometry& o) {
    for (const double value : {o.pose.x, o.pose.y, o.pose.phi, o.v, o.w}) bytes.f64(value);
    bytes.u8(o.stalled ? 1 : 0);
  });
  put_list(bytes, inputs.now, inputs.accelerations, [&](const Acceleration& a) {
    bytes.f64(a.x);
    bytes.f64(a.y);
  });
  put_list(bytes, inputs.now, inputs.aims, [&](const AimState& a) {
    bytes.f64(a.pitch);
    bytes.f64(a.roll);
  });
  put_list(bytes, inputs.now, inputs.cues, [&](const VictimCue& c) {
    bytes.u8(static_cast<std::uint8_t>(c.kind));
    for (const double value : {c.bearing, c.range, c.confidence}) bytes.f64(value);
  });
  close_frame(out, start);
}

Inputs decode_tick(std::string_view payload, TickContext& context) {
  ByteReader bytes = open_payload(payload);
  Inputs inputs;
  inputs.now.ns = wrapped_sum(context.last_now.ns, bytes.svarint());
  context.last_now = inputs.now;
  take_list(bytes, inputs.now, inputs.scans, [&] { return take_scan(bytes, context.last_geometry); });
  take_list(bytes, inputs.now, inputs.odometry, [&] {
    Odometry o;
    for (double* value : {&o.pose.x, &o.pose.y, &o.pose.phi, &o.v, &o.w}) *value = bytes.f64();
    o.stalled = bytes.u8() != 0;
    return o;
  });
  take_list(bytes, inputs.now, inputs.accelerations, [&] {
    Acceleration a;
    for (double* value : {&a.x, &a.y}) *value = bytes.f64();
    return a;
  });
  take_list(bytes, inputs.now, inputs.aims, [&] {
    AimState a;
    for (double* value : {&a.pitch, &a.roll}) *value = bytes.f64();
    return a;
  });
  take_list(bytes, inputs.now, inputs.cues, [&] {
    VictimCue c;
    c.kind = static_cast<CueKind>(bytes.u8());
    for (double* value : {&c.bearing, &c.range, &c.confidence}) *value = bytes.f64();
    return c;
  });
  expect_end(bytes);
  return inputs;
}

}  // namespace rubble::robot
