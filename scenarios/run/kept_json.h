#pragma once

#include <memory>
#include <nlohmann/json_fwd.hpp>
#include <string>

namespace rubble::scenarios {

/// JSON as a field of a struct: null at first, copied with its owner. Who only passes the struct on need not compile
/// the JSON library, which costs more than all else in most units; who looks inside includes <nlohmann/json.hpp>.
class KeptJson {
 public:
  KeptJson();
  explicit KeptJson(const nlohmann::ordered_json& json);
  KeptJson(const KeptJson& other);
  KeptJson(KeptJson&& other) noexcept;  ///< `other` may then only be assigned to or destroyed
  KeptJson& operator=(KeptJson other) noexcept;
  ~KeptJson();

  nlohmann::ordered_json& operator*() { return *json_; }
  const nlohmann::ordered_json& operator*() const { return *json_; }
  nlohmann::ordered_json* operator->() { return json_.get(); }
  const nlohmann::ordered_json* operator->() const { return json_.get(); }

  /// A member, made when it is not there.
  nlohmann::ordered_json& operator[](const std::string& key);

 private:
  std::unique_ptr<nlohmann::ordered_json> json_;
};

}  // namespace rubble::scenarios
