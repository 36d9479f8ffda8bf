#include "explore/search/faint_search.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <set>
#include <utility>

#include "base/planar.h"
#include "explore/search/victim_search.h"

namespace rubble::explore {

using mrpt::math::TPoint2D;
using mrpt::math::TPose2D;
using robot::CueKind;

namespace {

constexpr double kNearest = 0.2;        ///< a robot is never nearer to a victim [m]
constexpr double kLeastSigma = 0.05;    ///< no cue and no place is known better [m]
constexpr double kLongestStep = 0.5;    ///< of the least squares [m]
constexpr double kTail = 2.0;           ///< errors count as linear from here on [standard deviations]
constexpr double kFarOff = 2.0;         ///< errors count up to so many times the gate
constexpr double kChance = 5.0;         ///< what is rarer than so many standard deviations is no chance
constexpr double kError = 0.3;          ///< by so much a place may be off at the most ... [m]
constexpr double kLeastError = 0.1;     ///< ... and at the least [m]
constexpr double kTold = 18.0;          ///< cues that fit another place by so much better are of another victim
constexpr double kStand = 0.6;          ///< what was sensed from poses so near to each other is from one stand [m]
constexpr std::size_t kLeastStand = 3;  ///< cues
constexpr double kBeside = 1.0;         ///< what lies so near to a place may be of what its cues err by [m]
constexpr double kEnough = 1.4;         ///< evidence of a victim that was not seen
constexpr double kOneSense = 0.75;      ///< of it, or more, is of one sense
constexpr double kSameStand = 0.15;     ///< a robot that moved less stood [m]
constexpr double kSameHeading = deg_to_rad(15.0);  ///< and turned less
constexpr double kSameTime = 5.0;                  ///< no stand is longer [s]
constexpr double kSurelyHeard = 1.2;  ///< from so near a victim is heard in most looks, through walls as well [m]
constexpr double kSurelySmelt = 0.7;  ///< from so near it is smelt, ahead and without a wall between [m] ...
constexpr double kBeforeNose = deg_to_rad(75.0);
constexpr double kTellsOf = 0.2;  ///< cues a tick of the search, of which a sense looks in 0.7: fewer are no victim's
constexpr double kSeenError = 0.15;  ///< by so much one that was seen may be off [m]
constexpr double kShare = 0.4;       ///< of its evidence, or more, is another victim
constexpr double kKept = 0.5;        ///< of a victim's evidence: it is one no longer when less is left
constexpr double kVisit = 0.8;       ///< what lies within this of a place that was visited was visited too [m]
constexpr int kRounds = 2;           ///< of sorting and fitting after each cue

double along(const PlaceCovariance& c, double x, double y) { return x * x * c.xx + 2.0 * x * y * c.xy + y * y * c.yy; }

PlaceCovariance inverse(const PlaceCovariance& m) {
  const double det = m.xx * m.yy - m.xy * m.xy;
  return {m.yy / det, -m.xy / det, m.xx / det};
}

/// What a cue says about a victim at `p`.
struct Line {
  double distance;  ///< [m]
  double x, y;      ///< direction from the robot
  double across;    ///< by how much the victim lies to the left of p, by the cue's bearing [m]
  double beyond;    ///< and beyond it, by its range [m]
};

Line line_to(const TPoint2D& from, double bearing, double range, const TPoint2D& p) {
  Line line{};
  const double dx = p.x - from.x, dy = p.y - from.y;
  line.distance = std::max(std::hypot(dx, dy), kNearest);
  line.x = dx / line.distance;
  line.y = dy / line.distance;
  if (dx == 0.0 && dy == 0.0) {  // on the spot: the cue's own direction
    line.x = std::cos(bearing);
    line.y = std::sin(bearing);
  }
  line.across = wrap_angle(bearing - std::atan2(dy, dx)) * line.distance;
  line.beyond = range - line.distance;
  return line;
}

double square(double x) { return x * x; }

}  // namespace

void FaintSearch::add(const robot::VictimCue& cue, const Anchor& anchor, const PoseCovariance& covariance) {
  if (!std::isfinite(cue.bearing) || !std::isfinite(cue.range) || !(cue.confidence > 0.0)) return;
  cues_.push_back({cue.kind, cue.bearing, std::max(0.0, cue.range), anchor, covariance});
}

FaintSearch::Match FaintSearch::match(const Cue& cue, const TPoint2D& p, const PlaceCovariance& covariance) const {
  const FaintSense& s = sense(cue.kind);
  const Line line = line_to(cue.from(), cue.bearing_map(), cue.range, p);
  const double least = square(kLeastSigma);
  const double across = square(s.bearing_sigma * line.distance) + along(covariance, -line.y, line.x) + least;
  const double beyond = square(s.range_sigma * line.distance) + along(covariance, line.x, line.y) + least;
  const double error2 = square(line.across) / across + square(line.beyond) / beyond;
  return {error2, error2 + std::log(across * beyond)};
}

double FaintSearch::slack(const Place& place) {
  return std::clamp(2.0 * worst_sigma(place.covariance), kLeastError, kError);
}

/// Whether the sense could tell of a victim at `p` at all, or nearer to the robot by no more than `error` [m].
bool FaintSearch::possible(const Cue& cue, TPoint2D p, double error, const HiddenFn& hidden) const {
  const TPoint2D way = p - cue.from();
  const double far = way.norm();
  if (far > sense(cue.kind).range + kError) return false;
  // Sound comes over and through boxes, what is smelt does not.
  if (cue.kind == CueKind::Sound || far <= error) return true;
  p = cue.from() + way * ((far - error) / far);
  return !hidden(cue.from(), p);
}

/// Each cue to what explains it best.
void FaintSearch::assign(const std::vector<Seen>& seen, const HiddenFn& hidden) {
  for (Cue& cue : cues_) {
    cue.owner = -1;
    double least = 1e9;
    const auto offer = [&](const TPoint2D& p, const PlaceCovariance& covariance, double error, int owner) {
      if (distance(cue.from(), p) > sense(cue.kind).range + 1.0) return;
      const Match match = this->match(cue, p, covariance);
      if (match.error2 >= config_.gate || match.surprise >= least || !possible(cue, p, error, hidden)) return;
      least = match.surprise;
      cue.owner = owner;
    };
    for (std::size_t i = 0; i < seen.size(); ++i) offer(seen[i].p_map, {}, 0.0, -2 - static_cast<int>(i));
    for (std::size_t i = 0; i < places_.size(); ++i)
      offer(places_[i].p_map, places_[i].covariance, slack(places_[i]), static_cast<int>(i));
  }
}

std::vector<const FaintSearch::Cue*> FaintSearch::cues_of(int owner) const {
  std::vector<const Cue*> cues;
  for (const Cue& cue : cues_)
    if (cue.owner == owner) cues.push_back(&cue);
  return cues;
}

/// Least squares over bearings and ranges, from where the place is taken to be (Gauss-Newton, Huber's weights). False
/// without cues.
bool FaintSearch::fit(Place& place, const std::vector<const Cue*>& cues) const {
  if (cues.empty()) return false;
  for (int iteration = 0; iteration < 5; ++iteration) {
    PlaceCovariance information;
    double bx = 0.0, by = 0.0;
    for (const Cue* cue : cues) {
      const FaintSense& s = sense(cue->kind);
      const Line line = line_to(cue->from(), cue->bearing_map(), cue->range, place.p_map);
      const double across = square(s.bearing_sigma * line.distance) + square(kLeastSigma);
      const double beyond = square(s.range_sigma * line.distance) + square(kLeastSigma);
      const double error = std::sqrt(square(line.across) / across + square(line.beyond) / beyond);
      const double weight = error > kTail ? kTail / error : 1.0;
      const double wa = weight / across, wb = weight / beyond;
      information.xx += wa * line.y * line.y + wb * line.x * line.x;
      information.xy += (wb - wa) * line.x * line.y;
      information.yy += wa * line.x * line.x + wb * line.y * line.y;
      bx += -wa * line.across * line.y + wb * line.beyond * line.x;
      by += wa * line.across * line.x + wb * line.beyond * line.y;
    }
    const PlaceCovariance covariance = inverse(information);
    double dx = covariance.xx * bx + covariance.xy * by, dy = covariance.xy * bx + covariance.yy * by;
    const double step = std::hypot(dx, dy);
    if (step > kLongestStep) dx *= kLongestStep / step, dy *= kLongestStep / step;
    place.p_map = {place.p_map.x + dx, place.p_map.y + dy};
    place.covariance = covariance + PlaceCovariance{square(kLeastSigma), 0.0, square(kLeastSigma)};
    if (step < 0.005) break;
  }
  return true;
}

void FaintSearch::remove(std::size_t index) {
  places_.erase(places_.begin() + static_cast<std::ptrdiff_t>(index));
  for (Cue& cue : cues_) {
    if (cue.owner == static_cast<int>(index)) cue.owner = -1;
    if (cue.owner > static_cast<int>(index)) --cue.owner;
  }
}

void FaintSearch::refit() {
  for (std::size_t i = places_.size(); i-- > 0;)
    if (!fit(places_[i], cues_of(static_cast<int>(i)))) remove(i);
}

/// What nothing explains is a place of its own; where most of it agrees comes first.
void FaintSearch::open_places() {
  while (true) {
    const std::vector<const Cue*> left = cues_of(-1);
    if (left.empty()) return;
    Place best;
    double most = 0.0;
    for (const Cue* cue : left) {
      const TPoint2D p = tip(*cue);
      double evidence = 0.0;
      for (const Cue* other : left) evidence += error2(*other, p) < 4.0 ? sense(other->kind).evidence : 0.0;
      if (evidence <= most) continue;
      most = evidence;
      best.p_map = p;
    }
    if (most == 0.0) return;  // cues too near to tell anything
    std::vector<const Cue*> own;
    const int index = static_cast<int>(places_.size());
    for (Cue& cue : cues_)
      if (cue.owner == -1 && error2(cue, best.p_map) < 4.0) cue.owner = index;
    own = cues_of(index);
    if (own.empty()) return;  // a cue too near to tell anything
    fit(best, own);
    places_.push_back(best);
  }
}

/// Whether a victim at `p` explains all these cues: their errors are no larger than chance makes them. Of two normal
/// errors the squares come to 2 in the mean, with a standard deviation of 2.
bool FaintSearch::explains(const TPoint2D& p, double error, const std::vector<const Cue*>& cues,
                           const HiddenFn& hidden) const {
  const auto n = static_cast<double>(cues.size());
  return errors2(p, error, cues, hidden) <= 2.0 * n + kChance * 2.0 * std::sqrt(n);
}

std::vector<const FaintSearch::Cue*> FaintSearch::of_kind(CueKind kind, const std::vector<const Cue*>& cues) {
  std::vector<const Cue*> own;
  std::copy_if(cues.begin(), cues.end(), std::back_inserter(own), [&](const Cue* cue) { return cue->kind == kind; });
  return own;
}

double FaintSearch::errors2(const TPoint2D& p, double error, const std::vector<const Cue*>& cues,
                            const HiddenFn& hidden) const {
  double sum = 0.0;
  for (const Cue* cue : cues) {
    const double most = kFarOff * config_.gate;
    sum += possible(*cue, p, error, hidden) ? std::min(error2(*cue, p), most) : most;
  }
  return sum;
}

/// Whether these cues, each of which may well be of a victim at `p`, are together of one that lies elsewhere: that is
/// much likelier. Of one victim the squares differ by those of two normal errors, and more than `kTold` once in
/// 8,000.
bool FaintSearch::tell_of_another(const std::vector<const Cue*>& cues, const TPoint2D& p, double error,
                                  const HiddenFn& hidden) const {
  if (cues.empty()) return false;
  const double here = errors2(p, error, cues, hidden);
  if (here <= kTold) return false;
  Place other;
  for (const Cue* cue : cues) other.p_map = other.p_map + tip(*cue) * (1.0 / static_cast<double>(cues.size()));
  return fit(other, cues) && here - errors2(other.p_map, kError, cues, hidden) > kTold;
}

/// Whether what was smelt of two places is much likelier to be of two victims than of one at `p`. Sorted to the nearer
/// of two places the cues of one victim fit better as well, by less than one square each.
bool FaintSearch::are_two(const std::vector<const Cue*>& a, const TPoint2D& p_a, const std::vector<const Cue*>& b,
                          const TPoint2D& p_b, const TPoint2D& p, const HiddenFn& hidden) const {
  const double one = errors2(p, kError, a, hidden) + errors2(p, kError, b, hidden);
  const double two = errors2(p_a, kError, a, hidden) + errors2(p_b, kError, b, hidden);
  return !a.empty() && one - two > kTold + static_cast<double>(a.size() + b.size());
}

/// Takes from places, and from victims that were seen, what was smelt of others: a wide gate lets such cues through one
/// by one. Sound is heard from so far that other stands tell.
void FaintSearch::set_apart(const std::vector<Seen>& seen, const HiddenFn& hidden) {
  std::vector<Cue*> stand;
  const auto judge = [&] {
    std::set<int> owners;
    for (const Cue* cue : stand) owners.insert(cue->owner);
    owners.erase(-1);
    for (const int owner : owners) {
      const bool is_place = owner >= 0;
      const TPoint2D p =
          is_place ? places_[static_cast<std::size_t>(owner)].p_map : seen[static_cast<std::size_t>(-2 - owner)].p_map;
      const double error = is_place ? slack(places_[static_cast<std::size_t>(owner)]) : 0.0;
      // What it does not explain at all was sensed together with what it may.
      std::vector<const Cue*> cues;
      std::copy_if(stand.begin(), stand.end(), std::back_inserter(cues),
                   [&](const Cue* cue) { return cue->owner == owner || cue->owner == -1; });
      if (cues.size() < kLeastStand || !tell_of_another(cues, p, error, hidden)) continue;
      for (Cue* cue : stand)
        if (cue->owner == owner) cue->owner = -1;
    }
    stand.clear();
  };
  for (Cue& cue : cues_) {
    if (cue.kind != CueKind::Co2) continue;
    if (!stand.empty() && distance(stand.front()->from(), cue.from()) > kStand) judge();
    stand.push_back(&cue);
  }
  judge();
}

/// A place whose cues another one, or a victim that was seen, explains together with its own is none of its own. Where
/// that holds of what is heard alone, what is smelt stays.
void FaintSearch::join_places(std::vector<Seen>& seen, const HiddenFn& hidden) {
  for (std::size_t i = places_.size(); i-- > 0;) {
    const int own = static_cast<int>(i);
    const std::vector<const Cue*> all = cues_of(own), heard = of_kind(CueKind::Sound, all);
    const auto explained = [&](int owner, TPoint2D p, Place* joint, const std::vector<const Cue*>& cues) {
      if (cues.empty() || distance(p, places_[i].p_map) > config_.sound.range) return false;
      const std::vector<const Cue*> others = cues_of(owner);
      std::vector<const Cue*> both = cues;
      both.insert(both.end(), others.begin(), others.end());
      const TPoint2D before = p;
      if (joint != nullptr && fit(*joint, both)) p = joint->p_map;
      const double error = joint != nullptr ? slack(*joint) : 0.0;
      // Many cues of one sense say nothing of whether few of another fit. Sound carries: where it is heard at all it
      // is heard from many places, which tell together.
      const auto of_another = [&](CueKind kind) { return tell_of_another(of_kind(kind, cues), p, error, hidden); };
      const std::vector<const Cue*> smelt_there = of_kind(CueKind::Co2, others);
      if (smelt_there.empty() ? of_another(CueKind::Co2)
                              : are_two(of_kind(CueKind::Co2, cues), places_[i].p_map, smelt_there, before, p, hidden))
        return false;
      if (!others.empty() && of_kind(CueKind::Sound, others).empty() && of_another(CueKind::Sound)) return false;
      return explains(p, error, both, hidden);
    };
    const auto join = [&](const std::vector<const Cue*>& cues) {
      const bool whole = cues.size() == all.size();
      for (std::size_t k = 0; k < seen.size(); ++k) {
        const int owner = -2 - static_cast<int>(k);
        if (!explained(owner, seen[k].p_map, nullptr, cues)) continue;
        if (hands_over_number(places_[i], whole) && (seen[k].is_also == 0 || places_[i].id < seen[k].is_also))
          seen[k].is_also = places_[i].id;
        give(own, owner, whole);
        return true;
      }
      for (std::size_t k = 0; k < i; ++k) {
        Place joint = places_[k];
        if (!explained(static_cast<int>(k), joint.p_map, &joint, cues)) continue;
        take_over(joint, places_[i], whole);
        places_[k] = joint;
        give(own, static_cast<int>(k), whole);
        count(places_[k], cues_of(static_cast<int>(k)));
        return true;
      }
      return false;
    };
    if (!join(all) && heard.size() < all.size()) join(heard);
  }
}

/// Whether a victim's number goes with what is given away: with all of its cues, or with what was heard where that made
/// it a victim.
bool FaintSearch::hands_over_number(const Place& place, bool whole) const {
  return place.sure && (whole || place.co2 * config_.co2.evidence < 1.0);
}

/// What is known of a place that turned out to be the same, or in part.
void FaintSearch::take_over(Place& place, const Place& other, bool whole) const {
  if (hands_over_number(other, whole)) {
    if (!place.sure || other.id < place.id) {
      place.id = other.id;
      place.confirmed = other.confirmed;
    }
    place.sure = true;
  }
  if (!whole) return;  // nobody went there for what was heard
  place.looked_at = std::max(place.looked_at, other.looked_at);
  place.visited_from.insert(place.visited_from.end(), other.visited_from.begin(), other.visited_from.end());
}

/// All cues of a place to another owner, and the place is gone; or what was heard alone, and what was smelt stays.
void FaintSearch::give(int place, int owner, bool whole) {
  for (Cue& cue : cues_)
    if (cue.owner == place && (whole || cue.kind == CueKind::Sound)) cue.owner = owner;
  if (whole) return remove(static_cast<std::size_t>(place));
  Place& left = places_[static_cast<std::size_t>(place)];
  if (hands_over_number(left, whole)) {
    left.sure = false;
    left.id = 0;
    left.confirmed = Stamp::never();
  }
  const std::vector<const Cue*> smelt = cues_of(place);
  fit(left, smelt);
  count(left, smelt);
}

/// Of each owner's cues the newest stay.
void FaintSearch::forget() {
  std::vector<std::pair<int, std::size_t>> count;  // by owner
  for (std::size_t i = cues_.size(); i-- > 0;) {
    const int owner = cues_[i].owner;
    auto own = std::find_if(count.begin(), count.end(), [&](const auto& c) { return c.first == owner; });
    if (own == count.end()) own = count.insert(count.end(), {owner, 0});
    if (++own->second > config_.most) cues_.erase(cues_.begin() + static_cast<std::ptrdiff_t>(i));
  }
}

void FaintSearch::count(Place& place, const std::vector<const Cue*>& cues) const {
  place.sound = place.co2 = 0;
  place.evidence = 0.0;
  place.poses = {};
  double base = 0.0;
  for (const Cue* cue : cues) {
    ++(cue->kind == CueKind::Sound ? place.sound : place.co2);
    place.evidence += sense(cue->kind).evidence;
    place.newest = std::max(place.newest, cue->anchor.stamp);
    if (cue->kind == CueKind::Co2) place.smelt = std::max(place.smelt, cue->anchor.stamp);
    place.poses = place.poses + covariance_at(place.p_map, cue->anchor.T_map_base, cue->pose) *
                                    (1.0 / static_cast<double>(cues.size()));
    base = std::max(base, distance(cue->from(), cues.front()->from()));
  }
  place.base = base;
}

void FaintSearch::stood(const Anchor& anchor) {
  const TPoint2D here = position(anchor.T_map_base);
  if (std::none_of(places_.begin(), places_.end(),
                   [&](const Place& place) { return !place.sure && distance(place.p_map, here) < kSurelyHeard; }))
    return;
  if (!stands_.empty()) {
    Stand& last = stands_.back();
    const double turned = std::abs(wrap_angle(anchor.T_map_base.phi - last.anchor.T_map_base.phi));
    if (distance(here, position(last.anchor.T_map_base)) < kSameStand && turned < kSameHeading &&
        anchor.stamp - last.anchor.stamp < kSameTime) {
      ++last.ticks;
      return;
    }
  }
  stands_.push_back({anchor, 1});
}

/// Whether a sense told too seldom of a place for a victim there, from where nothing keeps it from telling: since the
/// oldest of the cues that it is known by.
bool FaintSearch::refuted(const Place& place, CueKind kind, const std::vector<const Cue*>& cues,
                          const HiddenFn& hidden) const {
  if (cues.empty()) return false;
  const Stamp since = cues.front()->anchor.stamp;  // cues are kept in the order in which they came
  int ticks = 0;
  for (const Stand& stand : stands_) {
    const TPose2D& pose = stand.anchor.T_map_base;
    const double far = distance(position(pose), place.p_map);
    if (stand.anchor.stamp < since || far > (kind == CueKind::Sound ? kSurelyHeard : kSurelySmelt)) continue;
    const TPoint2D at = pose.inverseComposePoint(place.p_map);
    const bool tells = kind == CueKind::Sound ||
                       (std::abs(std::atan2(at.y, at.x)) < kBeforeNose && !hidden(position(pose), place.p_map));
    ticks += tells ? stand.ticks : 0;
  }
  return static_cast<double>(cues.size()) < kTellsOf * ticks;
}

/// Whether a place is most likely what its cues err by about a victim that was seen: it lies near by, and most of its
/// cues could be of that one.
bool FaintSearch::is_of(const Place& place, const Seen& victim, const HiddenFn& hidden) const {
  if (distance(victim.p_map, place.p_map) >= kBeside) return false;
  const std::vector<const Cue*> cues = cues_of(static_cast<int>(&place - places_.data()));
  const auto could = std::count_if(cues.begin(), cues.end(),
                                   [&](const Cue* cue) { return possible(*cue, victim.p_map, kSeenError, hidden); });
  return 2 * could > static_cast<std::ptrdiff_t>(cues.size());
}

/// A place becomes a victim. A few cues beside one that has many are what these err by, and none.
void FaintSearch::confirm(Place& place, std::vector<Seen>& seen, const HiddenFn& hidden) const {
  const auto own =
      std::find_if(seen.begin(), seen.end(), [&](const Seen& victim) { return is_of(place, victim, hidden); });
  if (own != seen.end()) {
    if (place.sure && (own->is_also == 0 || place.id < own->is_also)) own->is_also = place.id;
    place.sure = false;
    place.id = 0;
    place.confirmed = Stamp::never();
    place.beside = true;
    return;
  }
  place.sure = place.sure && place.evidence >= kKept;
  if (place.sure) return;
  const auto few = [](int own, int others) { return own == 0 || own < kShare * others; };
  const auto overshadows = [&](const TPoint2D& p, int sound, int co2) {
    return distance(p, place.p_map) < kBeside && few(place.sound, sound) && few(place.co2, co2);
  };
  place.beside = std::any_of(places_.begin(), places_.end(),
                             [&](const Place& other) {
                               return &other != &place && overshadows(other.p_map, other.sound, other.co2);
                             }) ||
                 std::any_of(seen.begin(), seen.end(),
                             [&](const Seen& victim) { return overshadows(victim.p_map, victim.sound, victim.co2); });
  const double heard = place.sound * config_.sound.evidence;
  // A single one may be of a neighbour, or of nobody.
  const double smelt = place.co2 > 1 ? place.co2 * config_.co2.evidence : 0.0;
  // Stray cues of two senses meet somewhere.
  if (place.beside || heard + smelt < kEnough || std::max(heard, smelt) < kOneSense) return;
  if (worst_sigma(place.covariance) > config_.sure) return;
  if (smelt < kOneSense && place.base < config_.base) return;
  const std::vector<const Cue*> cues = cues_of(static_cast<int>(&place - places_.data()));
  const double told = (refuted(place, CueKind::Sound, of_kind(CueKind::Sound, cues), hidden) ? 0.0 : heard) +
                      (refuted(place, CueKind::Co2, of_kind(CueKind::Co2, cues), hidden) ? 0.0 : smelt);
  if (told < kOneSense) return;
  place.sure = true;
  if (place.confirmed == Stamp::never()) place.confirmed = place.newest;
}

void FaintSearch::sort(std::vector<Seen>& seen, const HiddenFn& hidden) {
  for (int round = 0; round < kRounds; ++round) {
    assign(seen, hidden);
    set_apart(seen, hidden);
    refit();
    open_places();
    join_places(seen, hidden);
  }
  forget();
  for (const Cue& cue : cues_)
    if (cue.owner < -1) {
      Seen& victim = seen[static_cast<std::size_t>(-2 - cue.owner)];
      ++(cue.kind == CueKind::Sound ? victim.sound : victim.co2);
    }
  for (std::size_t i = 0; i < places_.size(); ++i) count(places_[i], cues_of(static_cast<int>(i)));
  for (Place& place : places_) confirm(place, seen, hidden);
}

void FaintSearch::follow(const slam::Mapper& mapper) {
  for (Cue& cue : cues_) cue.anchor.follow(mapper);
  for (Stand& stand : stands_) stand.anchor.follow(mapper);
  for (Place& place : places_)
    for (Anchor& from : place.visited_from) from.follow(mapper);
  refit();
  for (std::size_t i = 0; i < places_.size(); ++i) count(places_[i], cues_of(static_cast<int>(i)));
}

bool FaintSearch::suspect(const Place& place) const {
  return !place.sure && !place.beside && place.visited_from.size() < config_.visits &&
         place.evidence >= std::max(0.0, place.looked_at) + config_.worth_look;
}

bool FaintSearch::undecided(Stamp now, double age) const {
  return std::any_of(places_.begin(), places_.end(), [&](const Place& place) {
    return !place.sure && !place.beside && place.evidence > place.looked_at && place.smelt != Stamp::never() &&
           now - place.smelt < age;
  });
}

void FaintSearch::visited(const TPoint2D& place, const Anchor& from) {
  for (Place& p : places_) {
    if (p.sure || distance(p.p_map, place) > kVisit) continue;
    p.looked_at = p.evidence;
    p.visited_from.push_back(from);
  }
}

}  // namespace rubble::explore
