#include "explore/paper/levelling_care.h"

namespace rubble::explore {
namespace {

constexpr double kPatience = 5.0;  ///< a unit that was unplugged talks again within [s]

}  // namespace

void LevellingCare::update(const robot::Inputs& inputs) {
  const robot::LevellingState before = watch_.state();
  watch_.update(inputs);
  news_.clear();
  if (given_up_) return;
  if (jammed()) {
    given_up_ = true;
    news_ = "the levelling unit does not take the tilt away";
  } else if (works()) {
    if (before != robot::LevellingState::Works) news_ = "the levelling unit talks again";
  } else if (before == robot::LevellingState::Works) {
    failed_ = inputs.now;
    news_ = "the levelling unit is silent: waits for it";
  } else if (inputs.now - failed_ > kPatience) {
    given_up_ = true;
  }
}

}  // namespace rubble::explore
