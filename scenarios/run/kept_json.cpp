#include "scenarios/run/kept_json.h"

#include <nlohmann/json.hpp>
#include <utility>

namespace rubble::scenarios {

using nlohmann::ordered_json;

KeptJson::KeptJson() : json_(std::make_unique<ordered_json>()) {}
KeptJson::KeptJson(const ordered_json& json) : json_(std::make_unique<ordered_json>(json)) {}
KeptJson::KeptJson(const KeptJson& other) : KeptJson(*other) {}
KeptJson::KeptJson(KeptJson&& other) noexcept = default;
KeptJson& KeptJson::operator=(KeptJson other) noexcept {
  std::swap(json_, other.json_);
  return *this;
}
KeptJson::~KeptJson() = default;

ordered_json& KeptJson::operator[](const std::string& key) { return (*json_)[key]; }

}  // namespace rubble::scenarios
