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

/// Reads victims from CSV. The header tells the form:
/// - `detection,time,type,name,x,y,...`: the league's, behind its preamble; only rows of type victim; x is up in the
///   picture and y to its left;
/// - `name,x,y`: x to the right and y up.
/// Or from an arena file (.yaml). Throws InputError with file and line.
std::vector<Poi> read_pois(const std::string& path);

/// The fields of one line of CSV: commas between, quotes around a field with commas, doubled inside.
std::vector<std::string> csv_fields(const std::string& line);

/// A field as CSV wants it.
std::string csv_field(const std::string& text);

}  // namespace rubble::scoring
