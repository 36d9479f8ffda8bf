#include "scenarios/run/score_json.h"

namespace rubble::scenarios {

void add_map_score(nlohmann::ordered_json& json, const scoring::MapScore& s) {
  json["score"] = s.score;
  json["precision"] = s.precision;
  json["recall"] = s.recall;
  json["psi_m"] = s.psi_m;
  json["aligned"] = s.aligned;
  json["known"] = s.aligned ? nlohmann::ordered_json(s.known) : nlohmann::ordered_json();
  json["psi_literal_m"] = s.psi_literal_m;
  json["psi_occupied_map_m"] = s.psi_occupied_map_m;
  json["psi_occupied_truth_m"] = s.psi_occupied_truth_m;
  json["psi_free_map_m"] = s.psi_free_map_m;
  json["psi_free_truth_m"] = s.psi_free_truth_m;
  json["align_runner_up"] = s.runner_up;
  json["align_x_m"] = s.T_truth_map.x;
  json["align_y_m"] = s.T_truth_map.y;
  json["align_rad"] = s.T_truth_map.phi;
  json["align_note"] = s.note;
}

}  // namespace rubble::scenarios
