#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

namespace rubble::robot::arcos {

/// Numbers of the commands a client sends (Pioneer 3 operations manual, table of client commands); those above 200 are
/// understood by simulators only (MobileSim's documentation).
enum Command : std::uint8_t {
  kSync0 = 0,
  kSync1 = 1,
  kSync2 = 2,
  kPulse = 0,  ///< the first three numbers mean this once the connection is open
  kOpen = 1,
  kClose = 2,
  kEnable = 4,
  kSetAcceleration = 5,       ///< mm/s2; negative: the deceleration
  kSetSpeed = 6,              ///< mm/s
  kSetOrigin = 7,             ///< odometry to 0, 0, 0
  kMove = 8,                  ///< mm
  kRotate = 9,                ///< deg/s
  kSetTurnRate = 10,          ///< deg/s
  kVelocity = 11,             ///< mm/s
  kHead = 12,                 ///< deg, absolute
  kTurnBy = 13,               ///< deg, relative
  kConfig = 18,               ///< asks for the configuration packet
  kEncoder = 19,              ///< 0: never, 1: once, 2: always
  kTurnRate = 21,             ///< deg/s, counter-clockwise
  kSetTurnAcceleration = 23,  ///< deg/s2; negative: the deceleration
  kStop = 29,
  kWheelSpeeds = 32,  ///< low byte right, high byte left, signed, 20 mm/s
  kEmergencyStop = 55,
  kOldLaserEnable = 35,  ///< numbers of older simulators for kSimLaserEnable and what follows it
  kOldLaserStart = 36,
  kOldLaserEnd = 37,
  kOldLaserStep = 38,
  kSimSetPose = 224,
  kSimReset = 225,        ///< back to where it began, odometry to 0, 0, 0
  kSimLaserEnable = 230,  ///< 0: off, 1: packets kSimLaserPacket, 2: kSimLaserExtendedPacket
  kSimLaserStart = 231,   ///< deg, first reading
  kSimLaserEnd = 232,     ///< deg, last reading
  kSimLaserStep = 233,    ///< 0.01 deg between readings
  kSimControl = 236,      ///< kSimTellInfo asks for the simulator's own packet; the others are not obeyed
  kSimStat = 237,         ///< none or 1: once, 2: with every report, 0: never
  kBatteryTest = 250,     ///< 0.1 V; 0: as it is
  kReset = 253,
  kMaintenance = 255,
};

constexpr int kSimTellInfo = 6;  ///< of kSimControl

/// Whole packets, ready to be sent.
std::string command(Command number);
std::string command(Command number, int value);  ///< |value| <= 65535; kept to that
std::string sim_set_pose(int x_mm, int y_mm, int heading_deg);

/// A command as the robot takes it out of a packet.
struct Order {
  std::uint8_t number = 0;
  std::optional<int> value;  ///< the integer argument with its sign
  std::string text;          ///< the string argument
  std::string rest;          ///< everything behind the number
};

/// Takes all forms that clients send: no argument, an argument type without a value, integers, strings.
/// Nothing for an empty payload.
std::optional<Order> parse_order(std::string_view payload);

struct WheelSpeeds {
  int left = 0;   ///< [20 mm/s]
  int right = 0;  ///< [20 mm/s]
};
/// The two signed bytes of a kWheelSpeeds argument, which some clients send raw and some as a signed word.
WheelSpeeds wheel_speeds(int value);

}  // namespace rubble::robot::arcos
