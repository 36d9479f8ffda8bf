#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include "base/stamp.h"

namespace rubble::robot {

/// How a device's answers come.
struct Answers {
  double late = 0.0;     ///< so long after the question, the way of the bytes left out [s]
  bool missing = false;  ///< none has come for so long, though it may report
};

/// Measures how late a device answers, by questions that cost nothing: reports that come unasked have no age of their
/// own, so what they and an order wait for on a slow line shows only in an answer.
///
/// Answers carry no number. While one is waited for the question is repeated, and when answers have ceased the last one
/// belongs to the last question: so one that got lost, or a silence, is not taken for a slow line. Nor is a single late
/// one but the first, for which this computer may have been busy, nor a single quick one for a line that is quick
/// again. Where some of several questions were not answered the answer may be to any of them: that makes a line slower
/// than was thought, never quicker. An answer that comes when none is waited for is to an older question than it
/// seemed: no other is asked until the line is quiet. Answers are missing when so many questions in a row went
/// unanswered that a line which loses one in five of them has that once in days.
class AnswerTimer {
 public:
  static constexpr double kPause = 0.3;      ///< between questions that are answered [s]
  static constexpr double kRepeat = 0.4;     ///< a question without an answer is asked again [s]
  static constexpr double kInsist = 0.12;    ///< and from then on so often [s]
  static constexpr double kMissing = 1.3;    ///< without any answer for so long it is late by so much [s]
  static constexpr std::size_t kInVain = 8;  ///< and so many questions at least were not answered
  static constexpr double kUnable = 5.0;     ///< a device that has never answered is not asked any more [s]

  /// The connection is a new one.
  void reset();
  /// What another question, the last one before, took [s].
  void assume(double late) {
    take(late, false);
    known_ = true;
  }
  /// Whether the question shall be asked at `now`.
  bool due(Stamp now) const { return now >= next(); }
  /// When it shall be asked next.
  Stamp next() const;
  void asked(Stamp now);
  /// `on_line`: so much of the way the bytes of question and answer take by the line's bit rate [s].
  void answered(Stamp now, double on_line = 0.0);
  /// Looks whether answers have ceased.
  void advance(Stamp now);
  /// The round trip as most of the last three answers have it, or the time that they have been missing for, when that
  /// is more; 0 at first, and of a device that does not know the question [s].
  double late(Stamp now) const;
  /// How late it is is known, or that it does not know the question. Where some of several questions were not answered
  /// it is a guess still.
  bool known() const { return unable_ || known_; }
  /// No answer for more than kMissing, or what is usual on a slow line, though there were some before.
  bool missing(Stamp now) const;

 private:
  void settle(Stamp now);
  void take(double late, bool sure);
  void take_at_least(double late, bool sure);

  std::vector<Stamp> asked_;        ///< since the first one without an answer
  std::vector<Stamp> answers_;      ///< to these
  Stamp settled_ = Stamp::never();  ///< nothing is waited for since
  Stamp last_asked_ = Stamp::never();
  double on_line_ = 0.0;
  std::vector<double> round_trips_;  ///< the last three [s]
  double least_ = 0.0;               ///< of the answers that are waited for; it took so long at least [s]
  double late_ = 0.0;                ///< median of the last three [s]
  double missed_ = 0.0;              ///< so long answers were missing before those that are coming now [s]
  bool restless_ = false;            ///< answers to questions that were repeated may still be on their way
  bool known_ = false;
  bool able_ = false;  ///< it has answered, over any connection
  bool unable_ = false;
};

}  // namespace rubble::robot
