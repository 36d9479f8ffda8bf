#include "scoring/alignment/trust.h"

#include <algorithm>
#include <cmath>

namespace rubble::scoring {
namespace {

// Where the maps agree to the decimetre.
constexpr double kAhead = 1.2;            // times the tight agreement of the best rival: trusted
constexpr double kUnexplained = 1.65;     // or the rival leaves so many times as much wall unexplained
constexpr double kSideUnexplained = 2.6;  // or so many times as much of the walls of one map, ...
constexpr double kSideKnown = 0.8;        // ... if nearly all of both maps' walls lie in the other
constexpr double kLeastEach = 0.25;       // kappa that the walls of either map must reach
constexpr double kFloor = 0.02;           // of what is left unexplained: less says nothing
// A fragment fits somewhere by chance: less than this of one map's walls and this much floor are common. There walls
// must meet better and rivals leave more unexplained.
constexpr double kFragmentKnown = 0.35;
constexpr double kFragmentArea = 20.0;       // [m^2]
constexpr double kFragmentLeastArea = 10.0;  // less of it tells nothing [m^2]
constexpr double kFragmentKappa = 0.8;
constexpr double kFragmentUnexplained = 2.0;
constexpr double kFragmentTelling = 16.0;   // floor of one that other witnesses may be asked about [m^2]
constexpr double kFragmentBestKappa = 0.9;  // of the better side: gaps cost the other one
// Of the walls that meet at one of two poses only.
constexpr double kTimesTheirs = 2.0;
constexpr double kDeviations = 2.0;         // from even odds, ...
constexpr double kSharpTimesTheirs = 1.75;  // where walls must meet within kSharp
constexpr double kSharpDeviations = 1.65;   // luck does so once in twenty times
constexpr double kPiece = 0.6;              // ... pieces of wall so long are right or wrong together: half a pallet [m]
// Where they agree only loosely.
constexpr double kLeastLogOdds = -1.2;
constexpr double kLeastMargin = 0.4;  // of the log odds over those of the best rival
constexpr double kMostMargin = 3.0;   // more of it tells no more
constexpr double kLeastSum = 1.6;     // of the log odds and twice the margin
constexpr double kLeastKappa = 0.3;   // below, walls meet no more often than chance would have it
// Other arenas at their best pose are right about lines of sight by less than this beyond luck.
constexpr double kAgreesWell = 0.25;
constexpr const char* kStartIf = " (--start where the map counts from the robot's start)";
constexpr const char* kNowhere = "; probably another arena, or too little of this one, or too damaged";

double net(const WallEvidence& e, double chance, double contradiction) {
  return e.known * (e.met - chance - contradiction * e.contradicted);
}

double known_share(const PoseEvidence& e) { return e.map.known + e.truth.known; }
double agreement(const WallEvidence& e) { return e.known * e.kappa(); }

/// How many times as much of `all` a rival leaves unexplained as the best does.
double unexplained(double all, double best, double rival) { return (all - rival) / std::max(all - best, kFloor); }

bool side_ahead(const WallEvidence& best, double rival) {
  return unexplained(best.known, agreement(best), rival) >= kSideUnexplained;
}

bool is_fragment(const PoseEvidence& e) {
  return std::min(e.map.known, e.truth.known) < kFragmentKnown && e.common_area < kFragmentArea;
}

double least_kappa(const PoseEvidence& e) { return std::min(e.map.kappa(), e.truth.kappa()); }

/// A fragment that is large enough to fit nowhere else, where nearly all walls of one side meet.
bool is_telling(const PoseEvidence& e) {
  return e.common_area >= kFragmentTelling && std::max(e.map.kappa(), e.truth.kappa()) >= kFragmentBestKappa;
}

/// One agreement is enough ahead of another; `ratio`: of what the two leave unexplained.
bool is_ahead(double best, double rival, double ratio) { return best >= kAhead * rival || ratio >= kUnexplained; }

bool is_ahead_by(const WallDuel& duel, double times, double deviations) {
  return duel.ours > 0.0 && duel.ours >= times * duel.theirs &&
         duel.ours - duel.theirs >= deviations * std::sqrt(kPiece * (duel.ours + duel.theirs));
}

/// No rival comes near the best.
bool ahead_of(const PoseEvidence& tight, const Rivals& rivals) {
  const double best = tight_agreement(tight);
  const double ratio = unexplained(known_share(tight), best, rivals.tight);
  const bool ahead = is_ahead(best, rivals.tight, ratio);
  if (is_fragment(tight))
    return ahead && ratio >= kFragmentUnexplained && least_kappa(tight) >= kFragmentKappa &&
           tight.common_area >= kFragmentLeastArea;
  return ahead || (std::min(tight.map.known, tight.truth.known) >= kSideKnown &&
                   (side_ahead(tight.map, rivals.map_tight) || side_ahead(tight.truth, rivals.truth_tight)));
}

void refuse_for_rivals(Trust& out) {
  out.rivalled = true;
  out.note = why_rivalled({true, true}, std::nullopt);
}

Trust judge_tight(const PoseEvidence& tight, const Rivals& rivals) {
  Trust out;
  out.tight = true;
  const bool ahead = ahead_of(tight, rivals);
  const bool mutual = least_kappa(tight) >= kLeastEach;
  out.trusted = ahead && mutual;
  out.fragment = is_fragment(tight);
  out.open = !ahead && mutual && (!out.fragment || is_telling(tight));
  if (!mutual)
    out.note = "not aligned: walls of one map are missing in the other";
  else if (!ahead && is_fragment(tight))
    out.note = "not aligned: the maps have too little in common; such a fragment fits at some place by chance";
  else if (!ahead)
    refuse_for_rivals(out);
  return out;
}

}  // namespace

double wide_agreement(const PoseEvidence& wide) { return net(wide.map, 0.4, 0.25) + net(wide.truth, 0.4, 0.25); }

double tight_agreement(const PoseEvidence& tight) { return agreement(tight.map) + agreement(tight.truth); }

double whole_agreement(const PoseEvidence& metre) { return net(metre.map, 0.3, 1.0) + net(metre.truth, 0.3, 1.0); }

double log_odds(const PoseEvidence& wide, const PoseEvidence& tight) {
  const auto both = [](const PoseEvidence& e, double WallEvidence::*share) {
    return e.map.known * e.map.*share + e.truth.known * e.truth.*share;
  };
  return -5.1 - 31.0 * both(wide, &WallEvidence::contradicted) - 3.9 * both(wide, &WallEvidence::met) -
         25.8 * both(wide, &WallEvidence::chance) + 4.3 * both(tight, &WallEvidence::contradicted) +
         14.75 * wide.free_common + 15.7 * std::min(wide.map.known, wide.truth.known);
}

bool is_near(const PoseEvidence& tight, const PoseEvidence& rival_tight) {
  const double best = tight_agreement(tight);
  const double rival = tight_agreement(rival_tight);
  const double ratio = unexplained(known_share(tight), best, rival);
  return !is_ahead(best, rival, ratio) || (is_fragment(tight) && ratio < kFragmentUnexplained);
}

bool is_won(const WallDuel& duel) { return is_ahead_by(duel, kTimesTheirs, kDeviations); }

bool is_won_sharply(const WallDuel& duel) { return is_ahead_by(duel, kSharpTimesTheirs, kSharpDeviations); }

std::string why_rivalled(const NearRivals& rivals, const std::optional<double>& beyond_luck) {
  std::string out = "not aligned: ";
  if (!beyond_luck) {
    if (!rivals.mirrored) return out + "another pose fits about as well";
    return out + (rivals.another_pose ? "another pose, or a mirror image, fits about as well"
                                      : "mirrored, the map fits about as well");
  }
  if (*beyond_luck < kAgreesWell) {
    out += std::string("agrees nowhere with the truth, even at its best pose little better than a guess") + kNowhere;
    return out + (rivals.mirrored ? ", or a flipped picture" : "");
  }
  const std::string how =
      std::string(", for the arena repeats itself: --start or --pose says where it lies") + kStartIf;
  if (!rivals.mirrored) return out + "agrees well at several poses" + how;
  if (rivals.another_pose) return out + "agrees well at several poses, and as well mirrored" + how;
  return out + "agrees well, and as well mirrored, for the arena is nearly its own mirror image or the map came " +
         "apart: --start or --pose says where it lies" + kStartIf + ", if the picture is not flipped";
}

void Rivals::meet(const PoseEvidence& wide, const PoseEvidence& tight_evidence) {
  log_odds = std::max(log_odds, scoring::log_odds(wide, tight_evidence));
  tight = std::max(tight, tight_agreement(tight_evidence));
  map_tight = std::max(map_tight, agreement(tight_evidence.map));
  truth_tight = std::max(truth_tight, agreement(tight_evidence.truth));
}

void Rivals::join(const Rivals& others) {
  log_odds = std::max(log_odds, others.log_odds);
  tight = std::max(tight, others.tight);
  map_tight = std::max(map_tight, others.map_tight);
  truth_tight = std::max(truth_tight, others.truth_tight);
}

Trust judge(const PoseEvidence& wide, const PoseEvidence& tight, const Rivals& rivals) {
  if (tight_agreement(tight) >= kTightEnough) return judge_tight(tight, rivals);
  Trust out;
  const double odds = log_odds(wide, tight);
  const double margin = odds - rivals.log_odds;
  if (std::max(tight.map.kappa(), tight.truth.kappa()) < kLeastKappa)
    out.note =
        std::string("not aligned: at no pose do the walls of both maps meet more often than by chance") + kNowhere;
  else if (odds < kLeastLogOdds)
    out.note = std::string("not aligned: the walls of one map run through the free space of the other") + kNowhere;
  else if (margin < kLeastMargin || odds + 2.0 * std::min(margin, kMostMargin) < kLeastSum) {
    refuse_for_rivals(out);
    out.open = margin > 0.0 && odds > 0.0;
  } else {
    out.trusted = true;
    out.note = "the walls meet loosely, to the metre; no other pose comes near";
  }
  return out;
}

}  // namespace rubble::scoring
