#include "explore/paper/rounds.h"

#include <algorithm>

namespace rubble::explore {
namespace {

constexpr int kMaxPardons = 3;    ///< times that what failed is tried again before giving up
constexpr int kBarrenRounds = 2;  ///< rounds in a row that gain nothing are the last
constexpr int kForgets = 4;       ///< times that all that was felt is forgotten, but on the way home
constexpr int kHomeTries = 6;     ///< times that it is on the way home

}  // namespace

Resort Rounds::next_resort(bool homeward, bool may_push, LeftAlone& left_alone, Stamp now, bool worth) {
  if (looks_in_vain_ == 0 || (failed_plans_ < 2 && looks_in_vain_ < 2)) {
    ++looks_in_vain_;
    return Resort::LookAround;
  }
  if (!worth) return Resort::GiveUp;
  if (pardons_ < kMaxPardons && left_alone.pardon(now)) {
    ++pardons_;
    return Resort::TryAgain;
  }
  if (may_push) return Resort::Push;
  if (!homeward || home_tries_ >= kHomeTries || !left_alone.forget(now)) return Resort::GiveUp;
  ++home_tries_;
  return Resort::ForgetAll;
}

std::optional<std::string> Rounds::before_all_faces(const Standing& standing, bool more, FloorSearch& search,
                                                    LeftAlone& left_alone) {
  if (!tried_before_search_ && standing.frontier_left() > 0 && (left_alone.pardon_all(standing.now) || more)) {
    tried_before_search_ = true;
    begin();
    return "no niche is left: what could not be reached is tried again before the rest is searched";
  }
  if (forgets_ == 0) return forget_what_was_felt(For::Frontiers, standing, search, left_alone);
  return std::nullopt;
}

std::optional<std::string> Rounds::another(const Standing& standing, FloorSearch& search, LeftAlone& left_alone) {
  const bool barren = !known_then_.grown(standing.floor) && standing.victims <= victims_then_;
  barren_rounds_ = barren ? barren_rounds_ + 1 : 0;
  known_then_.mark(standing.floor);
  victims_then_ = standing.victims;
  // What was felt may bar the way to them: then a round that forgives all else would be in vain.
  if (search.faces_left())
    if (auto news = forget_what_was_felt(For::Faces, standing, search, left_alone)) return news;
  if (barren_rounds_ >= kBarrenRounds) return forget_what_was_felt(For::Frontiers, standing, search, left_alone);
  const bool given_up = search.reconsider(standing.floor);
  const bool failed = left_alone.pardon_all(standing.now);
  if (!given_up && !failed) return forget_what_was_felt(For::Frontiers, standing, search, left_alone);
  tried_before_search_ = false;
  begin();
  return "round " + std::to_string(++rounds_) + ": what could not be reached or seen is tried again";
}

/// What was felt may bar the only way to half of the arena, and be wrong: where there is ground to be seen behind it,
/// or faces are left, even what was felt for certain is tried anew, and what could not be reached or seen with it.
std::optional<std::string> Rounds::forget_what_was_felt(For what, const Standing& standing, FloorSearch& search,
                                                        LeftAlone& left_alone) {
  if (forgets_ >= kForgets || !left_alone.has_chances() || (what == For::Frontiers && standing.behind_felt() == 0) ||
      !left_alone.forget_once(standing.now))
    return std::nullopt;
  ++forgets_;
  barren_rounds_ = 0;
  search.reconsider(standing.floor);
  left_alone.pardon_all(standing.now);
  tried_before_search_ = false;
  begin();
  return "round " + std::to_string(++rounds_) + ": all that was felt is forgotten";
}

void Rounds::go_home() {
  pardons_ = std::min(pardons_, kMaxPardons - 1);
  looks_in_vain_ = 1;  // no looking round first
}

void Rounds::begin() {
  failed_plans_ = looks_in_vain_ = 0;
  pardons_ = std::min(pardons_, kMaxPardons - 1);
}

}  // namespace rubble::explore
