#pragma once

#include <string>
#include <vector>

#include "scoring/league/league.h"

namespace rubble::scoring {

/// What one team's row links to, relative to the page; empty: nothing.
struct LeaguePictures {
  std::string overlay;
  std::string error;
  std::string sight;
  std::string tool;
};

/// The ranking as an HTML page with the overlays; `pictures` in the order of `entries`; `left_out`: images that were
/// taken for no team's map.
std::string league_page(const std::string& truth, bool with_points, const std::vector<LeagueEntry>& entries,
                        const std::vector<LeaguePictures>& pictures, const std::string& left_out);

}  // namespace rubble::scoring
