#pragma once

#include <mrpt/math/TPoint2D.h>
#include <mrpt/math/TPose2D.h>

#include <cstddef>
#include <functional>
#include <optional>
#include <vector>

#include "base/stamp.h"
#include "explore/anchor.h"
#include "explore/stuck/motion_watch.h"
#include "explore/stuck/way_back.h"
#include "explore/stuck/way_out.h"
#include "robot/commands.h"

namespace rubble::explore {

/// How the robot gets free of what holds it: back the way it came for half a metre; where that fails turns and other
/// directions, then pose by pose the way it came, and all of it again, until it has moved away or everything was tried.
/// Out of a trap it goes by a plan first, and all the way: half a metre on it would be held again.
class Escape {
 public:
  enum class Result { UnderWay, Free, Failed };
  /// What stopped the robot was met driving forwards, backwards, or turning.
  enum class Met { Forwards, Backwards, Turning };
  /// Whether half a body has room about a pose, as far as is known.
  using RoomFn = std::function<bool(const mrpt::math::TPose2D&)>;
  /// How near the body in a pose would be to the walls that are known; below 0: in them [m].
  using GapFn = std::function<double(const mrpt::math::TPose2D&)>;
  struct Around {
    RoomFn room;
    GapFn gap;
  };

  explicit Escape(double turn_speed) : turn_speed_(turn_speed) {}

  /// `failures`: escapes in a row that failed just before; each turns by another angle. `way_out`: of a trap it is in.
  void begin(Met met, const mrpt::math::TPose2D& T_map_base, Stamp now, int failures = 0,
             std::optional<WayOut> way_out = std::nullopt);
  /// The mapper corrected its past: where it was held, and where it began to move, lie elsewhere now.
  void follow(const slam::Mapper& mapper);
  /// One tick of `dt` [s] under the command that was in force. `wheels`: what they do, where that is known. `struck`: a
  /// blow stopped the robot. `trail`: where it came along, oldest first; `way_back`: the poses.
  Result step(const mrpt::math::TPose2D& T_map_base, const robot::Drive& commanded, bool stalled,
              const std::optional<robot::Drive>& wheels, bool struck, double dt, Stamp now,
              const std::vector<mrpt::math::TPoint2D>& trail, const WayBack& way_back, const Around& around);
  /// The command for the tick to come.
  const robot::Drive& drive() const { return drive_; }
  /// Something was met in this tick: the base shall not push on.
  bool met() const { return met_; }
  /// How far from where it was held the robot has been since [m].
  double roamed() const { return roamed_; }

 private:
  enum class Move { Back, StraightBack, Ahead, Left, Right, BackLeft, BackRight, AheadLeft, AheadRight, Retrace, Out };

  void start_move(const mrpt::math::TPose2D& T_map_base, Stamp now);
  bool free(const mrpt::math::TPoint2D& p_map) const;
  bool meets_wall(const mrpt::math::TPose2D& T_map_base, const Around& around) const;
  std::optional<Move> opens(const mrpt::math::TPose2D& T_map_base, const Around& around) const;
  bool gets_nowhere(const mrpt::math::TPose2D& T_map_base, Stamp now);
  std::optional<robot::Drive> command(const mrpt::math::TPose2D& T_map_base,
                                      const std::vector<mrpt::math::TPoint2D>& trail, const WayBack& way_back);

  double turn_speed_;  ///< [rad/s]
  std::vector<Move> moves_;
  std::size_t at_ = 0;
  bool opened_ = false;            ///< the move is a straight one that a curve has opened
  bool straight_in_vain_ = false;  ///< such a move got nowhere
  bool scrapes_ = false;           ///< a turn may bring corners to walls: the escape before failed
  bool held_behind_ = false;       ///< it was held driving backwards
  double roamed_ = 0.0;            ///< [m]
  double turn_ = 0.0;              ///< of Left and Right [rad]
  std::optional<WayOut> way_out_;
  MotionWatch watch_;
  Anchor begun_{};       ///< where the escape began
  Anchor move_begun_{};  ///< where the present move began
  Stamp move_until_ = Stamp::never();
  Stamp old_stall_until_ = Stamp::never();  ///< the motors may still report what held them before the move
  Anchor place_{};                          ///< it has been about here
  Stamp there_since_ = Stamp::never();
  robot::Drive drive_;
  bool met_ = false;
};

}  // namespace rubble::explore
