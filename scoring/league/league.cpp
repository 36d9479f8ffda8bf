#include "scoring/league/league.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <set>
#include <sstream>
#include <tuple>
#include <utility>

#include "base/error.h"
#include "base/text/csv.h"
#include "base/text/number_text.h"
#include "base/text/text_file.h"

namespace rubble::scoring {
namespace {

/// What decides, as the table prints it: judged, thousandths of score, tenths of points.
std::tuple<bool, long, long> merit(const LeagueEntry& entry) {
  if (!entry.error.empty()) return {false, 0, 0};
  return {true, std::lround(1000.0 * entry.score.score), std::lround(10.0 * entry.total())};
}

std::string number(const char* format, double value) {
  char text[40];
  std::snprintf(text, sizeof text, format, value);
  return text;
}

}  // namespace

void rank_league(std::vector<LeagueEntry>& entries) {
  std::sort(entries.begin(), entries.end(), [](const LeagueEntry& a, const LeagueEntry& b) {
    if (merit(a) != merit(b)) return merit(a) > merit(b);
    return std::tie(a.team, a.file) < std::tie(b.team, b.file);
  });
  for (std::size_t i = 0; i < entries.size(); ++i)
    entries[i].rank = !entries[i].error.empty()                             ? 0
                      : i > 0 && merit(entries[i]) == merit(entries[i - 1]) ? entries[i - 1].rank
                                                                            : static_cast<int>(i) + 1;
}

std::string LeagueEntry::rank_text() const { return rank == 0 ? "-" : std::to_string(rank); }

std::string LeagueEntry::text_of(const Figure& figure, const Evidence& of_this) const {
  return !score.aligned && figure.is(kPlaced) ? "" : scoring::text_of(figure, figure.get(of_this));
}

Evidence LeagueEntry::evidence() const {
  Evidence out;
  if (!error.empty()) return out;
  out.score = score;
  out.victims = victim_figures(reported, points);
  return out;
}

std::string league_csv(const std::vector<LeagueEntry>& entries) {
  std::vector<std::string> header = {"rank", "team", "points", "judge"};
  for (const Figure* figure : figures_with(kLeague)) header.push_back(figure->key);
  header.insert(header.end(), {"file", "note"});
  std::string out = csv_line(header) + "\n";
  for (const LeagueEntry& e : entries) {
    const bool judged = e.error.empty();
    std::vector<std::string> fields = {judged ? std::to_string(e.rank) : "", e.team,
                                       judged ? number("%.1f", e.total()) : "", judged ? number("%.1f", e.judge) : ""};
    const Evidence evidence = e.evidence();
    for (const Figure* figure : figures_with(kLeague)) fields.push_back(plain_text_of(*figure, figure->get(evidence)));
    fields.insert(fields.end(), {e.file, e.note()});
    out += csv_line(fields) + "\n";
  }
  return out;
}

std::map<std::string, double> read_judge(const std::string& path) {
  std::map<std::string, double> out;
  std::set<std::pair<std::string, std::string>> seen;  // team and victim
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
    if (header.size() == 3 && !seen.emplace(fields[0], fields[1]).second)
      throw InputError(at(path, line_number, 1,
                          "victim '" + fields[1] + "' of team '" + fields[0] + "' stands here twice; keep one row"));
    out[fields[0]] += *points;
  }
  return out;
}

}  // namespace rubble::scoring
