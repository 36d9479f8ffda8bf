#pragma once

#include <mrpt/math/TPoint2D.h>
#include <mrpt/math/TPose2D.h>

#include <optional>
#include <vector>

#include "explore/caution/trap.h"
#include "robot/commands.h"
#include "robot/model.h"
#include "slam/mapper.h"

namespace rubble::explore {

/// The way out of a trap, planned with the shape of the body: between the high corners of crossing ramps and the walls
/// beside them it has 0.05 m to either side, and turns only where its corners have room.
///
/// It drives one piece of the way, straight on or a turn on the spot, and plans anew from where that led.
class WayOut {
 public:
  /// `obstacles` [m, map frame]: walls, and what was felt beside the trap. `known`: where the robot was before [m, map
  /// frame]; the way ends on such floor if there is one.
  WayOut(const robot::RobotModel& model, const Trap& trap, const std::vector<mrpt::math::TPoint2D>& obstacles,
         const std::vector<mrpt::math::TPoint2D>& known);

  /// The mapper corrected its past; what stands about the trap moves with it.
  void follow(const slam::Mapper& mapper) { trap_.follow(mapper); }
  /// Whether a robot in this place is out of it, all of its body.
  bool out(const mrpt::math::TPoint2D& p_map) const { return !trap_.holds(p_map, kBeside); }

  /// Drops the piece under way, for the robot was moved otherwise.
  void begin_anew() { piece_.reset(); }
  /// The drive along the way; nothing where there is none.
  std::optional<robot::Drive> drive(const mrpt::math::TPose2D& T_map_base);

 private:
  static constexpr double kBeside = 0.3;  ///< nearer to the trap the body may still reach into it [m]

  /// A drive along the heading, or a turn.
  struct Piece {
    mrpt::math::TPose2D to;  ///< pallet frame
    bool turns = false;
    double way = 0.0;  ///< of a drive: ahead, or back where negative [m]
  };
  /// How ways out begin, where there are any: to floor where the robot was before, and wherever else.
  struct Ways {
    std::optional<Piece> to_known, anywhere;
  };
  /// A pose of the search, with how it was come to.
  struct Node {
    mrpt::math::TPose2D pose;
    int heading = 0;
    int before = -1;
    int move = 0;  ///< -1, 1: back, ahead; -2, 2: right, left; 0: the start
  };
  /// What the body keeps away from, and how far.
  struct Keep {
    mrpt::math::TPoint2D at;  ///< pallet frame [m]
    double away;              ///< [m]
  };

  std::optional<robot::Drive> along(const mrpt::math::TPose2D& T_pallet_base) const;
  std::optional<Piece> plan(const mrpt::math::TPose2D& T_pallet_base) const;
  Ways search(const mrpt::math::TPose2D& T_pallet_base, double margin, long& work) const;
  static Piece first_piece(const std::vector<Node>& nodes, int last);
  bool fits(const mrpt::math::TPose2D& T_pallet_base, const std::vector<Keep>& keeps) const;
  double room(const mrpt::math::TPoint2D& p_base) const;
  bool leaves(const mrpt::math::TPose2D& T_pallet_base) const;
  bool is_known(const mrpt::math::TPoint2D& p_pallet) const;

  robot::RobotModel model_;
  Trap trap_;
  std::vector<mrpt::math::TPoint2D> obstacles_, known_;  ///< pallet frame
  std::optional<Piece> piece_;
};

}  // namespace rubble::explore
