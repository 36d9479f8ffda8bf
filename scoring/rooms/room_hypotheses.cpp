#include "scoring/rooms/room_hypotheses.h"

#include <algorithm>
#include <cmath>

#include "base/rigid.h"
#include "scoring/measures/association.h"

namespace rubble::scoring {
namespace {

using mrpt::math::TPoint2D;
using mrpt::math::TPose2D;

constexpr double kOpennessOfPieces = 0.6;  // also cuts corridors where they bend or widen

/// d(f, g) of all pairs of rooms, computed once.
class Differences {
 public:
  Differences(const std::vector<Room>& map, const std::vector<Room>& truth) : columns_(truth.size()) {
    for (const Room& f : map)
      for (const Room& g : truth) value_.push_back(room_difference(f, g));
  }
  double operator()(std::size_t f, std::size_t g) const { return value_[f * columns_ + g]; }

 private:
  std::size_t columns_;
  std::vector<double> value_;
};

double squared(const TPoint2D& d) { return d.x * d.x + d.y * d.y; }

double pair_cost(const TPoint2D& moved, const TPoint2D& truth, double difference, const RoomMatchConfig& config) {
  return difference > config.most_difference
             ? config.cap
             : std::min(config.cap, squared(moved - truth) + config.lambda * difference);
}

/// A lower bound of E that needs no assignment: each room of the map takes its cheapest partner.
double quick_error(const std::vector<Room>& map, const std::vector<Room>& truth, const TPose2D& T_truth_map,
                   const Differences& difference, const RoomMatchConfig& config) {
  double sum = 0.0;
  for (std::size_t f = 0; f < map.size(); ++f) {
    const TPoint2D moved = T_truth_map.composePoint(map[f].centre);
    double best = config.cap;
    for (std::size_t g = 0; g < truth.size(); ++g)
      best = std::min(best, pair_cost(moved, truth[g].centre, difference(f, g), config));
    sum += best;
  }
  return sum;
}

RigidHypothesis match(const std::vector<Room>& map, const std::vector<Room>& truth, const TPose2D& T_truth_map,
                      const Differences& difference, const RoomMatchConfig& config) {
  RigidHypothesis out;
  out.T_truth_map = T_truth_map;
  if (map.empty() || truth.empty()) return out;
  std::vector<TPoint2D> moved;
  for (const Room& room : map) moved.push_back(T_truth_map.composePoint(room.centre));
  const auto cost = [&](std::size_t f, std::size_t g) {
    return pair_cost(moved[f], truth[g].centre, difference(f, g), config);
  };
  Association found = associate(map.size(), truth.size(), cost, config.cap);
  out.matches = std::move(found.pairs);
  out.score = 1.0 - found.error / config.cap;
  return out;
}

/// Fits the pose to the partners it finds, and finds partners again.
RigidHypothesis refined(const std::vector<Room>& map, const std::vector<Room>& truth, const TPose2D& start,
                        const Differences& difference, const RoomMatchConfig& config) {
  constexpr int kRounds = 3;
  RigidHypothesis best = match(map, truth, start, difference, config);
  for (int round = 0; round < kRounds && best.matches.size() >= 2; ++round) {
    std::vector<TPoint2D> from, to;
    for (const auto& [f, g] : best.matches) {
      from.push_back(map[f].centre);
      to.push_back(truth[g].centre);
    }
    const RigidHypothesis next = match(map, truth, fit_rigid(from, to), difference, config);
    if (next.score <= best.score) break;
    best = next;
  }
  return best;
}

struct Draft {
  TPose2D T_truth_map;
  double error = 0.0;
};

std::vector<Draft> drafts(const std::vector<Room>& map, const std::vector<Room>& truth, const Differences& difference,
                          const RoomMatchConfig& config) {
  std::vector<Draft> out;
  for (std::size_t i = 0; i < map.size(); ++i)
    for (std::size_t j = i + 1; j < map.size(); ++j) {
      const double apart = (map[i].centre - map[j].centre).norm();
      if (apart < config.least_baseline) continue;
      for (std::size_t k = 0; k < truth.size(); ++k) {
        if (difference(i, k) > config.most_difference) continue;
        for (std::size_t l = 0; l < truth.size(); ++l) {
          if (l == k || difference(j, l) > config.most_difference) continue;
          if (std::abs((truth[k].centre - truth[l].centre).norm() - apart) > config.distance_tolerance) continue;
          const TPose2D T = fit_rigid({map[i].centre, map[j].centre}, {truth[k].centre, truth[l].centre});
          out.push_back({T, quick_error(map, truth, T, difference, config)});
        }
      }
    }
  std::stable_sort(out.begin(), out.end(), [](const Draft& a, const Draft& b) { return a.error < b.error; });
  return out;
}

bool same(const TPose2D& a, const TPose2D& b, const TPoint2D& centre, const RoomMatchConfig& config) {
  return same_pose(a, b, centre, config.distinct_shift, config.distinct_turn);
}

TPoint2D centre_of(const std::vector<Room>& rooms) {
  TPoint2D sum(0.0, 0.0);
  for (const Room& room : rooms) sum += room.centre;
  return sum * (1.0 / static_cast<double>(rooms.size()));
}

}  // namespace

RigidHypothesis match_rooms(const std::vector<Room>& map, const std::vector<Room>& truth, const TPose2D& T_truth_map,
                            const RoomMatchConfig& config) {
  return match(map, truth, T_truth_map, Differences(map, truth), config);
}

std::vector<RigidHypothesis> room_hypotheses(const std::vector<Room>& map, const std::vector<Room>& truth,
                                             const RoomMatchConfig& config) {
  if (map.size() < 2 || truth.size() < 2 || too_many(map, truth, config)) return {};
  const Differences difference(map, truth);
  const TPoint2D centre = centre_of(map);
  std::vector<Draft> distinct;
  for (const Draft& draft : drafts(map, truth, difference, config)) {
    const auto known = [&](const Draft& d) { return same(d.T_truth_map, draft.T_truth_map, centre, config); };
    if (std::none_of(distinct.begin(), distinct.end(), known)) distinct.push_back(draft);
    if (distinct.size() == config.examined) break;
  }
  std::vector<RigidHypothesis> all;
  for (const Draft& draft : distinct) all.push_back(refined(map, truth, draft.T_truth_map, difference, config));
  std::stable_sort(all.begin(), all.end(),
                   [](const RigidHypothesis& a, const RigidHypothesis& b) { return a.score > b.score; });
  std::vector<RigidHypothesis> out;
  for (const RigidHypothesis& hypothesis : all) {
    const auto known = [&](const RigidHypothesis& h) {
      return same(h.T_truth_map, hypothesis.T_truth_map, centre, config);
    };
    if (hypothesis.matches.size() < 2 || std::any_of(out.begin(), out.end(), known)) continue;
    out.push_back(hypothesis);
    if (out.size() == config.most) break;
  }
  return out;
}

bool too_many(const std::vector<Room>& map, const std::vector<Room>& truth, const RoomMatchConfig& config) {
  return std::max(map.size(), truth.size()) > config.most_rooms ||
         map.size() * truth.size() > config.most_rooms * config.most_rooms / 5;
}

RoomGuesses propose_by_rooms(const OccupancyGrid& map, const OccupancyGrid& truth) {
  RoomConfig pieces;
  pieces.openness = kOpennessOfPieces;
  const RoomMatchConfig config;
  RoomGuesses out;
  const Rooms of_map = extract_rooms(map, pieces);
  if (of_map.too_many_corners || of_map.rooms.size() > config.most_rooms) {
    out.note = "the map's walls have too many corners for rooms";
    return out;
  }
  const Rooms of_truth = extract_rooms(truth, pieces);
  if (of_truth.too_many_corners || too_many(of_map.rooms, of_truth.rooms, config)) {
    out.note = "the maps have too many rooms to compare";
    return out;
  }
  for (const RigidHypothesis& h : room_hypotheses(of_map.rooms, of_truth.rooms, config))
    out.guesses.push_back({h.T_truth_map, h.score, AlignBy::Rooms});
  return out;
}

}  // namespace rubble::scoring
