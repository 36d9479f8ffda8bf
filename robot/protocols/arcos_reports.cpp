#include "robot/protocols/arcos_reports.h"

#include <algorithm>
#include <cmath>

#include "robot/protocols/arcos_commands.h"
#include "robot/protocols/arcos_packet.h"

namespace rubble::robot::arcos {
namespace {

constexpr std::size_t kUpToFlags = 18;  // bytes of the payload

/// The older controllers (without -sh) count in units of their own.
constexpr std::pair<const char*, Factors> kFactors[] = {
    {"p3at-sh", {1.0, 0.0034}}, {"p3atiw-sh", {1.0, 0.0034}}, {"p3at", {0.465, 0.0034}},
    {"p3dx-sh", {1.0, 0.0056}}, {"p3dx", {0.485, 0.0056}},
};

/// A walk over the configuration packet's fields in their order; one list serves reading and writing.
template <class Walk>
void walk(Walk& w, Configuration& c) {
  w.text(c.type);
  w.text(c.subtype);
  w.text(c.serial);
  w.byte(1);
  w.word(c.top_turn_rate);
  w.word(c.top_speed);
  w.word(c.top_turn_accel);
  w.word(c.top_accel);
  w.fixed(500);  // most of the motors' pulse width
  w.text(c.name);
  w.byte(c.cycle_ms);
  w.byte(0);   // host rate: 9600
  w.byte(0);   // auxiliary rate
  w.fixed(0);  // gripper
  w.fixed(0);  // front sonar
  w.byte(0);   // rear sonar
  w.word(c.low_battery);
  w.word(c.rev_count);
  w.word(c.watchdog_ms);
  w.byte(0);     // other packets
  w.fixed(400);  // stall: pulse width
  w.fixed(200);  // stall: rest [ms]
  w.word(c.max_speed);
  w.word(c.max_turn_rate);  // by joystick
  w.word(c.max_turn_rate);
  w.word(c.max_speed);
  w.word(c.turn_accel);
  w.word(c.turn_accel);
  for (const int gain : {40, 20, 0}) w.fixed(gain);  // turning: proportional, damping, integral
  w.word(c.accel);
  w.word(c.accel);
  for (const int gain : {40, 20, 0}) w.fixed(gain);  // travelling
  for (int i = 0; i < 3; ++i) w.byte(0);             // bumpers, charger
  w.byte(0);                                         // sonar cycle
  w.byte(0);                                         // the host rate is not changed
  w.byte(0);                                         // gyro
  w.fixed(0);                                        // drift
  w.byte(0);
  w.byte(0);  // rates of two more ports
  w.word(c.ticks_mm);
  w.word(c.shutdown_battery);
  w.text(c.firmware);
  w.fixed(0);
  w.fixed(0);  // gyro
  w.byte(0);   // poses are sent without delay
}

class Writer {
 public:
  explicit Writer(std::string& out) : out_(out) {}
  void text(const std::string& value) { put_text(out_, value); }
  void byte(int value) { put_u8(out_, value); }
  void word(int value) { put_u16(out_, value); }
  void fixed(int value) { put_u16(out_, value); }

 private:
  std::string& out_;
};

class Reader {
 public:
  explicit Reader(Fields& fields) : fields_(fields) {}
  void text(std::string& value) { value = fields_.text(); }
  void byte(int& value) { value = fields_.u8(); }
  void byte(int&& /*constant*/) { fields_.u8(); }
  void word(int& value) { value = fields_.u16(); }
  void fixed(int /*constant*/) { fields_.u16(); }

 private:
  Fields& fields_;
};

}  // namespace

std::string encode(const StandardInformation& s) {
  std::string out;
  put_u8(out, s.moving ? kMovingPacket : kStoppedPacket);
  put_u16(out, s.x);
  put_u16(out, s.y);
  put_u16(out, s.heading);
  put_u16(out, s.left);
  put_u16(out, s.right);
  put_u8(out, static_cast<int>(std::lround(s.battery * 10.0)));
  put_u16(out, s.stall);
  put_u16(out, s.control);
  put_u16(out, s.flags);
  put_u8(out, 0);  // compass
  put_u8(out, static_cast<int>(s.sonar.size()));
  for (const auto& [number, range] : s.sonar) {
    put_u8(out, number);
    put_u16(out, range);
  }
  for (int i = 0; i < 5; ++i) put_u8(out, 0);  // gripper, analogue and digital ports
  put_u16(out, static_cast<int>(std::lround(s.battery * 10.0)));
  put_u8(out, 0);  // charger
  put_u16(out, static_cast<int>(std::lround(s.turn_rate.value_or(0.0) * 10.0)));
  put_u16(out, 0);  // faults
  return out;
}

std::optional<StandardInformation> parse_information(std::string_view payload) {
  Fields fields(payload);
  const int type = fields.u8();
  if ((type != kStoppedPacket && type != kMovingPacket) || payload.size() < kUpToFlags) return std::nullopt;
  StandardInformation s;
  s.moving = type == kMovingPacket;
  s.x = fields.u16();
  s.y = fields.u16();
  s.heading = fields.i16();
  s.left = fields.i16();
  s.right = fields.i16();
  s.battery = 0.1 * fields.u8();
  s.stall = fields.u16();
  s.control = fields.i16();
  s.flags = fields.u16();
  fields.u8();  // compass
  const int count = fields.u8();
  for (int i = 0; i < count && fields.left() >= 3; ++i) {
    const int number = fields.u8();
    const int range = fields.u16();
    s.sonar.emplace_back(number, range);
  }
  fields.skip(5);
  if (fields.left() >= 2) {
    const int fine = fields.u16();  // the byte before ends at 25.5 V
    if (fine > 0) s.battery = 0.1 * fine;
  }
  fields.skip(1);
  if (fields.left() >= 2) s.turn_rate = 0.1 * fields.i16();
  return s;
}

std::optional<Factors> factors_of(const std::string& subclass) {
  const std::string plain = subclass.substr(0, subclass.find("-lms"));  // with a laser fitted: the same base
  for (const auto& [name, factors] : kFactors)
    if (plain == name) return factors;
  return std::nullopt;
}

std::string known_subclasses() {
  std::string names;
  for (const auto& [name, factors] : kFactors) names += (names.empty() ? "" : ", ") + std::string(name);
  return names;
}

std::string encode(const Identity& identity) {
  std::string out;
  put_u8(out, kSync2);
  put_text(out, identity.name);
  put_text(out, identity.type);
  put_text(out, identity.subclass);
  return out;
}

std::optional<Identity> parse_identity(std::string_view payload) {
  if (payload.size() < 2 || payload[0] != kSync2) return std::nullopt;
  Fields fields(payload, 1);
  Identity identity;
  identity.name = fields.text();
  identity.type = fields.text();
  identity.subclass = fields.text();
  return identity;
}

std::string encode(const Configuration& configuration) {
  std::string out;
  put_u8(out, kConfigPacket);
  Writer writer(out);
  Configuration copy = configuration;  // the walk takes what it could change
  walk(writer, copy);
  return out;
}

std::optional<Configuration> parse_configuration(std::string_view payload) {
  if (payload.empty() || payload[0] != kConfigPacket) return std::nullopt;
  Fields fields(payload, 1);
  Configuration configuration;
  Reader reader(fields);
  walk(reader, configuration);
  return configuration;
}

std::string encode_encoders(std::int32_t left, std::int32_t right) {
  std::string out;
  put_u8(out, kEncoderPacket);
  put_i32(out, left);
  put_i32(out, right);
  return out;
}

std::string encode(const SimStatus& s) {
  std::string out;
  put_u8(out, kSimStatPacket);
  put_u16(out, 0);
  put_i32(out, 1);  // there is a map
  for (int i = 0; i < 3; ++i) put_u16(out, s.interval_ms);
  put_i32(out, s.x_mm);
  put_i32(out, s.y_mm);
  put_i32(out, 0);
  put_i32(out, s.heading_deg);
  for (int i = 0; i < 3; ++i) put_i32(out, 0);  // no place on Earth
  put_i32(out, -1);
  for (int i = 0; i < 3; ++i) put_i32(out, 0);  // the odometry's error is not told
  return out;
}

std::string encode(const SimInfo& info) {
  std::string out;
  put_u8(out, kSimInfoPacket);
  put_text(out, info.name);
  put_text(out, info.version);
  put_i32(out, 0);  // neither a window nor a crash before
  put_i32(out, static_cast<std::int32_t>(info.devices.size()));
  for (const auto& [name, type] : info.devices) {
    put_text(out, name);
    put_text(out, type);
    put_u8(out, 0);
    put_i32(out, 0);
  }
  return out;
}

std::vector<std::string> encode(const SimLaser& laser) {
  std::vector<std::string> payloads;
  for (std::size_t first = 0; first < laser.ranges.size(); first += kMostLaserReadings) {
    const std::size_t count = std::min(kMostLaserReadings, laser.ranges.size() - first);
    std::string out;
    put_u8(out, laser.extended ? kSimLaserExtendedPacket : kSimLaserPacket);
    if (!laser.extended)
      for (const int value : {laser.x_mm, laser.y_mm, laser.heading_deg}) put_u16(out, value);
    put_u16(out, static_cast<int>(laser.ranges.size()));
    put_u16(out, static_cast<int>(first));
    put_u8(out, static_cast<int>(count));
    for (std::size_t i = first; i < first + count; ++i) {
      put_u16(out, laser.ranges[i]);
      if (!laser.extended) continue;
      put_u8(out, 0);   // reflectance
      put_u16(out, 0);  // flags
    }
    if (laser.extended) put_u16(out, 0);  // the laser's number, flags
    payloads.push_back(std::move(out));
  }
  return payloads;
}

}  // namespace rubble::robot::arcos
