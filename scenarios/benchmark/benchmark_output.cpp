#include "scenarios/benchmark/benchmark_output.h"

#include <algorithm>
#include <cstdio>
#include <nlohmann/json.hpp>

#include "base/text/html.h"
#include "scenarios/run/run.h"

namespace rubble::scenarios {
namespace {

using nlohmann::ordered_json;

/// One table, from which text, page and document are made.
struct Table {
  std::vector<std::string> head;
  std::vector<std::vector<std::string>> rows;
};

std::string number(double value, const char* format = "%.3g") {
  char text[64];
  std::snprintf(text, sizeof text, format, value);
  return text;
}

std::string optional_number(const std::optional<double>& value, const char* format) {
  return value ? number(*value, format) : "";
}

std::string measure_name(BenchmarkMeasure measure) {
  return measure == BenchmarkMeasure::Relations ? "relations" : "aligned";
}

std::string error_of(const BenchmarkResult& result) {
  if (!result.missing.empty()) return "not there: " + result.missing;
  if (!result.failure.empty()) return (result.stopped ? "" : "failed: ") + result.failure;
  return optional_number(result.error_m, "%.4f");
}

/// Of the error, then what the others are of.
std::string goals_of(const BenchmarkCase& what) {
  std::string text = optional_number(what.goal, "%g");
  const auto add = [&](const std::optional<double>& goal, const char* of) {
    if (goal) text += (text.empty() ? "" : ", ") + std::string(of) + " " + number(*goal, "%g");
  };
  if (what.heading_goal) text += (text.empty() ? "" : ", ") + number(*what.heading_goal, "%g") + " deg";
  add(what.worst_goal, "worst");
  add(what.live_goal, "known at the scan");
  add(what.false_loops_goal, "false loops");
  add(what.speed_goal, "scans/s");
  add(what.slow_goal, "99 % ms");
  add(what.worst_time_goal, "worst ms");
  return text;
}

/// "no" says which.
std::string goal_met(const BenchmarkResult& result) {
  const std::string not_judged = result.not_judged.empty() ? "" : "not judged: " + result.not_judged;
  if (!result.goal_met) return not_judged;
  if (*result.goal_met) return "yes";
  std::string text = "no";
  for (const std::string& column : result.goals_missed) text += (text == "no" ? ": " : ", ") + column;
  return text + (not_judged.empty() ? "" : "; " + not_judged);
}

Table results_table(const Benchmark& benchmark) {
  Table table;
  table.head = {"case",      "measure",   "mapper",    "runs",         "error m",  "worst m", "as known at the scan m",
                "deg",       "goals",     "goal met",  "scans/s",      "usual ms", "99 % ms", "worst ms",
                "most work", "finish ms", "memory MB", "loops closed", "removed",  "false",   "doubted"};
  for (const BenchmarkRow& row : benchmark.rows)
    for (const BenchmarkResult& r : row.results) {
      const bool ran = r.missing.empty() && r.failure.empty();
      const auto timed = [&](const std::optional<double>& value, const char* format) {
        return ran ? optional_number(value, format) : std::string();
      };
      table.rows.push_back({row.what.name,
                            measure_name(row.what.measure),
                            r.mapper,
                            ran ? std::to_string(r.runs) : std::string(),
                            error_of(r),
                            optional_number(r.worst_m, "%.4f"),
                            optional_number(r.live_error_m, "%.4f"),
                            optional_number(r.error_deg, "%.3f"),
                            goals_of(row.what),
                            goal_met(r),
                            timed(r.scans_per_second, "%.0f"),
                            timed(r.usual_ms, "%.2f"),
                            timed(r.slow_ms, "%.2f"),
                            timed(r.worst_ms, "%.1f"),
                            timed(r.most_work_ms, "%.1f"),
                            timed(r.finish_ms, "%.0f"),
                            timed(r.peak_mb, "%.0f"),
                            optional_number(r.loops_closed, "%.0f"),
                            optional_number(r.loops_removed, "%.0f"),
                            optional_number(r.loops_false, "%.0f"),
                            optional_number(r.doubted, "%.0f")});
    }
  return table;
}

Table published_table(const Benchmark& benchmark) {
  Table table;
  table.head = {"case", "measure", "by", "error m", "source"};
  for (const BenchmarkRow& row : benchmark.rows)
    for (const PublishedFigure& p : row.what.published)
      table.rows.push_back({row.what.name, measure_name(row.what.measure), p.by, number(p.value, "%.4g"), p.source});
  return table;
}

std::string as_text(const Table& table) {
  std::vector<std::size_t> widths(table.head.size());
  const auto widen = [&](const std::vector<std::string>& row) {
    for (std::size_t k = 0; k < row.size(); ++k) widths[k] = std::max(widths[k], row[k].size());
  };
  widen(table.head);
  for (const auto& row : table.rows) widen(row);
  std::string text;
  const auto add = [&](const std::vector<std::string>& row) {
    std::string line;
    for (std::size_t k = 0; k < row.size(); ++k) line += row[k] + std::string(widths[k] - row[k].size() + 2, ' ');
    line.erase(line.find_last_not_of(' ') + 1);
    text += line + '\n';
  };
  add(table.head);
  for (const auto& row : table.rows) add(row);
  return text;
}

/// `text` where `|` would end a cell and a line break the row.
std::string in_cell(std::string text) {
  std::replace(text.begin(), text.end(), '|', '/');
  std::replace(text.begin(), text.end(), '\n', ' ');
  return text;
}

std::string as_markdown(const Table& table) {
  std::string text;
  const auto add = [&](const std::vector<std::string>& row) {
    text += "|";
    for (const std::string& cell : row) text += " " + in_cell(cell) + " |";
    text += "\n";
  };
  add(table.head);
  add(std::vector<std::string>(table.head.size(), "---"));
  for (const auto& row : table.rows) add(row);
  return text;
}

std::string as_html(const Table& table) {
  std::string text = "<table><thead><tr>";
  for (const std::string& cell : table.head) text += "<th>" + escape_html(cell) + "</th>";
  text += "</tr></thead><tbody>\n";
  for (const auto& row : table.rows) {
    text += "<tr>";
    for (const std::string& cell : row) {
      const char* kind = cell == "yes" ? " class=\"met\"" : cell.rfind("no: ", 0) == 0 ? " class=\"missed\"" : "";
      text += "<td" + std::string(kind) + ">" + escape_html(cell) + "</td>";
    }
    text += "</tr>\n";
  }
  return text + "</tbody></table>\n";
}

constexpr const char* kNote =
    "Error: relations are mean errors between pairs of moments (Kuemmerle et al. 2009), aligned is the RMS error of "
    "the positions after the best rigid alignment with the reference that came with the log or the arena. Of several "
    "runs errors are medians, times, work and memory the largest, loops and doubts the sums, and scans/s is all scans "
    "by all CPU time; a map is doubted by its own mapper; false loops lead more than 0.3 m or 0.2 rad from where the "
    "reference has the robot. Times are CPU time of the mapper alone, of this machine; the most work of a scan is in "
    "millions of units that the mapper counts, the same on every machine.";

/// What was not run, case by case; empty: it was not interrupted.
std::string interruption(const Benchmark& benchmark) {
  if (benchmark.gaps.empty()) return "";
  std::string text = "Interrupted, so these are not run to their end: ", last;
  for (const BenchmarkGap& gap : benchmark.gaps) {
    if (!last.empty()) text += gap.name == last ? ", " : "), ";
    if (gap.name != last) text += gap.name + " (";
    text += gap.mapper;
    if (gap.runs > 0) text += " after " + std::to_string(gap.runs) + " of " + std::to_string(gap.seeds) + " seeds";
    last = gap.name;
  }
  return text + ").";
}

}  // namespace

std::string to_text(const Benchmark& benchmark) {
  std::string text = as_text(results_table(benchmark));
  const Table published = published_table(benchmark);
  if (!published.rows.empty()) text += "\npublished\n" + as_text(published);
  if (!benchmark.gaps.empty()) text += "\n" + interruption(benchmark) + "\n";
  return text;
}

std::string to_json(const Benchmark& benchmark) {
  ordered_json cases = ordered_json::array();
  const auto set = [](ordered_json& json, const char* key, const std::optional<double>& value) {
    json[key] = value ? ordered_json(*value) : ordered_json();
  };
  for (const BenchmarkRow& row : benchmark.rows) {
    ordered_json c = {{"name", row.what.name}, {"measure", measure_name(row.what.measure)}};
    set(c, "goal_m", row.what.goal);
    set(c, "goal_deg", row.what.heading_goal);
    set(c, "live_goal_m", row.what.live_goal);
    set(c, "worst_goal_m", row.what.worst_goal);
    set(c, "false_loops_goal", row.what.false_loops_goal);
    set(c, "scans_per_s_goal", row.what.speed_goal);
    set(c, "ms_99_goal", row.what.slow_goal);
    set(c, "worst_ms_goal", row.what.worst_time_goal);
    c["results"] = ordered_json::array();
    for (const BenchmarkResult& r : row.results) {
      ordered_json j = {{"mapper", r.mapper}};
      if (!r.missing.empty()) j["missing"] = r.missing;
      if (!r.failure.empty()) j["failure"] = r.failure;
      j["runs"] = r.runs;
      set(j, "error_m", r.error_m);
      set(j, "worst_m", r.worst_m);
      set(j, "live_error_m", r.live_error_m);
      set(j, "error_deg", r.error_deg);
      j["goal_met"] = r.goal_met ? ordered_json(*r.goal_met) : ordered_json();
      j["goals_missed"] = r.goals_missed;
      if (!r.doubt.empty()) j["doubt"] = r.doubt;
      if (!r.not_judged.empty()) j["not_judged"] = r.not_judged;
      j["scans"] = r.scans;
      set(j, "scans_per_second", r.scans_per_second);
      set(j, "usual_ms", r.usual_ms);
      set(j, "slow_ms", r.slow_ms);
      set(j, "worst_ms", r.worst_ms);
      set(j, "most_work_ms", r.most_work_ms);
      set(j, "finish_ms", r.finish_ms);
      set(j, "peak_mb", r.peak_mb);
      set(j, "loops_closed", r.loops_closed);
      set(j, "loops_removed", r.loops_removed);
      set(j, "loops_false", r.loops_false);
      set(j, "doubted", r.doubted);
      c["results"].push_back(j);
    }
    c["published"] = ordered_json::array();
    for (const PublishedFigure& p : row.what.published)
      c["published"].push_back({{"by", p.by}, {"source", p.source}, {"error_m", p.value}});
    cases.push_back(c);
  }
  ordered_json gaps = ordered_json::array();
  for (const BenchmarkGap& gap : benchmark.gaps)
    gaps.push_back({{"case", gap.name}, {"mapper", gap.mapper}, {"runs", gap.runs}, {"seeds", gap.seeds}});
  return ordered_json{{"name", benchmark.name},
                      {"about", benchmark.about},
                      {"commit", versions().commit},
                      {"interrupted", !benchmark.gaps.empty()},
                      {"not_run", gaps},
                      {"cases", cases}}
             .dump(2, ' ', true, ordered_json::error_handler_t::replace) +
         "\n";
}

std::string to_html(const Benchmark& benchmark) {
  std::string text =
      "<!doctype html><html lang=\"en\"><head><meta charset=\"utf-8\"><title>" + escape_html(benchmark.name) +
      "</title><style>body{font:15px/1.5 "
      "sans-serif;margin:2em;color:#222;background:#fff}table{border-collapse:collapse;"
      "margin:1em 0}td,th{padding:.25em .6em;border-bottom:1px solid "
      "#ccc;text-align:left}.met{color:#06662f;font-weight:"
      "bold}.missed{color:#a11212;font-weight:bold}</style></head><body>\n<h1>" +
      escape_html(benchmark.name) + "</h1>\n<p>" + escape_html(benchmark.about) + "</p>\n<p>" + kNote + "</p>\n";
  if (!benchmark.gaps.empty()) text += "<p class=\"missed\">" + escape_html(interruption(benchmark)) + "</p>\n";
  text += as_html(results_table(benchmark));
  const Table published = published_table(benchmark);
  if (!published.rows.empty()) text += "<h2>Published</h2>\n" + as_html(published);
  return text + "</body></html>\n";
}

std::string to_markdown(const Benchmark& benchmark) {
  std::string text = "# Benchmark of the mappers: " + benchmark.name + "\n\n";
  if (!benchmark.about.empty()) text += benchmark.about + "\n\n";
  if (!benchmark.gaps.empty()) text += "**" + in_cell(interruption(benchmark)) + "**\n\n";
  text += std::string(kNote) + " Made by `rubble benchmark --markdown` of commit " + versions().commit + ".\n\n" +
          as_markdown(results_table(benchmark));
  const Table published = published_table(benchmark);
  if (!published.rows.empty()) text += "\n## Published\n\n" + as_markdown(published);
  return text;
}

}  // namespace rubble::scenarios
