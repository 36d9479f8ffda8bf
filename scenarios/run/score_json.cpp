#include "scenarios/run/score_json.h"

#include <cmath>
#include <cstdint>
#include <nlohmann/json.hpp>
#include <type_traits>

namespace rubble::scenarios {
namespace {

using nlohmann::ordered_json;

ordered_json as_json(const scoring::Value& value) {
  return std::visit(
      [](const auto& v) -> ordered_json {
        if constexpr (std::is_same_v<std::decay_t<decltype(v)>, std::monostate>)
          return nullptr;
        else
          return v;
      },
      value);
}

bool is_known(const scoring::Value& value) { return !std::holds_alternative<std::monostate>(value); }

/// Counts are written without a point.
ordered_json as_json(double value) {
  constexpr double kExact = 9007199254740992.0;  // 2^53: whole numbers below are exact
  if (value == std::floor(value) && std::abs(value) < kExact) return static_cast<std::int64_t>(value);
  return value;
}

ordered_json places_json(const std::vector<scoring::WrongPlace>& places) {
  ordered_json json = ordered_json::array();
  for (const scoring::WrongPlace& place : places)
    json.push_back({{"x_m", place.p_truth.x},
                    {"y_m", place.p_truth.y},
                    {"phantom_m", place.phantom_m},
                    {"missing_m", place.missing_m}});
  return json;
}

}  // namespace

ordered_json score_json(const scoring::Evidence& evidence) {
  ordered_json json;
  for (const scoring::Figure& figure : scoring::figures()) {
    const scoring::Value value = figure.get(evidence);
    if (is_known(value) || !figure.is(scoring::kSpecial)) json[figure.key] = as_json(value);
  }
  json["worst_places"] = evidence.score ? places_json(evidence.score->errors.worst) : ordered_json();
  if (evidence.run)
    for (const auto& [key, value] : evidence.run->own) json[key] = as_json(value);
  return json;
}

ordered_json known_figures(const scoring::Evidence& evidence) {
  ordered_json json;
  for (const scoring::Figure& figure : scoring::figures())
    if (const scoring::Value value = figure.get(evidence); is_known(value)) json[figure.key] = as_json(value);
  return json;
}

scoring::Value value_of(const ordered_json& json) {
  if (json.is_boolean()) return json.get<bool>();
  if (json.is_number_unsigned()) return json.get<std::uint64_t>();
  if (json.is_number()) return json.get<double>();
  if (json.is_string()) return json.get<std::string>();
  return {};
}

ordered_json without_machine(const ordered_json& score) {
  ordered_json kept;
  for (const auto& [key, value] : score.items()) {
    const scoring::Figure* figure = scoring::find_figure(key);
    if (figure == nullptr || !figure->is(scoring::kMachine)) kept[key] = value;
  }
  return kept;
}

}  // namespace rubble::scenarios
