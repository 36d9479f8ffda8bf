#include <GeographicLib/Math.hpp>
#include <GeographicLib/UTMUPS.hpp>
#include <cmath>

#include "base/error.h"
#include "base/image/geotiff.h"
#include "base/text/number_text.h"

namespace rubble {

PixelToModel georeference(double x0, double y1, double resolution, const std::optional<GeoAnchor>& anchor, int& epsg) {
  epsg = 0;
  if (!anchor) return {resolution, 0.0, x0, 0.0, -resolution, y1};

  if (!(std::abs(anchor->latitude_deg) <= 90.0) || !std::isfinite(anchor->longitude_deg) ||
      !std::isfinite(anchor->heading_deg))
    throw InputError("geographic anchor: latitude " + number_text(anchor->latitude_deg) + ", longitude " +
                     number_text(anchor->longitude_deg) + "; give degrees, the latitude from -90 to 90");
  int zone = 0;
  bool north = true;
  double easting = 0.0, northing = 0.0, convergence_deg = 0.0, scale = 1.0;
  GeographicLib::UTMUPS::Forward(anchor->latitude_deg, anchor->longitude_deg, zone, north, easting, northing,
                                 convergence_deg, scale);
  epsg = GeographicLib::UTMUPS::EncodeEPSG(zone, north);

  // The convergence is the bearing of grid north, so the heading on the grid is what the heading exceeds it by.
  double sin_heading = 0.0, cos_heading = 1.0;
  GeographicLib::Math::sincosd(anchor->heading_deg - convergence_deg, sin_heading, cos_heading);
  const double s = scale * sin_heading;  // x points to (s, c), y to its left: (-c, s)
  const double c = scale * cos_heading;
  return {resolution * s, resolution * c,  easting + x0 * s - y1 * c,
          resolution * c, -resolution * s, northing + x0 * c + y1 * s};
}

}  // namespace rubble
