#pragma once

#include <mrpt/math/TPoint2D.h>

#include <string>
#include <vector>

namespace rubble::scoring {

/// A victim as a file reports it, in the coordinates of the map picture: x to its right, y up [m].
struct Poi {
  std::string name;
  mrpt::math::TPoint2D p_picture;
};

/// Whose coordinates a list of victims counts in.
enum class PoiForm {
  League,  ///< the robot's: where it started, x ahead of it; in the picture as if it had started looking up
  Plain,   ///< the map file's own: x to the right, y up
  Arena    ///< the arena's, which are those of a truth map made from it
};

struct PoiList {
  std::vector<Poi> pois;
  PoiForm form = PoiForm::Plain;
};

/// Reads victims from CSV. The header tells the form:
/// - `detection,time,type,name,x,y,...`: the league's, behind its preamble; only rows of type victim; x is up in the
///   picture and y to its left;
/// - `name,x,y`: x to the right and y up.
/// Or from an arena file (.yaml). A name like "victim_3", as lists without blanks have it, comes back as "victim 3".
/// Throws InputError with file and line.
PoiList read_poi_list(const std::string& path);

}  // namespace rubble::scoring
