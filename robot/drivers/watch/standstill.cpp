#include "robot/drivers/watch/standstill.h"

#include "robot/drivers/watch/freshness.h"

namespace rubble::robot {

bool Standstill::look(Stamp now, double asleep) {
  const double gone = now - Stamp{looked_ns_.load()} + asleep - asleep_;
  const bool stood = gone > kBusy;
  if (stood) {
    seconds_ = gone;
    until_ns_ = (now + kKeepsUp).ns;
  }
  asleep_ = asleep;
  looked_ns_ = now.ns;
  return stood;
}

bool Standstill::is_over(Stamp now, double asleep) const {
  return now - Stamp{looked_ns_.load()} + asleep - asleep_ <= kBusy && now >= Stamp{until_ns_.load()};
}

double Standstill::seconds(Stamp now, double asleep) const {
  const double gone = now - Stamp{looked_ns_.load()} + asleep - asleep_;
  return gone > kBusy ? gone : seconds_.load();
}

}  // namespace rubble::robot
