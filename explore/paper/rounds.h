#pragma once

#include <cstddef>
#include <functional>
#include <optional>
#include <string>

#include "base/stamp.h"
#include "explore/caution/left_alone.h"
#include "explore/paper/known_ground.h"
#include "explore/plan/traversable.h"
#include "explore/search/floor_search.h"

namespace rubble::explore {

/// What is tried when nothing can be reached, from the least to the last.
enum class Resort { LookAround, TryAgain, Push, ForgetAll, GiveUp };

/// Rounds of exploring and searching. What could not be reached or seen may be had from another side, or once the map
/// has changed; so what failed is tried again, within a round and in one more round after it.
///
/// It ends: within a round each resort is taken a few times at most, what was felt is forgotten four times in a mission
/// (and six times on the way home), and two rounds in a row that gain neither ground nor a victim are the last.
class Rounds {
 public:
  /// How things stand when a decision is due.
  struct Standing {
    Stamp now;
    const Traversable& floor;
    std::size_t victims;  ///< sure ones so far
    /// How many frontiers are worth another try; asked for where it matters only, for it takes a while.
    std::function<std::size_t()> frontier_left;
    std::function<std::size_t()> behind_felt;  ///< and those that nothing but what was felt keeps the robot from
  };

  /// A plan found a way.
  void way_found() { failed_plans_ = looks_in_vain_ = 0; }
  /// A plan found none, on a map that was `new_map` or not.
  void no_way(bool new_map) { failed_plans_ += new_map ? 1 : 0; }
  /// What to try now that nothing can be reached, on the way to frontiers or (`homeward`) home; where that is to
  /// forgive something, that is done. `may_push`: so may things be. `worth`: so may other ground be had, if what keeps
  /// the robot from it was none; else it looks around and gives up.
  Resort next_resort(bool homeward, bool may_push, LeftAlone& left_alone, Stamp now, bool worth = true);

  /// No niche is left to be searched, but frontiers may be: before the search of all other faces, which takes
  /// most of the time, what failed is tried again, once a round, or what was not tried so far (`more`). Returns the
  /// news; nothing: there is nothing to try.
  std::optional<std::string> before_all_faces(const Standing& standing, bool more, FloorSearch& search,
                                              LeftAlone& left_alone);
  /// It was in this round.
  bool tried_before_search() const { return tried_before_search_; }
  /// Everything is done: begins another round if one is worth while. Returns the news; nothing: that was the last.
  std::optional<std::string> another(const Standing& standing, FloorSearch& search, LeftAlone& left_alone);
  /// The robot is to go home: what failed is forgiven once more on the way.
  void go_home();

 private:
  /// What all that was felt is forgotten for.
  enum class For { Frontiers, Faces };

  std::optional<std::string> forget_what_was_felt(For what, const Standing& standing, FloorSearch& search,
                                                  LeftAlone& left_alone);
  void begin();

  int failed_plans_ = 0;   ///< in a row, each on a new map
  int looks_in_vain_ = 0;  ///< in a row
  int pardons_ = 0;
  int home_tries_ = 0;
  bool tried_before_search_ = false;  ///< in this round
  int rounds_ = 1;                    ///< this one included
  int barren_rounds_ = 0;             ///< that gained nothing, in a row
  int forgets_ = 0;                   ///< times that all that was felt was forgotten
  KnownGround known_then_;            ///< at the end of the last round
  std::size_t victims_then_ = 0;      ///< likewise
};

}  // namespace rubble::explore
