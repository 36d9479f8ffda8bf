#include "scoring/league/league_page.h"

#include <algorithm>
#include <cstdio>

#include "base/angle.h"
#include "base/text/html.h"
#include "scoring/marks.h"

namespace rubble::scoring {
namespace {

std::string cell(const char* format, double value) {
  char text[60];
  std::snprintf(text, sizeof text, format, value);
  return std::string("<td class=\"n\">") + text + "</td>";
}

std::string victims_cell(const LeagueEntry& e) {
  if (!e.points) return "<td class=\"n\"></td>";
  std::string text = std::to_string(found_victims(*e.points)) + " of " + std::to_string(e.points->victims.size());
  if (e.points->false_alarms > 0) text += ", " + std::to_string(e.points->false_alarms) + " false";
  if (e.reported.from == VictimSource::Symbols) text += ", drawn";
  return "<td class=\"n\">" + text + "</td>";
}

/// Of the entry's section on the page.
std::string anchor(std::size_t index) { return "team-" + std::to_string(index + 1); }

std::string row(const LeagueEntry& e, std::size_t index, const LeaguePictures& pictures, bool with_points,
                bool with_warp) {
  const std::string name = pictures.overlay.empty()
                               ? escape_html(e.team)
                               : "<a href=\"#" + anchor(index) + "\">" + escape_html(e.team) + "</a>";
  std::string html = "<tr><td class=\"n\">" + e.rank_text() + "</td><td>" + name + "</td>";
  if (!e.error.empty())
    return html + "<td class=\"failed\" colspan=\"" +
           std::to_string((with_points ? 6 : 0) + (with_warp ? 1 : 0) + figures_with(kRanking).size() + 2) + "\">" +
           escape_html(e.error) + "</td></tr>\n";
  const Evidence evidence = e.evidence();
  for (const Figure* figure : figures_with(kRanking))
    html += "<td class=\"n\">" + e.text_of(*figure, evidence) + "</td>";
  if (with_warp) html += e.score.warped ? cell("%.3f", e.score.warped_score) : "<td></td>";
  if (with_points) {
    const double quality = e.points ? e.points->quality : 0.0;
    const double location = e.points ? e.points->location : 0.0;
    html += cell("%.1f", e.total()) + cell("%.1f", quality) + cell("%.1f", location) +
            cell("%.1f", e.points ? e.points->fine : 0.0) + cell("%.1f", e.judge) + victims_cell(e);
  }
  html += "<td class=\"why\">" + escape_html(e.note()) + "</td><td>" +
          (pictures.tool.empty() ? "" : "<a href=\"" + escape_html(pictures.tool) + "\">lay by hand</a>") + "</td>";
  return html + "</tr>\n";
}

/// What eq. (8) makes of the map, where that was asked for.
std::string warp_text(const LeagueEntry& e) {
  if (!e.score.warped) return "";
  char text[160];
  std::snprintf(text, sizeof text, "<p>After warp %.3f, distorted by %.3f m, %.3f with penalty.</p>\n",
                e.score.warped_score, e.score.warp_m, e.score.penalised_score);
  std::string html = text;
  if (e.score.broken.found) {
    std::snprintf(text, sizeof text,
                  "<p>Came apart: two parts, %.2f m and %.1f deg apart; %.3f with both in place.</p>\n",
                  e.score.broken.apart_m, rad_to_deg(e.score.broken.turned_rad), e.score.mended_score);
    html += text;
  }
  return html;
}

std::string figure(const LeagueEntry& e, const std::string& picture, const std::string& what) {
  if (picture.empty()) return "";
  const std::string link = escape_html(picture);
  return "<figure class=\"map\"><a href=\"" + link + "\"><img src=\"" + link + "\" alt=\"\"></a><figcaption>" +
         escape_html(e.team) + ": " + what + "</figcaption></figure>\n";
}

/// Links to the teams before and behind that have a section, and to the table.
std::string neighbours(const std::vector<LeagueEntry>& entries, const std::vector<LeaguePictures>& pictures,
                       std::size_t index) {
  std::string html = "<p class=\"note\">";
  for (std::size_t i = index; i-- > 0;) {
    if (pictures[i].overlay.empty()) continue;
    html += "<a href=\"#" + anchor(i) + "\">previous: " + escape_html(entries[i].team) + "</a> &middot; ";
    break;
  }
  html += "<a href=\"#table\">table</a>";
  for (std::size_t i = index + 1; i < entries.size(); ++i) {
    if (pictures[i].overlay.empty()) continue;
    html += " &middot; <a href=\"#" + anchor(i) + "\">next: " + escape_html(entries[i].team) + "</a>";
    break;
  }
  return html + "</p>\n";
}

std::string victim_table(const LeagueEntry& e) {
  if (!e.points || e.points->victims.empty()) return "";
  std::string html =
      "<table><tr><th>victim</th><th>reported as</th><th class=\"n\">error [m]</th><th class=\"n\">map quality</th>"
      "<th class=\"n\">location</th></tr>\n";
  for (const auto& v : e.points->victims) {
    html += "<tr><td>" + escape_html(true_victim_name(v.victim)) + "</td>";
    html += v.found ? "<td>" + escape_html(v.report) + "</td>" + cell("%.2f", v.error_m) + cell("%.1f", v.quality) +
                          cell("%.1f", v.location)
                    : "<td class=\"none\" colspan=\"4\">missed</td>";
    html += "</tr>\n";
  }
  return html + "</table>\n";
}

}  // namespace

std::string league_page(const std::string& truth, bool with_points, const std::vector<LeagueEntry>& entries,
                        const std::vector<LeaguePictures>& pictures, const std::string& left_out) {
  std::string body =
      "<style>figure.map { width: 26em; } td a { white-space: nowrap; } #table { font-size: .85em; } #table th, "
      "#table td { padding: .2em .4em; } #table td:nth-child(2) { max-width: 16em; overflow-wrap: anywhere; } "
      "td.why { min-width: 16em; }</style>\n<h1>League</h1>\n<p "
      "class=\"note\">" +
      std::to_string(entries.size()) + " maps against " + escape_html(truth) +
      ". Ranked by score (to 0.001), then by points (to 0.1); equal maps share a rank. Score: lines "
      "of sight that are right beyond chance; overlap = min(precision, recall) of the walls.</p>\n<table "
      "id=\"table\">\n<tr><th "
      "class=\"n\">rank</th><th>team</th>";
  for (const Figure* figure : figures_with(kRanking)) body += "<th class=\"n\">" + escape_html(figure->label) + "</th>";
  const bool with_warp =
      std::any_of(entries.begin(), entries.end(), [](const LeagueEntry& e) { return e.score.warped; });
  if (with_warp) body += "<th class=\"n\">after warp</th>";
  if (with_points)
    body +=
        "<th class=\"n\">points</th><th class=\"n\">map quality</th><th class=\"n\">location</th><th "
        "class=\"n\">fine</th>"
        "<th class=\"n\">judge</th><th class=\"n\">victims</th>";
  body += "<th>note</th><th></th></tr>\n";
  for (std::size_t i = 0; i < entries.size(); ++i) body += row(entries[i], i, pictures[i], with_points, with_warp);
  body += "</table>\n";
  if (!left_out.empty()) body += "<p class=\"note\">No team's maps: " + escape_html(left_out) + "</p>\n";
  for (std::size_t i = 0; i < entries.size(); ++i) {
    if (pictures[i].overlay.empty()) continue;
    body += "<h2 id=\"" + anchor(i) + "\">" + (entries[i].rank > 0 ? entries[i].rank_text() + ". " : "") +
            escape_html(entries[i].team) + "</h2>\n" + neighbours(entries, pictures, i);
    body += figure(entries[i], pictures[i].overlay,
                   entries[i].score.aligned               ? "laid over the truth"
                   : entries[i].score.by != AlignBy::Auto ? "best pose, not trusted"
                                                          : "beside the truth: no pose was found") +
            figure(entries[i], pictures[i].error, "distance of its walls") +
            figure(entries[i], pictures[i].sight, "its lines of sight") + warp_text(entries[i]) +
            victim_table(entries[i]);
  }
  return html_page("League", body);
}

}  // namespace rubble::scoring
