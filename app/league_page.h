#pragma once

#include <string>
#include <vector>

#include "scoring/league.h"

namespace rubble::app {

/// What one team's row links to, relative to the page; empty: nothing.
struct LeaguePictures {
  std::string overlay;
  std::string error;
  std::string tool;
};

/// The ranking as an HTML page with the overlays; `pictures` in the order of `entries`.
std::string league_page(const std::string& truth, bool with_points, const std::vector<scoring::LeagueEntry>& entries,
                        const std::vector<LeaguePictures>& pictures);

}  // namespace rubble::app
