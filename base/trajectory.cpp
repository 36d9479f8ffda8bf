#include "base/trajectory.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <cinttypes>
#include <cmath>
#include <cstdio>
#include <sstream>
#include <string_view>

#include "base/angle.h"
#include "base/error.h"
#include "base/text/number_text.h"
#include "base/text/text_file.h"
#include "base/text/words.h"

namespace rubble {
namespace {

struct Word {
  std::string_view text;
  int column = 1;
};

/// The words before a '#'.
std::vector<Word> words_of(std::string_view line) {
  line = line.substr(0, line.find('#'));
  std::vector<Word> words;
  std::size_t end = 0;
  while (true) {
    const std::size_t start = line.find_first_not_of(" \t\r", end);
    if (start == std::string_view::npos) return words;
    end = std::min(line.find_first_of(" \t\r", start), line.size());
    words.push_back({line.substr(start, end - start), static_cast<int>(start) + 1});
  }
}

/// Seconds to nanoseconds; a Unix time with nanoseconds needs more than the 53 bits of a double.
std::optional<Stamp> parse_stamp(std::string_view text) {
  long double seconds = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), seconds);
  if (error != std::errc{} || end != text.data() + text.size() || !(std::abs(seconds) < 9.2e9L)) return std::nullopt;
  return Stamp{std::llround(seconds * 1e9L)};
}

StampedPose parse_tum_line(const std::vector<Word>& words, const std::string& path, int line) {
  static constexpr const char* kFields = "'time x y z qx qy qz qw'";
  if (words.size() != 8)
    throw InputError(
        at(path, line, words.front().column, std::to_string(words.size()) + " fields; give 8 numbers " + kFields));
  std::array<double, 8> v{};
  for (std::size_t i = 0; i < 8; ++i) {
    const auto number = parse_number(words[i].text);
    if (!number)
      throw InputError(
          at(path, line, words[i].column, in_quotes(words[i].text) + " is no number; give 8 numbers " + kFields));
    v[i] = *number;
  }
  const auto stamp = parse_stamp(words[0].text);
  if (!stamp) throw InputError(at(path, line, words[0].column, in_quotes(words[0].text) + " is no time in seconds"));
  const double qx = v[4], qy = v[5], qz = v[6], qw = v[7];
  const double norm = qx * qx + qy * qy + qz * qz + qw * qw;
  if (!(std::abs(norm - 1.0) < 0.01))
    throw InputError(
        at(path, line, words[4].column, "the quaternion is not of length 1; give qx qy qz qw in this order"));
  const double yaw = std::atan2(2.0 * (qw * qz + qx * qy), norm - 2.0 * (qy * qy + qz * qz));
  return {*stamp, {v[1], v[2], yaw}};
}

}  // namespace

using mrpt::math::TPose2D;

TPose2D interpolate(const TPose2D& a, const TPose2D& b, double u) {
  return {a.x + u * (b.x - a.x), a.y + u * (b.y - a.y), wrap_angle(a.phi + u * wrap_angle(b.phi - a.phi))};
}

std::optional<TPose2D> pose_at(const Trajectory& trajectory, Stamp stamp) {
  const auto after = std::lower_bound(trajectory.begin(), trajectory.end(), stamp,
                                      [](const StampedPose& p, Stamp s) { return p.stamp < s; });
  if (after == trajectory.end()) return std::nullopt;
  if (after->stamp == stamp) return after->pose;
  if (after == trajectory.begin()) return std::nullopt;
  const auto before = after - 1;
  return interpolate(before->pose, after->pose, (stamp - before->stamp) / (after->stamp - before->stamp));
}

std::vector<PosePair> associate(const Trajectory& estimate, const Trajectory& truth) {
  std::vector<PosePair> pairs;
  for (const StampedPose& stamped : estimate)
    if (const auto true_pose = pose_at(truth, stamped.stamp)) pairs.push_back({stamped.pose, *true_pose});
  return pairs;
}

std::string stamp_text(Stamp stamp) {
  char text[40];
  const bool is_negative = stamp.ns < 0;
  const auto ns = is_negative ? -static_cast<std::uint64_t>(stamp.ns) : static_cast<std::uint64_t>(stamp.ns);
  std::snprintf(text, sizeof text, "%s%" PRIu64 ".%09" PRIu64, is_negative ? "-" : "", ns / 1000000000u,
                ns % 1000000000u);
  return text;
}

std::string tum_line(const StampedPose& stamped) {
  char pose[130];
  const double half = 0.5 * wrap_angle(stamped.pose.phi);
  std::snprintf(pose, sizeof pose, " %.6f %.6f 0.000000 0.000000 0.000000 %.9f %.9f", stamped.pose.x, stamped.pose.y,
                std::sin(half), std::cos(half));
  return stamp_text(stamped.stamp) + pose;
}

Trajectory read_tum(const std::string& path) {
  std::istringstream file(read_text_file(path));
  Trajectory trajectory;
  std::string text;
  for (int line = 1; std::getline(file, text); ++line) {
    const std::vector<Word> words = words_of(text);
    if (words.empty()) continue;
    const StampedPose stamped = parse_tum_line(words, path, line);
    if (!trajectory.empty() && stamped.stamp <= trajectory.back().stamp)
      throw InputError(at(path, line, words[0].column, "the time does not increase; sort the file by time"));
    trajectory.push_back(stamped);
  }
  return trajectory;
}

}  // namespace rubble
