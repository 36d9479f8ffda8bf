// What rubble and a mapper process say to each other: every text reads back as what it was made of, and whatever is not
// of the protocol is refused with a reason, never believed and never waited for.
#include <gtest/gtest.h>

#include <Eigen/Core>
#include <cmath>
#include <cstring>
#include <limits>

#include "base/rng.h"
#include "slam/process/answer.h"
#include "slam/process/request.h"

namespace rubble::slam {
namespace {

using mrpt::math::TPose2D;

/// Bytes in pieces of a few, as a pipe may give them.
class TextSource : public ByteSource {
 public:
  explicit TextSource(std::string text, std::size_t piece = 7) : text_(std::move(text)), piece_(piece) {}
  std::size_t read(char* to, std::size_t at_most) override {
    const std::size_t part = std::min({at_most, piece_, text_.size() - at_});
    std::memcpy(to, text_.data() + at_, part);
    at_ += part;
    return part;
  }

 private:
  std::string text_;
  std::size_t piece_;
  std::size_t at_ = 0;
};

std::string refusal_of(const std::string& answer) {
  TextSource source(answer);
  MessageReader in(source);
  try {
    read_answer(in);
  } catch (const BadMessage& bad) {
    return bad.what();
  }
  return "";
}

MapperAnswer answer_of(const std::string& text) {
  TextSource source(text);
  MessageReader in(source);
  return read_answer(in);
}

robot::Inputs random_inputs(Rng& rng) {
  robot::Inputs in;
  in.now = {static_cast<std::int64_t>(rng.uniform(-1e18, 1e18))};
  const auto stamp = [&] { return Stamp{static_cast<std::int64_t>(rng.uniform(-1e18, 1e18))}; };
  const auto value = [&] { return rng.gaussian(1.0) * std::pow(10.0, rng.uniform(-12.0, 12.0)); };
  for (int i = static_cast<int>(rng.uniform(0.0, 4.0)); i > 0; --i) {
    in.odometry.push_back({stamp(), {value(), value(), value()}, value(), value(), i % 2 == 0});
    in.accelerations.push_back({stamp(), value(), value()});
    in.aims.push_back({stamp(), value(), value()});
    robot::LaserScan scan;
    scan.stamp = stamp();
    scan.angle_min = value();
    scan.angle_step = value();
    scan.beam_period = value();
    scan.range_min = value();
    scan.range_max = value();
    for (int beam = static_cast<int>(rng.uniform(0.0, 900.0)); beam > 0; --beam) {
      const double kind = rng.uniform(0.0, 3.0);
      scan.ranges.push_back(kind < 1.0   ? std::numeric_limits<float>::infinity()
                            : kind < 2.0 ? std::numeric_limits<float>::quiet_NaN()
                                         : static_cast<float>(value()));
      if (i % 2 == 0) scan.codes.push_back(static_cast<std::uint8_t>(rng.uniform(0.0, 256.0)));
    }
    in.scans.push_back(scan);
  }
  if (rng.uniform(0.0, 1.0) < 0.5) in.command = robot::Commands{{value(), value()}, {value(), value()}};
  return in;
}

TEST(MapperProtocol, TicksReadBackToTheSameBits) {
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    Rng rng(seed, "ticks");
    const robot::Inputs told = random_inputs(rng);
    std::string text;
    append_tick(text, told);
    append_finish(text);
    TextSource source(text, 1 + seed * 100);
    MessageReader in(source);
    const auto tick = read_request(in);
    ASSERT_TRUE(tick && !tick->finish);
    const robot::Inputs& heard = tick->inputs;
    EXPECT_EQ(heard.now, told.now);
    ASSERT_EQ(heard.odometry.size(), told.odometry.size());
    ASSERT_EQ(heard.scans.size(), told.scans.size());
    for (std::size_t i = 0; i < told.odometry.size(); ++i) {
      EXPECT_EQ(heard.odometry[i].stamp, told.odometry[i].stamp);
      EXPECT_EQ(heard.odometry[i].pose.x, told.odometry[i].pose.x);
      EXPECT_EQ(heard.odometry[i].pose.phi, told.odometry[i].pose.phi);
      EXPECT_EQ(heard.odometry[i].w, told.odometry[i].w);
      EXPECT_EQ(heard.odometry[i].stalled, told.odometry[i].stalled);
      EXPECT_EQ(heard.accelerations[i].y, told.accelerations[i].y);
      EXPECT_EQ(heard.aims[i].roll, told.aims[i].roll);
    }
    for (std::size_t i = 0; i < told.scans.size(); ++i) {
      EXPECT_EQ(heard.scans[i].beam_period, told.scans[i].beam_period);
      EXPECT_EQ(heard.scans[i].range_max, told.scans[i].range_max);
      EXPECT_EQ(heard.scans[i].codes, told.scans[i].codes);
      ASSERT_EQ(heard.scans[i].ranges.size(), told.scans[i].ranges.size());
      for (std::size_t beam = 0; beam < told.scans[i].ranges.size(); ++beam) {
        const float a = told.scans[i].ranges[beam], b = heard.scans[i].ranges[beam];
        EXPECT_TRUE(a == b || (std::isnan(a) && std::isnan(b))) << a << " became " << b;
      }
    }
    ASSERT_EQ(heard.command.has_value(), told.command.has_value());
    if (told.command) {
      EXPECT_EQ(heard.command->aim.roll, told.command->aim.roll);
    }
    const auto last = read_request(in);
    EXPECT_TRUE(last && last->finish);
    EXPECT_FALSE(read_request(in));
  }
}

TEST(MapperProtocol, HeaderReadsBack) {
  MapperHeader told;
  told.model.name = "my robot";
  told.model.width = 0.1 + 0.2;
  told.model.accelerometer_mount = robot::AccelerometerMount::Body;
  told.model.laser.beams = 1081;
  told.model.T_base_laser.yaw = -1.0 / 3.0;
  told.seed = 9007199254740993u;
  told.parameters = "particles: 3\nicp: false\n";
  std::string text;
  append_header(text, told);
  TextSource source(text);
  MessageReader in(source);
  const MapperHeader heard = read_header(in);
  EXPECT_EQ(heard.model.name, told.model.name);
  EXPECT_EQ(heard.model.width, told.model.width);
  EXPECT_EQ(heard.model.accelerometer_mount, told.model.accelerometer_mount);
  EXPECT_EQ(heard.model.laser.beams, told.model.laser.beams);
  EXPECT_EQ(heard.model.T_base_laser.yaw, told.model.T_base_laser.yaw);
  EXPECT_EQ(heard.seed, told.seed);
  EXPECT_EQ(heard.parameters, told.parameters);
}

TEST(MapperProtocol, LinesOfLaterVersionsAreSkipped) {
  TextSource source("tick 5\nsmell 1 2 3 of tomorrow\nodometry 4 1 2 0.5 0 0 1\nend\n");
  MessageReader in(source);
  const auto tick = read_request(in);
  ASSERT_TRUE(tick);
  ASSERT_EQ(tick->inputs.odometry.size(), 1u);
  EXPECT_TRUE(tick->inputs.odometry[0].stalled);
}

TEST(MapperProtocol, AnswersReadBackToTheSameBits) {
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    Rng rng(seed, "answers");
    MapperAnswer told;
    const auto value = [&] { return rng.gaussian(100.0); };
    told.pose = TPose2D(value(), value(), value());
    Eigen::Matrix3d root;
    for (int i = 0; i < 9; ++i) root(i / 3, i % 3) = value();
    const Eigen::Matrix3d square = root * root.transpose();
    told.covariance = PoseCovariance(Eigen::Matrix3d(0.5 * (square + square.transpose())));
    for (std::int64_t i = 0; i < 5; ++i) told.at.push_back({{i * 100}, {value(), value(), value()}});
    told.corrected = told.at;
    told.mapped = seed;
    told.settled = rng.uniform(0.0, 1.0) < 0.5;
    told.blind_way = std::abs(value());
    told.figures = {{"loops_closed", value()}};
    AnsweredMap map;
    map.frame = {1 + static_cast<int>(rng.uniform(0.0, 40.0)), 1 + static_cast<int>(rng.uniform(0.0, 40.0)), 0.05,
                 value(), value()};
    for (std::size_t i = 0; i < map.frame.size(); ++i) {
      map.seen.push_back(static_cast<std::uint16_t>(rng.uniform(0.0, 65536.0)));
      map.occupied.push_back(static_cast<std::uint16_t>(rng.uniform(0.0, map.seen.back() + 1.0)));
    }
    told.map = map;
    std::string text;
    append_answer(text, told);
    const MapperAnswer heard = answer_of(text);
    EXPECT_EQ(heard.pose->phi, told.pose->phi);
    EXPECT_EQ(*heard.covariance, *told.covariance);
    ASSERT_EQ(heard.at.size(), told.at.size());
    EXPECT_EQ(heard.at[3].pose.y, told.at[3].pose.y);
    ASSERT_EQ(heard.corrected->size(), told.corrected->size());
    EXPECT_EQ((*heard.corrected)[4].stamp, (*told.corrected)[4].stamp);
    EXPECT_EQ(heard.mapped, told.mapped);
    EXPECT_EQ(heard.settled, told.settled);
    EXPECT_EQ(heard.blind_way, told.blind_way);
    EXPECT_EQ(heard.figures[0].value, told.figures[0].value);
    EXPECT_EQ(heard.map->frame, map.frame);
    EXPECT_EQ(heard.map->seen, map.seen);
    EXPECT_EQ(heard.map->occupied, map.occupied);
  }
}

TEST(MapperProtocol, DrawnMapHasItsSouthernmostRowFirst) {
  const MapperAnswer answer = answer_of("map 3 2 0.1 -1 -2\n?.#\n...\r\nend\n");
  ASSERT_TRUE(answer.map);
  EXPECT_EQ(answer.map->frame, (GridFrame{3, 2, 0.1, -1.0, -2.0}));
  EXPECT_EQ(answer.map->seen, (std::vector<std::uint16_t>{0, 1, 1, 1, 1, 1}));
  EXPECT_EQ(answer.map->occupied, (std::vector<std::uint16_t>{0, 0, 1, 0, 0, 0}));
}

TEST(MapperProtocol, NonsenseIsRefusedWithItsReason) {
  const std::vector<std::pair<std::string, std::string>> cases = {
      {"hello world\nend\n", "'hello world' where a line of the answer"},
      {"pose 1 2\nend\n", "a word is missing"},
      {"pose 1 2 3 4\nend\n", "'4' is too much"},
      {"pose 1 two 3\nend\n", "'two' is no number"},
      {"pose 1 nan 3\nend\n", "not finite"},
      {"pose 1 inf 3\nend\n", "not finite"},
      {"pose 1 1e300 3\nend\n", "far too large"},
      {"pose 1 2 3\n", "no 'end'"},
      {"pose 1 2 3\nen", "the last line has no end"},
      {"covariance 1 0 0 -1 0 1\nend\n", "negative variance"},
      {"map 99999999999 1 0.05 0 0\nend\n", "not within 1 to 8000"},
      {"map 0 5 0.05 0 0\nend\n", "not within 1 to 8000"},
      {"map 2 2 0 0 0\nend\n", "resolution"},
      {"map 2 2 0.05 0 0 7\n..\n..\nend\n", "'7' is too much"},
      {"map 2 2 0.05 0 0\n..\n...\nend\n", "row 1 of the map has 3 cells, not 2"},
      {"map 2 2 0.05 0 0\n..\n....\nend\n", "longer than 3 bytes: '....'"},
      {"map 5 2 0.05 0 0\n..\n...\nend\n", "row 0 of the map has 2 cells, not 5"},
      {"map 2 2 0.05 0 0\n..\n.x\nend\n", "one of ? . #"},
      {"map 2 2 0.05 0 0\n..\n", "fewer rows"},
      {"counts 1 1 0.05 0 0\n\x01", "bytes are missing"},
      {std::string("counts 1 1 0.05 0 0\n\x01\x00\x02\x00\nend\n", 30), "more often than seen"},
      {std::string("counts 1 1 0.05 0 0\n\x01\x00\x01\x00x\nend\n", 31), "not followed by a line end"},
      {"trajectory 2\n1 0 0 0\nend\n", "is no whole number"},
      {"trajectory 2\n5 0 0 0\n5 0 0 0\nend\n", "do not rise"},
      {"trajectory 99999999999\nend\n", "not within"},
      {"figure Score 1\nend\n", "names are a-z"},
      {"mapped -1\nend\n", "not within"},
      {std::string(kLongestLine + 10, 'a'), "a line is longer than"},
  };
  for (const auto& [text, reason] : cases)
    EXPECT_NE(refusal_of(text).find(reason), std::string::npos)
        << text.substr(0, 60) << " was answered by '" << refusal_of(text) << "', not by '" << reason << "'";
}

TEST(MapperProtocol, OtherVersionsAreRefused) {
  for (const char* text : {"ready 2\n", "ready\n", "Hello\n", "", "ready 1 extra"}) {
    TextSource source(text);
    MessageReader in(source);
    EXPECT_THROW(read_ready(in), BadMessage) << text;
  }
  TextSource source("ready 1\n");
  MessageReader in(source);
  EXPECT_NO_THROW(read_ready(in));
}

TEST(MapperProtocol, DamagedAnswersAreRefusedOrHarmless) {
  MapperAnswer whole;
  whole.pose = TPose2D(1.0, 2.0, 3.0);
  whole.at = {{{5}, {1.0, 2.0, 3.0}}};
  whole.corrected = whole.at;
  whole.map = AnsweredMap{{3, 2, 0.05, 0.0, 0.0}, {1, 2, 3, 4, 5, 6}, {0, 1, 2, 3, 4, 5}};
  std::string text;
  append_answer(text, whole);
  text += "map 3 2 0.05 0 0\n?.#\n...\nend\n";
  int refused = 0;
  for (std::uint64_t seed = 1; seed <= 3000; ++seed) {
    Rng rng(seed, "damage");
    std::string damaged = text;
    for (int n = 1 + static_cast<int>(rng.uniform(0.0, 3.0)); n > 0; --n) {
      const auto at = static_cast<std::size_t>(rng.uniform(0.0, static_cast<double>(damaged.size())));
      const double kind = rng.uniform(0.0, 3.0);
      if (kind < 1.0) {
        damaged[at] = static_cast<char>(rng.uniform(0.0, 256.0));
      } else if (kind < 2.0) {
        damaged.erase(at, 1);
      } else {
        damaged.insert(at, 1, "0123456789 \n"[static_cast<std::size_t>(rng.uniform(0.0, 12.0))]);
      }
    }
    if (damaged.empty()) continue;
    const std::string reason = refusal_of(damaged);
    refused += reason.empty() ? 0 : 1;
    EXPECT_EQ(reason.find('\n'), std::string::npos) << "seed " << seed;
  }
  EXPECT_GT(refused, 1000);
}

}  // namespace
}  // namespace rubble::slam
