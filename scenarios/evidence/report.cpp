#include "scenarios/evidence/report.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <opencv2/imgproc.hpp>
#include <set>

#include "base/error.h"
#include "base/image/png.h"
#include "base/text/html.h"
#include "scenarios/evidence/compare.h"
#include "scenarios/evidence/metrics.h"
#include "scenarios/evidence/statistics.h"
#include "scenarios/evidence/svg_plot.h"
#include "scoring/maps/raster_image.h"

namespace rubble::scenarios {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t kThumbnails = 4;
constexpr int kThumbnailPixels = 320;
constexpr std::size_t kFailuresShown = 50;

/// The runs of one configuration, all scenarios together.
std::vector<const RunRecord*> of(const ResultSet& set, const std::string& configuration) {
  std::vector<const RunRecord*> runs;
  for (const auto& run : set.runs)
    if (run.configuration == configuration) runs.push_back(&run);
  return runs;
}

std::vector<double> times(const std::vector<const RunRecord*>& runs, const Timing& timing, const std::string& key) {
  std::vector<double> values;
  for (const RunRecord* run : runs) {
    const auto found = timing.find(run->run_id);
    if (found != timing.end() && found->second->contains(key) && found->second->at(key).is_number())
      values.push_back(found->second->at(key).get<double>());
  }
  return values;
}

/// Three significant digits: more than the intervals are worth.
std::string brief(double value) {
  char text[40];
  std::snprintf(text, sizeof text, "%.3g", value);
  return text;
}

/// "0.812 [0.79, 0.83]".
std::string mean_text(const std::vector<double>& values) {
  if (values.empty()) return "-";
  const Interval interval = bootstrap_mean(values, 1);
  if (!std::isfinite(interval.low)) return brief(mean(values));
  return brief(mean(values)) + " [" + brief(interval.low) + ", " + brief(interval.high) + "]";
}

std::string summary_table(const ResultSet& set, const SweepNote& note) {
  std::string out = "<table>\n<tr><th>configuration</th><th class=n>runs</th><th class=n>failed</th>";
  for (const Metric* column : figures_with(scoring::kReport))
    out += "<th class=n>" + escape_html(heading(*column)) + "</th>";
  out += "<th class=n>time a run [s]</th></tr>\n";
  for (const auto& name : note.configurations) {
    const auto runs = of(set, name);
    const auto failed = std::count_if(runs.begin(), runs.end(), [](const auto* run) { return !run->ok(); });
    out += "<tr><td>" + escape_html(name) + "</td><td class=n>" + std::to_string(runs.size()) + "</td><td class=\"n" +
           (failed ? " failed" : "") + "\">" + std::to_string(failed) + "</td>";
    for (const Metric* column : figures_with(scoring::kReport))
      out += "<td class=n>" + mean_text(numbers(runs, column->key)) + "</td>";
    out += "<td class=n>" + figure(median(times(runs, set.timing, "wall_s"))) + "</td></tr>\n";
  }
  return out + "</table>\n<p class=note>Means over runs with 95 % bootstrap intervals; the time is a median.</p>\n";
}

std::string plots(const ResultSet& set, const SweepNote& note) {
  std::vector<Strip> scores, durations;
  std::vector<Cloud> clouds;
  for (const auto& name : note.configurations) {
    const auto runs = of(set, name);
    scores.push_back({name, numbers(runs, "score")});
    durations.push_back({name, times(runs, set.timing, "wall_s")});
    Cloud cloud{name, {}};
    for (const RunRecord* run : runs) {
      const double error = run->metric("ate_aligned_m"), score = run->metric("score");
      if (!std::isnan(error) && !std::isnan(score)) cloud.points.push_back({error, score});
    }
    clouds.push_back(std::move(cloud));
  }
  return "<h2>Score by configuration</h2>\n" + strip_plot("score", scores) +
         "<p class=note>A dot is a run, the box holds the middle half, the line is the median.</p>\n"
         "<h2>Score against trajectory error</h2>\n" +
         scatter_plot("trajectory error, aligned [m]", "score", clouds) + "<h2>Time of a run</h2>\n" +
         strip_plot("wall time [s]", durations);
}

/// The run's picture as a data URI; empty when it has none.
std::string thumbnail(const std::string& folder) {
  for (const char* name : {"/overlay.png", "/map.png"}) {
    if (!fs::exists(folder + name)) continue;
    RgbImage rgb;
    try {
      rgb = scoring::read_rgb(folder + name);
    } catch (const InputError&) {
      continue;  // the run was killed while it drew, or its folder is foreign
    }
    cv::Mat image;
    cv::cvtColor(cv::Mat(rgb.height, rgb.width, CV_8UC3, rgb.rgb.data()), image, cv::COLOR_RGB2BGR);
    const double factor = std::min(1.0, static_cast<double>(kThumbnailPixels) / std::max(image.cols, image.rows));
    cv::Mat small;
    cv::resize(image, small, {}, factor, factor, cv::INTER_AREA);
    return "data:image/png;base64," + base64(png_bytes(small));
  }
  return "";
}

/// Results may come from elsewhere: a run folder lies below its batch.
bool is_below(const std::string& folder) {
  const fs::path path = fs::path(folder).lexically_normal();
  return !folder.empty() && !path.is_absolute() && *path.begin() != "..";
}

/// A path as a link of a page: its colons are coded, so that it has no scheme ("javascript:"), no query, no fragment.
std::string local_link(const std::string& path) {
  if (path.empty()) return "";
  static constexpr char kHex[] = "0123456789ABCDEF";
  std::string out;
  for (const char c : path) {
    const auto byte = static_cast<unsigned char>(c);
    const bool plain = std::isalnum(byte) != 0 || std::strchr("/-_.~=+,", c) != nullptr;
    if (plain && c != '\0') {
      out += c;
    } else {
      out += {'%', kHex[byte >> 4], kHex[byte & 15]};
    }
  }
  return out;
}

/// "cannot be seen: true victim2"; nothing where all victims can be, or where an older program did not say.
std::string out_of_sight(const RunRecord& run) {
  const auto found = run.score->find("unseen_victims");
  if (found == run.score->end() || !found->is_array()) return "";
  std::string names;
  for (const auto& name : *found)
    if (name.is_string()) names += (names.empty() ? "" : ", ") + name.get<std::string>();
  return names.empty() ? "" : "<br>cannot be seen from floor the robot reaches: " + escape_html(names);
}

std::string figure_of(const RunRecord& run, const ResultSet& set, const std::string& page_folder) {
  const std::string folder = set.folder + "/" + run.folder;
  const bool is_inside = is_below(run.folder);
  const std::string picture = is_inside ? thumbnail(folder) : "";
  std::error_code error;
  const std::string link = local_link(fs::relative(folder, page_folder.empty() ? "." : page_folder, error).string());
  std::string out = "<figure>";
  if (!link.empty() && is_inside) out += "<a href=\"" + escape_html(link) + "/\">";
  out += picture.empty() ? "(no picture)" : "<img src=\"" + picture + "\" alt=\"map over truth\">";
  if (!link.empty() && is_inside) out += "</a>";
  return out + "<figcaption>score " + figure(run.metric("score")) + "<br>" + escape_html(run.scenario) + ", seed " +
         std::to_string(run.seed) + "<br>" + escape_html(run.configuration) + out_of_sight(run) +
         "</figcaption></figure>\n";
}

std::string thumbnails(const ResultSet& set, const std::string& page_folder) {
  std::vector<const RunRecord*> scored;
  for (const auto& run : set.runs)
    if (!std::isnan(run.metric("score"))) scored.push_back(&run);
  std::stable_sort(scored.begin(), scored.end(),
                   [](const auto* a, const auto* b) { return a->metric("score") < b->metric("score"); });
  const std::size_t count = std::min(kThumbnails, (scored.size() + 1) / 2);
  std::string out = "<h2>Worst maps</h2>\n";
  for (std::size_t i = 0; i < count; ++i) out += figure_of(*scored[i], set, page_folder);
  out += "<h2>Best maps</h2>\n";
  for (std::size_t i = 0; i < count && i + count < scored.size() + count % 2; ++i)
    out += figure_of(*scored[scored.size() - 1 - i], set, page_folder);
  return out;
}

std::string failed_table(const ResultSet& set) {
  std::string rows;
  std::size_t count = 0;
  for (const auto& run : set.runs) {
    if (run.ok() && run.broken.empty()) continue;
    if (++count > kFailuresShown) continue;
    std::string what = run.error;
    for (const auto& broken : run.broken) what += (what.empty() ? "" : "; ") + broken;
    rows += "<tr><td>" + escape_html(run.scenario) + "</td><td>" + escape_html(run.configuration) +
            "</td><td class=n>" + std::to_string(run.seed) + "</td><td class=failed>" +
            (run.ok() ? "not as expected" : name_of(run.status)) + "</td><td>" + escape_html(what) + "</td></tr>\n";
  }
  if (count == 0) return "";
  std::string out =
      "<h2>Failed runs</h2>\n<table>\n<tr><th>scenario</th><th>configuration</th><th class=n>seed</th>"
      "<th>status</th><th>why</th></tr>\n" +
      rows + "</table>\n";
  if (count > kFailuresShown) out += "<p class=note>and " + std::to_string(count - kFailuresShown) + " more</p>\n";
  return out;
}

std::string codes(const ResultSet& set) {
  std::set<std::string> codes;
  for (const auto& run : set.runs) codes.insert(run.code);
  std::string out;
  for (const auto& code : codes) out += (out.empty() ? "" : "; ") + code;
  return out;
}

}  // namespace

std::string report_html(const ResultSet& set, const SweepNote& note, const std::string& page_folder) {
  std::string body = "<h1>" + escape_html(note.name) + "</h1>\n";
  if (!note.about.empty()) body += "<p>" + escape_html(note.about) + "</p>\n";
  body += "<p class=note>" + std::to_string(set.runs.size()) + " runs, rubble " + escape_html(codes(set)) + "</p>\n";
  body += summary_table(set, note) + plots(set, note) + thumbnails(set, page_folder) + failed_table(set);
  return html_page(note.name, body);
}

std::string report_markdown(const ResultSet& set, const SweepNote& note) {
  std::string out = "## " + note.name + "\n\n";
  if (!note.about.empty()) out += note.about + "\n\n";
  out += "| configuration | runs | failed |";
  std::string rule = "|---|---|---|";
  for (const Metric* column : figures_with(scoring::kReport)) out += " " + heading(*column) + " |", rule += "---|";
  out += "\n" + rule + "\n";
  for (const auto& name : note.configurations) {
    const auto runs = of(set, name);
    const auto failed = std::count_if(runs.begin(), runs.end(), [](const auto* run) { return !run->ok(); });
    out += "| " + name + " | " + std::to_string(runs.size()) + " | " + std::to_string(failed) + " |";
    for (const Metric* column : figures_with(scoring::kReport))
      out += " " + mean_text(numbers(runs, column->key)) + " |";
    out += "\n";
  }
  out += "\n";
  if (note.configurations.size() < 2) return out;
  out +=
      "Paired by scenario and seed:\n\n| configuration | against | metric | pairs | difference | "
      "95 % interval | better : worse | p | verdict |\n|---|---|---|---|---|---|---|---|---|\n";
  for (const auto& name : note.configurations) {
    const std::string& reference = note.references.at(name);
    if (name == reference) continue;
    CompareOptions options;
    options.configuration_a = reference;
    options.configuration_b = name;
    const Comparison comparison = compare(set, set, note.name, note.name, options);
    for (const auto& c : comparison.groups[0].metrics) {
      if (!c.metric.is(scoring::kReport)) continue;
      const std::string interval =
          std::isfinite(c.interval.low) ? "[" + figure(c.interval.low) + ", " + figure(c.interval.high) + "]" : "-";
      out += "| " + name + " | " + reference + " | " + heading(c.metric) + " | " + std::to_string(c.pairs) + " | " +
             (c.difference > 0 ? "+" : "") + figure(c.difference) + " | " + interval + " | " +
             std::to_string(c.better) + " : " + std::to_string(c.worse) + " | " + figure(c.p_sign) + " | " +
             text_of(c.verdict) + " |\n";
    }
  }
  return out + "\n";
}

}  // namespace rubble::scenarios
