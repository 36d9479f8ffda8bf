#include "scenarios/evidence/between_scans.h"

namespace rubble::scenarios {

std::optional<std::string> between_scans(const Trajectory& scans, const std::vector<scoring::Relation>& relations,
                                         const std::string& path, const std::string& log) {
  const scoring::RelationsAtScans at_scans = scoring::relations_at_scans(scans, relations);
  if (!at_scans.doubtful()) return std::nullopt;
  return path + ": of " + std::to_string(at_scans.relations) + " relations " + std::to_string(at_scans.between) +
         " name a moment at which " + log +
         " has no scan (within 1 ms), and are judged by poses in between; are both of one log, by one clock?";
}

}  // namespace rubble::scenarios
