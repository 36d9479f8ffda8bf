#pragma once

#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "robot/logs/foreign/mrpt_bridge.h"

/// What of MRPT's files needs libmrpt-obs, which loads a hundred other libraries (image formats and databases of maps
/// among them): it lies in the module rubble_mrpt_logs.so, and only those who read or write such files wait for it.
namespace rubble::robot {

constexpr std::size_t kMostBeams = 100000;  ///< the finest scanners give 7200

/// What is said of an entry of a rawlog; the first byte of a record, the entry's number follows.
enum class Fact : std::uint8_t { Entry, Comment, Scan, Odometry, Movement, Unreadable };

/// What the module does.
struct MrptLogs {
  /// Hands out what the entries of a rawlog hold, as records that begin with a Fact.
  void (*tell)(std::string_view bytes, const std::string& path, const std::function<void(std::string_view)>& send);
  /// Hands `put` the bytes of a rawlog of what `next` gives until it gives nothing, and the comment at its end. Sorted
  /// by stamp; what comes more than a minute after its stamp stands where it came.
  void (*rawlog)(const std::function<std::optional<Inputs>()>& next, const mrpt::math::TPose3D& T_base_laser,
                 const std::string& comment, const std::function<void(std::string_view)>& put);
  std::string (*simplemap)(const std::vector<PosedScan>& scans, const mrpt::math::TPose3D& T_base_laser);
};

/// The border between the program and the module: one function, found by its name.
constexpr const char* kMrptLogsSymbol = "rubble_mrpt_logs";
using MrptLogsFunction = const MrptLogs* (*)();

/// The module, loaded when first asked for. Throws RunError where it cannot be.
const MrptLogs& mrpt_logs();

}  // namespace rubble::robot
