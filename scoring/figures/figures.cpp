#include "scoring/figures/figures.h"

#include <algorithm>
#include <cstdio>
#include <functional>

#include "base/angle.h"

namespace rubble::scoring {
namespace {

using Getter = std::function<Value(const Evidence&)>;

// Where a row takes its figure from: a member of that part, or a function of it. Unknown where the part is missing.

template <class Read>
Getter of_score(Read read) {
  return [read](const Evidence& e) { return e.score ? Value(std::invoke(read, *e.score)) : Value(); };
}

/// Only where the map was placed: else nobody can say what of the truth it shows.
template <class Read>
Getter of_placed(Read read) {
  return
      [read](const Evidence& e) { return e.score && e.score->aligned ? Value(std::invoke(read, *e.score)) : Value(); };
}

template <class Read>
Getter of_warped(Read read) {
  return
      [read](const Evidence& e) { return e.score && e.score->warped ? Value(std::invoke(read, *e.score)) : Value(); };
}

/// Of one kind of feature, where the truth has enough of them.
Getter of_kind(EvidenceKind kind) {
  return [kind](const Evidence& e) {
    if (e.score)
      for (const KindScore& s : e.score->by_features.kinds)
        if (s.kind == kind && s.usable) return Value(s.score);
    return Value();
  };
}

template <class Read>
Getter of_error(Read read) {
  return [read](const Evidence& e) {
    return e.error && e.error->matched > 0 ? Value(std::invoke(read, *e.error)) : Value();
  };
}

template <class Read>
Getter of_live(Read read) {
  return [read](const Evidence& e) {
    return e.live_error && e.live_error->matched > 0 ? Value(std::invoke(read, *e.live_error)) : Value();
  };
}

template <class Read>
Getter of_victims(Read read) {
  return [read](const Evidence& e) { return e.victims ? Value(std::invoke(read, *e.victims)) : Value(); };
}

template <class Read>
Getter of_judged_victims(Read read) {
  return [read](const Evidence& e) {
    return e.victims && e.victims->judged ? Value(std::invoke(read, *e.victims)) : Value();
  };
}

template <class Read>
Getter of_run(Read read) {
  return [read](const Evidence& e) { return e.run ? Value(std::invoke(read, *e.run)) : Value(); };
}

template <class Read>
Getter of_mission(Read read) {
  return [read](const Evidence& e) { return e.mission ? Value(std::invoke(read, *e.mission)) : Value(); };
}

template <class Read>
Getter of_devices(Read read) {
  return [read](const Evidence& e) { return e.devices ? Value(std::invoke(read, *e.devices)) : Value(); };
}

/// `part`: which pieces; angles in degrees.
template <class Part, class Read>
Getter of_pieces(Part part, Read read) {
  return [part, read](const Evidence& e) { return e.pieces ? Value(std::invoke(read, (*e.pieces).*part)) : Value(); };
}

template <class Read>
Getter of_relations(Read read) {
  return [read](const Evidence& e) { return e.relations ? Value(std::invoke(read, *e.relations)) : Value(); };
}

/// An error of relations; of none there is no mean.
template <class Read>
Getter of_compared(Read read) {
  return [read](const Evidence& e) {
    return e.relations && e.relations->relations > 0 ? Value(std::invoke(read, *e.relations)) : Value();
  };
}

template <class Read>
Getter of_machine(Read read) {
  return [read](const Evidence& e) { return e.machine ? Value(std::invoke(read, *e.machine)) : Value(); };
}

Value victim_error(const Evidence& e) {
  return e.victims && e.victims->judged && e.victims->found > 0 ? Value(e.victims->error_m) : Value();
}

Value real_time_factor(const Evidence& e) {
  return e.run && e.machine && e.machine->wall_s > 0.0 ? Value(e.run->sim_s / e.machine->wall_s) : Value();
}

Value text_or_unknown(const std::string& text) { return text.empty() ? Value() : Value(text); }

constexpr Better kUp = Better::Higher, kDown = Better::Lower, kNone = Better::Neither;

std::vector<Figure> make_table() {
  using S = MapScore;
  using C = Contest;
  const auto contest = [](auto member) { return of_score([member](const S& s) { return s.contest.*member; }); };
  const auto wall = [](auto member) { return of_placed([member](const S& s) { return s.errors.*member; }); };
  const auto pose = [](auto member) { return of_score([member](const S& s) { return s.T_truth_map.*member; }); };
  const auto rival = [](auto member) {
    return of_score([member](const S& s) { return s.contest.T_runner_up.*member; });
  };
  const auto feature = [](auto member) { return of_warped([member](const S& s) { return s.features.*member; }); };
  using Pose = mrpt::math::TPose2D;
  const auto part = [](auto member) {
    return Getter([member](const Evidence& e) {
      return e.score && e.score->broken.found ? Value(std::invoke(member, e.score->broken)) : Value();
    });
  };
  const auto drive = [](auto member) {
    return of_mission([member](const MissionFigures& m) { return m.drive.*member; });
  };
  using D = DriveFigures;
  using P = PieceErrors;
  using R = RelationError;
  return {
      // key, label, unit, decimals, which way is better, floor of noise, where it goes, how to get it, what it means
      {"score", "score", "", 3, kUp, 0.01, kShown | kReport | kRanking | kLeague, of_score(&S::score),
       "1 the truth, 0 what a guess or another arena earns"},
      {"score_version", "version of the score", "", 0, kNone, 0.0, kLeague,
       of_score([](const S&) { return std::uint64_t{kScoreVersion}; })},
      {"score_at_best_pose", "score at the best pose", "", 3, kNone, 0.0, kLeague, of_score(&S::score_at_best_pose)},
      {"sight_known", "lines of sight known", "%", 3, kNone, 0.0, kShown, of_score(&S::sight_known),
       "of the lines asked about, each between two places, the map shows whether a wall is in between"},
      {"sight_kappa", "lines of sight right", "", 3, kNone, 0.0, kShown, of_score(&S::sight_kappa),
       "how often it is right about those: 1 always, 0 as chance; 0.25 (bare arenas: more) scores 0"},
      {"detached", "drawn apart from the arena", "%", 3, kNone, 0.0, kPlain, of_score(&S::detached)},
      {"overlap", "overlap of walls", "", 3, kUp, 0.01, kShown | kRanking | kLeague | kPlaced, of_score(&S::overlap),
       "the lesser of the next two"},
      {"precision", "precision", "", 3, kUp, 0.01, kShown | kRanking | kLeague | kPlaced, of_score(&S::precision),
       "of the map's walls lie on true ones (the further off the less, from 0.5 m on nothing)"},
      {"recall", "recall", "", 3, kUp, 0.01, kShown | kRanking | kLeague | kPlaced, of_score(&S::recall),
       "of the true walls are there in the map, measured the same way"},
      {"psi_m", "psi", "m", 3, kDown, 0.01, kShown | kReport | kRanking | kLeague | kPlaced, of_score(&S::psi_m),
       "how far a wall or free cell is from the next one of its kind in the other map, in the mean"},
      {"ate_first_m", "trajectory error, first pose", "m", 3, kDown, 0.02, kShown,
       of_error(&TrajectoryError::ate_first_m),
       "RMS of how far the places of the way are off, first poses laid on each other"},
      {"ate_aligned_m", "trajectory error, aligned", "m", 3, kDown, 0.02, kShown | kReport,
       of_error(&TrajectoryError::ate_aligned_m), "the same, the whole way laid on the true one as well as it fits"},
      {"ate_scaled_m", "trajectory error, aligned with scale", "m", 3, kDown, 0.02, kPlain,
       of_error(&TrajectoryError::ate_scaled_m), "the same, with the scale that fits best as well"},
      {"ate_scale", "size of the trajectory", "", 4, kNone, 0.0, kPlain, of_error(&TrajectoryError::scale),
       "the estimate's beside the truth's: 1.002 is a scanner that measures 0.2 % too far"},
      {"ate_live_m", "trajectory error, live", "m", 3, kDown, 0.02, kShown, of_live(&TrajectoryError::ate_aligned_m),
       "the same, of the places as they were known at each scan"},
      {"known", "arena known", "%", 3, kUp, 0.01, kShown | kReport | kRanking | kLeague, of_placed(&S::known),
       "of the truth's floor and walls, the map has seen"},
      {"aligned", "maps aligned", "", 0, kUp, 0.0, kLeague, of_score(&S::aligned)},
      {"victims_found", "victims found", "", 0, kUp, 0.0, kReport | kLeague, of_judged_victims(&VictimFigures::found),
       "true victims with a reported one within 1.2 m"},
      {"victims_false", "false victims", "", 0, kDown, 0.0, kLeague, of_judged_victims(&VictimFigures::false_alarms),
       "reported ones that are no true victim"},
      {"victims_error_m", "victim error", "m", 2, kDown, 0.02, kPlain, victim_error,
       "how far the found ones are from where they were reported, in the mean"},
      {"victims_total", "victims there are", "", 0, kNone, 0.0, kLeague, of_judged_victims(&VictimFigures::total),
       "in the truth"},
      {"victims_reported", "victims reported", "", 0, kNone, 0.0, kPlain, of_victims(&VictimFigures::reported)},
      {"victims_from", "victims taken from", "", 0, kNone, 0.0, kText | kLeague,
       of_victims([](const VictimFigures& v) { return name_of(v.from); })},
      {"victim_symbols", "victim symbols on the map", "", 0, kNone, 0.0, kLeague, of_victims(&VictimFigures::symbols)},
      {"points_quality", "points for map quality", "", 1, kUp, 0.5, kShown | kLeague,
       of_judged_victims(&VictimFigures::quality), "of 10 a victim: how right the walls around the found ones are"},
      {"points_location", "points for location", "", 1, kUp, 0.5, kShown | kLeague,
       of_judged_victims(&VictimFigures::location), "of 10 a victim: how near the found ones are reported"},
      {"points_unfined", "points before the fine", "", 1, kUp, 0.5, kLeague,
       of_judged_victims(&VictimFigures::unfined)},
      {"points_fine", "points lost by false reports", "", 1, kDown, 0.5, kShown | kLeague,
       of_judged_victims(&VictimFigures::fine),
       "10 for each reported one that is no true victim, and no more than was earned"},
      {"points_victims", "points for victims", "", 1, kUp, 0.5, kShown | kLeague,
       of_judged_victims(&VictimFigures::points), "what is left of both after that"},
      {"phantom_m", "phantom wall", "m", 2, kDown, 0.1, kShown | kLeague, wall(&WallErrors::phantom_m),
       "the map's walls where the truth has none"},
      {"missing_m", "missing wall", "m", 2, kDown, 0.1, kShown | kLeague, wall(&WallErrors::missing_m),
       "true walls that the map has not"},
      {"ignored_m", "wall where the truth is unknown", "m", 2, kNone, 0.0, kShown | kLeague,
       wall(&WallErrors::ignored_m), "in no other figure"},
      {"warped_score", "score after warp", "", 3, kNone, 0.0, kShown | kLeague, of_warped(&S::warped_score),
       "what the score would be without the map's distortion"},
      {"warp_m", "distorted by", "m", 3, kNone, 0.0, kShown | kLeague, of_warped(&S::warp_m),
       "RMS of how far the map's walls are shifted beyond what moving and turning it explains"},
      {"penalised_score", "score with penalty for the warp", "", 3, kNone, 0.0, kShown | kLeague,
       of_warped(&S::penalised_score), "the same less a fine for the distortion, but not below the score"},
      {"feature_error_m2", "feature error", "m2", 3, kNone, 0.0, kShown, feature(&MatchError::error),
       "E of eq. (7), of the SURF features of both maps: 0 where each lies on its partner"},
      {"feature_matched", "features matched", "", 0, kNone, 0.0, kShown, feature(&MatchError::matched),
       "pairs of them"},
      {"feature_offset_m", "features apart", "m", 3, kNone, 0.0, kShown, feature(&MatchError::mean_offset),
       "of these pairs, in the mean"},
      {"feature_score", "features right beyond strangers", "", 3, kUp, 0.01, kSpecial | kShown,
       of_warped([](const S& s) { return s.by_features.score; }),
       "0 another arena, 1 the truth; the mean of the next ones"},
      {"surf_score", "SURF features right", "", 3, kNone, 0.0, kSpecial | kShown, of_kind(EvidenceKind::Surf),
       "the same, of textured places alone"},
      {"corner_score", "wall corners right", "", 3, kNone, 0.0, kSpecial | kShown, of_kind(EvidenceKind::Corners),
       "the same, of corners and ends of walls alone"},
      {"room_score", "rooms right", "", 3, kNone, 0.0, kSpecial | kShown, of_kind(EvidenceKind::Rooms),
       "the same, of rooms alone"},
      {"feature_stranger_m2", "feature error of strangers", "m2", 3, kNone, 0.0, kSpecial | kShown,
       [](const Evidence& e) {
         return e.score && !e.score->by_features.kinds.empty() ? Value(e.score->by_features.kinds.front().stranger)
                                                               : Value();
       },
       "E of the map's mirror image: what another arena would get"},
      {"feature_warp_m", "distorted by, from features", "m", 3, kNone, 0.0, kSpecial | kShown,
       of_warped(&S::feature_warp_m), "as above, but fitted to pairs of features instead of walls"},
      {"feature_warped_score", "score after that warp", "", 3, kNone, 0.0, kSpecial | kShown,
       of_warped(&S::feature_warped_score), "what the score would be without it"},
      {"broken", "came apart", "", 0, kNone, 0.0, kSpecial, of_warped([](const S& s) { return s.broken.found; })},
      {"break_m", "parts off by", "m", 2, kNone, 0.0, kSpecial | kShown, part(&MapBreak::apart_m),
       "the map came apart into two; at the middle of the seam"},
      {"break_deg", "parts turned by", "deg", 1, kNone, 0.0, kSpecial | kShown,
       part([](const MapBreak& b) { return rad_to_deg(b.turned_rad); }), "one part against the other"},
      {"break_from_x_m", "seam from x", "m", 2, kNone, 0.0, kSpecial, part([](const MapBreak& b) { return b.from.x; })},
      {"break_from_y_m", "seam from y", "m", 2, kNone, 0.0, kSpecial, part([](const MapBreak& b) { return b.from.y; })},
      {"break_to_x_m", "seam to x", "m", 2, kNone, 0.0, kSpecial, part([](const MapBreak& b) { return b.to.x; })},
      {"break_to_y_m", "seam to y", "m", 2, kNone, 0.0, kSpecial, part([](const MapBreak& b) { return b.to.y; })},
      {"mended_score", "score with both parts in place", "", 3, kNone, 0.0, kSpecial | kShown,
       [](const Evidence& e) { return e.score && e.score->broken.found ? Value(e.score->mended_score) : Value(); },
       "what the score would be with both where they belong"},
      {"area_known_m2", "area mapped", "m2", 1, kNone, 0.0, kShown, of_run(&RunFigures::area_known_m2),
       "floor and walls that the map has seen"},
      {"ate_matched", "poses compared", "", 0, kNone, 0.0, kPlain,
       [](const Evidence& e) { return e.error ? Value(e.error->matched) : Value(); },
       "of the estimate, within the truth's time"},
      {"psi_literal_m", "psi, sum of eq. (5)", "m", 3, kNone, 0.0, kPlain, of_score(&S::psi_literal_m)},
      {"psi_occupied_map_m", "psi, walls, map to truth", "m", 3, kNone, 0.0, kPlain, of_score(&S::psi_occupied_map_m)},
      {"psi_occupied_truth_m", "psi, walls, truth to map", "m", 3, kNone, 0.0, kPlain,
       of_score(&S::psi_occupied_truth_m)},
      {"psi_free_map_m", "psi, free space, map to truth", "m", 3, kNone, 0.0, kPlain, of_score(&S::psi_free_map_m)},
      {"psi_free_truth_m", "psi, free space, truth to map", "m", 3, kNone, 0.0, kPlain, of_score(&S::psi_free_truth_m)},
      {"align_x_m", "map moved in x", "m", 3, kNone, 0.0, kPlain, pose(&Pose::x)},
      {"align_y_m", "map moved in y", "m", 3, kNone, 0.0, kPlain, pose(&Pose::y)},
      {"align_rad", "map turned", "rad", 4, kNone, 0.0, kPlain, pose(&Pose::phi)},
      {"align_note", "note on the alignment", "", 0, kNone, 0.0, kText, of_score(&S::note)},
      {"align_source", "pose proposed by", "", 0, kNone, 0.0, kText | kLeague,
       of_score([](const S& s) { return names_of(s.by); })},
      {"align_tried", "proposals tried", "", 0, kNone, 0.0, kText,
       of_score([](const S& s) { return names_of(s.contest.tried); })},
      {"align_agreement", "agreement of walls", "", 3, kNone, 0.0, kPlain, contest(&C::agreement)},
      {"align_measure", "decided by", "", 0, kNone, 0.0, kText,
       of_score([](const S& s) { return std::string(s.contest.by_agreement ? "agreement" : "log odds"); })},
      {"align_margin", "ahead by", "", 3, kNone, 0.0, kPlain, contest(&C::margin)},
      {"align_runner_up", "runner-up pose, of the best", "", 3, kNone, 0.0, kPlain, of_score(&S::runner_up)},
      {"align_runner_up_source", "runner-up proposed by", "", 0, kNone, 0.0, kText,
       of_score([](const S& s) { return names_of(s.contest.runner_up_by); })},
      {"align_runner_up_x_m", "runner-up moved in x", "m", 3, kNone, 0.0, kPlain, rival(&Pose::x)},
      {"align_runner_up_y_m", "runner-up moved in y", "m", 3, kNone, 0.0, kPlain, rival(&Pose::y)},
      {"align_runner_up_rad", "runner-up turned", "rad", 4, kNone, 0.0, kPlain, rival(&Pose::phi)},
      {"align_mirrored", "mirror image, of the best", "", 3, kNone, 0.0, kPlain, of_score(&S::mirrored)},
      {"scale_hint", "scale at which the maps agree", "", 2, kNone, 0.0, kPlain, of_score(&S::scale_hint)},
      {"map", "map", "", 0, kNone, 0.0, kText, [](const Evidence& e) { return text_or_unknown(e.map_read_as); }},
      {"truth", "truth", "", 0, kNone, 0.0, kText, [](const Evidence& e) { return text_or_unknown(e.truth_read_as); }},
      {"scans", "scans", "", 0, kNone, 0.0, kPlain, of_run(&RunFigures::scans)},
      {"scans_mapped", "scans mapped", "", 0, kNone, 0.0, kPlain, of_run(&RunFigures::scans_mapped)},
      {"scans_out_of_order", "scans out of order", "", 0, kNone, 0.0, kPlain, of_run(&RunFigures::scans_out_of_order)},
      {"hits_outside", "hits outside the map", "", 0, kNone, 0.0, kPlain, of_run(&RunFigures::hits_outside)},
      {"end", "ended", "", 0, kNone, 0.0, kText, of_run(&RunFigures::end)},
      {"end_code", "end in a word", "", 0, kNone, 0.0, kText, of_mission(&MissionFigures::end_code)},
      {"contact_s", "walls or steps touched for", "s", 1, kDown, 0.5, kShown, drive(&D::contact_s),
       "time within 12 mm of a wall, or of a step too high to climb"},
      {"contacts", "times touched", "", 0, kDown, 1.0, kPlain, drive(&D::contacts)},
      {"contact_speed", "fastest touch [m/s]", "", 2, kDown, 0.02, kPlain, drive(&D::contact_speed)},
      {"min_clearance_m", "least clearance", "m", 3, kUp, 0.01, kPlain, drive(&D::min_clearance_m)},
      {"stalls", "stalls", "", 0, kDown, 1.0, kPlain, of_mission(&MissionFigures::stalls)},
      {"way_m", "driven", "m", 1, kNone, 0.0, kShown, drive(&D::way_m), "in the plan view, by the robot's true place"},
      {"home_m", "from the start at the end", "m", 2, kDown, 0.1, kPlain, drive(&D::home_m)},
      {"area_per_min", "area a minute [m2]", "", 1, kUp, 0.5, kPlain, of_mission(&MissionFigures::area_per_min)},
      {"victims_visible", "victims that can be seen", "", 0, kNone, 0.0, kPlain,
       of_mission(&MissionFigures::victims_visible)},
      {"victims_withdrawn", "victims taken back", "", 0, kDown, 1.0, kPlain,
       of_mission(&MissionFigures::victims_withdrawn), "that it was sure of on the way and later no more"},
      {"visible_share", "floor that can be seen", "%", 3, kNone, 0.0, kPlain,
       of_mission(&MissionFigures::visible_share)},
      {"rooms_reachable", "rooms that can be entered", "", 0, kNone, 0.0, kPlain,
       of_mission(&MissionFigures::rooms_reachable)},
      {"rooms_entered", "rooms entered", "", 0, kUp, 0.5, kPlain, of_mission(&MissionFigures::rooms_entered)},
      {"rpe_frame_m", "error from pose to pose", "m", 4, kNone, 0.0, kSpecial,
       of_pieces(&P::frames, &RelativeError::rmse_m),
       "RMS of how far a step from one pose to the next is off in length"},
      {"rpe_frame_deg", "turned from pose to pose", "deg", 4, kNone, 0.0, kSpecial,
       of_pieces(&P::frames, [](const RelativeError& r) { return rad_to_deg(r.rmse_rad); }), "the same in angle"},
      {"rpe_1m_pairs", "metres of path compared", "", 0, kNone, 0.0, kSpecial,
       of_pieces(&P::metres, &RelativeError::pairs), "pieces of a metre, one behind the other"},
      {"rpe_1m_m", "error over a metre", "m", 4, kNone, 0.0, kSpecial, of_pieces(&P::metres, &RelativeError::rmse_m),
       "RMS of how far such a piece is off in length"},
      {"rpe_1m_deg", "turned over a metre", "deg", 4, kNone, 0.0, kSpecial,
       of_pieces(&P::metres, [](const RelativeError& r) { return rad_to_deg(r.rmse_rad); }), "the same in angle"},
      {"relations", "relations compared", "", 0, kNone, 0.0, kSpecial, of_relations(&R::relations),
       "pairs of places whose relation is known"},
      {"relations_missing", "relations outside the time", "", 0, kNone, 0.0, kSpecial, of_relations(&R::missing),
       "not compared: the estimate has no pose then"},
      {"relation_m", "error of a relation", "m", 4, kNone, 0.0, kSpecial | kShown, of_compared(&R::mean_m),
       "how far the estimate has one of a pair from where the other sees it, in the mean"},
      {"relation_std_m", "its standard deviation", "m", 4, kNone, 0.0, kSpecial, of_compared(&R::std_m),
       "of that distance"},
      {"relation_m2", "its mean square", "m2", 4, kNone, 0.0, kSpecial, of_compared(&R::mean_m2), "of that distance"},
      {"relation_deg", "angle of a relation off by", "deg", 4, kNone, 0.0, kSpecial | kShown,
       of_compared([](const R& r) { return rad_to_deg(r.mean_rad); }), "the same in angle, in the mean"},
      {"relation_std_deg", "standard deviation of the angle", "deg", 4, kNone, 0.0, kSpecial,
       of_compared([](const R& r) { return rad_to_deg(r.std_rad); }), "of that angle"},
      {"bad_packets", "damaged packets", "", 0, kNone, 0.0, kSpecial, of_devices(&DeviceFigures::bad_packets)},
      {"base_jumps", "jumps of the base's odometry", "", 0, kNone, 0.0, kSpecial,
       of_devices(&DeviceFigures::odometry_jumps)},
      {"scans_damaged", "damaged scans", "", 0, kNone, 0.0, kSpecial, of_devices(&DeviceFigures::scans_damaged)},
      {"scans_missed", "scans missed", "", 0, kNone, 0.0, kSpecial, of_devices(&DeviceFigures::scans_missed)},
      {"answer_ms_median", "answer to a scan [ms]", "", 1, kNone, 0.0, kSpecial | kShown | kMachine,
       of_devices(&DeviceFigures::answer_ms_median),
       "from a scan's last byte to what the base is told because of it, half of them faster"},
      {"answer_ms_99", "99 % of answers below [ms]", "", 1, kNone, 0.0, kSpecial | kShown | kMachine,
       of_devices(&DeviceFigures::answer_ms_99), "of the same times"},
      {"cpu_share", "computing, of one core", "%", 3, kNone, 0.0, kSpecial | kShown | kMachine,
       of_devices(&DeviceFigures::cpu_share), "of the program, from start to end"},
      {"sim_s", "time covered", "s", 1, kNone, 0.0, kShown, of_run(&RunFigures::sim_s), "of the robot's clock"},
      {"wall_s", "time taken", "s", 1, kDown, 0.0, kShown | kMachine, of_machine(&MachineFigures::wall_s),
       "of the computer's clock, from start to score"},
      {"real_time_factor", "times real time", "", 0, kUp, 0.0, kShown | kMachine, real_time_factor,
       "time covered by time taken"},
      {"peak_mb", "memory", "MB", 0, kDown, 0.0, kShown | kMachine, of_machine(&MachineFigures::peak_mb),
       "the most that the program held"},
  };
}

std::string with_decimals(double value, int decimals) {
  char text[64];
  std::snprintf(text, sizeof text, "%.*f", decimals, value);
  return text;
}

}  // namespace

std::string name_of(VictimSource source) {
  switch (source) {
    case VictimSource::None:
      return "none";
    case VictimSource::List:
      return "csv";
    case VictimSource::Symbols:
      return "symbols";
  }
  return "";
}

const std::vector<Figure>& figures() {
  static const std::vector<Figure> table = make_table();
  return table;
}

const Figure* find_figure(const std::string& key) {
  const auto& table = figures();
  const auto row = std::find_if(table.begin(), table.end(), [&](const Figure& figure) { return figure.key == key; });
  return row == table.end() ? nullptr : &*row;
}

std::vector<const Figure*> figures_with(Traits trait) {
  std::vector<const Figure*> chosen;
  for (const Figure& figure : figures())
    if (figure.is(trait)) chosen.push_back(&figure);
  return chosen;
}

std::string heading(const Figure& figure) {
  return figure.label + (figure.unit.empty() || figure.unit == "%" ? "" : " [" + figure.unit + "]");
}

std::string plain_text_of(const Figure& figure, const Value& value) {
  if (const auto* yes = std::get_if<bool>(&value)) return *yes ? "yes" : "no";
  if (const auto* count = std::get_if<std::uint64_t>(&value)) return std::to_string(*count);
  if (const auto* number = std::get_if<double>(&value)) return with_decimals(*number, figure.decimals);
  if (const auto* text = std::get_if<std::string>(&value)) return *text;
  return "";
}

std::string text_of(const Figure& figure, const Value& value) {
  const auto* number = std::get_if<double>(&value);
  if (figure.unit == "%" && number != nullptr)
    return with_decimals(100.0 * *number, std::max(0, figure.decimals - 2)) + " %";
  const std::string text = plain_text_of(figure, value);
  return text.empty() || figure.unit.empty() ? text : text + " " + figure.unit;
}

}  // namespace rubble::scoring
