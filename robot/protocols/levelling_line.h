#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace rubble::robot {

/// `$body*HH\r\n`, HH the exclusive or of the body's bytes, as in NMEA 0183. docs/hardware.md describes the protocol.
std::string levelling_line(std::string_view body);

/// Cuts a stream of bytes into lines.
class LevellingLines {
 public:
  void feed(std::string_view bytes);
  /// The fields, split at commas, of the next line with a good sum; nothing while more bytes are needed.
  std::optional<std::vector<std::string>> next();
  void reset() { waiting_.clear(); }
  /// Lines with a wrong sum or without frame, since the start.
  std::size_t bad_lines() const { return bad_lines_; }

 private:
  std::string waiting_;
  std::size_t bad_lines_ = 0;
};

/// `$V,...`: what the unit is.
struct LevellingIdentity {
  std::string model = "LEV1";
  std::string sensor = "ADXL202";
  int tick_hz = 1000000;
  int period_ticks = 10000;  ///< nominal T2
  int rate = 50;             ///< reports a second
  int us_min = 900;
  int us_max = 2100;
  int watchdog_ms = 500;
};
std::string body(const LevellingIdentity& identity);
std::optional<LevellingIdentity> parse_identity(const std::vector<std::string>& fields);

/// `$L,1,...`: one measurement.
struct LevellingReport {
  static constexpr int kServosOn = 1, kSettled = 2, kWatchdog = 4, kSensorFault = 8, kClipped = 16;
  int sequence = 0;           ///< mod 65536
  std::uint32_t time_us = 0;  ///< the unit's clock in the middle of the measurement, mod 2^32
  long t1x = 0;               ///< high time, forward axis [ticks]; may be a sum over several periods
  long t1y = 0;               ///< left axis
  long t2 = 1;                ///< period, summed likewise
  int pitch_us = 1500;        ///< pulse being output; longer: nose up
  int roll_us = 1500;         ///< longer: left side up
  int flags = 0;
};
std::string body(const LevellingReport& report);
std::optional<LevellingReport> parse_report(const std::vector<std::string>& fields);

/// A whole decimal number within bounds; nothing for any other text.
std::optional<long> whole_number(const std::string& text, long low, long high);

}  // namespace rubble::robot
