#pragma once

#include <mrpt/math/TPoint2D.h>

#include <cmath>
#include <cstddef>
#include <functional>
#include <vector>

#include "base/angle.h"
#include "base/pose_covariance.h"
#include "base/stamp.h"
#include "explore/anchor.h"
#include "explore/victim_report.h"
#include "robot/measurements.h"

namespace rubble::explore {

/// How a sense errs that tells whereabouts only, as far as the explorer counts on it.
struct FaintSense {
  double bearing_sigma;  ///< of a cue [rad]
  double range_sigma;    ///< relative to the range
  double range;          ///< [m]
  double evidence;       ///< of one cue; 1 in all makes a victim
};

struct FaintSearchConfig {
  FaintSense sound{deg_to_rad(15.0), 0.4, 3.0, 0.125};
  FaintSense co2{deg_to_rad(30.0), 0.3, 0.9, 0.25};
  double gate = 9.2;        ///< square of the error, in standard deviations, up to which a cue is of a place (99 %)
  double sure = 0.30;       ///< a victim's place has no larger standard deviation [m]
  double base = 0.5;        ///< one that is only heard was heard from places so far apart [m]
  double worth_look = 0.5;  ///< evidence that is new of a place and worth a visit
  std::size_t visits = 2;   ///< to one place
  std::size_t most = 60;    ///< cues kept of one place
};

/// Places what is heard or smelt. A cue of such a sense tells a direction, and a range that may be wrong by half: the
/// place that fits all its cues best, weighted by their errors, is found by least squares, with its covariance. Each
/// cue belongs to the place that explains it best; victims that were seen are such places as well, and take theirs.
class FaintSearch {
 public:
  /// Where something is heard or smelt.
  struct Place {
    mrpt::math::TPoint2D p_map;  ///< [m]
    PlaceCovariance covariance;  ///< by the cues
    PlaceCovariance poses{};     ///< by the poses they were sensed from
    int sound = 0, co2 = 0;      ///< its cues
    double evidence = 0.0;
    double base = 0.0;    ///< how far apart it was sensed from [m]
    bool beside = false;  ///< its cues are too few beside those of a victim nearby
    bool sure = false;    ///< it is a victim
    int id = 0;           ///< of that victim, given by whom it is told to
    Stamp confirmed = Stamp::never();
    Stamp newest = Stamp::never();  ///< its newest cue
    Stamp smelt = Stamp::never();   ///< its newest one of CO2
    double looked_at = -1.0;        ///< its evidence when it was visited last; < 0: never
    std::vector<Anchor> visited_from;
  };
  /// A victim that was seen, and what of its cues was heard or smelt.
  struct Seen {
    int id;
    mrpt::math::TPoint2D p_map;  ///< [m]
    int sound = 0, co2 = 0;
    int is_also = 0;  ///< id of a sure place that turned out to be this victim
  };
  /// Whether a wall of the map stands before the second of two places.
  using HiddenFn = std::function<bool(const mrpt::math::TPoint2D&, const mrpt::math::TPoint2D&)>;

  explicit FaintSearch(const FaintSearchConfig& config = {}) : config_(config) {}

  /// Whether such cues are its matter.
  static bool takes(robot::CueKind kind) { return kind == robot::CueKind::Sound || kind == robot::CueKind::Co2; }
  /// Takes a cue that was sensed from `anchor`; `covariance`: of that pose.
  void add(const robot::VictimCue& cue, const Anchor& anchor, const PoseCovariance& covariance = {});
  /// A tick of the search: the senses were at work, and would have told of a victim close by.
  void stood(const Anchor& anchor);
  /// Sorts all cues to the victims seen (whose counts are 0) and to places of their own.
  void sort(std::vector<Seen>& seen, const HiddenFn& hidden);
  /// The mapper corrected its past.
  void follow(const slam::Mapper& mapper);

  std::vector<Place>& places() { return places_; }
  const std::vector<Place>& places() const { return places_; }
  /// Whether a place may be a victim and is worth a visit.
  bool suspect(const Place& place) const;
  /// True when something was smelt within the last `age` [s] that may be a victim.
  bool undecided(Stamp now, double age) const;
  /// The robot stood at `from` for a while, near a place that may be a victim.
  void visited(const mrpt::math::TPoint2D& place, const Anchor& from);

 private:
  struct Cue {
    robot::CueKind kind;
    double bearing, range;  ///< from the base [rad, m]
    Anchor anchor;
    PoseCovariance pose;  ///< of the anchor
    int owner = -1;       ///< index of a place; below -1: -2 - index of a victim seen; -1: none

    mrpt::math::TPoint2D from() const { return {anchor.T_map_base.x, anchor.T_map_base.y}; }
    double bearing_map() const { return wrap_angle(anchor.T_map_base.phi + bearing); }
  };

  /// Moments in which the robot stood at about the same place.
  struct Stand {
    Anchor anchor;
    int ticks;  ///< of the search, some three a second
  };

  const FaintSense& sense(robot::CueKind kind) const {
    return kind == robot::CueKind::Sound ? config_.sound : config_.co2;
  }
  /// Where a cue by itself puts what it is of.
  static mrpt::math::TPoint2D tip(const Cue& cue) {
    return cue.from() + mrpt::math::TPoint2D(std::cos(cue.bearing_map()), std::sin(cue.bearing_map())) * cue.range;
  }
  /// By how much a place may be off [m].
  static double slack(const Place& place);
  /// How well a place explains a cue.
  struct Match {
    double error2;  ///< square of the error, in standard deviations
    double
        surprise;  ///< -2 log of the likelihood, but for a constant: a place that is hardly known explains all, badly
  };
  Match match(const Cue& cue, const mrpt::math::TPoint2D& p, const PlaceCovariance& covariance) const;
  double error2(const Cue& cue, const mrpt::math::TPoint2D& p) const { return match(cue, p, {}).error2; }
  bool possible(const Cue& cue, mrpt::math::TPoint2D p, double error, const HiddenFn& hidden) const;
  void assign(const std::vector<Seen>& seen, const HiddenFn& hidden);
  bool fit(Place& place, const std::vector<const Cue*>& cues) const;
  std::vector<const Cue*> cues_of(int owner) const;
  void refit();
  void open_places();
  void join_places(std::vector<Seen>& seen, const HiddenFn& hidden);
  double errors2(const mrpt::math::TPoint2D& p, double error, const std::vector<const Cue*>& cues,
                 const HiddenFn& hidden) const;
  bool explains(const mrpt::math::TPoint2D& p, double error, const std::vector<const Cue*>& cues,
                const HiddenFn& hidden) const;
  static std::vector<const Cue*> of_kind(robot::CueKind kind, const std::vector<const Cue*>& cues);
  bool tell_of_another(const std::vector<const Cue*>& cues, const mrpt::math::TPoint2D& p, double error,
                       const HiddenFn& hidden) const;
  bool are_two(const std::vector<const Cue*>& a, const mrpt::math::TPoint2D& p_a, const std::vector<const Cue*>& b,
               const mrpt::math::TPoint2D& p_b, const mrpt::math::TPoint2D& p, const HiddenFn& hidden) const;
  void set_apart(const std::vector<Seen>& seen, const HiddenFn& hidden);
  bool hands_over_number(const Place& place, bool whole) const;
  void take_over(Place& place, const Place& other, bool whole) const;
  void give(int place, int owner, bool whole);
  void remove(std::size_t index);
  void forget();
  void count(Place& place, const std::vector<const Cue*>& cues) const;
  bool is_of(const Place& place, const Seen& victim, const HiddenFn& hidden) const;
  void confirm(Place& place, std::vector<Seen>& seen, const HiddenFn& hidden) const;

  bool refuted(const Place& place, robot::CueKind kind, const std::vector<const Cue*>& cues,
               const HiddenFn& hidden) const;

  FaintSearchConfig config_;
  std::vector<Stand> stands_;
  std::vector<Cue> cues_;
  std::vector<Place> places_;
};

}  // namespace rubble::explore
