#include "robot/drivers/watch/answer_watch.h"

#include <cstdio>

namespace rubble::robot {

bool AnswerWatch::look(const Answers& given, Stamp now) {
  freshness_.look(given.late, most_, now, given.missing);
  return !freshness_.stale();
}

std::string AnswerWatch::trouble(const Answers& given) const {
  char text[160];
  const double late = freshness_.stale().value_or(given.late);
  if (given.missing || freshness_.missing()) {
    std::snprintf(text, sizeof text, "%s for %.1f s; it does not hear, or the line to it is too slow",
                  given.missing ? "reports, but has not answered" : "had not answered", late);
  } else {
    std::snprintf(text, sizeof text, "answers %.1f s late (at most %g s); the line to it or this computer is too slow",
                  late, most_);
  }
  return text;
}

}  // namespace rubble::robot
