#include "scenarios/evidence/baseline.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <nlohmann/json.hpp>
#include <set>

#include "base/error.h"
#include "base/text/json_size.h"
#include "base/text/text_file.h"
#include "scenarios/batch/score_version.h"
#include "scenarios/evidence/statistics.h"
#include "scoring/scorecard.h"

namespace rubble::scenarios {
namespace {

using nlohmann::ordered_json;

using GroupKey = std::pair<std::string, std::string>;  // scenario, configuration

std::map<GroupKey, std::vector<const RunRecord*>> grouped(const std::vector<RunRecord>& runs) {
  std::map<GroupKey, std::vector<const RunRecord*>> groups;
  for (const auto& run : runs) groups[{run.scenario, run.configuration}].push_back(&run);
  return groups;
}

std::size_t failed_runs(const std::vector<const RunRecord*>& runs) {
  return static_cast<std::size_t>(std::count_if(runs.begin(), runs.end(), [](const auto* run) { return !run->ok(); }));
}

std::vector<std::uint64_t> seeds_of(const std::vector<const RunRecord*>& runs) {
  std::vector<std::uint64_t> seeds;
  for (const RunRecord* run : runs) seeds.push_back(run->seed);
  std::sort(seeds.begin(), seeds.end());
  return seeds;
}

/// Rounded up, so that a file made to be read does not carry 17 digits.
double rounded_tolerance(double value) { return std::ceil(value * 1e4) / 1e4; }

std::string name_of(const std::string& scenario, const std::string& configuration) {
  return scenario + " / " + configuration;
}

const Metric& judged_metric(const std::string& group, const std::string& key) {
  const auto& known = judged_metrics();
  const auto metric = std::find_if(known.begin(), known.end(), [&](const Metric& m) { return m.key == key; });
  if (metric != known.end()) return *metric;
  throw InputError("baseline of " + group + ": '" + key +
                   "' is no metric that can be judged; remove it or save the baseline again");
}

CheckCase check_metric(const std::string& group, const BaselineMetric& wanted,
                       const std::vector<const RunRecord*>& runs) {
  const Metric& metric = judged_metric(group, wanted.key);
  CheckCase c{group, heading(metric), true, ""};
  const std::vector<double> values = numbers(runs, wanted.key);
  if (values.empty()) {
    c.passed = false;
    c.detail = "no run has it any more; the baseline is " + figure(wanted.median);
    return c;
  }
  const auto worse_by = [&](double before, double now) {
    return metric.better == Better::Higher ? before - now : now - before;
  };
  const double now = median(values);
  const double mean_now = mean(values);
  const std::size_t missing = runs.size() - values.size();
  c.passed = worse_by(wanted.median, now) <= wanted.tolerance &&
             worse_by(wanted.mean, mean_now) <= wanted.mean_tolerance && missing <= wanted.missing;
  c.detail = "median " + figure(now) + ", baseline " + figure(wanted.median) + ", tolerance " +
             figure(wanted.tolerance) + "; mean " + figure(mean_now) + ", baseline " + figure(wanted.mean) +
             ", tolerance " + figure(wanted.mean_tolerance);
  if (missing > 0)
    c.detail += "; " + std::to_string(missing) + " runs lack it, baseline " + std::to_string(wanted.missing);
  return c;
}

CheckCase check_completed(const std::string& group, std::size_t before, const std::vector<const RunRecord*>& runs) {
  const std::size_t failed = failed_runs(runs);
  CheckCase c{group, "runs completed", failed <= before, ""};
  c.detail = std::to_string(failed) + " of " + std::to_string(runs.size()) + " runs failed, baseline " +
             std::to_string(before);
  for (const RunRecord* run : runs)
    if (!run->ok() && !c.passed)
      c.detail += "; seed " + std::to_string(run->seed) + ": " + name_of(run->status) + " " + run->error;
  return c;
}

CheckCase check_expectations(const std::string& group, const std::vector<const RunRecord*>& runs) {
  CheckCase c{group, "expectations", true, "all met"};
  std::string broken;
  for (const RunRecord* run : runs)
    for (const auto& line : run->broken)
      broken += (broken.empty() ? "seed " : "; seed ") + std::to_string(run->seed) + ": " + line;
  if (broken.empty()) return c;
  return {group, "expectations", false, broken};
}

bool judges_scores(const Baseline& baseline) {
  for (const auto& group : baseline.groups)
    for (const auto& metric : group.metrics)
      if (metric.key == "score") return true;
  return false;
}

/// Of whole numbers from 0; the JSON library would take others for one of those.
std::uint64_t count_of(const ordered_json& json, const std::string& path) {
  if (!json.is_number_unsigned())
    throw InputError(path + ": seeds, 'failed' and 'missing' must be whole numbers from 0; correct them");
  return json.get<std::uint64_t>();
}

std::vector<std::uint64_t> seeds_in(const ordered_json& json, const std::string& path) {
  if (!json.is_array()) throw InputError(path + ": 'seeds' must be a list; correct it");
  std::vector<std::uint64_t> seeds;
  for (const auto& seed : json) seeds.push_back(count_of(seed, path));
  return seeds;
}

/// A misspelt key must not quietly judge by something else.
void allow_only(const ordered_json& json, const std::set<std::string>& keys, const std::string& path) {
  for (const auto& entry : json.items())
    if (keys.count(entry.key()) == 0) throw InputError(path + ": unknown key '" + entry.key() + "'; remove it");
}

std::string escaped_xml(const std::string& text) {
  std::string out;
  for (const char c : text) {
    if (c == '&') {
      out += "&amp;";
    } else if (c == '<') {
      out += "&lt;";
    } else if (c == '>') {
      out += "&gt;";
    } else if (c == '"') {
      out += "&quot;";
    } else if (static_cast<unsigned char>(c) >= 0x20) {  // XML 1.0 has no form for control characters
      out += c;
    } else {
      out += ' ';
    }
  }
  return out;
}

std::string escaped_github(const std::string& text, bool property) {
  std::string out;
  for (const char c : text) {
    if (c == '%') {
      out += "%25";
    } else if (c == '\n') {
      out += "%0A";
    } else if (c == '\r') {
      out += "%0D";
    } else if (property && c == ':') {
      out += "%3A";
    } else if (property && c == ',') {
      out += "%2C";
    } else {
      out += c;
    }
  }
  return out;
}

}  // namespace

Baseline make_baseline(const std::string& sweep, const std::vector<RunRecord>& runs) {
  Baseline baseline;
  baseline.sweep = sweep;
  if (!runs.empty()) baseline.code = runs.front().code;
  baseline.score_version = score_version_of(runs, sweep).value_or(scoring::kScoreVersion);
  for (const auto& [key, members] : grouped(runs)) {
    BaselineGroup group{key.first, key.second, seeds_of(members), failed_runs(members), {}};
    for (const Metric& metric : judged_metrics()) {
      const std::vector<double> values = numbers(members, metric.key);
      if (values.empty() || metric.key == "completed") continue;
      const double error = 1.2533 * robust_deviation(values) / std::sqrt(static_cast<double>(values.size()));
      const double n = static_cast<double>(values.size());
      const double one_run = metric.floor > 0.0 ? metric.floor : 1.5 / n;
      const double mean_error = standard_deviation(values) / std::sqrt(n);
      group.metrics.push_back({metric.key, median(values), std::max(metric.floor, rounded_tolerance(2.0 * error)),
                               mean(values), std::max(one_run, rounded_tolerance(3.0 * mean_error)),
                               members.size() - values.size()});
    }
    baseline.groups.push_back(std::move(group));
  }
  return baseline;
}

void save_baseline(const Baseline& baseline, const std::string& path) {
  ordered_json json{{"sweep", baseline.sweep},
                    {"code", baseline.code},
                    {"score_version", baseline.score_version},
                    {"groups", ordered_json::array()}};
  for (const auto& group : baseline.groups) {
    ordered_json metrics = ordered_json::object();
    for (const auto& m : group.metrics)
      metrics[m.key] = {{"median", m.median},
                        {"tolerance", m.tolerance},
                        {"mean", m.mean},
                        {"mean_tolerance", m.mean_tolerance},
                        {"missing", m.missing}};
    json["groups"].push_back({{"scenario", group.scenario},
                              {"config", group.configuration},
                              {"seeds", group.seeds},
                              {"failed", group.failed},
                              {"metrics", metrics}});
  }
  write_text_file(path, json.dump(2) + "\n");
}

Baseline load_baseline(const std::string& path) {
  const std::string text = read_text_file(path);
  if (!is_modest_json(text))
    throw InputError(path +
                     ": is no baseline (64 levels, 1000 keys an object and 10 million values at most); make one with "
                     "'rubble batch SWEEP --save-baseline FILE'");
  try {
    const ordered_json json = ordered_json::parse(text);
    allow_only(json, {"sweep", "code", "score_version", "groups"}, path);
    Baseline baseline;
    baseline.sweep = json.at("sweep");
    baseline.code = json.at("code");
    baseline.score_version = json.value("score_version", 1);
    for (const auto& g : json.at("groups")) {
      allow_only(g, {"scenario", "config", "seeds", "failed", "metrics"}, path);
      BaselineGroup group{
          g.at("scenario"), g.at("config"), seeds_in(g.at("seeds"), path), count_of(g.at("failed"), path), {}};
      for (const auto& [key, m] : g.at("metrics").items()) {
        allow_only(m, {"median", "tolerance", "mean", "mean_tolerance", "missing"}, path);
        const BaselineMetric metric{key,          m.at("median"),         m.at("tolerance"),
                                    m.at("mean"), m.at("mean_tolerance"), count_of(m.at("missing"), path)};
        if (!(metric.tolerance >= 0.0 && metric.mean_tolerance >= 0.0))
          throw InputError(path + ": the tolerances of '" + key + "' must be 0 or more");
        group.metrics.push_back(metric);
      }
      baseline.groups.push_back(std::move(group));
    }
    return baseline;
  } catch (const ordered_json::parse_error& error) {
    throw InputError(path + ": is no baseline (no JSON from byte " + std::to_string(error.byte) +
                     " on); make one with 'rubble batch SWEEP --save-baseline FILE'");
  } catch (const ordered_json::exception&) {
    throw InputError(path +
                     ": is no baseline (a value is missing or of another kind); make one with 'rubble batch SWEEP "
                     "--save-baseline FILE'");
  }
}

void require_fit(const Baseline& baseline, const std::vector<RunRecord>& runs) {
  const std::string remedy = "; save the baseline again with 'rubble batch SWEEP --save-baseline FILE'";
  const auto groups = grouped(runs);
  std::set<GroupKey> known;
  for (const auto& group : baseline.groups) {
    const std::string name = name_of(group.scenario, group.configuration);
    known.insert({group.scenario, group.configuration});
    const auto members = groups.find({group.scenario, group.configuration});
    if (members == groups.end()) throw InputError("baseline: has '" + name + "', which the sweep has not" + remedy);
    auto seeds = group.seeds;
    std::sort(seeds.begin(), seeds.end());
    if (seeds != seeds_of(members->second))
      throw InputError("baseline: was made with other seeds of '" + name + "' than the sweep has" + remedy);
    for (const auto& metric : group.metrics) judged_metric(name, metric.key);
  }
  for (const auto& [key, members] : groups)
    if (known.count(key) == 0) throw InputError("baseline: lacks '" + name_of(key.first, key.second) + "'" + remedy);
  const int judged_by = score_version_of(runs, baseline.sweep).value_or(scoring::kScoreVersion);
  if (judges_scores(baseline) && baseline.score_version != judged_by)
    throw InputError("baseline: has a score of version " + std::to_string(baseline.score_version) +
                     ", this program's is of version " + std::to_string(judged_by) + ": they cannot be compared" +
                     remedy);
}

std::vector<CheckCase> check_runs(const Baseline& baseline, const std::vector<RunRecord>& runs) {
  require_fit(baseline, runs);
  const auto groups = grouped(runs);
  std::vector<CheckCase> cases;
  for (const auto& group : baseline.groups) {
    const std::string name = name_of(group.scenario, group.configuration);
    const auto& members = groups.at({group.scenario, group.configuration});
    cases.push_back(check_completed(name, group.failed, members));
    cases.push_back(check_expectations(name, members));
    for (const auto& metric : group.metrics) cases.push_back(check_metric(name, metric, members));
  }
  return cases;
}

std::size_t failures(const std::vector<CheckCase>& cases) {
  return static_cast<std::size_t>(std::count_if(cases.begin(), cases.end(), [](const auto& c) { return !c.passed; }));
}

std::string to_junit(const std::vector<CheckCase>& cases, const std::string& suite) {
  std::map<std::string, std::vector<const CheckCase*>> suites;
  for (const auto& c : cases) suites[c.group].push_back(&c);
  std::string xml = "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n<testsuites name=\"" + escaped_xml(suite) +
                    "\" tests=\"" + std::to_string(cases.size()) + "\" failures=\"" + std::to_string(failures(cases)) +
                    "\">\n";
  for (const auto& [group, members] : suites) {
    const auto failed = std::count_if(members.begin(), members.end(), [](const auto* c) { return !c->passed; });
    xml += "  <testsuite name=\"" + escaped_xml(group) + "\" tests=\"" + std::to_string(members.size()) +
           "\" failures=\"" + std::to_string(failed) + "\" errors=\"0\" skipped=\"0\">\n";
    for (const CheckCase* c : members) {
      xml += "    <testcase classname=\"" + escaped_xml(suite + "." + group) + "\" name=\"" + escaped_xml(c->name) +
             "\" time=\"0\"";
      xml += c->passed ? "/>\n" : ">\n      <failure message=\"" + escaped_xml(c->detail) + "\"/>\n    </testcase>\n";
    }
    xml += "  </testsuite>\n";
  }
  return xml + "</testsuites>\n";
}

std::string to_github_annotations(const std::vector<CheckCase>& cases) {
  std::string out;
  for (const auto& c : cases)
    if (!c.passed)
      out += "::error title=" + escaped_github("Regression: " + c.name, true) +
             "::" + escaped_github(c.group + ": " + c.detail, false) + "\n";
  return out;
}

std::string to_markdown(const std::vector<CheckCase>& cases, const std::string& title) {
  std::string out = "## " + title + "\n\n" + std::to_string(cases.size() - failures(cases)) + " of " +
                    std::to_string(cases.size()) + " checks passed\n\n| | group | check | found |\n|---|---|---|---|\n";
  for (const bool passed : {false, true})
    for (const auto& c : cases) {
      if (c.passed != passed) continue;
      std::string detail = c.detail;
      for (std::size_t bar = 0; (bar = detail.find('|', bar)) != std::string::npos; bar += 2) detail.insert(bar, "\\");
      out += std::string(c.passed ? "| ok | " : "| **FAILED** | ") + c.group + " | " + c.name + " | " + detail + " |\n";
    }
  return out;
}

}  // namespace rubble::scenarios
