#include "scoring/trust.h"

#include <algorithm>

namespace rubble::scoring {
namespace {

constexpr double kTight = 0.8;          // tight agreement from which it is the measure of the pose
constexpr double kRivalTight = 0.85;    // share of it that another pose may reach
constexpr double kRivalFar = 0.7;       // the same for the wide agreement, where the tight one leaves a doubt
constexpr double kLeastEach = 0.25;     // kappa that the walls of either map must reach
constexpr double kPerfect = 0.93;       // kappa of one map's walls that needs no comparison with other poses ...
constexpr double kPerfectOther = 0.45;  // ... with this kappa for the walls of the other
constexpr double kPerfectShare = 0.2;   // ... and this share of the truth's walls found
constexpr double kRivalWide = 0.9;      // share of the wide agreement that another pose may reach
constexpr double kLeastKappa = 0.3;     // below, walls meet no more often than chance would have it
constexpr double kCovered = 0.95;       // share of one map's walls inside the other from which nothing ...
constexpr double kCoveredKappa = 0.5;   // ... excuses less agreement of them than this
constexpr double kLeastWide = 0.1;
constexpr double kLeastLogOdds = -0.9;

double net(const WallEvidence& e, double chance, double contradiction) {
  return e.known * (e.met - chance - contradiction * e.contradicted);
}

/// Log odds of a right pose where maps agree only loosely: logistic regression on right and wrong poses of public
/// sensor maps.
double log_odds(const PoseEvidence& wide, const PoseEvidence& tight, double runner_up) {
  const double kappa = std::max(tight.map.kappa(), tight.truth.kappa());
  const double contradicted = std::min(wide.map.contradicted, wide.truth.contradicted);
  return -5.9 + 6.0 * wide_agreement(wide) - 2.0 * runner_up + 4.8 * kappa - 22.3 * contradicted +
         8.7 * wide.free_common;
}

bool perfect(const PoseEvidence& tight) {
  const double map = tight.map.kappa();
  const double truth = tight.truth.kappa();
  return std::max(map, truth) >= kPerfect && std::min(map, truth) >= kPerfectOther &&
         tight.truth.known * truth >= kPerfectShare;
}

/// One map lies wholly inside the other, and yet its walls are not found there: wrong scale, or another place.
bool covered_but_not_met(const PoseEvidence& tight) {
  const WallEvidence& inner = tight.map.known > tight.truth.known ? tight.map : tight.truth;
  return inner.known >= kCovered && inner.kappa() < kCoveredKappa;
}

}  // namespace

double wide_agreement(const PoseEvidence& wide) { return net(wide.map, 0.4, 0.25) + net(wide.truth, 0.4, 0.25); }

double tight_agreement(const PoseEvidence& tight) {
  return tight.map.known * tight.map.kappa() + tight.truth.known * tight.truth.kappa();
}

double whole_agreement(const PoseEvidence& metre) { return net(metre.map, 0.3, 1.0) + net(metre.truth, 0.3, 1.0); }

Trust judge(const PoseEvidence& wide, const PoseEvidence& tight, const Rivals& rivals) {
  Trust out;
  const double best_tight = tight_agreement(tight);
  const double best_wide = wide_agreement(wide);
  if (best_tight >= kTight) {
    out.tight = true;
    out.runner_up = std::clamp(rivals.tight / best_tight, 0.0, 1.0);
    const bool unrivalled = out.runner_up <= kRivalTight || rivals.wide <= kRivalFar * best_wide;
    const bool mutual = std::min(tight.map.kappa(), tight.truth.kappa()) >= kLeastEach;
    out.trusted = (unrivalled && mutual) || perfect(tight);
    if (!out.trusted) out.note = "not aligned: another pose fits about as well, the map's structure is not the truth's";
    return out;
  }
  out.runner_up = best_wide > 0.0 ? std::clamp(rivals.wide / best_wide, 0.0, 1.0) : 1.0;
  const bool better_than_chance = std::max(tight.map.kappa(), tight.truth.kappa()) >= kLeastKappa;
  if (!better_than_chance || best_wide < kLeastWide) {
    out.note = "not aligned: at no pose do the walls of both maps meet more often than by chance";
  } else if (out.runner_up > kRivalWide) {
    out.note = "not aligned: another pose fits about as well";
  } else if (covered_but_not_met(tight) || log_odds(wide, tight, out.runner_up) < kLeastLogOdds) {
    out.note = "not aligned: the walls of one map run through the free space of the other";
  } else {
    out.trusted = true;
  }
  return out;
}

}  // namespace rubble::scoring
