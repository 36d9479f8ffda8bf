#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace rubble {

/// An 8-bit RGB raster, row 0 at the top, three bytes a pixel.
struct RgbImage {
  int width = 0;
  int height = 0;
  std::vector<std::uint8_t> rgb;
  std::vector<std::uint8_t> alpha;  ///< opacity of each pixel, already worked into `rgb`; empty: all opaque
  std::uint32_t white = 0;          ///< deep sample taken for white because it is the brightest; 0: a usual one
  RgbImage() = default;
  RgbImage(int w, int h) : width(w), height(h), rgb(static_cast<std::size_t>(w) * static_cast<std::size_t>(h) * 3u) {}
  std::size_t index(int x, int y) const {
    return static_cast<std::size_t>(y) * static_cast<std::size_t>(width) + static_cast<std::size_t>(x);
  }
  std::uint8_t* pixel(int x, int y) { return rgb.data() + 3u * index(x, y); }
  const std::uint8_t* pixel(int x, int y) const { return const_cast<RgbImage*>(this)->pixel(x, y); }
};

/// Affine map from pixel corners to model coordinates, as in a world file:
/// X = a * column + b * row + c,  Y = d * column + e * row + f  (PixelIsArea: (0, 0) is the upper-left corner).
struct PixelToModel {
  double a = 1.0, b = 0.0, c = 0.0;
  double d = 0.0, e = -1.0, f = 0.0;
};

/// Where the map frame's origin lies on Earth, and which way its x axis points.
struct GeoAnchor {
  double latitude_deg = 0.0;
  double longitude_deg = 0.0;
  double heading_deg = 0.0;  ///< of the map's x axis, clockwise from north
};

struct GeoTiff {
  RgbImage image;
  std::optional<PixelToModel> transform;  ///< absent: the file says nothing about scale
  int epsg = 0;                           ///< projected CRS; 0: local metric frame
  std::string description;                ///< TIFF ImageDescription
};

/// The transform of an image whose pixels lie on a metric map grid: x0, y1 = west and north edge, in a local frame or,
/// with an anchor, in UTM through GeographicLib (heading minus convergence, scale k). Sets `epsg`.
PixelToModel georeference(double x0, double y1, double resolution, const std::optional<GeoAnchor>& anchor, int& epsg);

/// Writes a deflate-compressed RGB GeoTIFF with real tags (ModelPixelScale + ModelTiepoint, or ModelTransformation when
/// rotated), PixelIsArea, resolution in metres. No time stamp: same input, same bytes. Throws RunError.
void write_geotiff(const std::string& path, const GeoTiff& tiff);

using Rgb = std::array<std::uint8_t, 3>;

/// Reads any strip, tiled, compressed, 1..16-bit, grey, palette or RGB(A) TIFF with or without GeoTIFF tags.
/// `behind`: what transparent pixels let through. Throws InputError: missing, truncated, not a TIFF, over 20,000 pixels
/// a side or 10^8 in all.
GeoTiff read_geotiff(const std::string& path, const Rgb& behind = {255, 255, 255});

/// The six lines of a world file: a, d, b, e and the centre of the upper-left pixel.
void write_world_file(const std::string& path, const PixelToModel& transform);
/// Throws InputError with file and line.
PixelToModel read_world_file(const std::string& path);

}  // namespace rubble
