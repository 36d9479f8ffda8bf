#include "scoring/league/league.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <sstream>
#include <tuple>

#include "base/error.h"
#include "base/text/number_text.h"
#include "base/text/text_file.h"

namespace rubble::scoring {
namespace {

/// What decides, as the table prints it: judged, tenths of points, thousandths of score.
std::tuple<bool, long, long> merit(const LeagueEntry& entry) {
  if (!entry.error.empty()) return {false, 0, 0};
  return {true, std::lround(10.0 * entry.total()), std::lround(1000.0 * entry.score.score)};
}

std::string number(const char* format, double value) {
  char text[40];
  std::snprintf(text, sizeof text, format, value);
  return text;
}

std::size_t found(const LeaguePoints& points) {
  return static_cast<std::size_t>(
      std::count_if(points.victims.begin(), points.victims.end(), [](const VictimPoints& v) { return v.found; }));
}

}  // namespace

void rank_league(std::vector<LeagueEntry>& entries) {
  std::sort(entries.begin(), entries.end(), [](const LeagueEntry& a, const LeagueEntry& b) {
    if (merit(a) != merit(b)) return merit(a) > merit(b);
    return std::tie(a.team, a.file) < std::tie(b.team, b.file);
  });
  for (std::size_t i = 0; i < entries.size(); ++i)
    entries[i].rank =
        i > 0 && merit(entries[i]) == merit(entries[i - 1]) ? entries[i - 1].rank : static_cast<int>(i) + 1;
}

std::string league_csv(const std::vector<LeagueEntry>& entries) {
  std::string out =
      "rank,team,points,quality,location,judge,score,precision,recall,psi_m,known,aligned,victims_found,victims_total,"
      "false_alarms,victims_from,victim_symbols,align_source,phantom_m,missing_m,ignored_m,warped_score,warp_m,"
      "penalised_score,file,note\n";
  for (const LeagueEntry& e : entries) {
    out += std::to_string(e.rank) + "," + csv_field(e.team) + ",";
    if (!e.error.empty()) {
      out += std::string(22, ',');
    } else {
      const LeaguePoints none;
      const LeaguePoints& points = e.points ? *e.points : none;
      for (const double value : {e.total(), points.quality, points.location, e.judge})
        out += number("%.1f", value) + ",";
      for (const double value : {e.score.score, e.score.precision, e.score.recall, e.score.psi_m, e.score.known})
        out += number("%.3f", value) + ",";
      out += e.score.aligned ? "yes," : "no,";
      out += e.points ? std::to_string(found(points)) + "," + std::to_string(points.victims.size()) + "," +
                            std::to_string(points.false_alarms) + ","
                      : ",,,";
      out += e.victims_from + "," + std::to_string(e.symbols) + "," + e.score.source + ",";
      for (const double value : {e.score.errors.phantom_m, e.score.errors.missing_m, e.score.errors.ignored_m})
        out += number("%.2f", value) + ",";
      out += e.score.warped ? number("%.3f,", e.score.warped_score) + number("%.3f,", e.score.warp_m) +
                                  number("%.3f,", e.score.penalised_score)
                            : ",,,";
    }
    out += csv_field(e.file) + "," + csv_field(e.note()) + "\n";
  }
  return out;
}

std::map<std::string, double> read_judge(const std::string& path) {
  std::map<std::string, double> out;
  std::stringstream lines(read_text_file(path));
  std::vector<std::string> header;
  int line_number = 0;
  for (std::string line; std::getline(lines, line);) {
    ++line_number;
    if (!line.empty() && line.back() == '\r') line.pop_back();
    if (line.empty()) continue;
    const std::vector<std::string> fields = csv_fields(line);
    if (header.empty()) {
      header = fields;
      if (header != std::vector<std::string>{"team", "points"} &&
          header != std::vector<std::string>{"team", "victim", "points"})
        throw InputError(at(path, line_number, 1, "the header must be team,points or team,victim,points"));
      continue;
    }
    const std::optional<double> points = fields.size() == header.size() ? parse_number(fields.back()) : std::nullopt;
    if (!points || *points < 0.0 || (header.size() == 3 && *points > kJudgesMostPerVictim))
      throw InputError(
          at(path, line_number, 1,
             "needs " + std::to_string(header.size()) + " fields with the points last, from 0 (to 30 for a victim)"));
    out[fields[0]] += *points;
  }
  return out;
}

}  // namespace rubble::scoring
