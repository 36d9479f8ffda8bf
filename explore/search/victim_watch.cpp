#include "explore/search/victim_watch.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "base/planar.h"
#include "explore/search/behind_wall.h"

namespace rubble::explore {
namespace {

using mrpt::math::TPoint2D;
using mrpt::math::TPose2D;

constexpr double kCueAge = 1.2;     ///< an unconfirmed cue younger than this is worth waiting for [s]
constexpr double kVisit = 2.0;      ///< shorter stares are none [s]
constexpr double kStaredAge = 5.0;  ///< what was smelt so long ago is what the robot stood still for [s]
constexpr int kSureOfHoles = 3;     ///< cues
constexpr double kJudged = 2.0;     ///< all cues are judged anew on the newest map this often [s]

}  // namespace

bool VictimWatch::hear(const robot::VictimCue& cue, const slam::Mapper& mapper, const TPose2D& T_map_base,
                       const Traversable& floor) {
  if (unsure()) return false;
  const Anchor anchor{cue.stamp, mapper.pose_at(cue.stamp).value_or(T_map_base)};
  const std::size_t before = reports_.size();
  if (FaintSearch::takes(cue.kind)) {
    faint_.add(cue, anchor, covariance_);
    sort_faint(floor);
  } else if (take_in(cue, anchor, floor)) {
    sort_faint(floor);
  }
  rebuild_reports();
  return reports_.size() > before;
}

/// A cue of a camera. Says whether a victim was confirmed by it.
bool VictimWatch::take_in(const robot::VictimCue& cue, const Anchor& anchor, const Traversable& floor) {
  const auto same_side = [&](const TPoint2D& a, const TPoint2D& b) {
    const Cell from = floor.cells.cell(a);
    const Cell to = floor.cells.cell(b);
    if (!floor.cells.inside(from) || !floor.cells.inside(to)) return true;
    return in_sight(floor, from, to);
  };
  const std::size_t before = victims_.reports().size();
  const auto hidden = [&](const TPoint2D& from, const TPoint2D& to) { return is_behind_wall(floor.cells, from, to); };
  const auto through = [&](const TPoint2D& from, const TPoint2D& to) {
    return shows_through_hole(floor.cells, from, to);
  };
  victims_.add(cue, anchor, {same_side, hidden, through, search_.squarely()}, covariance_);
  return victims_.reports().size() > before;
}

/// What is heard and smelt, to the victims that were seen and to places of its own.
void VictimWatch::sort_faint(const Traversable& floor) {
  seen_.clear();
  for (const VictimReport& victim : victims_.reports()) seen_.push_back({victim.id, victim.p_map});
  const auto hidden = [&](const TPoint2D& from, const TPoint2D& to) { return is_within_wall(floor.cells, from, to); };
  const std::vector<FaintSearch::Place> before = faint_.places();
  faint_.sort(seen_, hidden);
  for (FaintSearch::Seen& victim : seen_) {
    const auto same = std::find_if(before.begin(), before.end(), [&](const FaintSearch::Place& place) {
      return place.id != 0 && place.id == victim.is_also;
    });
    if (same == before.end() || same->id > victim.id) continue;
    victims_.rename(victim.id, same->id, same->confirmed);
    if (std::none_of(reports_.begin(), reports_.end(), [&](const VictimReport& told) { return told.id == victim.id; }))
      victims_.give_id_back(victim.id);
    victim.id = same->id;
  }
  for (FaintSearch::Place& place : faint_.places())
    if (place.sure && place.id == 0) place.id = victims_.take_id();
  tell_suspects();
}

void VictimWatch::tell_suspects() {
  std::vector<Suspect> suspects;
  for (const FaintSearch::Place& place : faint_.places()) {
    if (!faint_.suspect(place)) continue;
    Suspect suspect{place.p_map, {}};
    for (const Anchor& from : place.visited_from) suspect.visited_from.push_back(position(from.T_map_base));
    suspects.push_back(std::move(suspect));
  }
  search_.set_suspects(std::move(suspects));
}

void VictimWatch::rebuild_reports() {
  reports_ = victims_.reports();
  for (VictimReport& report : reports_)
    for (const FaintSearch::Seen& victim : seen_) {
      if (victim.id != report.id) continue;
      if (victim.sound > 1) report.cues.push_back(robot::CueKind::Sound);
      if (victim.co2 > 1) report.cues.push_back(robot::CueKind::Co2);
      break;
    }
  for (const FaintSearch::Place& place : faint_.places()) {
    if (!place.sure) continue;
    VictimReport report{
        place.id, place.p_map, place.confirmed, 1.0 - std::exp(-place.evidence), {}, place.covariance + place.poses};
    if (place.sound > 1) report.cues.push_back(robot::CueKind::Sound);
    if (place.co2 > 1) report.cues.push_back(robot::CueKind::Co2);
    reports_.push_back(std::move(report));
  }
  std::sort(reports_.begin(), reports_.end(), [](const VictimReport& a, const VictimReport& b) { return a.id < b.id; });
}

/// A victim in a niche lies before its back, though a cue past the niche's edge may seem to come through it; one that
/// is seen behind a wall again and again, and hardly ever before it, is seen through a hole. Driving along a wall for
/// the first time the robot may see a victim before the wall is on the map, and never again: so all cues count on the
/// newest map.
void VictimWatch::judge_holes(const Traversable& floor, const slam::CountMap& map, Stamp now) {
  if (!search_.on() || search_.squarely() || now < next_judged_ || victims_.reports().empty()) return;
  next_judged_ = now + kJudged;
  const OccupancyGrid shut = with_holes_shut(floor.cells);
  for (const VictimReport& victim : victims_.reports()) {
    int through = 0, others = 0;
    for (const TPoint2D& from : victims_.seen_from(victim.id))
      ++(is_behind_hole(shut, &map, from, victim.p_map) ? through : others);
    if (through >= kSureOfHoles && through > 2 * others) search_.expect_holes();
  }
}

bool VictimWatch::look(const Traversable& floor, const TPose2D& T_map_base, double turn_rate, Stamp now) {
  if (unsure() || !search_.look(floor, T_map_base, turn_rate, now)) return false;
  faint_.stood({now, T_map_base});
  return true;
}

bool VictimWatch::holds_still(const Traversable& floor, const TPose2D& T_map_base, Stamp now) {
  const bool smelt = faint_.undecided(now, kCueAge);
  const bool stared = stares_;
  stares_ = search_.staring(victims_.undecided(now, kCueAge), smelt, now);
  if (stares_ && !stared) stares_since_ = smelt_at_ = now;
  if (stares_ && smelt) smelt_at_ = now;
  // Standing there for a while, with the nose in it, is a visit to what was smelt.
  if (stared && !stares_ && smelt_at_ - stares_since_ >= kVisit) {
    for (const FaintSearch::Place& place : std::vector<FaintSearch::Place>(faint_.places()))
      if (!place.sure && place.smelt != Stamp::never() && now - place.smelt < kStaredAge)
        faint_.visited(place.p_map, {now, T_map_base});
    tell_suspects();
  }
  if (stares_) return true;
  if (search_.dwelling(floor, T_map_base, now)) return true;
  if (const auto place = search_.visited_suspect()) {
    faint_.visited(*place, {now, T_map_base});
    tell_suspects();
  }
  return false;
}

bool VictimWatch::follow(const slam::Mapper& mapper) {
  victims_.follow(mapper);
  faint_.follow(mapper);
  rebuild_reports();
  tell_suspects();
  return search_.follow(mapper);
}

}  // namespace rubble::explore
