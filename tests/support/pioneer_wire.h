#pragma once

#include <cmath>
#include <deque>
#include <functional>
#include <random>
#include <string>
#include <utility>
#include <vector>

#include "robot/drivers/pioneer.h"
#include "robot/emulators/arcos_emulator.h"
#include "robot/emulators/line_faults.h"
#include "robot/protocols/arcos_commands.h"

namespace rubble::robot {

constexpr double kStep = 0.001;  ///< [s]
constexpr double kCycle = 0.1;   ///< of the reports [s]

/// The Pioneer's driver and its emulator, byte by byte over a wire without ports or clocks; the robot's wheels do what
/// the emulator asks, exactly.
class Wire {
 public:
  explicit Wire(ArcosEmulatorSettings emulator = {}, BaseSettings settings = {}) : base(emulator), driver(settings) {
    base.client_came(now);
    driver.opened(now, LineKind::Tcp);
  }

  void run(double seconds) {
    for (const Stamp end = now + seconds; now < end;) step();
  }

  /// Until it is true, at most so long; whether it became.
  bool run_until(const std::function<bool()>& reached, double seconds) {
    for (const Stamp end = now + seconds; now < end && !reached();) step();
    return reached();
  }

  void step() {
    now = now + kStep;
    driver.advance(now);
    const std::string to_base = driver.take_output(now);
    if (!to_base.empty()) said.push_back(to_base);
    const bool heard = !cut && (!deaf_to || !deaf_to(to_base));
    if (heard && !to_base.empty() && !gets_lost()) base.receive(to_base, now);
    base.advance(now);
    const Drive& motion = base.motion();
    truth.phi += motion.w * kStep;
    truth.x += motion.v * std::cos(truth.phi) * kStep;
    truth.y += motion.v * std::sin(truth.phi) * kStep;
    ++steps;
    if (steps % 100 == 0) base.measure({now, truth, motion.v, motion.w, false}, now);
    for (const std::string& piece : faults.pass(base.take_output(), now)) {
      if (!cut && !gets_lost()) on_its_way.emplace_back(now + slow, piece);
      if (listener != nullptr) listener->receive(piece, now);
    }
    for (; !on_its_way.empty() && on_its_way.front().first <= now; on_its_way.pop_front())
      driver.receive(on_its_way.front().second, now);
    if (listener != nullptr) {
      listener->advance(now);
      said_by_listener += listener->take_output(now);
    }
    for (const Odometry& o : driver.take_odometry()) odometry.push_back(o);
  }

  bool gets_lost() {
    const bool gone = loss > 0.0 && std::uniform_real_distribution<double>()(random) < loss;
    lost += gone ? 1 : 0;
    return gone;
  }

  void go(double v, double w) {
    driver.enable(true);
    run_until([&] { return driver.motors_on(); }, 2.0);
    driver.drive({v, w});
  }

  Stamp now{1'700'000'000'000'000'000};
  ArcosEmulator base;
  Pioneer driver;
  LineFaults faults{1};
  mrpt::math::TPose2D truth;
  std::vector<Odometry> odometry;
  bool cut = false;
  std::function<bool(const std::string&)> deaf_to;  ///< packets that the base passes over
  std::vector<std::string> said;                    ///< by the driver
  double slow = 0.0;                                ///< the base's bytes take so long [s]
  std::deque<std::pair<Stamp, std::string>> on_its_way;
  double loss = 0.0;  ///< so many of the packets never arrive, either way
  std::mt19937 random{1};
  int lost = 0;
  int steps = 0;
  Pioneer* listener = nullptr;  ///< hears what the base says
  std::string said_by_listener;
};

}  // namespace rubble::robot
