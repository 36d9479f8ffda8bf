#include "scoring/pictures/evaluation_page.h"

#include <cmath>
#include <cstdint>
#include <cstdio>
#include <string_view>

#include "base/angle.h"
#include "base/text/html.h"
#include "base/text/number_text.h"
#include "base/text/shell.h"
#include "scoring/pictures/page_assets.h"
#include "scoring/pictures/picture.h"
#include "scoring/pictures/sight_picture.h"
#include "scoring/pose_score.h"
#include "scoring/walls/overlap.h"
#include "scoring/walls/resample.h"

namespace rubble::scoring {
namespace {

/// Bytes of class * 64 + run length - 1, row by row from the south-west corner.
std::string packed_cells(const OccupancyGrid& grid) {
  constexpr int kLongest = 64;
  std::string out;
  const auto& cells = grid.cells();
  for (std::size_t i = 0; i < cells.size();) {
    int length = 1;
    while (length < kLongest && i + static_cast<std::size_t>(length) < cells.size() &&
           cells[i + static_cast<std::size_t>(length)] == cells[i])
      ++length;
    out += static_cast<char>(static_cast<unsigned char>(static_cast<int>(cells[i]) * kLongest + length - 1));
    i += static_cast<std::size_t>(length);
  }
  return out;
}

/// A JSON string that may stand inside an HTML script element.
std::string quoted(const std::string& text) {
  std::string out = "\"";
  for (const char c : text) {
    const auto code = static_cast<unsigned char>(c);
    if (c == '"' || c == '\\' || c == '<' || c == '>' || code < 0x20) {
      char escape[8];
      std::snprintf(escape, sizeof escape, "\\u%04x", static_cast<unsigned>(code));
      out += escape;
    } else {
      out += c;
    }
  }
  return out + "\"";
}

std::string grid_json(const OccupancyGrid& grid, const std::string& name) {
  const GridFrame& f = grid.frame();
  return "{\"name\":" + quoted(name) + ",\"w\":" + std::to_string(f.width) + ",\"h\":" + std::to_string(f.height) +
         ",\"res\":" + number_text(f.resolution) + ",\"x0\":" + number_text(f.x0) + ",\"y0\":" + number_text(f.y0) +
         ",\"half\":" + number_text(wall_half_thickness(grid)) + ",\"runs\":\"" + base64(packed_cells(grid)) + "\"}";
}

/// Centimetres are enough for a mark: [x, y], [x, y, name] or [x, y, name, least x, least y, greatest x, greatest y].
std::string mark_json(const Mark& mark) {
  const auto centimetres = [](double value) { return number_text(std::round(value * 100.0) / 100.0); };
  return "[" + centimetres(mark.p.x) + "," + centimetres(mark.p.y) +
         (mark.name.empty() && !mark.box ? "" : "," + quoted(mark.name)) +
         (mark.box ? "," + centimetres(mark.box->first.x) + "," + centimetres(mark.box->first.y) + "," +
                         centimetres(mark.box->second.x) + "," + centimetres(mark.box->second.y)
                   : "") +
         "]";
}

std::string marks_json(const std::vector<Marks>& all) {
  const auto list = [](const auto& items, const auto& text_of) {
    std::string out = "[";
    for (const auto& item : items) out += (out.size() > 1 ? "," : "") + text_of(item);
    return out + "]";
  };
  return list(all, [&](const Marks& marks) {
    const auto pair = [](const std::pair<Mark, Mark>& p) {
      return "[" + mark_json(p.first) + "," + mark_json(p.second) + "]";
    };
    return "{\"what\":" + quoted(marks.what) + ",\"pairs\":" + list(marks.pairs, pair) +
           ",\"map\":" + list(marks.map_only, mark_json) + ",\"truth\":" + list(marks.truth_only, mark_json) +
           ",\"unjudged\":" + list(marks.unjudged, mark_json) + "}";
  });
}

std::string data_json(const OccupancyGrid& map, const OccupancyGrid& truth, const EvaluationStart& start) {
  const mrpt::math::TPose2D& T = start.T_truth_map;
  return "{\"map\":" + grid_json(crop_to_known(map, 0.0), start.map_name) +
         ",\n\"truth\":" + grid_json(crop_to_known(truth, 0.0), start.truth_name) +
         ",\n\"pose\":{\"x\":" + number_text(T.x) + ",\"y\":" + number_text(T.y) +
         ",\"deg\":" + number_text(rad_to_deg(T.phi)) + ",\"scale\":" + number_text(start.scale) +
         "},\"tau\":" + number_text(start.config.tau) + ",\"cap\":" + number_text(start.config.colour_absent_cap) +
         ",\"command\":" + quoted(start.command) + ",\"warning\":" + quoted(start.not_trusted) +
         ",\"marks\":" + marks_json(start.marks) + "}";
}

/// `page` with each placeholder replaced once.
void replace(std::string& page, std::string_view placeholder, std::string_view text) {
  const std::size_t at = page.find(placeholder);
  if (at != std::string::npos) page.replace(at, placeholder.size(), text);
}

std::string figure_of(double value, const std::string& what, const std::string& where, const char* kind = "main") {
  char text[400];
  std::snprintf(text, sizeof text, "<div class=\"%s\"><b>%.3f</b> <span>%s</span><small>%s</small></div>\n", kind,
                value, what.c_str(), where.c_str());
  return text;
}

/// What the program says: it does not move with the maps.
std::string verdict(const EvaluationStart& start) {
  const bool given = start.by == AlignBy::Hand;
  if (start.not_trusted.empty())
    return figure_of(start.score, "score", given ? "at the pose that was given" : "at the pose that the program found");
  std::string out = figure_of(0.0, "score", "of a map whose pose is not trusted");
  if (start.by != AlignBy::Auto)
    out += figure_of(start.score, "score there", "at the best pose found; it does not count", "aside");
  return out;
}

/// What does not move with the maps: the pictures at the pose at start.
std::string at_start(const OccupancyGrid& map, const OccupancyGrid& truth, const EvaluationStart& start) {
  const OccupancyGrid grid = scaled_frame(map, start.scale);
  const auto figure = [](const std::string& png, const std::string& what) {
    return "<figure><img alt=\"" + what + "\" src=\"data:image/png;base64," + base64(png) + "\"><figcaption>" + what +
           "</figcaption></figure>\n";
  };
  const bool has_victims = !start.marks.empty() && start.marks.front().what == "victims";
  Marks victims = has_victims ? start.marks.front() : Marks{};
  victims.seam = start.seam;
  for (auto& [of_map, of_truth] : victims.pairs) of_map.p *= start.scale;
  for (std::vector<Mark>* marks : {&victims.map_only, &victims.unjudged})
    for (Mark& of_map : *marks) of_map.p *= start.scale;
  return figure(overlay_png(grid, truth, start.T_truth_map,
                            start.not_trusted.empty() ? "" : "NOT TRUSTED: " + start.not_trusted, victims),
                "walls right (dark, within 5 cm), near (orange), only in the map (red), only in the truth (blue)") +
         figure(error_map_png(grid, truth, start.T_truth_map, start.config.tau),
                "distance of phantom walls (to red) and missing ones (to blue)") +
         figure(
             sight_map_png(grid, truth, start.T_truth_map),
             "lines of sight that make the score: right (green), blocked where the way is open (red), walls missing or "
             "elsewhere (blue), not known (yellow)");
}

}  // namespace

std::string words_of(const ScoreCommand& command) {
  std::string words = "rubble score " + shell_word(command.map) + " " + shell_word(command.truth);
  if (command.map_resolution) words += " --resolution " + number_text(*command.map_resolution);
  if (command.truth_resolution) words += " --truth-resolution " + number_text(*command.truth_resolution);
  if (command.tau != ScoreConfig().tau) words += " --tau " + number_text(command.tau);
  if (!command.pois.empty()) words += " --pois " + shell_word(command.pois);
  if (!command.victims.empty()) words += " --victims " + shell_word(command.victims);
  return words;
}

std::string evaluation_page(const OccupancyGrid& map, const OccupancyGrid& truth, const EvaluationStart& start) {
  std::string page(kEvaluationHtml);
  replace(page, "@STYLE@", kEvaluationCss);
  replace(page, "@METRIC@", kMetricJs);
  replace(page, "@TOOL@", kEvaluationJs);
  replace(page, "@VERDICT@", verdict(start));
  replace(page, "@ATSTART@", at_start(map, truth, start));
  replace(page, "@DATA@", data_json(map, truth, start));
  return page;
}

}  // namespace rubble::scoring
