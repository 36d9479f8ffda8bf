#include "scoring/alignment/alignment.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <future>
#include <optional>
#include <vector>

#include "base/angle.h"
#include "base/rigid.h"
#include "scoring/alignment/examiner.h"
#include "scoring/alignment/feature_score.h"
#include "scoring/alignment/matching.h"
#include "scoring/alignment/trust.h"
#include "scoring/measures/sight_lines.h"
#include "scoring/rooms/room_hypotheses.h"
#include "scoring/walls/resample.h"
#include "scoring/walls/specks.h"

namespace rubble::scoring {
namespace {

using mrpt::math::TPoint2D;
using mrpt::math::TPose2D;

constexpr std::ptrdiff_t kMostWalls = 8000000;  // cells: a wall of 10 cm in cells of 1 cm is 8 km long
constexpr double kTooWide = 10.0;               // walls so many times as wide as the truth's belong to something else
constexpr WallMatch::Stiffness kSoft = {0.0, 0.0005, 0.0005, 0.001};

/// Of the fits that belong to the best pose, the one with most walls within a metre and least contradicted: a bent map
/// has a pose for each of its parts, and this is the one for the whole.
TPose2D fit_to_the_whole(const Hypothesis& best, const std::vector<Hypothesis>& hypotheses, const WallMatch& match) {
  const WallMatch::Kernel metre = match.kernel(1.0);
  TPose2D pick = best.T_best;
  double most = whole_agreement(match.evidence(match.rigid(pick), metre));
  for (const Hypothesis& h : hypotheses) {
    if (!same_pose(h.T_best, best.T_best, match.map_centre(), 2.5, 0.15)) continue;
    const double agreement = whole_agreement(match.evidence(match.rigid(h.T_wide), metre));
    if (agreement <= most) continue;
    most = agreement;
    pick = h.T_wide;
  }
  // A soft bend shows where each part of the map belongs; its nearest rigid transform errs differently from the pick,
  // and their mean less than either.
  Warp bent = match.rigid(best.T_wide);
  for (const double sigma : {1.5, 1.0, 0.5, 0.3}) bent = match.refine(bent, sigma, kSoft, 6);
  return match.halfway(pick, match.nearest_rigid(bent, 0.4));
}

/// The pose of a map that says where it started is off by less than this at the start [m, rad].
constexpr double kStartShift = 0.8;
constexpr double kStartTurn = 0.2;
// At the start pose the maps agree about as well as at their best one, and well.
constexpr double kTieTimes = 1.2;    // tight agreement
constexpr double kStartKappa = 0.8;  // of either map's walls: on one lattice strangers reach 0.7

// Lines of sight are another witness than walls that meet: what is open and what is blocked, not where ink lies. Alone
// they are none to be trusted: maps of other buildings were right about 0.85 of a seventh of the lines.
constexpr double kSightKnown = 0.08;  // of each map's lines that the other knows, at least
constexpr double kSightKappa = 0.75;  // of those, how right it is
// Where walls meet to the decimetre, other arenas reach 0.31 but for fragments. Mirror images reach 0.95: of them lines
// tell nothing.
constexpr double kSightKappaTight = 0.6;

/// What one map says of the other's lines of sight; none where these are too few.
std::optional<SightAgreement> sights_of(const OccupancyGrid& asked, const OccupancyGrid& other,
                                        const TPose2D& T_other_asked) {
  const SightLines lines(other, SightLines::Credit::Whole);
  if (!lines.usable()) return std::nullopt;
  return lines.at(asked, PlanarTransform(T_other_asked));
}

/// Each map is right about the other's lines of sight.
bool see_the_same(const OccupancyGrid& map, const OccupancyGrid& truth, const TPose2D& T_truth_map,
                  double least_kappa) {
  const auto is_right = [=](const std::optional<SightAgreement>& sights) {
    return sights && sights->known >= kSightKnown && sights->kappa >= least_kappa;
  };
  return is_right(sights_of(map, truth, T_truth_map)) && is_right(sights_of(truth, map, TPose2D() - T_truth_map));
}

/// The map is right about the truth's lines of sight more often than a guess. A truth without such lines has no say.
bool is_borne_out(const OccupancyGrid& map, const OccupancyGrid& truth, const TPose2D& T_truth_map) {
  const std::optional<SightAgreement> sights = sights_of(map, truth, T_truth_map);
  return !sights || (sights->known >= kSightKnown && sights->kappa > 0.0);
}

/// Who is asked by walls may also find what nobody else proposes: the search examines walls in any case.
bool may_win(const Hypothesis& h, AlignBy by) {
  if (includes(by, AlignBy::Walls) || includes(by, AlignBy::Equation7)) return true;
  const auto proposed = [&](AlignBy method) { return includes(by, method) && includes(h.by, method); };
  return proposed(AlignBy::Features) || proposed(AlignBy::Rooms);
}

/// Two maps to be aligned, with what several methods share.
class Aligner {
 public:
  Aligner(const OccupancyGrid& map, const OccupancyGrid& truth, const AlignmentConfig& config)
      : map_(map),
        truth_(truth),
        config_(config),
        match_(map, truth, config.search.reach, config.search.max_points),
        examiner_(match_, config.search) {}

  bool usable() const { return match_.usable(); }
  /// How many times as wide as the truth's walls the map's are.
  double times_as_wide() const { return match_.map_extent() / match_.truth_extent(); }

  /// `method` is a union of methods, not Auto.
  Alignment by(AlignBy method) {
    Alignment out;
    out.contest.tried = method;
    // It takes as long as the map itself: on another processor, where there is one.
    if (!mirrored_ && !mirrored_beside_.valid()) mirrored_beside_ = std::async([this] { return examine_mirrored(); });
    const std::vector<Hypothesis> hypotheses = examiner_.examine(proposals(method));
    const auto best =
        std::find_if(hypotheses.begin(), hypotheses.end(), [&](const Hypothesis& h) { return may_win(h, method); });
    if (best == hypotheses.end()) {
      out.note = "not aligned: no pose was proposed" + about_rooms();
      return out;
    }
    if (includes(method, AlignBy::Equation7)) return by_equation_7(hypotheses, out);
    const Trust trust = conclude(*best, hypotheses, out);
    out.T_walls = match_.refine(best->T_best, 0.1, 20);
    out.T_walls.phi = wrap_angle(out.T_walls.phi);
    out.T_truth_map = trust.tight ? out.T_walls : fit_to_the_whole(*best, hypotheses, match_);
    out.T_truth_map.phi = wrap_angle(out.T_truth_map.phi);
    ask_others(trust, *best, hypotheses, out);
    return out;
  }

  /// The pose at the known start, if the maps agree there about as well as at their best pose; nothing else is.
  std::optional<Alignment> by_start(const Alignment& best) {
    std::vector<PoseGuess> guesses = by_walls_ ? *by_walls_ : std::vector<PoseGuess>();
    guesses.insert(guesses.begin(), {config_.start->T_truth_map, 0.0, AlignBy::Start});
    const std::vector<Hypothesis> hypotheses = examiner_.examine(guesses);
    const auto at_start = std::find_if(hypotheses.begin(), hypotheses.end(), [&](const Hypothesis& h) {
      return same_pose(h.T_best, config_.start->T_truth_map, config_.start->p_map, kStartShift, kStartTurn);
    });
    if (at_start == hypotheses.end()) return std::nullopt;
    // Any arena lies about as well at several poses of a truth on the same lattice; only where nearly all walls meet do
    // rivals mean that the arena is symmetric.
    if (std::min(at_start->tight.map.kappa(), at_start->tight.truth.kappa()) < kStartKappa) return std::nullopt;
    if (kTieTimes * tight_agreement(at_start->tight) < best.contest.agreement) return std::nullopt;
    Alignment out;
    out.contest.tried = best.contest.tried | AlignBy::Start;
    const bool mirrored = (describe(*at_start, hypotheses, out), is_mirror_image(at_start->tight));
    const Trust trust = judge(at_start->wide, at_start->tight, Rivals{});
    if (mirrored || !trust.trusted) return std::nullopt;
    out.aligned = true;
    out.by = out.by | AlignBy::Start;
    out.note = "another pose fits about as well; the start pose decided";
    out.T_walls = match_.refine(at_start->T_best, 0.1, 20);
    out.T_walls.phi = wrap_angle(out.T_walls.phi);
    out.T_truth_map = out.T_walls;
    return out;
  }

 private:
  Trust conclude(const Hypothesis& best, const std::vector<Hypothesis>& hypotheses, Alignment& out) {
    const Contenders rivals = describe(best, hypotheses, out);
    const Trust trust = judge(best.wide, best.tight, rivals.all());
    out.aligned = trust.trusted && !is_mirror_image(best.tight);
    out.note = trust.note;
    if (out.aligned) return trust;
    out.aside = about_rooms();
    if (is_mirror_image(best.tight)) {
      out.note = "not aligned: the map is a mirror image of the truth; flip it and score it again";
    } else if (trust.rivalled) {
      out.near = {!judge(best.wide, best.tight, rivals.own).trusted,
                  !judge(best.wide, best.tight, rivals.mirrored).trusted};
      if (!out.near.any()) out.near = {true, true};  // neither alone
      out.note = why_rivalled(out.near, std::nullopt);
    }
    out.note += out.aside;
    return trust;
  }

  /// Other witnesses, at the pose of `out`: where the walls leave open whether it is right, lines of sight decide;
  /// where walls meet to the decimetre, also those walls that do so at this pose or at its rivals only. Where the walls
  /// are rather against it, lines of sight must not be against it too.
  void ask_others(const Trust& trust, const Hypothesis& best, const std::vector<Hypothesis>& hypotheses,
                  Alignment& out) const {
    const auto rivals = trust.open && trust.tight ? near_rivals(best, hypotheses) : std::vector<WallMatch::Placement>();
    if (trust.open && !is_mirror_image(best.tight) && wins_all(best, rivals, trust.fragment) &&
        see_the_same(map_, truth_, out.T_truth_map, trust.tight && !trust.fragment ? kSightKappaTight : kSightKappa)) {
      out.aligned = true;
      out.near = {};
      out.note = !trust.tight     ? "the walls meet loosely, and at another pose about as well"
                 : rivals.empty() ? "the maps have little in common"
                                  : "at another pose, or mirrored, walls meet about as well";
      out.note +=
          rivals.empty() ? "; what is open and what is blocked decided" : "; those in which the two differ decided";
    }
    if (out.aligned && !trust.tight && out.log_odds < 0.0 && !is_borne_out(map_, truth_, out.T_truth_map)) {
      out.aligned = false;
      out.note = "not aligned: what is open in one map is blocked in the other" + about_rooms();
    }
  }

  /// Section IV.F: every pose proposed is improved until eq. (7) falls no further, and the least error wins. Whether it
  /// can be trusted is judged as for any other.
  Alignment by_equation_7(const std::vector<Hypothesis>& hypotheses, Alignment& out) {
    const MapFeatures of_map = features_of(map_);
    const MapFeatures of_truth = features_of(truth_);
    const Hypothesis* best = nullptr;
    FeaturePose least;
    for (const Hypothesis& h : hypotheses) {
      const FeaturePose pose = minimise_feature_error(of_map, of_truth, h.T_best);
      if (best != nullptr && pose.error >= least.error) continue;
      best = &h;
      least = pose;
    }
    Hypothesis there = *best;
    there.T_wide = there.T_best = least.T_truth_map;
    there.wide = match_.evidence(match_.rigid(there.T_best), match_.kernel(config_.search.tau_wide));
    there.tight = match_.evidence(match_.rigid(there.T_best), match_.kernel(config_.search.tau_tight));
    const Trust trust = conclude(there, hypotheses, out);
    out.by = out.by | AlignBy::Equation7;
    out.T_truth_map = least.T_truth_map;
    out.T_truth_map.phi = wrap_angle(out.T_truth_map.phi);
    ask_others(trust, there, hypotheses, out);
    out.T_walls = out.T_truth_map;
    return out;
  }

  /// What the walls propose always takes part, as rivals of what others propose.
  std::vector<PoseGuess> proposals(AlignBy method) {
    if (!by_walls_) by_walls_ = correlate(map_, truth_, config_.correlation);
    std::vector<PoseGuess> out = *by_walls_;
    const auto add = [&](const std::vector<PoseGuess>& more) { out.insert(out.end(), more.begin(), more.end()); };
    const bool all = includes(method, AlignBy::Equation7);
    if (all || includes(method, AlignBy::Features)) {
      if (!by_features_) by_features_ = propose_by_features(map_, truth_, config_.feature_kind);
      add(*by_features_);
    }
    if (!all && !includes(method, AlignBy::Rooms)) return out;
    if (config_.rooms) {
      add(config_.rooms(map_, truth_));
    } else {
      const RoomGuesses by_rooms = propose_by_rooms(map_, truth_);
      add(by_rooms.guesses);
      rooms_note_ = by_rooms.note;
    }
    return out;
  }

  /// Clearly another pose.
  bool is_rival(const Hypothesis& h, const Hypothesis& best) const {
    const double shift = std::max(config_.search.distinct_shift, config_.search.distinct_share * match_.map_extent());
    return !same_pose(h.T_best, best.T_best, match_.map_centre(), shift, config_.search.distinct_turn);
  }

  /// The poses that come near the best, and those of the mirrored map that do.
  std::vector<WallMatch::Placement> near_rivals(const Hypothesis& best,
                                                const std::vector<Hypothesis>& hypotheses) const {
    std::vector<WallMatch::Placement> rivals;
    for (const Hypothesis& h : hypotheses)
      if (is_rival(h, best) && is_near(best.tight, h.tight)) rivals.push_back({h.T_best, false});
    for (const Hypothesis& h : mirrored_->hypotheses)
      if (is_near(best.tight, h.tight)) rivals.push_back({h.T_best, true});
    return rivals;
  }

  /// Each of them loses to the best where the two differ. Of a fragment too few walls differ to look more sharply.
  bool wins_all(const Hypothesis& best, const std::vector<WallMatch::Placement>& rivals, bool fragment) const {
    const std::vector<WallDuel> duels = match_.duels({best.T_best}, rivals, config_.search.tau_tight);
    if (std::all_of(duels.begin(), duels.end(), is_won)) return true;
    if (fragment) return false;
    const std::vector<WallDuel> sharp = match_.duels({best.T_best}, rivals, kSharp);
    for (std::size_t i = 0; i < rivals.size(); ++i)
      if (!is_won(duels[i]) && !is_won_sharply(sharp[i])) return false;
    return true;
  }

  std::string about_rooms() const { return rooms_note_.empty() ? "" : "; " + rooms_note_; }

  /// A mirror image that fits to the decimetre, and clearly better than the map itself, is named as what it is. A
  /// building that is nearly its own mirror image fits both ways: there what is left unexplained decides.
  bool is_mirror_image(const PoseEvidence& tight) const {
    constexpr double kAhead = 1.2;
    constexpr double kLeft = 0.5;
    const double own = tight_agreement(tight);
    const double most = tight.map.known + tight.truth.known;
    constexpr double kMore = 0.02;  // a symmetric arena is its own mirror image
    if (!mirrored_) return false;
    const double its = mirrored_->rivals.tight;
    return its >= std::max(kTightEnough, own + kMore) && (its >= kAhead * own || most - its <= kLeft * (most - own));
  }

  /// Who the best pose has to be ahead of.
  struct Contenders {
    Rivals own;
    Rivals mirrored;
    Rivals all() const {
      Rivals out = own;
      out.join(mirrored);
      return out;
    }
  };

  /// Fills in the contest and returns the rivals.
  Contenders describe(const Hypothesis& best, const std::vector<Hypothesis>& hypotheses, Alignment& out) {
    out.by = best.by;
    out.wide_evidence = best.wide;
    out.tight_evidence = best.tight;
    out.log_odds = log_odds(best.wide, best.tight);
    Rivals others;
    double highest = -1.0;
    for (const Hypothesis& h : hypotheses) {
      if (!is_rival(h, best)) continue;
      others.meet(h.wide, h.tight);
      if (h.quality <= highest) continue;
      highest = h.quality;
      out.contest.T_runner_up = h.T_best;
      out.contest.runner_up_by = h.by;
    }
    out.runner_up = relative(others, best.tight, out.log_odds);
    out.contest.agreement = tight_agreement(best.tight);
    out.contest.by_agreement = out.contest.agreement >= kTightEnough;
    out.contest.margin =
        out.contest.by_agreement ? out.contest.agreement - others.tight : out.log_odds - others.log_odds;
    const Rivals& mirrored = of_mirrored();
    out.mirrored = relative(mirrored, best.tight, out.log_odds);
    return {others, mirrored};
  }

  /// How near the rivals come to the best, by the measure that `judge` uses.
  static double relative(const Rivals& rivals, const PoseEvidence& tight, double odds) {
    const double agreement = tight_agreement(tight);
    if (agreement >= kTightEnough) return std::clamp(rivals.tight / agreement, 0.0, 1.0);
    return std::min(1.0, std::exp(rivals.log_odds - odds));
  }

  /// A mirror image is as like the truth as the map itself in all but what counts: its best pose, which is wrong, shows
  /// how far chance gets with these two maps.
  const Rivals& of_mirrored() {
    if (!mirrored_) mirrored_ = mirrored_beside_.get();
    return mirrored_->rivals;
  }

  struct Mirrored {
    std::vector<Hypothesis> hypotheses;
    Rivals rivals;
  };
  Mirrored examine_mirrored() const {
    Mirrored out;
    const OccupancyGrid mirrored = mirror_image(map_);
    const WallMatch match(mirrored, truth_, config_.search.reach, config_.search.max_points);
    out.hypotheses = examine(correlate(mirrored, truth_, config_.correlation), match, config_.search);
    for (const Hypothesis& h : out.hypotheses) out.rivals.meet(h.wide, h.tight);
    return out;
  }

  const OccupancyGrid& map_;
  const OccupancyGrid& truth_;
  const AlignmentConfig& config_;
  WallMatch match_;
  Examiner examiner_;
  std::optional<std::vector<PoseGuess>> by_walls_;
  std::optional<std::vector<PoseGuess>> by_features_;
  std::optional<Mirrored> mirrored_;
  std::string rooms_note_;
  std::future<Mirrored> mirrored_beside_;  ///< last: it ends before what it reads does
};

/// Where the maps say that it started elsewhere than was given: who gives it may count from another axis.
std::string start_is_off(const Alignment& best, const KnownStart& start) {
  if (best.by == AlignBy::Auto || same_pose(best.T_truth_map, start.T_truth_map, start.p_map, kStartShift, kStartTurn))
    return {};
  const TPoint2D apart = best.T_truth_map.composePoint(start.p_map) - start.T_truth_map.composePoint(start.p_map);
  char text[200];
  std::snprintf(
      text, sizeof text,
      "the start pose does not fit: at the pose found the map begins %.1f m from there, turned by %.0f deg; one "
      "of the two is wrong (for a picture without a pose of its own, up is the robot's heading)",
      std::hypot(apart.x, apart.y), rad_to_deg(wrap_angle(best.T_truth_map.phi - start.T_truth_map.phi)));
  return text;
}

}  // namespace

std::string too_many_walls(const OccupancyGrid& map, const OccupancyGrid& truth) {
  for (const OccupancyGrid* grid : {&map, &truth}) {
    const auto walls = std::count(grid->cells().begin(), grid->cells().end(), Occupancy::Occupied);
    if (walls <= kMostWalls) continue;
    return "not aligned: " + std::to_string(walls) + " cells of the " + (grid == &map ? "map" : "truth") +
           " are walls, more than any building has; give a picture with thin walls, or scale it down";
  }
  return {};
}

Alignment align(const OccupancyGrid& map, const OccupancyGrid& truth, const AlignmentConfig& config) {
  if (std::string refusal = too_many_walls(map, truth); !refusal.empty()) {
    Alignment out;
    out.note = std::move(refusal);
    return out;
  }
  const OccupancyGrid clean_map = without_specks(map);
  const OccupancyGrid clean_truth = without_specks(truth);
  Aligner aligner(clean_map, clean_truth, config);
  if (!aligner.usable()) {
    Alignment out;
    out.note = "not aligned: one of the maps has too few walls to fix a pose";
    return out;
  }
  if (const double times = aligner.times_as_wide(); times > kTooWide) {
    char text[160];
    std::snprintf(
        text, sizeof text,
        "not aligned: the map is %.0f times as wide as the truth; check its resolution, or cut it to the arena", times);
    Alignment out;
    out.note = text;
    return out;
  }
  if (config.by != AlignBy::Auto && !config.start) return aligner.by(config.by);
  Alignment best = aligner.by(config.by == AlignBy::Auto ? AlignBy::Walls : config.by);
  const AlignBy with_features = AlignBy::Walls | AlignBy::Features;
  for (const AlignBy method : {with_features, with_features | AlignBy::Rooms}) {
    // Walls that agree to the decimetre at several poses leave a doubt that no other proposal resolves.
    if (config.by != AlignBy::Auto || best.aligned || best.contest.by_agreement) break;
    const Alignment more = aligner.by(method);
    if (more.aligned || more.log_odds > best.log_odds) best = more;
    best.contest.tried = method;
  }
  if (!best.aligned && config.start)
    if (const std::optional<Alignment> at_start = aligner.by_start(best)) return *at_start;
  if (best.aligned && config.start)
    if (const std::string off = start_is_off(best, *config.start); !off.empty())
      best.note += (best.note.empty() ? "" : "; ") + off;
  return best;
}

}  // namespace rubble::scoring
