#pragma once

#include <array>
#include <deque>
#include <string>
#include <utility>

#include "robot/commands.h"
#include "robot/measurements.h"

namespace rubble::robot {

/// Holds what a base reports of its wheels against what it was told.
///
/// Wheels that stand for kStands though told to go some way meanwhile, without a stall, do not obey, nor do wheels that
/// go less than half of the way that they are told. Wheels that for kMoves go faster than they were told lately, or
/// elsewhere, run away, and so do wheels that go on, however slowly, in the times when they are told to stand or to go
/// the other way. What a ramp takes and what a line and a firmware are late by is granted; a robot that is given a
/// push, or that was not heard for a while, is none of these.
class Obedience {
 public:
  static constexpr double kStands = 2.0;  ///< [s]
  static constexpr double kMoves = 1.0;   ///< [s]
  static constexpr int kCreeps = 3;       ///< of times when it may not; of slower ones up to four times that [s]

  /// Limits of the base's own ramps [m/s^2], [rad/s^2].
  Obedience(double max_accel, double max_turn_accel) { keep_ramp({max_accel, max_turn_accel}); }
  /// The same, once the base has told its own.
  void keep_ramp(const Drive& ramp) { ramp_ = {kRamp * ramp.v, kRamp * ramp.w}; }

  /// Nothing is told to the base that it must obey at once: it is held, its motors are off, its line is slow.
  void pause();
  /// It is told to do `told`, within its limits and as it reckons. To be called about fifty times a second.
  void tell(const Drive& told, Stamp now);
  /// A report that came at `now`.
  void look(const Odometry& odometry, Stamp now);
  /// How fast it goes, by the poses of the last half second.
  Drive motion() const;

  /// What is wrong, in words; empty: it obeys. Stays as long as the wheels stand or lag behind, or until pause().
  const std::string& trouble() const { return trouble_; }
  /// Stays until pause().
  bool runs_away() const { return runs_away_; }

 private:
  static constexpr double kRamp = 0.7;  ///< of the ramp's acceleration is believed

  /// The ways in which wheels may go though told not to.
  enum Way { Forwards, Backwards, Left, Right, kWays };
  /// The times when they were told not to go some way, put end to end.
  class Ban {
   public:
    struct Sum {
      Stamp when;
      double seconds = 0.0;
      double gone = 0.0;     ///< that way [m] or [rad]
      double at_rest = 0.0;  ///< of the seconds it was told to stand
    };
    /// Whether it holds from `now` on. `rest`: because it is told to stand.
    void hold(bool held, bool rest, Stamp now);
    /// So far was gone that way from one report to the next.
    void add(double gone, Stamp before, Stamp now);
    void clear() { *this = Ban(); }
    /// In each second of the last `seconds` it went on that way, and by more than `most` in all: a push ends sooner,
    /// and pushes leave gaps.
    bool broken(int seconds, double most) const;
    /// Within the last `seconds`.
    Sum lately(double seconds) const;

   private:
    Sum at(double seconds) const;
    Stamp since_ = Stamp::never();
    bool rest_ = false;
    std::deque<Sum> sums_;  ///< of the last minute
  };
  /// How far the wheels are behind half of the way that they were told [m] or [rad].
  struct Arrears {
    double owed = 0.0;
    double seconds = 0.0;  ///< of being told to go, since nothing was owed
    double told = 0.0;     ///< meanwhile
    double gone = 0.0;
  };

  void forget();
  void forget_ways();
  void mind_way(const Odometry& odometry, Stamp now);
  void mind_arrears(const Drive& gone, bool stalled);
  void ban(const Drive& high, const Drive& low, Stamp now);
  void mind_creeping();
  void mind_standing(const Odometry& odometry, Stamp now);
  void mind_running(Stamp now);
  void say();
  void expect_braking();

  Drive ramp_;                                   ///< [m/s^2], [rad/s^2]
  std::deque<std::pair<Stamp, Drive>> told_;     ///< lately
  Drive expected_;                               ///< what the base does at least, by now
  Drive most_, least_;                           ///< how fast it may go, either way
  bool judged_ = false;                          ///< how fast it went at first has been seen
  std::deque<std::pair<Stamp, Odometry>> seen_;  ///< of the last half second
  Stamp excess_ = Stamp::never();                ///< since then it is faster
  Stamp stands_ = Stamp::never();                ///< since then its wheels stand
  Drive missed_;                                 ///< the way that they should have gone since [m], [rad]
  std::array<Ban, kWays> bans_;
  Stamp misses_since_ = Stamp::never();  ///< since then that is too much
  Drive stood_way_;                      ///< and did go, however slowly
  Drive moves_;                          ///< as it was seen last
  Drive sure_;                           ///< how fast they go at least, whichever way
  Drive sure_way_;                       ///< by it, since the last report [m], [rad]
  double sure_seconds_v_ = 0.0, sure_seconds_w_ = 0.0;
  Arrears arrears_v_, arrears_w_;
  std::string standing_, lagging_, running_;  ///< what is wrong
  std::string trouble_;                       ///< the worst of it
  bool runs_away_ = false;
};

}  // namespace rubble::robot
