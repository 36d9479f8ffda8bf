#include "scenarios/evidence/compare_output.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <nlohmann/json.hpp>

#include "base/text/csv.h"
#include "base/text/html.h"
#include "base/text/number_text.h"

namespace rubble::scenarios {
namespace {

using nlohmann::ordered_json;

std::string interval_text(const Interval& interval) {
  if (!std::isfinite(interval.low)) return "-";
  return "[" + figure(interval.low) + ", " + figure(interval.high) + "]";
}

std::string split_text(const MetricComparison& c) {
  const std::size_t ties = c.pairs - c.better - c.worse;
  return std::to_string(c.better) + " : " + std::to_string(c.worse) +
         (ties ? " (" + std::to_string(ties) + " =)" : "") +
         (c.missing ? " (" + std::to_string(c.missing) + " missing)" : "");
}

std::string signed_figure(double value) { return (value > 0.0 ? "+" : "") + figure(value); }

std::string csv_number(double value) { return std::isfinite(value) ? number_text(value) : ""; }

ordered_json json_number(double value) { return std::isfinite(value) ? ordered_json(value) : ordered_json(); }

std::string unpaired(const Comparison& c) {
  std::string text = std::to_string(c.pairs) + " pairs of runs";
  if (c.only_a) text += ", " + std::to_string(c.only_a) + " runs only in A";
  if (c.only_b) text += ", " + std::to_string(c.only_b) + " runs only in B";
  return text;
}

const char* class_of(Verdict verdict) {
  return verdict == Verdict::Better ? "better" : verdict == Verdict::Worse ? "worse" : "none";
}

/// The interval of the difference as a bar around zero, scaled to the widest of the group is not possible (units
/// differ), so each bar is scaled to itself: what counts is on which side of zero it lies.
std::string interval_bar(const MetricComparison& c) {
  if (!std::isfinite(c.interval.low)) return "";
  const double reach = std::max({std::abs(c.interval.low), std::abs(c.interval.high), 1e-12});
  const auto x = [&](double v) { return 60.0 + 55.0 * v / reach; };
  char svg[600];
  std::snprintf(svg, sizeof svg,
                "<svg width=\"120\" height=\"18\" viewBox=\"0 0 120 18\" role=\"img\" aria-label=\"interval\">"
                "<line x1=\"60\" y1=\"1\" x2=\"60\" y2=\"17\" stroke=\"#8c959f\"/>"
                "<line x1=\"%.1f\" y1=\"9\" x2=\"%.1f\" y2=\"9\" stroke=\"#0969da\" stroke-width=\"3\"/>"
                "<circle cx=\"%.1f\" cy=\"9\" r=\"4\" fill=\"#0969da\"/></svg>",
                x(c.interval.low), x(c.interval.high), x(c.difference));
  return svg;
}

}  // namespace

std::string to_text(const Comparison& comparison) {
  std::string out = "A  " + comparison.a + "\nB  " + comparison.b + "\n" + unpaired(comparison) + "\n";
  for (const auto& group : comparison.groups) {
    char line[400];
    if (comparison.groups.size() > 1) out += "\n" + group.name + "\n";
    std::snprintf(line, sizeof line, "%-33s %9s %9s %10s  %-22s %-16s %7s  %s\n", "", "A", "B", "B - A",
                  "95 % interval", "better : worse", "p", "B is");
    out += line;
    for (const auto& c : group.metrics) {
      std::snprintf(line, sizeof line, "%-33s %9s %9s %10s  %-22s %-16s %7.2g  %s\n", heading(c.metric).c_str(),
                    figure(c.mean_a).c_str(), figure(c.mean_b).c_str(), signed_figure(c.difference).c_str(),
                    interval_text(c.interval).c_str(), split_text(c).c_str(), c.p_sign, text_of(c.verdict));
      out += line;
    }
  }
  return out;
}

std::string to_csv(const Comparison& comparison) {
  std::string out =
      "group,metric,pairs,missing,mean_a,mean_b,difference,interval_low,interval_high,better,worse,p_sign,verdict\r\n";
  for (const auto& group : comparison.groups)
    for (const auto& c : group.metrics)
      out += csv_line({group.name, c.metric.key, std::to_string(c.pairs), std::to_string(c.missing),
                       csv_number(c.mean_a), csv_number(c.mean_b), csv_number(c.difference), csv_number(c.interval.low),
                       csv_number(c.interval.high), std::to_string(c.better), std::to_string(c.worse),
                       csv_number(c.p_sign), text_of(c.verdict)}) +
             "\r\n";
  return out;
}

std::string to_json(const Comparison& comparison) {
  ordered_json json{{"a", comparison.a},           {"b", comparison.b},           {"pairs", comparison.pairs},
                    {"only_a", comparison.only_a}, {"only_b", comparison.only_b}, {"groups", ordered_json::array()}};
  for (const auto& group : comparison.groups) {
    ordered_json metrics;
    for (const auto& c : group.metrics)
      metrics[c.metric.key] = {{"pairs", c.pairs},
                               {"missing", c.missing},
                               {"mean_a", json_number(c.mean_a)},
                               {"mean_b", json_number(c.mean_b)},
                               {"difference", json_number(c.difference)},
                               {"interval_95", {json_number(c.interval.low), json_number(c.interval.high)}},
                               {"better", c.better},
                               {"worse", c.worse},
                               {"p_sign", json_number(c.p_sign)},
                               {"verdict", text_of(c.verdict)}};
    json["groups"].push_back({{"name", group.name}, {"metrics", metrics}});
  }
  return json.dump(2, ' ', false, ordered_json::error_handler_t::replace) + "\n";
}

std::string to_html(const Comparison& comparison) {
  std::string body = "<h1>" + escape_html(comparison.b) + " against " + escape_html(comparison.a) +
                     "</h1>\n<p>A: " + escape_html(comparison.a) + "<br>B: " + escape_html(comparison.b) + "<br>" +
                     unpaired(comparison) + "</p>\n";
  for (const auto& group : comparison.groups) {
    body += "<h2>" + escape_html(group.name) +
            "</h2>\n<table>\n<tr><th>metric</th><th class=n>A</th><th class=n>B</th>"
            "<th class=n>B &minus; A</th><th>95 % interval</th><th></th><th class=n>better : worse</th>"
            "<th class=n>p</th><th>B is</th></tr>\n";
    for (const auto& c : group.metrics)
      body += "<tr><td>" + escape_html(heading(c.metric)) + "</td><td class=n>" + figure(c.mean_a) +
              "</td><td class=n>" + figure(c.mean_b) + "</td><td class=n>" + signed_figure(c.difference) + "</td><td>" +
              interval_text(c.interval) + "</td><td>" + interval_bar(c) + "</td><td class=n>" + split_text(c) +
              "</td><td class=n>" + figure(c.p_sign) + "</td><td class=" + class_of(c.verdict) + ">" +
              text_of(c.verdict) + "</td></tr>\n";
    body += "</table>\n";
  }
  body +=
      "<p class=note>Means over pairs of runs with the same scenario and seed. The interval of the mean difference is "
      "a "
      "bootstrap (10,000 resamples, expanded percentiles); p is the exact two-sided sign test. Better or worse is said "
      "only when the interval leaves out zero and p is at most 0.05; the bar shows on which side of zero the interval "
      "lies.</p>\n";
  return html_page(comparison.b + " against " + comparison.a, body);
}

std::string to_markdown(const Comparison& comparison) {
  std::string out;
  for (const auto& group : comparison.groups) {
    if (comparison.groups.size() > 1) out += "**" + group.name + "**\n\n";
    out +=
        "| metric | A | B | B - A | 95 % interval | better : worse | p | B is |\n|---|---|---|---|---|---|---|---|\n";
    for (const auto& c : group.metrics)
      out += "| " + heading(c.metric) + " | " + figure(c.mean_a) + " | " + figure(c.mean_b) + " | " +
             signed_figure(c.difference) + " | " + interval_text(c.interval) + " | " + split_text(c) + " | " +
             figure(c.p_sign) + " | " + text_of(c.verdict) + " |\n";
    out += "\n";
  }
  return out;
}

}  // namespace rubble::scenarios
