#include "app/maps/score_parts.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <sstream>

#include "app/terminal.h"
#include "base/angle.h"
#include "base/error.h"

namespace rubble::app {

namespace {

struct Method {
  const char* name;
  scoring::AlignBy by;
  scoring::FeatureKind kind;
};

constexpr std::array<Method, 7> kMethods{{{"eq7", scoring::AlignBy::Equation7, scoring::FeatureKind::Surf},
                                          {"walls", scoring::AlignBy::Walls, scoring::FeatureKind::Surf},
                                          {"rooms", scoring::AlignBy::Rooms, scoring::FeatureKind::Surf},
                                          {"features", scoring::AlignBy::Features, scoring::FeatureKind::Surf},
                                          {"surf", scoring::AlignBy::Features, scoring::FeatureKind::Surf},
                                          {"akaze", scoring::AlignBy::Features, scoring::FeatureKind::Akaze},
                                          {"orb", scoring::AlignBy::Features, scoring::FeatureKind::Orb}}};

std::string break_text(const scoring::MapBreak& b) {
  char text[160];
  std::snprintf(text, sizeof text, "two parts, %.2f m and %.1f deg apart, seam from %.1f, %.1f m to %.1f, %.1f m",
                b.apart_m, rad_to_deg(b.turned_rad), b.from.x, b.from.y, b.to.x, b.to.y);
  return text;
}

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
                     ": give auto, eq7, or walls, rooms and one of features, surf, akaze, orb, joined by commas");
  return out;
}

void print_contest(const scoring::MapScore& s) {
  if (s.by == scoring::AlignBy::Auto || s.by == scoring::AlignBy::Hand) return;
  const auto thousandths = [](double value) {
    char text[32];
    std::snprintf(text, sizeof text, "%.3f", value);
    return std::string(text);
  };
  if (s.aligned) print_row("aligned", pose_text(s.T_truth_map));
  print_row(s.aligned ? "proposed by" : "best pose, not trusted, by",
            scoring::names_of(s.by) + ", of " + scoring::names_of(s.contest.tried) + "; agreement " +
                thousandths(s.contest.agreement) + " of 2");
  if (!s.aligned) print_row("score there, not trusted", thousandths(s.score_at_best_pose));
  print_row("runner-up pose",
            s.contest.runner_up_by == scoring::AlignBy::Auto
                ? "none"
                : thousandths(s.runner_up) + " of the best (" + (s.contest.by_agreement ? "agreement" : "log odds") +
                      " ahead by " + thousandths(s.contest.margin) + "), by " +
                      scoring::names_of(s.contest.runner_up_by) + ": " + pose_text(s.contest.T_runner_up));
  if (s.mirrored > 0.0) print_row("mirror image", thousandths(s.mirrored) + " of the best");
}

void print_worst_places(const scoring::MapScore& s) {
  if (s.broken.found) print_row("came apart", break_text(s.broken));
  for (const scoring::WrongPlace& place : s.errors.worst) {
    char text[120];
    // Rounded first: no place is at -0.00.
    const auto hundredths = [](double v) { return std::round(100.0 * v) / 100.0 + 0.0; };
    std::snprintf(text, sizeof text, "x %.2f m, y %.2f m: %.1f m phantom, %.1f m missing", hundredths(place.p_truth.x),
                  hundredths(place.p_truth.y), place.phantom_m, place.missing_m);
    print_row(&place == &s.errors.worst.front() ? "worst places" : "", text);
  }
}

}  // namespace rubble::app
