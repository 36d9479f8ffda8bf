#pragma once

#include <mrpt/math/TPose2D.h>

#include <functional>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "robot/emulators/emulated_device.h"
#include "robot/emulators/line_faults.h"
#include "scenarios/config/scenario.h"

namespace rubble::scenarios {

enum class EmulatedKind { Scanner, Base, Levelling };
/// What happens to a device's port.
enum class PortFault { Silence, Unplug, Slow };
using Fault = std::variant<robot::ByteFault, PortFault, robot::DeviceFault>;

/// Something goes wrong with an emulated device.
struct FaultAt {
  std::string name;  ///< DEVICE-FAULT, as people call it
  EmulatedKind device = EmulatedKind::Base;
  Fault fault = PortFault::Silence;
  double seconds = 0.0;  ///< after the start
};

/// Reads NAME@SECONDS. Throws UsageError, which names all that are known.
FaultAt parse_fault(const std::string& text);

/// "urg", "base", "levelling": as faults and options call the devices.
const char* name_of(EmulatedKind device);

struct EmulateOptions {
  std::string urg;  ///< port words; empty: that device is not there
  std::string base;
  std::string levelling;
  const std::string& port(EmulatedKind device) const;
  std::vector<FaultAt> faults;
  mrpt::math::TPose2D odometry_start;                          ///< what the base's dead reckoning begins with
  double urg_yaw = 0.0;                                        ///< of the scanner's mount, counter-clockwise [rad]
  bool urg_upside_down = false;                                ///< it hangs from its mount
  bool as_hardware = false;                                    ///< the base does not say that it is a simulator
  double time_limit = 0.0;                                     ///< 0: until interrupted [s]
  std::string truth;                                           ///< .tum file for the true trajectory; empty: none
  std::function<void(const std::vector<std::string>&)> ready;  ///< the ports are open: their words
  std::function<void(const std::string&)> tell;                ///< a fault begins: one line
  std::function<void(const std::string&)> warn;                ///< a client asks for what cannot be: one line
  std::function<bool()> interrupted;
};

struct EmulationReport {
  double seconds = 0.0;
  double late_95 = 0.0;  ///< how late a tick began [s]
  double late_worst = 0.0;
  std::uint64_t scans = 0;
};

/// Simulates the robot of a scenario in real time and offers its devices on ports. Throws InputError, RunError.
EmulationReport emulate(const Scenario& scenario, const EmulateOptions& options);

}  // namespace rubble::scenarios
