#include "slam/process/request.h"

#include <limits>
#include <map>

#include "base/text/words.h"
#include "robot/model_fields.h"

namespace rubble::slam {
namespace {

void put(std::string& text, const std::string& value) { text += ' ' + one_line(value); }
void put(std::string& text, double value) { append_number(text, value); }
void put(std::string& text, int value) { append_number(text, static_cast<std::int64_t>(value)); }
void put(std::string& text, bool value) { text += value ? " 1" : " 0"; }
void put(std::string& text, robot::AccelerometerMount value) { put(text, value == robot::AccelerometerMount::Body); }

void take(Words& words, std::string& value) { value = words.rest(); }
void take(Words& words, double& value) { value = words.real(); }
void take(Words& words, int& value) { value = static_cast<int>(words.whole(0, std::numeric_limits<int>::max())); }
void take(Words& words, bool& value) { value = words.whole(0, 1) != 0; }
void take(Words& words, robot::AccelerometerMount& value) {
  value = words.whole(0, 1) != 0 ? robot::AccelerometerMount::Body : robot::AccelerometerMount::Platform;
}

void append_stamp(std::string& text, Stamp stamp) { append_number(text, stamp.ns); }
Stamp take_stamp(Words& words) { return {words.whole(-kAnyStamp, kAnyStamp)}; }

void append_scan(std::string& text, const robot::LaserScan& scan) {
  text += "scan";
  append_stamp(text, scan.stamp);
  for (const double value : {scan.angle_min, scan.angle_step, scan.beam_period, scan.range_min, scan.range_max})
    append_number(text, value);
  append_number(text, static_cast<std::int64_t>(scan.ranges.size()));
  for (const float range : scan.ranges) append_number(text, range);
  text += '\n';
  if (scan.codes.empty()) return;
  text += "codes";
  append_number(text, static_cast<std::int64_t>(scan.codes.size()));
  for (const std::uint8_t code : scan.codes) append_number(text, static_cast<std::int64_t>(code));
  text += '\n';
}

robot::LaserScan take_scan(Words& words) {
  robot::LaserScan scan;
  scan.stamp = take_stamp(words);
  for (double* value : {&scan.angle_min, &scan.angle_step, &scan.beam_period, &scan.range_min, &scan.range_max})
    *value = words.real();
  const auto beams = words.whole(0, static_cast<std::int64_t>(kMostBeams));
  for (std::int64_t i = 0; i < beams; ++i) scan.ranges.push_back(static_cast<float>(words.real()));
  return scan;
}

/// What one line of a tick says.
void take_record(std::string_view kind, Words& words, robot::Inputs& inputs) {
  if (kind == "odometry") {
    robot::Odometry o;
    o.stamp = take_stamp(words);
    for (double* value : {&o.pose.x, &o.pose.y, &o.pose.phi, &o.v, &o.w}) *value = words.real();
    o.stalled = words.whole(0, 1) != 0;
    inputs.odometry.push_back(o);
  } else if (kind == "acceleration") {
    robot::Acceleration a;
    a.stamp = take_stamp(words);
    for (double* value : {&a.x, &a.y}) *value = words.real();
    inputs.accelerations.push_back(a);
  } else if (kind == "aim") {
    robot::AimState a;
    a.stamp = take_stamp(words);
    for (double* value : {&a.pitch, &a.roll}) *value = words.real();
    inputs.aims.push_back(a);
  } else if (kind == "scan") {
    inputs.scans.push_back(take_scan(words));
  } else if (kind == "codes") {
    const auto beams = words.whole(0, static_cast<std::int64_t>(kMostBeams));
    if (inputs.scans.empty()) throw BadMessage("codes without a scan before them");
    for (std::int64_t i = 0; i < beams; ++i)
      inputs.scans.back().codes.push_back(static_cast<std::uint8_t>(words.whole(0, 255)));
  } else if (kind == "command") {
    robot::Commands c;
    for (double* value : {&c.drive.v, &c.drive.w, &c.aim.pitch, &c.aim.roll}) *value = words.real();
    inputs.command = c;
  } else {
    return;
  }
  words.finish();
}

}  // namespace

void append_header(std::string& text, const MapperHeader& header) {
  text += "rubble-mapper " + std::to_string(kProtocolVersion) + "\nseed " + std::to_string(header.seed) + '\n';
  robot::each_model_field(header.model, [&](const robot::ModelKey& key, const auto& value) {
    if (key.protocol == nullptr) return;
    text += key.protocol;
    put(text, value);
    text += '\n';
  });
  std::size_t lines = 0;
  for (const char c : header.parameters) lines += c == '\n' ? 1u : 0u;
  if (lines > 0) text += "parameters " + std::to_string(lines) + '\n' + header.parameters;
  text += "start\n";
}

void append_tick(std::string& text, const robot::Inputs& inputs) {
  text += "tick";
  append_stamp(text, inputs.now);
  text += '\n';
  for (const robot::Odometry& o : inputs.odometry) {
    text += "odometry";
    append_stamp(text, o.stamp);
    for (const double value : {o.pose.x, o.pose.y, o.pose.phi, o.v, o.w}) append_number(text, value);
    text += o.stalled ? " 1\n" : " 0\n";
  }
  for (const robot::Acceleration& a : inputs.accelerations) {
    text += "acceleration";
    append_stamp(text, a.stamp);
    for (const double value : {a.x, a.y}) append_number(text, value);
    text += '\n';
  }
  for (const robot::AimState& a : inputs.aims) {
    text += "aim";
    append_stamp(text, a.stamp);
    for (const double value : {a.pitch, a.roll}) append_number(text, value);
    text += '\n';
  }
  for (const robot::LaserScan& scan : inputs.scans) append_scan(text, scan);
  if (inputs.command) {
    text += "command";
    const robot::Commands& c = *inputs.command;
    for (const double value : {c.drive.v, c.drive.w, c.aim.pitch, c.aim.roll}) append_number(text, value);
    text += '\n';
  }
  text += "end\n";
}

void append_finish(std::string& text) { text += "finish\nend\n"; }

MapperHeader read_header(MessageReader& in) {
  MapperHeader header;
  std::string_view line;
  if (!in.line(line)) throw BadMessage("there is no header");
  Words first(line);
  if (first.word() != "rubble-mapper") throw BadMessage("the header begins with " + in_quotes(line));
  if (first.whole(1, 1'000'000) != kProtocolVersion)
    throw BadMessage("version " + in_quotes(line) + "; known is " + std::to_string(kProtocolVersion));
  std::map<std::string, std::string, std::less<>> lines;
  for (;;) {
    if (!in.line(line)) throw BadMessage("the header has no end");
    Words words(line);
    const std::string key(words.word());
    if (key == "start") break;
    if (key == "parameters") {
      const auto count = words.whole(0, static_cast<std::int64_t>(kMostParameters));
      for (std::int64_t i = 0; i < count && in.line(line); ++i) header.parameters += std::string(line) + '\n';
      continue;
    }
    lines[key] = words.rest();
    if (lines.size() > kMostRecords) throw BadMessage("the header has no end");
  }
  Words seed(lines["seed"]);
  header.seed = static_cast<std::uint64_t>(seed.whole(0, kAnyStamp));
  robot::each_model_field(header.model, [&](const robot::ModelKey& key, auto& value) {
    if (key.protocol == nullptr) return;
    const auto found = lines.find(key.protocol);
    if (found == lines.end()) throw BadMessage("the header does not tell " + std::string(key.protocol));
    Words words(found->second);
    take(words, value);
  });
  return header;
}

std::optional<MapperRequest> read_request(MessageReader& in) {
  std::string_view line;
  if (!in.line(line)) return std::nullopt;
  MapperRequest request;
  Words first(line);
  const std::string_view kind = first.word();
  if (kind == "finish") {
    request.finish = true;
  } else if (kind == "tick") {
    request.inputs.now = take_stamp(first);
  } else {
    throw BadMessage(in_quotes(line) + " where a tick begins");
  }
  for (std::size_t records = 0; records < kMostRecords; ++records) {
    if (!in.line(line, std::numeric_limits<std::size_t>::max())) throw BadMessage("a tick has no end");
    Words words(line);
    const std::string_view record = words.word();
    if (record == "end") return request;
    take_record(record, words, request.inputs);
  }
  throw BadMessage("a tick has no end");
}

}  // namespace rubble::slam
