#pragma once

#include <cstddef>
#include <functional>
#include <string>
#include <string_view>

#include "robot/logs/foreign/mrpt_bridge.h"
#include "robot/measurements.h"

namespace rubble::robot {

/// The movement of one action: raw odometry when there is any.
struct Movement {
  mrpt::math::TPose2D step;
  double v = 0.0;
  double w = 0.0;
};

/// Takes what matters to us of a rawlog's entries, in order; `entry` counts from 0.
class RawlogVisitor {
 public:
  virtual ~RawlogVisitor() = default;
  virtual void comment(std::size_t entry, const std::string& text) = 0;
  virtual void scan(std::size_t entry, MrptScan scan) = 0;
  virtual void odometry(std::size_t entry, const Odometry& odometry) = 0;
  virtual void movement(std::size_t entry, const Movement& movement) = 0;
};

/// Visits the scans, odometry, movements and comments of a rawlog. MRPT trusts the counts and lengths of a file, so it
/// reads them in a child process with bounded memory (256 MB and four times the file) and time; what comes back was
/// checked: flags are 0 or 1, times lie between 1824 and 2116, a scan has at most 100,000 beams.
/// Throws InputError in one line that says which entry is damaged.
void visit_rawlog(std::string_view bytes, const std::string& path, RawlogVisitor& visitor);

}  // namespace rubble::robot
