#include "scoring/league/league_page.h"

#include <algorithm>
#include <cstdio>

#include "base/text/html.h"

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

std::string row(const LeagueEntry& e, const LeaguePictures& pictures, bool with_points) {
  std::string html = "<tr><td class=\"n\">" + std::to_string(e.rank) + "</td><td>" + escape_html(e.team) + "</td>";
  if (!e.error.empty())
    return html + "<td class=\"failed\" colspan=\"" +
           std::to_string((with_points ? 6 : 0) + figures_with(kRanking).size() + 2) + "\">" + escape_html(e.error) +
           "</td></tr>\n";
  if (with_points) {
    const double quality = e.points ? e.points->quality : 0.0;
    const double location = e.points ? e.points->location : 0.0;
    html += cell("%.1f", e.total()) + cell("%.1f", quality) + cell("%.1f", location) +
            cell("%.1f", e.points ? e.points->fine : 0.0) + cell("%.1f", e.judge) + victims_cell(e);
  }
  const Evidence evidence = e.evidence();
  for (const Figure* figure : figures_with(kRanking))
    html += "<td class=\"n\">" + text_of(*figure, figure->get(evidence)) + "</td>";
  html += "<td>" + escape_html(e.note()) + "</td><td>" +
          (pictures.tool.empty() ? "" : "<a href=\"" + escape_html(pictures.tool) + "\">lay by hand</a>") + "</td>";
  return html + "</tr>\n";
}

/// What eq. (8) makes of the map, where that was asked for.
std::string warp_text(const LeagueEntry& e) {
  if (!e.score.warped) return "";
  char text[120];
  std::snprintf(text, sizeof text, "<p>After warp %.3f, distorted by %.3f m, %.3f with penalty.</p>\n",
                e.score.warped_score, e.score.warp_m, e.score.penalised_score);
  return text;
}

std::string figure(const LeagueEntry& e, const std::string& picture, const std::string& what) {
  if (picture.empty()) return "";
  const std::string link = escape_html(picture);
  return "<figure class=\"map\"><a href=\"" + link + "\"><img src=\"" + link + "\" alt=\"\"></a><figcaption>" +
         escape_html(e.team) + ": " + what + "</figcaption></figure>\n";
}

std::string victim_table(const LeagueEntry& e) {
  if (!e.points || e.points->victims.empty()) return "";
  std::string html =
      "<table><tr><th>victim</th><th class=\"n\">error [m]</th><th class=\"n\">map quality</th>"
      "<th class=\"n\">location</th></tr>\n";
  for (const auto& v : e.points->victims) {
    html += "<tr><td>" + escape_html(v.victim) + "</td>";
    html += v.found ? cell("%.2f", v.error_m) + cell("%.1f", v.quality) + cell("%.1f", v.location)
                    : "<td class=\"none\" colspan=\"3\">not found</td>";
    html += "</tr>\n";
  }
  return html + "</table>\n";
}

}  // namespace

std::string league_page(const std::string& truth, bool with_points, const std::vector<LeagueEntry>& entries,
                        const std::vector<LeaguePictures>& pictures, const std::string& left_out) {
  std::string body =
      "<style>figure.map { width: 26em; } td a, td:nth-child(2) { white-space: nowrap; }</style>\n<h1>League</h1>\n<p "
      "class=\"note\">" +
      std::to_string(entries.size()) + " maps against " + escape_html(truth) +
      ". Ranked by points (to 0.1), then by score (to 0.001); equal maps share a rank. Score: lines "
      "of sight that are right beyond chance; overlap = min(precision, recall) of the walls.</p>\n<table>\n<tr><th "
      "class=\"n\">rank</th><th>team</th>";
  if (with_points)
    body +=
        "<th class=\"n\">points</th><th class=\"n\">map quality</th><th class=\"n\">location</th><th "
        "class=\"n\">fine</th>"
        "<th class=\"n\">judge</th><th class=\"n\">victims</th>";
  for (const Figure* figure : figures_with(kRanking)) body += "<th class=\"n\">" + escape_html(figure->label) + "</th>";
  body += "<th>note</th><th></th></tr>\n";
  for (std::size_t i = 0; i < entries.size(); ++i) body += row(entries[i], pictures[i], with_points);
  body += "</table>\n";
  if (!left_out.empty()) body += "<p class=\"note\">No team's maps: " + escape_html(left_out) + "</p>\n";
  for (std::size_t i = 0; i < entries.size(); ++i) {
    if (pictures[i].overlay.empty()) continue;
    body += "<h2>" + std::to_string(entries[i].rank) + ". " + escape_html(entries[i].team) + "</h2>\n";
    body += figure(entries[i], pictures[i].overlay,
                   entries[i].score.aligned ? "laid over the truth" : "best pose, not trusted") +
            figure(entries[i], pictures[i].error, "distance of its walls") + warp_text(entries[i]) +
            victim_table(entries[i]);
  }
  return html_page("League", body);
}

}  // namespace rubble::scoring
