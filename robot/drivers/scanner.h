#pragma once

#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include "robot/beam_order.h"

namespace rubble::robot {

/// What a scanner told of itself.
struct ScannerInfo {
  std::string model;     ///< as the device calls itself
  std::string firmware;  ///< version and date
  std::string serial;    ///< number
  std::string protocol;  ///< in use: `SCIP 2.0`, `SCIP 1.1`, or the MRPT class that speaks it
  LaserModel laser;      ///< geometry, ranges and timing as the device gives them
  std::vector<std::pair<std::string, std::string>> lines;  ///< every `KEY:value` it sent, in order
};

/// How the line to a scanner is doing.
struct ScannerStatus {
  bool connected = false;            ///< scans are coming, or are about to
  std::string error;                 ///< why not: one line that names the port and the remedy
  bool busy = false;                 ///< not connected because another program of this computer has the port
  bool slow = false;                 ///< not connected because it answers too late
  std::uint64_t turned_away = 0;     ///< how often another program seemed to have the scanner
  std::uint64_t scans = 0;           ///< whole scans received
  Stamp last_scan = Stamp::never();  ///< when the newest one arrived
  std::uint64_t damaged = 0;         ///< replies thrown away: wrong sum, wrong length, lost or doubled bytes
  std::uint64_t missed = 0;          ///< revolutions of which no whole scan came, by the device's clock
  std::uint64_t connects = 0;        ///< how often the handshake succeeded
  double latency = 0.0;         ///< from the last beam to the arrival of the scan's last byte, of the last scan [s]
  double worst_latency = 0.0;   ///< the most of it since the last connect [s]
  double recent_latency = 0.0;  ///< the most of it within the three seconds before the last scan [s]
  double clock_drift = 0.0;     ///< of the device's clock against the computer's, + : it runs slow [s/s]
  double clock_doubt = 0.0;  ///< the constant part of the stamps is known to +- so much [s]; 0: not measured, nominal
};

/// A scanner that is read in a thread of its own. It connects by itself, also again after the device was gone.
class Scanner {
 public:
  virtual ~Scanner() = default;
  /// Scans that arrived since the last call, the oldest first; stamps are host_now()'s.
  virtual std::vector<LaserScan> take() = 0;
  virtual ScannerStatus status() const = 0;
  /// Of the last connect; empty strings before.
  virtual ScannerInfo info() const = 0;
  /// For poll(): readable while scans wait to be taken.
  virtual int descriptor() const = 0;
};

/// The scan of a scanner that hangs upside down: its beams run clockwise, so the last one is the first.
inline void turn_over(LaserScan& scan) {
  if (scan.ranges.empty()) return;
  reverse_beams(scan);
  scan.angle_min = -scan.angle_min;
  scan.angle_step = -scan.angle_step;
}

}  // namespace rubble::robot
