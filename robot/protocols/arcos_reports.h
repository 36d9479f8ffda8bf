#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace rubble::robot::arcos {

/// First byte of what the robot sends.
enum PacketType : std::uint8_t {
  kConfigPacket = 0x20,
  kStoppedPacket = 0x32,  ///< standard information, wheels at rest
  kMovingPacket = 0x33,   ///< standard information, wheels turning
  kSimLaserPacket = 0x60,
  kSimLaserExtendedPacket = 0x61,
  kSimStatPacket = 0x62,
  kSimInfoPacket = 0x63,
  kEncoderPacket = 0x90,
};

/// Bits of StandardInformation::flags and ::stall.
constexpr int kMotorsOn = 1 << 0;
constexpr int kEmergencyButton = 1 << 5;
constexpr int kLeftStall = 1 << 0;
constexpr int kRightStall = 1 << 8;

/// The standard server information packet, sent every cycle (Pioneer 3 operations manual, table of SIP contents).
struct StandardInformation {
  bool moving = false;
  std::uint16_t x = 0;       ///< dead reckoning [mm], rolls over
  std::uint16_t y = 0;       ///< [mm], rolls over
  std::int16_t heading = 0;  ///< [4096ths of a turn], counter-clockwise
  std::int16_t left = 0;     ///< wheel speed [mm/s]
  std::int16_t right = 0;    ///< [mm/s]
  double battery = 12.0;     ///< [V]
  int stall = 0;             ///< bit 0 left, bit 8 right motor; the others are bumpers
  std::int16_t control = 0;  ///< set point of the heading servo [4096ths of a turn]
  int flags = 0;
  std::vector<std::pair<int, int>> sonar;  ///< number and range [mm]
  std::optional<double> turn_rate;         ///< [deg/s], in steps of 0.1; older firmware does not send it
};

/// The payload, with the fields up to the fault flags.
std::string encode(const StandardInformation& information);
/// Nothing unless it is a standard packet that reaches at least up to the flags.
std::optional<StandardInformation> parse_information(std::string_view payload);

/// What the numbers of one kind of robot mean (ARIA's parameter files, "Conversion factors").
struct Factors {
  double distance = 1.0;    ///< DistConvFactor: of x and y [mm]
  double turning = 0.0034;  ///< DiffConvFactor: turn rate over half the difference of the wheel speeds [rad/mm]
  /// Wheel speeds are v -+ w * half_track() [m].
  double half_track() const { return 1e-3 / turning; }
};
/// By the subclass that SYNC2 tells; nothing for one whose factors are not known: its distances would be wrong.
std::optional<Factors> factors_of(const std::string& subclass);
/// All that factors_of knows, for people.
std::string known_subclasses();

/// Who answered the third SYNC.
struct Identity {
  std::string name;
  std::string type;      ///< "Pioneer"
  std::string subclass;  ///< "p3at-sh"
};
std::string encode(const Identity& identity);
std::optional<Identity> parse_identity(std::string_view payload);

/// What of the configuration packet a client acts on; defaults are a Pioneer 3-AT's.
struct Configuration {
  std::string type = "Pioneer";
  std::string subtype = "p3at-sh";
  std::string serial = "SIM";
  std::string name = "rubble";
  std::string firmware = "S.0";
  int top_turn_rate = 300;   ///< [deg/s]
  int top_speed = 1200;      ///< [mm/s]
  int top_turn_accel = 300;  ///< [deg/s2]
  int top_accel = 2000;      ///< [mm/s2]
  int cycle_ms = 100;
  int watchdog_ms = 2000;
  int low_battery = 115;       ///< [0.1 V]
  int shutdown_battery = 110;  ///< [0.1 V]
  int max_turn_rate = 100;     ///< [deg/s]
  int max_speed = 700;         ///< [mm/s]
  int turn_accel = 100;        ///< [deg/s2]
  int accel = 300;             ///< [mm/s2]
  int rev_count = 22500;       ///< heading scale of the encoders
  int ticks_mm = 138;          ///< encoder ticks a millimetre
};
std::string encode(const Configuration& configuration);
std::optional<Configuration> parse_configuration(std::string_view payload);

/// Encoder counts of the two sides.
std::string encode_encoders(std::int32_t left, std::int32_t right);

/// What a simulator tells about itself.
struct SimStatus {
  int interval_ms = 100;
  int x_mm = 0;  ///< true pose
  int y_mm = 0;
  int heading_deg = 0;
};
std::string encode(const SimStatus& status);

/// Who the simulator is and which devices it plays, each a name and a type.
struct SimInfo {
  std::string name;
  std::string version;
  std::vector<std::pair<std::string, std::string>> devices;
};
std::string encode(const SimInfo& info);

/// A simulator's scan in the stream of reports, up to kMostLaserReadings a payload. Ranges in mm.
struct SimLaser {
  bool extended = false;  ///< with reflectance and flags, which are 0; else with the odometry before it
  int x_mm = 0, y_mm = 0, heading_deg = 0;  ///< odometry
  std::vector<int> ranges;
};
constexpr std::size_t kMostLaserReadings = 32;
std::vector<std::string> encode(const SimLaser& laser);

}  // namespace rubble::robot::arcos
