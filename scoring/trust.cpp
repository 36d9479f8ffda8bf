#include "scoring/trust.h"

#include <algorithm>

namespace rubble::scoring {
namespace {

// Where the maps agree to the decimetre.
constexpr double kAhead = 1.2;             // times the tight agreement of the best rival: trusted
constexpr double kUnexplained = 1.65;      // or the rival leaves so many times as much wall unexplained
constexpr double kLeastEach = 0.25;        // kappa that the walls of either map must reach
constexpr double kFloor = 0.02;            // of what is left unexplained: less says nothing
constexpr double kClearKappa = 0.8;        // of both maps' walls, ...
constexpr double kClearKnown = 0.8;        // ... which must nearly all lie in the other map, ...
constexpr double kClearUnexplained = 3.5;  // ... and every other pose must leave so many times as much unexplained
// Where they agree only loosely.
constexpr double kLeastLogOdds = -1.2;
constexpr double kLeastMargin = 0.4;  // of the log odds over those of the best rival
constexpr double kMostMargin = 3.0;   // more of it tells no more
constexpr double kLeastSum = 1.6;     // of the log odds and twice the margin
constexpr double kLeastKappa = 0.3;   // below, walls meet no more often than chance would have it

double net(const WallEvidence& e, double chance, double contradiction) {
  return e.known * (e.met - chance - contradiction * e.contradicted);
}

double known_share(const PoseEvidence& e) { return e.map.known + e.truth.known; }

Trust judge_tight(const PoseEvidence& tight, const Rivals& rivals) {
  Trust out;
  out.tight = true;
  const double best = tight_agreement(tight);
  const double all = known_share(tight);
  const double left = std::max(all - best, kFloor);
  const bool ahead = best >= kAhead * rivals.tight || all - rivals.tight >= kUnexplained * left;
  const bool mutual = std::min(tight.map.kappa(), tight.truth.kappa()) >= kLeastEach;
  out.trusted = ahead && mutual;
  if (!mutual)
    out.note = "not aligned: walls of one map are missing in the other";
  else if (!ahead)
    out.note = "not aligned: another pose, or a mirror image, fits about as well";
  return out;
}

}  // namespace

double wide_agreement(const PoseEvidence& wide) { return net(wide.map, 0.4, 0.25) + net(wide.truth, 0.4, 0.25); }

double tight_agreement(const PoseEvidence& tight) {
  return tight.map.known * tight.map.kappa() + tight.truth.known * tight.truth.kappa();
}

double whole_agreement(const PoseEvidence& metre) { return net(metre.map, 0.3, 1.0) + net(metre.truth, 0.3, 1.0); }

double log_odds(const PoseEvidence& wide, const PoseEvidence& tight) {
  const auto both = [](const PoseEvidence& e, double WallEvidence::*share) {
    return e.map.known * e.map.*share + e.truth.known * e.truth.*share;
  };
  return -5.1 - 31.0 * both(wide, &WallEvidence::contradicted) - 3.9 * both(wide, &WallEvidence::met) -
         25.8 * both(wide, &WallEvidence::chance) + 4.3 * both(tight, &WallEvidence::contradicted) +
         14.75 * wide.free_common + 15.7 * std::min(wide.map.known, wide.truth.known);
}

void Rivals::meet(const PoseEvidence& wide, const PoseEvidence& tight_evidence) {
  log_odds = std::max(log_odds, scoring::log_odds(wide, tight_evidence));
  tight = std::max(tight, tight_agreement(tight_evidence));
}

bool beyond_doubt(const PoseEvidence& tight, const Rivals& other_poses) {
  const double all = known_share(tight);
  const double left = std::max(all - tight_agreement(tight), kFloor);
  return std::min(tight.map.kappa(), tight.truth.kappa()) >= kClearKappa &&
         std::min(tight.map.known, tight.truth.known) >= kClearKnown &&
         all - other_poses.tight >= kClearUnexplained * left;
}

Trust judge(const PoseEvidence& wide, const PoseEvidence& tight, const Rivals& rivals) {
  if (tight_agreement(tight) >= kTightEnough) return judge_tight(tight, rivals);
  Trust out;
  const double odds = log_odds(wide, tight);
  const double margin = odds - rivals.log_odds;
  if (std::max(tight.map.kappa(), tight.truth.kappa()) < kLeastKappa)
    out.note = "not aligned: at no pose do the walls of both maps meet more often than by chance";
  else if (odds < kLeastLogOdds)
    out.note = "not aligned: the walls of one map run through the free space of the other";
  else if (margin < kLeastMargin || odds + 2.0 * std::min(margin, kMostMargin) < kLeastSum)
    out.note = "not aligned: another pose, or a mirror image, fits about as well";
  else
    out.trusted = true;
  return out;
}

}  // namespace rubble::scoring
