#pragma once

#include <string>

#include "robot/drivers/answer_timer.h"
#include "robot/drivers/watch/freshness.h"

namespace rubble::robot {

/// Whether a device answers in time: an order to stop would be as late as its answers are.
class AnswerWatch {
 public:
  /// Answers may be late by `most` [s].
  explicit AnswerWatch(double most) : most_(most) {}

  /// Answers as they come by now. False: they are late or missing, or were so a moment ago.
  bool look(const Answers& given, Stamp now);
  /// What is wrong, in words, of answers that are not in time.
  std::string trouble(const Answers& given) const;

 private:
  const double most_;
  Freshness freshness_;
};

}  // namespace rubble::robot
