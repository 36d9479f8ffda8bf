#pragma once

#include "explore/explorer.h"

namespace rubble::explore {

/// So much of a mission's time is kept for the way home, beside what the way itself takes: a time limit that is not
/// longer explores nothing. 0: this explorer does not drive home [s].
double time_for_home(const Explorer& explorer);

}  // namespace rubble::explore
