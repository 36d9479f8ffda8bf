#include "app/score_parts.h"

#include <algorithm>
#include <array>
#include <cstdio>
#include <sstream>

#include "base/angle.h"
#include "base/error.h"

namespace rubble::app {

namespace {

struct Method {
  const char* name;
  scoring::AlignBy by;
  scoring::FeatureKind kind;
};

constexpr std::array<Method, 6> kMethods{{{"walls", scoring::AlignBy::Walls, scoring::FeatureKind::Surf},
                                          {"rooms", scoring::AlignBy::Rooms, scoring::FeatureKind::Surf},
                                          {"features", scoring::AlignBy::Features, scoring::FeatureKind::Surf},
                                          {"surf", scoring::AlignBy::Features, scoring::FeatureKind::Surf},
                                          {"akaze", scoring::AlignBy::Features, scoring::FeatureKind::Akaze},
                                          {"orb", scoring::AlignBy::Features, scoring::FeatureKind::Orb}}};

std::string pose_text(const mrpt::math::TPose2D& T) {
  char text[80];
  std::snprintf(text, sizeof text, "turned %.2f deg, moved %.3f m, %.3f m", rad_to_deg(T.phi), T.x, T.y);
  return text;
}

}  // namespace

scoring::AlignmentConfig parse_align(const std::string& text) {
  scoring::AlignmentConfig out;
  if (text == "auto") return out;
  std::stringstream names(text);
  bool good = !text.empty() && text.back() != ',';
  for (std::string name; good && std::getline(names, name, ',');) {
    const auto method = std::find_if(kMethods.begin(), kMethods.end(), [&](const Method& m) { return m.name == name; });
    good = method != kMethods.end() && !scoring::includes(out.by, method->by);
    if (!good) break;
    out.by = out.by | method->by;
    if (method->by == scoring::AlignBy::Features) out.feature_kind = method->kind;
  }
  if (!good)
    throw UsageError("--align " + text +
                     ": give auto, or walls, rooms and one of features, surf, akaze, orb, joined by commas");
  return out;
}

void print_contest(const scoring::MapScore& s) {
  if (s.source.empty() || s.source == "given") return;
  if (s.aligned) std::printf("%-26s %s\n", "aligned", pose_text(s.T_truth_map).c_str());
  std::printf("%-26s %s, of %s; agreement %.3f of 2\n", s.aligned ? "proposed by" : "best pose, not trusted, by",
              s.source.c_str(), scoring::names_of(s.contest.tried).c_str(), s.contest.agreement);
  if (s.contest.runner_up_source.empty()) {
    std::printf("%-26s none\n", "runner-up pose");
  } else {
    std::printf("%-26s %.3f of the best (%s ahead by %.3f), by %s: %s\n", "runner-up pose", s.runner_up,
                s.contest.by_agreement ? "agreement" : "log odds", s.contest.margin, s.contest.runner_up_source.c_str(),
                pose_text(s.contest.T_runner_up).c_str());
  }
  if (s.mirrored > 0.0) std::printf("%-26s %.3f of the best\n", "mirror image", s.mirrored);
}

void print_parts(const scoring::MapScore& s) {
  if (!s.aligned) return;
  std::printf("%-26s %.1f m phantom, %.1f m missing, %.1f m ignored (truth unknown)\n", "wall", s.errors.phantom_m,
              s.errors.missing_m, s.errors.ignored_m);
  if (s.warped) {
    std::printf("%-26s %.3f, distorted by %.3f m, %.3f with penalty\n", "score after warp", s.warped_score, s.warp_m,
                s.penalised_score);
    std::printf("%-26s %.3f m^2, %zu matched, %.3f m apart\n", "feature error", s.features.error, s.features.matched,
                s.features.mean_offset);
  }
  for (const scoring::WrongPlace& place : s.errors.worst)
    std::printf("%-26s x %.2f m, y %.2f m: %.1f m phantom, %.1f m missing\n",
                &place == &s.errors.worst.front() ? "worst places" : "", place.p_truth.x, place.p_truth.y,
                place.phantom_m, place.missing_m);
}

void add_parts(nlohmann::ordered_json& json, const scoring::MapScore& s) {
  json["align_source"] = s.source;
  json["align_tried"] = scoring::names_of(s.contest.tried);
  json["align_agreement"] = s.contest.agreement;
  json["align_measure"] = s.contest.by_agreement ? "agreement" : "log odds";
  json["align_margin"] = s.contest.margin;
  json["align_runner_up_source"] = s.contest.runner_up_source;
  json["align_runner_up_x_m"] = s.contest.T_runner_up.x;
  json["align_runner_up_y_m"] = s.contest.T_runner_up.y;
  json["align_runner_up_rad"] = s.contest.T_runner_up.phi;
  json["align_mirrored"] = s.mirrored;
  json["scale_hint"] = s.scale_hint;
  json["phantom_m"] = s.errors.phantom_m;
  json["missing_m"] = s.errors.missing_m;
  json["ignored_m"] = s.errors.ignored_m;
  json["worst_places"] = nlohmann::ordered_json::array();
  for (const scoring::WrongPlace& place : s.errors.worst)
    json["worst_places"].push_back({{"x_m", place.p_truth.x},
                                    {"y_m", place.p_truth.y},
                                    {"phantom_m", place.phantom_m},
                                    {"missing_m", place.missing_m}});
  if (!s.warped) return;
  json["warped_score"] = s.warped_score;
  json["warp_m"] = s.warp_m;
  json["penalised_score"] = s.penalised_score;
  json["feature_error_m2"] = s.features.error;
  json["feature_matched"] = s.features.matched;
  json["feature_offset_m"] = s.features.mean_offset;
}

}  // namespace rubble::app
