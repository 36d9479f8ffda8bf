// What a base may send to the Pioneer driver, with time and set points in between: odometry stays finite and in order,
// answers are late by no more than the time that has passed, and whether the base obeys can be told from it.
// A driver that listens says nothing as long as it does.
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <string>

#include "robot/drivers/pioneer.h"
#include "robot/drivers/watch/obedience.h"

namespace {

using namespace rubble;
using namespace rubble::robot;

void require(bool law) {
  if (!law) std::abort();
}

void converse(const BaseSettings& settings, const std::uint8_t* data, std::size_t size) {
  Pioneer driver{settings};
  const Stamp begun{1'000'000'000};
  Stamp now = begun;
  driver.opened(begun, size % 2 == 1 ? LineKind::Uart : LineKind::Tcp);
  driver.enable(true);
  Obedience obedience(settings.max_accel, settings.max_turn_accel);
  Stamp last = Stamp::never(), told_at = Stamp::never();
  for (std::size_t at = 0; at < size;) {
    // Each piece: its length, the milliseconds before it, and its bytes.
    const std::size_t length = data[at] % 64u;
    now = now + 0.001 * (at + 1 < size ? data[at + 1] : 0);
    at += 2;
    if (at >= size) break;
    const std::size_t piece = std::min(length, size - at);
    driver.receive({reinterpret_cast<const char*>(data + at), piece}, now);
    at += piece;
    const Drive told{0.01 * static_cast<double>(length), 0.3};
    driver.drive(told);
    if (told_at == Stamp::never() || now - told_at >= 0.01) {  // as RealRobot does, not again and again at one moment
      obedience.tell(told, now);
      told_at = now;
    }
    driver.advance(now);
    const std::string out = driver.take_output(now);
    require(out.size() <= 200);
    require(out.empty() || driver.state().rfind("listen", 0) != 0);
    driver.deadline();
    const BaseDriver::Answers answers = driver.answers(now);
    require(answers.late >= 0.0 && answers.late <= now - begun);
    require(!answers.missing || answers.late > 0.3);
    if (length == 63) obedience.pause();
    for (const Odometry& o : driver.take_odometry()) {
      require(std::isfinite(o.pose.x) && std::isfinite(o.pose.y) && std::abs(o.pose.phi) <= 3.1416);
      require(last == Stamp::never() || o.stamp > last);
      last = o.stamp;
      obedience.look(o, now);
      require(!obedience.runs_away() || !obedience.trouble().empty());
    }
  }
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  converse({}, data, size);
  BaseSettings listening;
  listening.passive = listening.listen = true;
  converse(listening, data, size);
  return 0;
}
