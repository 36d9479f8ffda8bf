#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "robot/drivers/scanner.h"
#include "robot/drivers/scip/scip_receiver.h"

namespace rubble::robot::scip {

using Entries = std::vector<std::pair<std::string, std::string>>;

/// The status of a reply: two characters of SCIP 2.0 (their sum checked), one of SCIP 1.1; nothing when it is neither.
std::optional<std::string> status_of(const Reply& reply);

/// The `KEY:value` lines behind the status. SCIP 2.0: nothing when one sum is wrong; 1.1 has no sums.
std::optional<Entries> entries_of(const Reply& reply, bool sums);

/// A scanner's own numbers.
struct Geometry {
  int steps_per_turn = 0;
  int first_step = 0;
  int last_step = 0;
  int front_step = 0;
  int least_mm = 0;
  int most_mm = 0;
  int turns_per_minute = 0;

  std::size_t steps() const { return static_cast<std::size_t>(last_step - first_step + 1); }
  double step_angle() const;   ///< [rad]
  double period() const;       ///< of a turn [s]
  double step_time() const;    ///< [s]
  double after_sweep() const;  ///< from step 0 to the last step that measures [s]
};

/// From the lines of `PP`; nothing when one is missing or makes no sense.
std::optional<Geometry> geometry_of(const Entries& entries);

/// From the FIRM line of SCIP 1.1, `3.3.00,20/10/08(20-4095[mm],240[deg],44-725[step],600[rpm])`. The resolution is not
/// told: it is the URG-04LX's, 1024 steps a turn with step 384 in front. Nothing when it makes no sense.
std::optional<Geometry> geometry_of_firmware(const std::string& firmware);

LaserModel laser_of(const Geometry& geometry, const std::string& name);

/// One turn as the device sends it.
struct Sweep {
  std::uint32_t clock_ms = 0;         ///< when the beam passed step 0, 24 bits; SCIP 1.1: 0
  std::vector<std::uint32_t> values;  ///< [mm], or a code below 20
};

/// The scan in a reply of SCIP 2.0 with `count` values of three characters; nothing unless every sum and length is
/// right.
std::optional<Sweep> sweep_of(const Reply& reply, std::size_t count);

/// The scan in a reply of SCIP 1.1: values of two characters, without sums or time.
std::optional<Sweep> old_sweep_of(const Reply& reply, std::size_t count);

}  // namespace rubble::robot::scip
