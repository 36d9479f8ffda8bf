#include "slam/process/answer.h"

#include <cmath>

#include "base/text/words.h"

namespace rubble::slam {
namespace {

using mrpt::math::TPose2D;

constexpr std::size_t kMostFigures = 100;
constexpr char kUnknown = '?', kFree = '.', kOccupied = '#';

void append_pose(std::string& text, const TPose2D& pose) {
  for (const double value : {pose.x, pose.y, pose.phi}) append_number(text, value);
}

TPose2D take_pose(Words& words) {
  const double x = words.number(), y = words.number(), phi = words.number();
  return {x, y, phi};
}

StampedPose take_stamped(Words& words) {
  const Stamp stamp{words.whole(-kAnyStamp, kAnyStamp)};
  return {stamp, take_pose(words)};
}

PoseCovariance take_covariance(Words& words) {
  PoseCovariance c;
  for (int row = 0; row < 3; ++row)
    for (int column = row; column < 3; ++column) c(row, column) = c(column, row) = words.number();
  for (int i = 0; i < 3; ++i)
    if (c(i, i) < 0.0) throw BadMessage("a covariance has a negative variance");
  return c;
}

Trajectory take_trajectory(Words& words, MessageReader& in) {
  const auto count = words.whole(0, static_cast<std::int64_t>(kMostPoses));
  words.finish();
  Trajectory trajectory;
  std::string_view line;
  for (std::int64_t i = 0; i < count; ++i) {
    if (!in.line(line)) throw BadMessage("the trajectory has fewer poses than it says");
    Words pose(line);
    trajectory.push_back(take_stamped(pose));
    pose.finish();
    if (i > 0 && trajectory[trajectory.size() - 2].stamp >= trajectory.back().stamp)
      throw BadMessage("the stamps of the trajectory do not rise");
  }
  return trajectory;
}

GridFrame take_frame(Words& words) {
  GridFrame frame;
  frame.width = static_cast<int>(words.whole(1, kMostMapCells));
  frame.height = static_cast<int>(words.whole(1, kMostMapCells));
  frame.resolution = words.number();
  if (frame.resolution < 0.001 || frame.resolution > 10.0)
    throw BadMessage("a map's resolution is not within 0.001 to 10 m");
  frame.x0 = words.number();
  frame.y0 = words.number();
  words.finish();
  return frame;
}

/// Rows of one character a cell, the southernmost first.
AnsweredMap take_drawn_map(Words& words, MessageReader& in) {
  AnsweredMap map{take_frame(words), {}, {}};
  map.seen.assign(map.frame.size(), 0);
  map.occupied.assign(map.frame.size(), 0);
  const auto width = static_cast<std::size_t>(map.frame.width);
  std::string_view row;
  for (int y = 0; y < map.frame.height; ++y) {
    if (!in.line(row, width + 1)) throw BadMessage("the map has fewer rows than it says");
    if (row.size() != width)
      throw BadMessage("row " + std::to_string(y) + " of the map has " + std::to_string(row.size()) + " cells, not " +
                       std::to_string(width));
    const std::size_t first = map.frame.index({0, y});
    for (std::size_t x = 0; x < width; ++x) {
      if (row[x] == kUnknown) continue;
      if (row[x] != kFree && row[x] != kOccupied)
        throw BadMessage("a cell of the map is " + in_quotes(row.substr(x, 1)) + ", not one of ? . #");
      map.seen[first + x] = 1;
      map.occupied[first + x] = row[x] == kOccupied ? 1 : 0;
    }
  }
  return map;
}

std::vector<std::uint16_t> take_plane(MessageReader& in, std::size_t cells) {
  std::vector<char> bytes(2 * cells);
  in.block(bytes.data(), bytes.size());
  std::vector<std::uint16_t> plane(cells);
  for (std::size_t i = 0; i < cells; ++i) {
    const auto low = static_cast<unsigned char>(bytes[2 * i]);
    const auto high = static_cast<unsigned char>(bytes[2 * i + 1]);
    plane[i] = static_cast<std::uint16_t>(low | high << 8);
  }
  return plane;
}

/// Two planes of 16-bit counts, little-endian, and a line end.
AnsweredMap take_counted_map(Words& words, MessageReader& in) {
  AnsweredMap map{take_frame(words), {}, {}};
  map.seen = take_plane(in, map.frame.size());
  map.occupied = take_plane(in, map.frame.size());
  for (std::size_t i = 0; i < map.seen.size(); ++i)
    if (map.occupied[i] > map.seen[i]) throw BadMessage("a cell was occupied more often than seen");
  std::string_view line;
  if (!in.line(line) || !line.empty()) throw BadMessage("the counts of the map are not followed by a line end");
  return map;
}

void append_plane(std::string& text, const std::vector<std::uint16_t>& plane) {
  const std::size_t start = text.size();
  text.resize(start + 2 * plane.size());
  char* to = text.data() + start;
  for (const std::uint16_t count : plane) {
    *to++ = static_cast<char>(count & 0xff);
    *to++ = static_cast<char>(count >> 8);
  }
}

MapperFigure take_figure(Words& words) {
  const std::string key(words.word());
  for (const char c : key)
    if (!(c >= 'a' && c <= 'z') && !(c >= '0' && c <= '9') && c != '_')
      throw BadMessage("a figure is named " + in_quotes(key) + "; names are a-z, 0-9 and _");
  return {key, words.number(1e15)};
}

/// Returns false at the end of the answer.
bool take_record(std::string_view line, MessageReader& in, MapperAnswer& answer) {
  Words words(line);
  const std::string kind(words.word());
  if (kind == "end") {
    words.finish();
    return false;
  }
  if (kind == "pose") {
    answer.pose = take_pose(words);
  } else if (kind == "covariance") {
    answer.covariance = take_covariance(words);
  } else if (kind == "at") {
    answer.at.push_back(take_stamped(words));
  } else if (kind == "trajectory") {
    answer.corrected = take_trajectory(words, in);
    return true;  // the line's text is gone, and it was read to its end
  } else if (kind == "mapped") {
    answer.mapped = static_cast<std::uint64_t>(words.whole(0, kAnyStamp));
  } else if (kind == "settled") {
    answer.settled = words.whole(0, 1) == 1;
  } else if (kind == "blind_way") {
    answer.blind_way = words.number();
    if (*answer.blind_way < 0.0) throw BadMessage("a way of less than nothing");
  } else if (kind == "figure") {
    answer.figures.push_back(take_figure(words));
    if (answer.figures.size() > kMostFigures) throw BadMessage("more than a hundred figures");
  } else if (kind == "map") {
    answer.map = take_drawn_map(words, in);
    return true;
  } else if (kind == "counts") {
    answer.map = take_counted_map(words, in);
    return true;
  } else {
    throw BadMessage(in_quotes(line) + " where a line of the answer (pose, map, end, ...) was expected");
  }
  words.finish();
  return true;
}

}  // namespace

void append_ready(std::string& text) { text += "ready " + std::to_string(kProtocolVersion) + '\n'; }

void append_answer(std::string& text, const MapperAnswer& answer) {
  const auto append_stamped = [&](const StampedPose& pose) {
    append_number(text, pose.stamp.ns);
    append_pose(text, pose.pose);
    text += '\n';
  };
  if (answer.pose) {
    text += "pose";
    append_pose(text, *answer.pose);
    text += '\n';
  }
  if (answer.covariance) {
    text += "covariance";
    for (int row = 0; row < 3; ++row)
      for (int column = row; column < 3; ++column) append_number(text, (*answer.covariance)(row, column));
    text += '\n';
  }
  for (const StampedPose& pose : answer.at) {
    text += "at";
    append_stamped(pose);
  }
  if (answer.corrected) {
    text += "trajectory " + std::to_string(answer.corrected->size()) + '\n';
    for (const StampedPose& pose : *answer.corrected) append_stamped(pose);
  }
  if (answer.mapped) text += "mapped " + std::to_string(*answer.mapped) + '\n';
  if (answer.settled) text += *answer.settled ? "settled 1\n" : "settled 0\n";
  if (answer.blind_way) {
    text += "blind_way";
    append_number(text, *answer.blind_way);
    text += '\n';
  }
  for (const MapperFigure& figure : answer.figures) {
    text += "figure " + figure.key;
    append_number(text, figure.value);
    text += '\n';
  }
  if (answer.map) {
    const GridFrame& frame = answer.map->frame;
    text += "counts " + std::to_string(frame.width) + ' ' + std::to_string(frame.height);
    for (const double value : {frame.resolution, frame.x0, frame.y0}) append_number(text, value);
    text += '\n';
    append_plane(text, answer.map->seen);
    append_plane(text, answer.map->occupied);
    text += '\n';
  }
  text += "end\n";
}

void read_ready(MessageReader& in) {
  std::string_view line;
  if (!in.line(line)) throw BadMessage("nothing was said");
  Words words(line);
  if (words.word() != "ready") throw BadMessage(in_quotes(line) + " where 'ready 1' was expected");
  const auto version = words.whole(1, 1'000'000);
  if (version != kProtocolVersion)
    throw BadMessage("the mapper speaks version " + std::to_string(version) + " of the protocol, this rubble " +
                     std::to_string(kProtocolVersion));
}

MapperAnswer read_answer(MessageReader& in) {
  MapperAnswer answer;
  std::string_view line;
  for (std::size_t records = 0; records < kMostRecords; ++records) {
    if (!in.line(line)) throw BadMessage("the answer has no 'end'");
    if (!take_record(line, in, answer)) return answer;
  }
  throw BadMessage("an answer of more than a million lines");
}

}  // namespace rubble::slam
