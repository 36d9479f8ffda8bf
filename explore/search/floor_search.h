#pragma once

#include <functional>
#include <limits>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "base/stamp.h"
#include "explore/anchor.h"
#include "explore/explorer.h"
#include "explore/plan/exploration_transform.h"
#include "explore/search/searched_area.h"
#include "explore/search/wall_holes.h"

namespace rubble::explore {

/// A place that may be a victim's, known by sound or CO2.
struct Suspect {
  mrpt::math::TPoint2D p_map;                      ///< [m]
  std::vector<mrpt::math::TPoint2D> visited_from;  ///< where the robot stood for it before [m]
};

/// The search of the mapped floor for victims: what was looked at, from where to look next, and holding still there.
class FloorSearch {
 public:
  /// `room`: clearance a viewpoint should have, for the robot turns on the spot there [m]; `tight`: where none has,
  /// this.
  FloorSearch(const SearchConfig& config, double room, double tight, const OtherSenses& others = {});

  bool on() const { return config_.on; }
  /// Whether faces are looked at squarely as well, when all else was searched.
  bool squarely() const {
    return config_.squarely == SquareLook::Always || (config_.squarely == SquareLook::Holes && holes_);
  }
  /// There are victims behind holes in walls.
  void expect_holes() { holes_ = true; }

  /// What the place to face is looked at for, in words: "a place to search from".
  const char* purpose() const;
  /// What all the searching comes to, in words.
  std::string done() const;

  /// The places that may be victims' as far as is known now: they are visited together with what is left to be
  /// searched.
  void set_suspects(std::vector<Suspect> suspects) { suspects_ = std::move(suspects); }
  /// The suspect that the robot stood for, once its dwell is over.
  std::optional<mrpt::math::TPoint2D> visited_suspect() const {
    return dwell_over_ && subject_.record == Record::Suspect ? std::optional(subject_.at) : std::nullopt;
  }

  /// Records what the victim sensors see from here, a few times a second, and not while turning (at `turn_rate`
  /// [rad/s]) too fast to see. True when it did.
  bool look(const Traversable& floor, const mrpt::math::TPose2D& T_map_base, double turn_rate, Stamp now);
  /// Whether the cameras have seen the floor at a place [map frame, m].
  bool saw(const mrpt::math::TPoint2D& place) const { return searched_.saw(place); }
  /// Whether the place to face has been looked at.
  bool subject_seen(const Traversable& floor) const;
  /// The mapper corrected its past. True when a look moved by so much that the record must be made anew: `look_again`.
  bool follow(const slam::Mapper& mapper);
  /// Makes the record of all looks anew. Those that moved, and those where the floor is another now, are repeated from
  /// where they were made as is known now; what the others showed stays true.
  void look_again(const Traversable& floor);
  /// Counts the place to face and what is around it as searched, seen or not, until it is reconsidered.
  void give_up_subject(const Traversable& floor, const Anchor& here);
  /// Everything that was given up is to be looked at again; says whether there was anything.
  bool reconsider(const Traversable& floor);

  /// The cells from which something unsearched can be seen, each with the head start that `head_start` gives to its
  /// centre; without one it is left out. `idle`: places where nothing can be for the cameras to see.
  std::vector<Source> sources(const Traversable& map, Subjects subjects,
                              const std::function<std::optional<double>(const mrpt::math::TPoint2D&)>& head_start,
                              const std::function<bool(const Viewpoint&)>& idle = {});
  /// Length of the wall faces in range and in sight of a cell that are still to be looked at [m].
  double faces_in_view(const Traversable& floor, Cell from) const;
  /// Whether any such cell was found at the last time, in reach or not.
  bool place_left() const { return !views_.empty(); }
  /// Whether there were faces to be looked at squarely when that was asked last, in reach or not.
  bool faces_left() const { return squarely() && faces_left_; }
  /// Makes what is cheapest to be seen from `viewpoint` the place to face: that source which decided what the way there
  /// costs. Returns how much of its head start is no way, look or turn but says that its wall has no hole, that little
  /// else is left to be looked at around it, and that many scans saw the place [m].
  double choose_subject(Cell viewpoint);
  /// Of all that can be seen from here makes that the place to face which needs the smallest turn; returns the turn
  /// [rad]; nothing when it already lies ahead.
  std::optional<double> turn_to_subject(const Traversable& floor, const mrpt::math::TPose2D& T_map_base);

  void start_dwell(Stamp now);
  /// The same for what the last turn was made to, whatever was planned meanwhile.
  void start_dwell_as_turned(Stamp now);
  /// True while the robot holds still before the place to face. At the end that place counts as searched.
  bool dwelling(const Traversable& floor, const mrpt::math::TPose2D& T_map_base, Stamp now);
  /// True in the tick in which a dwell ended.
  bool dwell_over() const { return dwell_over_; }

  /// True while the robot holds still for a cue: a first one is no victim yet, a few more looks decide. `seen`: where
  /// there are fresh cues that are not, each worth a stare of its own; `smelt`: there is one somewhere.
  bool staring(const std::vector<mrpt::math::TPoint2D>& seen, bool smelt, Stamp now);

 private:
  /// What is to be searched: by cameras anyhow or squarely, by the other senses; or one of the suspects.
  enum class Record { Anyhow, Squarely, Heard, Smelt, Suspect };
  /// What a sense beside the cameras has searched.
  struct Other {
    Record record;
    SearchConfig config;
    SearchedArea area;
    FloorInView view{};  ///< of the look under way
  };
  struct View : Viewpoint {
    Record record = Record::Anyhow;
    bool hole = false;   ///< the scanner saw one in the board that it faces
    double scrap = 0.0;  ///< what it costs more for having little to be looked at around it [m]
    double solid = 0.0;  ///< and for having no hole [m]
    double known = 0.0;  ///< and for lying where many scans would have shown a box [m]
    double cost = std::numeric_limits<double>::infinity();  ///< head start of its source, if it is one [m]
  };

  /// The place to face.
  struct Subject {
    mrpt::math::TPoint2D at;  ///< [m, map frame]
    Faces faces = 0;
    Record record = Record::Anyhow;
    double known = std::numeric_limits<double>::infinity();  ///< as the view that it was chosen from [m]
  };

  bool look_around(const Traversable& floor, const mrpt::math::TPose2D& T_map_base);
  SearchedArea& record(Record record);
  const SearchedArea& record(Record record) const;
  template <class Search>
  static auto& record_of(Search& search, Record record);
  void add_views(const std::vector<Viewpoint>& views, Record record);
  double shown(const Traversable& floor, const View& view) const;
  void find_holes(const Traversable& floor);
  void find_scraps(double apart);
  void find_known(const Traversable& floor);
  static bool serves(const Subject& view, const mrpt::math::TPose2D& T_map_base);
  bool try_again(const Anchor& here);
  void add_suspects(const Traversable& floor);
  bool is_suspect(const mrpt::math::TPoint2D& place) const;
  double facing(Record record) const;
  static double radius_of(Record record);

  /// A place that could not be looked at, kept relative to where the robot gave it up.
  struct GivenUp {
    Anchor anchor;
    mrpt::math::TPoint2D p_base;
    Faces faces;
    Record record;
  };
  /// What an other sense found in a look, and the floor there.
  struct OtherLook {
    Grid<Faces> seen;
    OccupancyGrid ground;
  };
  /// A cue that the robot stood still for.
  struct Stare {
    mrpt::math::TPoint2D at;
    Stamp since;
  };
  /// A look that showed something new.
  struct Look {
    Anchor anchor;
    mrpt::math::TPose2D made_at;  ///< when it was last repeated [map frame]
    Grid<Faces> anyhow;           ///< what it saw then ...
    Grid<Faces> squarely;
    OccupancyGrid ground;  ///< ... and the floor there
    std::vector<OtherLook> others;
  };

  Look last_look(const Traversable& floor, const Anchor& from) const;
  bool same_ground(const Look& look, const Traversable& floor) const;
  static bool moved(const Anchor& anchor, const mrpt::math::TPose2D& was);
  void follow_subject(const slam::Mapper& mapper);

  SearchConfig config_;
  double room_;
  double tight_;
  SearchedArea searched_;
  SearchedArea squarely_;    ///< what was looked at squarely
  FloorInView view_;         ///< of the look under way
  bool by_cameras_ = false;  ///< the robot has other senses, with which it does not search everywhere
  std::vector<Other> others_;
  std::vector<Suspect> suspects_;
  std::vector<View> views_;
  Subject subject_;
  Subject turned_to_;                  ///< of the last turn
  Anchor looked_{Stamp::never(), {}};  ///< where it looked last ...
  mrpt::math::TPose2D looked_at_;      ///< ... in the map in which the place to face lies
  std::vector<Look> looks_;
  std::vector<GivenUp> given_up_;
  std::vector<AnchoredPoint> slid_;  ///< places that the robot did not stand squarely before, though it meant to
  Stamp next_look_ = Stamp::never();
  Stamp dwell_until_ = Stamp::never();
  std::vector<Stare> stared_at_;  ///< lately
  Stamp stare_until_ = Stamp::never();
  Stamp next_sniff_ = Stamp::never();
  bool dwell_over_ = false;
  bool holes_ = false;
  bool faces_left_ = false;
};

}  // namespace rubble::explore
