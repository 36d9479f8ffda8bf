#include "base/yaml/binder.h"

#include <cmath>

#include "base/angle.h"
#include "base/text/number_text.h"

namespace rubble {

void Binder::degrees(const char* key, double& radians, double low, double high) {
  // Written degrees must read back to the same radians, so the degree value nearest to a round one is kept.
  double deg = rad_to_deg(radians);
  const double round = std::round(deg * 1e6) / 1e6;
  if (deg_to_rad(round) == radians) deg = round;
  for (const double beside : {std::nextafter(deg, -1e9), std::nextafter(deg, 1e9)})
    if (deg_to_rad(deg) != radians && deg_to_rad(beside) == radians) deg = beside;
  const double before = deg;
  number(key, deg, low, high);
  if (deg != before) radians = deg_to_rad(deg);
}

void YamlReader::number(const char* key, double& value, double low, double high) {
  value = map_.number(key, value, low, high);
}

void YamlReader::integer(const char* key, int& value, int low, int high) {
  value = static_cast<int>(map_.integer(key, value, low, high));
}

void YamlReader::boolean(const char* key, bool& value) { value = map_.boolean(key, value); }

void YamlReader::text(const char* key, std::string& value) { value = map_.text(key, value); }

void YamlReader::choice(const char* key, std::string& value, const std::vector<std::string>& choices) {
  value = map_.choice(key, value, choices);
}

void YamlReader::section(const char* key, const std::function<void(Binder&)>& fields) {
  YamlReader inner(map_.map(key));
  fields(inner);
}

void YamlWriter::line(const char* key, const std::string& value) {
  yaml_ += std::string(static_cast<std::size_t>(indent_), ' ') + key + ": " + value + "\n";
}

void YamlWriter::number(const char* key, double& value, double, double) { line(key, number_text(value)); }

void YamlWriter::integer(const char* key, int& value, int, int) { line(key, std::to_string(value)); }

void YamlWriter::boolean(const char* key, bool& value) { line(key, value ? "true" : "false"); }

void YamlWriter::text(const char* key, std::string& value) { line(key, yaml_quoted(value)); }

void YamlWriter::choice(const char* key, std::string& value, const std::vector<std::string>&) { line(key, value); }

void YamlWriter::section(const char* key, const std::function<void(Binder&)>& fields) {
  YamlWriter inner(indent_ + 2);
  fields(inner);
  yaml_ += std::string(static_cast<std::size_t>(indent_), ' ') + key + ":\n" + inner.yaml();
}

}  // namespace rubble
