#include "slam/robust/graph/loop_closer.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <limits>
#include <string>

#include "tests/support/slam_key_frames.h"

namespace rubble::slam {
namespace {

using mrpt::math::TPoint2D;
using mrpt::math::TPose2D;
using robot::RobotModel;

constexpr double kSurfelCell = 0.10;
constexpr double kBend = 0.008;  ///< of the estimate [rad/m]

/// A corridor round a block, each side with niches of its own.
slam_test::World ring_corridor() {
  slam_test::World world;
  slam_test::add_box(world, 0.0, 0.0, 9.0, 7.0);
  slam_test::add_box(world, 1.5, 1.5, 7.5, 5.5);
  slam_test::add_box(world, 2.3, 0.0, 2.7, 0.35);
  slam_test::add_box(world, 5.1, 1.2, 6.2, 1.5);
  slam_test::add_box(world, 8.6, 2.0, 9.0, 3.1);
  slam_test::add_box(world, 7.5, 4.0, 7.8, 4.3);
  slam_test::add_box(world, 5.0, 6.7, 6.8, 7.0);
  slam_test::add_box(world, 2.2, 5.5, 2.9, 5.8);
  slam_test::add_box(world, 0.0, 4.4, 0.3, 5.0);
  slam_test::add_box(world, 1.25, 2.4, 1.5, 2.9);
  return world;
}

std::vector<TPose2D> twice_round() {
  std::vector<TPoint2D> way;
  for (int round = 0; round < 2; ++round)
    for (const TPoint2D& corner : {TPoint2D(0.8, 0.75), TPoint2D(8.2, 0.75), TPoint2D(8.2, 6.2), TPoint2D(0.8, 6.2)})
      way.push_back(corner);
  way.push_back({0.8, 0.75});
  return slam_test::places_along(way, 0.3);
}

/// Drives round, asking for loops at each key frame; each gets `budget`.
void drive(KeyFrames& frames, LoopCloser& closer, Work budget) {
  const RobotModel model;
  const auto places = twice_round();
  for (std::size_t i = 0; i < places.size(); ++i) {
    slam_test::add_key_frame(frames, ring_corridor(), places, kBend, model);
    closer.look();
    Work left = budget;
    closer.work(left);
  }
}

TEST(LoopCloser, ClosesTheRing) {
  KeyFrames open;
  KeyFrames frames;
  LoopCloser closer({}, kSurfelCell, frames);
  const RobotModel model;
  const auto places = twice_round();
  for (std::size_t i = 0; i < places.size(); ++i) slam_test::add_key_frame(open, ring_corridor(), places, kBend, model);
  drive(frames, closer, 1000000000);
  EXPECT_LT(slam_test::key_frame_rmse(frames, places), 0.3 * slam_test::key_frame_rmse(open, places));
  closer.finish();
  EXPECT_GT(slam_test::key_frame_rmse(open, places), 0.4);
  EXPECT_LT(slam_test::key_frame_rmse(frames, places), 0.05);
  EXPECT_GT(closer.counts().closed + closer.counts().near_edges, 20u);
  EXPECT_EQ(slam_test::false_loops(frames, places, 0.25), 0);
}

TEST(LoopCloser, SlicesThatKeepUpGiveTheSameGraph) {
  KeyFrames whole;
  KeyFrames sliced;
  LoopCloser at_once({}, kSurfelCell, whole);
  LoopCloser by_slices({}, kSurfelCell, sliced);
  const RobotModel model;
  const auto places = twice_round();
  for (std::size_t i = 0; i < places.size(); ++i) {
    slam_test::add_key_frame(whole, ring_corridor(), places, kBend, model);
    slam_test::add_key_frame(sliced, ring_corridor(), places, kBend, model);
    at_once.look();
    by_slices.look();
    Work all = std::numeric_limits<Work>::max();
    at_once.work(all);
    int slices = 0;
    for (Work slice = 0; slice <= 0; ++slices) {
      slice = 200000;
      by_slices.work(slice);
      ASSERT_LT(slices, 100000);
    }
    ASSERT_EQ(whole.graph().edges.size(), sliced.graph().edges.size());
    for (int k = 0; k < whole.size(); ++k) ASSERT_EQ(whole.pose(k), sliced.pose(k));
  }
  EXPECT_GT(at_once.counts().solved, 3u);
}

TEST(LoopCloser, TellsOfEachLoopWhichTestsItStood) {
  KeyFrames frames;
  const LoopConfig config;
  LoopCloser closer(config, kSurfelCell, frames);
  drive(frames, closer, 1000000000);
  closer.finish();
  const auto ended = [&](LoopRecord::End end) {
    return std::count_if(closer.records().begin(), closer.records().end(),
                         [end](const LoopRecord& record) { return record.end == end; });
  };
  EXPECT_GT(ended(LoopRecord::End::Closed), 3);
  EXPECT_EQ(static_cast<std::uint64_t>(ended(LoopRecord::End::Ambiguous)), closer.counts().ambiguous);
  for (const LoopRecord& record : closer.records()) {
    EXPECT_GT(record.stamp, record.old_stamp);
    EXPECT_GE(record.path, config.least_path);
    EXPECT_GE(record.score, config.least_score);
    EXPECT_EQ(record.inliers.has_value(), record.end != LoopRecord::End::Ambiguous);
    if (record.end != LoopRecord::End::Closed && record.end != LoopRecord::End::Waits) continue;
    EXPECT_GE(record.inliers.value(), config.least_inliers);
    EXPECT_LE(record.contradiction.value(), config.most_contradiction);
  }
  // Those that count are edges between these two key frames.
  for (const LoopRecord& record : closer.records()) {
    if (record.end != LoopRecord::End::Closed) continue;
    EXPECT_TRUE(std::any_of(frames.graph().edges.begin(), frames.graph().edges.end(), [&](const GraphEdge& edge) {
      return edge.loop && edge.on && frames[edge.to].stamp == record.stamp &&
             frames[edge.from].stamp == record.old_stamp;
    }));
  }
}

/// A loop from an old key frame to one of a while ago that lies `by` metres off the truth.
GraphEdge planted_loop(const KeyFrames& frames, const std::vector<TPose2D>& places, double by) {
  GraphEdge planted;
  planted.from = 20;
  planted.to = frames.last() - 20;
  planted.T_from_to = places[static_cast<std::size_t>(planted.to)] - places[20];
  planted.T_from_to.x += by;
  planted.information = Eigen::Vector3d(1000.0, 1000.0, 10000.0).asDiagonal();
  planted.loop = true;
  return planted;
}

TEST(LoopCloser, AFalseLoopPlantedByHandIsRemoved) {
  for (const double by : {0.8, 1.2, 2.5}) {
    SCOPED_TRACE(by);
    KeyFrames frames;
    LoopCloser closer({}, kSurfelCell, frames);
    drive(frames, closer, 1000000000);
    const auto places = twice_round();
    frames.add_loop(planted_loop(frames, places, by), 0.3);
    const std::size_t index = frames.graph().edges.size() - 1;
    closer.finish();
    EXPECT_FALSE(frames.graph().edges[index].on);
    EXPECT_GE(closer.counts().removed, 1u);
    EXPECT_LT(slam_test::key_frame_rmse(frames, places), 0.05);
    EXPECT_EQ(slam_test::false_loops(frames, places, 0.25), 0);
  }
}

/// Planted a while into the second round; the third key frame on is where it goes.
TEST(LoopCloser, AFalseLoopPlantedByHandIsRemovedWhileDrivingOn) {
  const auto places = twice_round();
  const int planted_at = static_cast<int>(places.size()) - 60;
  for (const double by : {0.8, 1.2, 2.5})
    for (const Work budget : {Work{1000000}, Work{1000000000}}) {
      SCOPED_TRACE("by " + std::to_string(by) + ", budget " + std::to_string(budget));
      KeyFrames frames;
      LoopCloser closer({}, kSurfelCell, frames);
      std::size_t planted = 0;
      int gone_after = 0;  // key frames
      while (frames.size() < static_cast<int>(places.size())) {
        slam_test::add_key_frame(frames, ring_corridor(), places, kBend, RobotModel());
        if (frames.last() == planted_at) {
          planted = frames.graph().edges.size();
          frames.add_loop(planted_loop(frames, places, by), 0.3);
        }
        closer.look();
        Work left = budget;
        closer.work(left);
        if (frames.last() >= planted_at && frames.graph().edges[planted].on) ++gone_after;
      }
      EXPECT_FALSE(frames.graph().edges[planted].on);
      EXPECT_LE(gone_after, 6);
      EXPECT_GE(closer.counts().removed, 1u);
      EXPECT_LT(slam_test::key_frame_rmse(frames, places), 0.06);
      EXPECT_EQ(slam_test::false_loops(frames, places, 0.25), 0);
    }
}

/// Adds the next key frame of a robot whose wheels spun by `slip` between walls that did not tell.
void add_slipped(KeyFrames& frames, const std::vector<TPose2D>& places, double slip, const RobotModel& model) {
  const int last = frames.last();
  const auto next = static_cast<std::size_t>(frames.size());
  KeyFrame frame;
  frame.stamp = Stamp{frames.size() * 1000000000ll};
  frame.cloud = slam_test::cloud_at(ring_corridor(), places[next], model);
  GraphEdge edge;
  edge.from = last;
  edge.to = frames.size();
  edge.T_from_to = places[next] - places[next - 1];
  edge.T_from_to.x += slip;
  frame.path = frames[last].path + edge.T_from_to.x;
  edge.information = Eigen::Vector3d(1.0 / (slip * slip), 1.0 / 4e-4, 1.0 / 4e-4).asDiagonal();
  frames.add(std::move(frame), frames.pose(last) + edge.T_from_to, edge);
}

TEST(LoopCloser, ARobotThatSlidIsFoundAgainByWhatOldKeyFramesContradict) {
  // 5 m on the way through the graph is too short for a usual loop; 12 m on, what slid along is old as well.
  struct Case {
    double slip;
    std::size_t on;
    bool asked;
  };
  for (const double by : {0.7, 1.0, 1.3}) {
    for (const auto& [slip, on, asked] : {Case{by, 18, true}, Case{by, 18, false}, Case{by, 40, true}}) {
      SCOPED_TRACE(slip);
      SCOPED_TRACE(on);
      SCOPED_TRACE(asked);
      LoopConfig config;
      if (!asked) config.astray_contradiction = 2.0;
      KeyFrames frames;
      LoopCloser closer(config, kSurfelCell, frames);
      const RobotModel model;
      const auto places = twice_round();
      const std::size_t slips = places.size() / 2 + 18;
      const std::size_t end = slips + on;
      for (std::size_t i = 0; i < end; ++i) {
        if (i == slips)
          add_slipped(frames, places, slip, model);
        else
          slam_test::add_key_frame(frames, ring_corridor(), places, 0.001, model);
        closer.look();
        Work budget = 1000000000;
        closer.work(budget);
      }
      const TPose2D off = frames.pose(frames.last()) - (places[end - 1] - places.front());
      const LoopCloser judge({}, kSurfelCell, frames);
      EXPECT_EQ(judge.doubled().empty(), asked);
      if (!asked) {
        EXPECT_GT(length(off.x, off.y), 0.4);
        continue;
      }
      EXPECT_LT(length(off.x, off.y), 0.10);
      EXPECT_EQ(slam_test::false_loops(frames, places, 0.25), 0);
    }
  }
}

/// Loops closed on a spot of the second round, and in all, of a drive that goes on after some more key frames there.
struct ClosedOnASpot {
  std::uint64_t there = 0;
  std::uint64_t all = 0;
  int wrong = 0;
};

/// Loops are asked for from the spot on only; `move(k)` is where the k-th key frame there stands, ahead and turned.
template <class Move>
ClosedOnASpot closed_on_a_spot(const LoopConfig& config, int frames_there, const Move& move) {
  std::vector<TPose2D> places = twice_round();
  const std::size_t spot = places.size() / 2 + 4;
  const TPose2D at = places[spot - 1];
  std::vector<TPose2D> way(places.begin(), places.begin() + static_cast<std::ptrdiff_t>(spot));
  for (int k = 1; k <= frames_there; ++k) way.push_back(at + move(k));
  const std::size_t there = way.size();
  way.insert(way.end(), places.begin() + static_cast<std::ptrdiff_t>(spot),
             places.begin() + static_cast<std::ptrdiff_t>(spot + 14));
  KeyFrames frames;
  LoopCloser closer(config, kSurfelCell, frames);
  const RobotModel model;
  ClosedOnASpot closed;
  for (std::size_t i = 0; i < way.size(); ++i) {
    slam_test::add_key_frame(frames, ring_corridor(), way, kBend, model);
    if (i + 1 < spot) continue;
    closer.look();
    Work budget = 1000000000;
    closer.work(budget);
    if (i + 1 == there) closed.there = closer.counts().closed;
  }
  closed.all = closer.counts().closed;
  closed.wrong = slam_test::false_loops(frames, way, 0.25);
  return closed;
}

/// Of a robot that the estimate is farther off than its way there explains.
LoopConfig unexpected() {
  LoopConfig config;
  config.window = 0.05;
  config.window_per_m = 0.0;
  config.astray_contradiction = 0.0;
  return config;
}

TEST(LoopCloser, WhatIsSaidThriceOfOneOldViewIsNotBelieved) {
  const auto turn = [](int k) { return TPose2D(0.0, 0.0, 0.15 * k); };
  for (const int views : {1, 2}) {
    SCOPED_TRACE(views);
    LoopConfig config;
    config.views = views;
    const ClosedOnASpot closed = closed_on_a_spot(config, 6, turn);
    EXPECT_EQ(closed.there > 0, views == 1);
    EXPECT_GT(closed.all, 2u);
    EXPECT_EQ(closed.wrong, 0);
  }
}

/// Each old view that is asked has to be led to by a loop that contradicts next to nothing.
TEST(LoopCloser, OfViewsThatAreHalfContradictedNoneCounts) {
  const auto places = twice_round();
  KeyFrames frames;
  for (std::size_t i = 0; i < 12; ++i) slam_test::add_key_frame(frames, ring_corridor(), places, 0.001, RobotModel());
  const auto claim = [](int from, int to, bool clear, double moves) {
    LoopClaim claim{{}, clear, false, moves};
    claim.loop.from = from;
    claim.loop.to = to;
    return claim;
  };
  LoopConfig config;
  config.apart_distance = 0.1;
  const auto with = [&](const LoopClaim& a, const LoopClaim& b, const LoopClaim& newest) {
    return believed(config, frames, newest, {a, b});
  };
  EXPECT_TRUE(with(claim(0, 7, true, 1.2), claim(1, 9, true, 1.2), claim(1, 11, true, 1.2)));
  EXPECT_TRUE(with(claim(0, 7, true, 1.2), claim(1, 9, true, 1.2), claim(2, 11, false, 1.2))) << "two are clear";
  EXPECT_FALSE(with(claim(0, 7, true, 1.2), claim(0, 9, true, 1.2), claim(1, 11, false, 1.2))) << "both of one view";
  EXPECT_FALSE(with(claim(0, 7, false, 1.2), claim(1, 9, false, 1.2), claim(2, 11, true, 1.2)));
  EXPECT_FALSE(with(claim(0, 7, false, 0.2), claim(1, 9, false, 0.2), claim(2, 11, false, 0.2)));
  EXPECT_TRUE(with(claim(0, 7, false, 0.2), claim(1, 9, false, 0.2), claim(2, 11, true, 0.2))) << "it hardly moves";
  config.views = 1;
  EXPECT_TRUE(with(claim(0, 7, false, 1.2), claim(1, 9, false, 1.2), claim(2, 11, true, 1.2)));
}

TEST(LoopCloser, WhatIsSaidOnOneSpotIsNotBelievedOfAnUnexpectedMove) {
  const auto turn = [](int k) { return TPose2D(0.0, 0.0, 0.15 * k); };
  // To and fro: metres of path.
  const auto shuffle = [](int k) { return TPose2D(k % 2 == 0 ? 0.0 : 0.3, 0.0, 0.0); };
  LoopConfig config = unexpected();
  config.views = 1;
  for (const ClosedOnASpot& closed : {closed_on_a_spot(config, 6, turn), closed_on_a_spot(config, 8, shuffle)}) {
    EXPECT_EQ(closed.there, 0u);
    EXPECT_GT(closed.all, 2u);
    EXPECT_EQ(closed.wrong, 0);
  }
  config.apart_distance = 0.3;
  EXPECT_GT(closed_on_a_spot(config, 8, shuffle).there, 0u);
}

/// In its second round a robot that stands right is shown to do so by what it saw in the first; one that slid by half a
/// metre, which a loop has to bring back, is not.
TEST(LoopCloser, OldKeyFramesTellARobotThatStandsRightFromOneThatSlid) {
  const RobotModel model;
  const auto places = twice_round();
  const int first_round = static_cast<int>(places.size()) / 2;
  const auto said = [&](int more, double slip) {
    KeyFrames frames;
    while (frames.size() < first_round + more)
      if (frames.size() == first_round + 4 && slip > 0.0)
        add_slipped(frames, places, slip, model);
      else
        slam_test::add_key_frame(frames, ring_corridor(), places, 0.0, model);
    const LoopConfig config;
    const int last = frames.last();
    SurfelGrid seen;
    frames.draw(frames.ending_at(last, config.new_frames, config.new_path), frames.pose(last), kSurfelCell, seen);
    Work left = 100000000;
    return agreement_here(frames, config, kSurfelCell, last, last, seen.every_nth(1), left);
  };
  for (const int more : {10, 16, 20}) {
    SCOPED_TRACE(more);
    const auto right = said(more, 0.0), slid = said(more, 0.5);
    ASSERT_TRUE(right && slid);
    EXPECT_LT(right->there.contradiction(), 0.03);
    EXPECT_LT(right->back.contradiction(), 0.03);
    EXPECT_GT(std::max(slid->there.contradiction(), slid->back.contradiction()), 0.06);
  }
  EXPECT_FALSE(said(12 - first_round, 0.0)) << "of the first round nothing is old";
}

TEST(LoopCloser, NothingToDoTakesNothing) {
  KeyFrames frames;
  LoopCloser closer({}, kSurfelCell, frames);
  Work budget = 1000;
  EXPECT_FALSE(closer.work(budget));
  EXPECT_EQ(budget, 1000);
  closer.finish();
  EXPECT_EQ(closer.counts().searched, 0u);
}

/// Equal cells of 1.2 m on both sides of a corridor, their walls 0.8 m deep. Nothing but its ends tells one from the
/// next.
slam_test::World comb(int cells) {
  slam_test::World world;
  const double end = 1.2 * cells;
  slam_test::add_box(world, 0.0, 0.0, end, 3.6);
  for (int k = 1; k < cells; ++k)
    for (const double y : {0.0, 2.4}) slam_test::add_box(world, 1.2 * k - 0.02, y, 1.2 * k + 0.02, y + 1.2);
  return world;
}

/// Equal rooms of 2.4 m in two rows, each open to a corridor between them.
slam_test::World rooms(int count) {
  slam_test::World world;
  const double end = 2.4 * count;
  slam_test::add_box(world, 0.0, 0.0, end, 6.0);
  for (int k = 0; k < count; ++k) {
    for (const double y : {2.36, 3.6}) {
      slam_test::add_box(world, 2.4 * k, y, 2.4 * k + 0.7, y + 0.04);
      slam_test::add_box(world, 2.4 * k + 1.7, y, 2.4 * (k + 1), y + 0.04);
    }
    if (k == 0) continue;
    slam_test::add_box(world, 2.4 * k - 0.02, 0.0, 2.4 * k + 0.02, 2.4);
    slam_test::add_box(world, 2.4 * k - 0.02, 3.6, 2.4 * k + 0.02, 6.0);
  }
  return world;
}

struct Maze {
  const char* name;
  slam_test::World world;
  std::vector<TPoint2D> way;
};

std::vector<Maze> mazes() {
  return {{"comb", comb(10), {{0.6, 1.8}, {11.4, 1.8}, {0.6, 1.8}, {11.4, 1.8}}},
          {"rooms",
           rooms(5),
           {{0.6, 3.0},
            {11.4, 3.0},
            {1.2, 3.0},
            {1.2, 1.0},
            {1.2, 3.0},
            {10.8, 3.0},
            {10.8, 5.0},
            {10.8, 3.0},
            {0.6, 3.0}}}};
}

/// What becomes of a drive through a maze whose searches reach farther than its cells are apart.
struct Driven {
  std::uint64_t searched = 0;
  int wrong = 0;  ///< at most at one time, also of those removed later
  double rmse = 0.0;
};

Driven drive_through(const Maze& maze, LoopConfig config, double bend) {
  config.window = config.largest_window = 2.5;
  const RobotModel model;
  const auto places = slam_test::places_along(maze.way, 0.3);
  KeyFrames frames;
  LoopCloser closer(config, kSurfelCell, frames);
  int most_wrong = 0;
  for (std::size_t i = 0; i < places.size(); ++i) {
    slam_test::add_key_frame(frames, maze.world, places, bend, model);
    closer.look();
    Work budget = 1000000000;
    closer.work(budget);
    most_wrong = std::max(most_wrong, slam_test::false_loops(frames, places, 0.4));
  }
  closer.finish();
  return {closer.counts().searched, most_wrong, slam_test::key_frame_rmse(frames, places)};
}

TEST(LoopCloser, KeepsNoFalseLoopInMazesOfEqualCells) {
  for (const Maze& maze : mazes()) {
    SCOPED_TRACE(maze.name);
    const Driven driven = drive_through(maze, {}, 0.001);
    EXPECT_GT(driven.searched, 20u);
    EXPECT_EQ(driven.wrong, 0);
    EXPECT_LT(driven.rmse, 0.03);
  }
}

/// What keeps them out where the estimate bends twice as much: without it loops to a cell beside are closed and stay.
TEST(LoopCloser, TheNullTestKeepsFalseLoopsOutOfAMazeOfEqualCells) {
  const Maze comb = mazes().front();
  EXPECT_EQ(drive_through(comb, {}, 0.002).wrong, 0);
  LoopConfig config;
  config.expected_contradiction = 0.0;
  const Driven driven = drive_through(comb, config, 0.002);
  EXPECT_GT(driven.wrong, 0);
  EXPECT_GT(driven.rmse, 0.3);
}

}  // namespace
}  // namespace rubble::slam
