#include "app/score_parts.h"

#include <cstdio>

namespace rubble::app {

scoring::AlignmentConfig parse_align(const std::string& text) {
  scoring::AlignmentConfig out;
  if (text == "walls") out.by = scoring::AlignBy::Walls;
  if (text == "rooms") out.by = scoring::AlignBy::Rooms;
  if (text == "features" || text == "surf" || text == "akaze" || text == "orb") out.by = scoring::AlignBy::Features;
  if (text == "akaze") out.feature_kind = scoring::FeatureKind::Akaze;
  if (text == "orb") out.feature_kind = scoring::FeatureKind::Orb;
  return out;
}

void print_parts(const scoring::MapScore& s) {
  if (!s.aligned) return;
  std::printf("%-26s %.1f m phantom, %.1f m missing\n", "wall", s.errors.phantom_m, s.errors.missing_m);
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
  json["align_mirrored"] = s.mirrored;
  json["scale_hint"] = s.scale_hint;
  json["phantom_m"] = s.errors.phantom_m;
  json["missing_m"] = s.errors.missing_m;
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
