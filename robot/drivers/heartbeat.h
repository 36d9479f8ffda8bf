#pragma once

#include <string>

#include "base/stamp.h"
#include "robot/drivers/descriptor.h"

namespace rubble::robot {

/// The operator's sign of life: a file that is touched or a pipe that is written to again and again.
class Heartbeat {
 public:
  /// An empty path: nobody is asked for. A file that is not there yet counts as silence.
  explicit Heartbeat(std::string path) : path_(std::move(path)) {}
  /// When the last sign came; Stamp::never() before the first. Without a path: `now`.
  Stamp last(Stamp now);

 private:
  std::string path_;
  Descriptor pipe_;
  std::int64_t touched_ns_ = 0;  ///< the file's own time
  Stamp last_ = Stamp::never();
};

}  // namespace rubble::robot
