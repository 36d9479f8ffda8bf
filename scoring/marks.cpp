#include "scoring/marks.h"

#include <cstddef>
#include <utility>

#include "scoring/league/league_points.h"
#include "scoring/measures/victims.h"

namespace rubble::scoring {
namespace {

using mrpt::math::TPoint2D;

std::string room_name(std::size_t index) { return "room " + std::to_string(index + 1); }

Mark mark_of(const Room& room, std::size_t index) {
  return {room.centre, room_name(index), std::pair(room.box_min, room.box_max)};
}

/// Features have no names.
std::vector<Mark> marks_at(const std::vector<TPoint2D>& places) {
  std::vector<Mark> out;
  for (const TPoint2D& place : places) out.push_back({place, "", std::nullopt});
  return out;
}

Mark mark_of(const Poi& poi) { return {poi.p_picture, poi.name, std::nullopt}; }

/// Fills in the outliers: all marks of either side that no pair has.
void add_rest(Marks& marks, const std::vector<Mark>& map, const std::vector<Mark>& truth,
              const std::vector<std::pair<std::size_t, std::size_t>>& pairs) {
  std::vector<bool> in_map(map.size(), false);
  std::vector<bool> in_truth(truth.size(), false);
  for (const auto& [i, j] : pairs) {
    marks.pairs.emplace_back(map[i], truth[j]);
    in_map[i] = in_truth[j] = true;
  }
  for (std::size_t i = 0; i < map.size(); ++i)
    if (!in_map[i]) marks.map_only.push_back(map[i]);
  for (std::size_t j = 0; j < truth.size(); ++j)
    if (!in_truth[j]) marks.truth_only.push_back(truth[j]);
}

}  // namespace

std::string true_victim_name(const std::string& name) {
  return (name.rfind("victim", 0) == 0 ? "true " : "true victim ") + name;
}

std::string joined_name(const Mark& map, const Mark& truth) {
  return map.name.empty() || truth.name.empty() ? map.name + truth.name : map.name + " = " + truth.name;
}

Marks marks_of(const KindScore& features) {
  Marks out;
  out.what = name_of(features.kind);
  add_rest(out, marks_at(features.map), marks_at(features.truth), features.match.pairs);
  return out;
}

Marks marks_of(const Rooms& map, const Rooms& truth, const RoomMatch& match) {
  Marks out;
  out.what = "rooms";
  std::vector<Mark> of_map;
  std::vector<Mark> of_truth;
  for (std::size_t i = 0; i < map.rooms.size(); ++i) of_map.push_back(mark_of(map.rooms[i], i));
  for (std::size_t j = 0; j < truth.rooms.size(); ++j) of_truth.push_back(mark_of(truth.rooms[j], j));
  std::vector<std::pair<std::size_t, std::size_t>> pairs;
  for (const RoomPair& pair : match.pairs) pairs.emplace_back(pair.map, pair.truth);
  add_rest(out, of_map, of_truth, pairs);
  return out;
}

Marks marks_of(const std::vector<Poi>& reported, const std::vector<Poi>& victims,
               const mrpt::math::TPose2D& T_truth_map) {
  Marks out;
  out.what = "victims";
  std::vector<Mark> map;
  std::vector<Mark> truth;
  std::vector<TPoint2D> p_map;
  std::vector<TPoint2D> p_truth;
  for (const Poi& poi : reported) {
    map.push_back(mark_of(poi));
    p_map.push_back(poi.p_picture);
  }
  for (const Poi& poi : victims) {
    truth.push_back(mark_of(poi));
    truth.back().name = true_victim_name(poi.name);
    p_truth.push_back(poi.p_picture);
  }
  std::vector<std::pair<std::size_t, std::size_t>> pairs;
  for (const VictimMatch& match : score_victims(p_map, p_truth, T_truth_map, LeaguePointsConfig().worthless).matches)
    pairs.emplace_back(match.reported, match.truth);
  add_rest(out, map, truth, pairs);
  return out;
}

Marks marks_on_overlay(const MapScore& score, const std::vector<Poi>& reported, const std::vector<Poi>& victims,
                       bool listed) {
  Marks out = marks_of(reported, victims, score.T_truth_map);
  if (!listed) out.unjudged = std::exchange(out.map_only, {});
  if (score.broken.found) out.seam = {score.broken.from, score.broken.to};
  return out;
}

std::vector<Marks> marks_on_page(const MapScore& score, const Marks& victims, const Marks& rooms) {
  std::vector<Marks> out;
  if (!victims.pairs.empty() || !victims.map_only.empty() || !victims.truth_only.empty() || !victims.unjudged.empty())
    out.push_back(victims);
  for (const KindScore& kind : score.by_features.kinds)
    out.push_back(kind.kind == EvidenceKind::Rooms ? rooms : marks_of(kind));
  return out;
}

}  // namespace rubble::scoring
