#pragma once

#include "base/stamp.h"

namespace rubble::robot {

/// The computer's time at which a byte arrived, since 1970. It runs with the monotonic clock from the first call on, so
/// setting the computer's clock during a drive moves no stamp. Only drivers and emulators may ask it.
Stamp host_now();

/// How long this computer was suspended, since it was switched on; host_now() stands still meanwhile [s].
double time_asleep();

/// Sleeps until host_now() has reached `when`, to the precision of the system's timer.
void sleep_until(Stamp when);

}  // namespace rubble::robot
