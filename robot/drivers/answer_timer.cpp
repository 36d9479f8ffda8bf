#include "robot/drivers/answer_timer.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>

namespace rubble::robot {
namespace {

/// Answers to questions that were repeated come so far apart, and a bit more on a line that is not steady [s].
constexpr double kCeased = AnswerTimer::kRepeat + 0.15;
constexpr double kUsual = 1.5;   ///< so many times what they are late by answers may take
constexpr double kUnlike = 0.1;  ///< an answer that took so much longer than the one before is looked at again [s]
constexpr Stamp kNever{std::numeric_limits<std::int64_t>::max()};

}  // namespace

void AnswerTimer::reset() {
  asked_.clear();
  answers_.clear();
  settled_ = last_asked_ = Stamp::never();
  round_trips_.clear();
  least_ = missed_ = late_ = 0.0;
  restless_ = unable_ = known_ = false;
}

Stamp AnswerTimer::next() const {
  if (unable_ || !answers_.empty()) return kNever;  // what is on its way comes first
  if (!asked_.empty()) return asked_.back() + (asked_.size() == 1 ? kRepeat : kInsist);
  if (settled_ == Stamp::never()) return Stamp::never();
  if (restless_) return settled_ + std::max(kCeased, late_);
  return std::abs(round_trips_.back() - late_) > kUnlike ? settled_ : settled_ + kPause;
}

void AnswerTimer::asked(Stamp now) {
  asked_.push_back(now);
  last_asked_ = now;
}

void AnswerTimer::answered(Stamp now, double on_line) {
  able_ = true;
  unable_ = false;
  on_line_ = on_line;
  if (asked_.empty()) {
    // One before it was to another question than it was taken for: this one may be to any up to the last.
    if (last_asked_ == Stamp::never()) return;
    take_at_least(now - last_asked_ - on_line_, true);
    settled_ = now;
    restless_ = true;
    return;
  }
  if (answers_.empty() && missing(now)) missed_ = now - asked_.front();
  answers_.push_back(now);
  if (answers_.size() == asked_.size()) return settle(now);
  // It was late by this at least, whichever question it is to; asked again and again, no single one was held up.
  if (answers_.size() > 1) least_ = std::max(least_, now - asked_.back() - on_line_);
}

void AnswerTimer::settle(Stamp now) {
  const double last = std::max(0.0, answers_.back() - asked_.back() - on_line_);
  const bool all = answers_.size() == asked_.size();
  double took = last;
  for (std::size_t i = 0; all && i < asked_.size(); ++i) took = std::min(took, answers_[i] - asked_[i] - on_line_);
  restless_ = asked_.size() > 1;
  // Where some got lost it may have been to an earlier question than the last, and later than it seems.
  if (all) {
    if (!known_) round_trips_.clear();  // what was guessed so far it took at least
    known_ = true;
    take(std::max(took, least_), asked_.size() > 1);
  } else {
    take_at_least(std::max(took, least_), answers_.size() > 1);
  }
  least_ = missed_ = 0.0;
  asked_.clear();
  answers_.clear();
  settled_ = now;
}

/// What was later still remains so until it is known otherwise.
void AnswerTimer::take_at_least(double late, bool sure) {
  if (late > late_) take(late, sure);
}

/// `sure`: more than one answer says so.
void AnswerTimer::take(double late, bool sure) {
  for (int i = sure ? 0 : 1; i < 2; ++i) round_trips_.push_back(std::max(0.0, late));
  while (round_trips_.size() > 3) round_trips_.erase(round_trips_.begin());
  std::vector<double> sorted = round_trips_;
  std::sort(sorted.begin(), sorted.end());
  late_ = sorted[(sorted.size() - 1) / 2];
}

void AnswerTimer::advance(Stamp now) {
  // On a line that is slow and loses much the last ones may come after a gap.
  if (!answers_.empty() && now - std::max(answers_.back(), asked_.back() + late_) > kCeased) settle(now);
  if (!able_ && !asked_.empty() && now - asked_.front() > kUnable) {
    asked_.clear();
    round_trips_.clear();  // what another question took: how late it is now nobody can tell
    late_ = 0.0;
    unable_ = true;
  }
}

bool AnswerTimer::missing(Stamp now) const {
  if (missed_ > 0.0) return true;  // until it is known what the answers are to
  return able_ && asked_.size() >= kInVain && answers_.empty() &&
         now - asked_.front() > std::max(kMissing, kUsual * late_);
}

double AnswerTimer::late(Stamp now) const {
  if (missed_ > 0.0) return std::max({late_, least_, missed_});
  return std::max({late_, least_, missing(now) ? now - asked_.front() : 0.0});
}

}  // namespace rubble::robot
