#include "base/image/geotiff.h"

#include <geotiff/geotiff.h>
#include <geotiff/geovalues.h>
#include <geotiff/xtiffio.h>

#include <algorithm>
#include <cassert>
#include <cmath>
#include <memory>
#include <new>

#include "base/error.h"
#include "base/image/rich_tiff.h"
#include "base/image/tiff_file.h"
#include "base/image/tiff_pixels.h"
#include "base/text/text_file.h"

namespace rubble {
namespace {

constexpr unsigned kRowsPerStrip = 64;
constexpr int kUserDefined = 32767;

struct FreeKeys {
  void operator()(GTIF* keys) const { GTIFFree(keys); }
};
using GeoKeys = std::unique_ptr<GTIF, FreeKeys>;

void ignore(GTIF*, int, const char*, ...) {}

/// Value of a number key; 0 when it is not there.
int short_key(GTIF* keys, geokey_t key) {
  unsigned short value = 0;
  return GTIFKeyGet(keys, key, &value, 0, 1) == 1 ? value : 0;
}

bool is_invertible(const PixelToModel& t) {
  const double determinant = t.a * t.e - t.b * t.d;
  return std::isfinite(t.a + t.b + t.c + t.d + t.e + t.f) && std::isfinite(determinant) && determinant != 0.0;
}

std::optional<PixelToModel> read_transform(TIFF* tiff) {
  std::uint16_t count = 0;
  double* m = nullptr;
  if (TIFFGetField(tiff, TIFFTAG_GEOTRANSMATRIX, &count, &m) == 1 && count >= 8)
    return PixelToModel{m[0], m[1], m[3], m[4], m[5], m[7]};
  double* scale = nullptr;
  double* tie = nullptr;
  std::uint16_t ties = 0;
  if (TIFFGetField(tiff, TIFFTAG_GEOPIXELSCALE, &count, &scale) != 1 || count < 2) return std::nullopt;
  if (TIFFGetField(tiff, TIFFTAG_GEOTIEPOINTS, &ties, &tie) != 1 || ties < 6) return std::nullopt;
  return PixelToModel{scale[0], 0.0, tie[3] - scale[0] * tie[0], 0.0, -scale[1], tie[4] + scale[1] * tie[1]};
}

/// Metres in a unit of the model, by ProjLinearUnits.
double metres_per_unit(GTIF* keys, const std::string& path) {
  const int unit = short_key(keys, ProjLinearUnitsGeoKey);
  double size = 0.0;
  switch (unit) {
    case 0:
    case Linear_Meter:
      return 1.0;
    case Linear_Foot:
      return 0.3048;
    case Linear_Foot_US_Survey:
      return 1200.0 / 3937.0;
    case kUserDefined:
      if (GTIFKeyGet(keys, ProjLinearUnitSizeGeoKey, &size, 0, 1) == 1 && std::isfinite(size) && size > 0.0)
        return size;
      break;
    default:
      break;
  }
  throw InputError(path + ": is in linear unit " + std::to_string(unit) +
                   " of EPSG; reproject it to metres (gdalwarp)");
}

void read_georeference(TIFF* tiff, const std::string& path, GeoTiff& result) {
  const GeoKeys keys(GTIFNewEx(tiff, ignore, nullptr));
  result.transform = read_transform(tiff);
  if (!keys || !result.transform) return;
  const int model = short_key(keys.get(), GTModelTypeGeoKey);
  if (model == ModelTypeGeographic)
    throw InputError(path + ": is in degrees; reproject it to metres (gdalwarp -t_srs EPSG:326<zone>)");
  const int code = model == ModelTypeProjected ? short_key(keys.get(), ProjectedCSTypeGeoKey) : 0;
  if (code != kUserDefined) result.epsg = code;

  PixelToModel& t = *result.transform;
  if (short_key(keys.get(), GTRasterTypeGeoKey) == RasterPixelIsPoint) {  // (0, 0) is then the centre of a pixel
    t.c -= 0.5 * (t.a + t.b);
    t.f -= 0.5 * (t.d + t.e);
  }
  const double metres = metres_per_unit(keys.get(), path);
  if (metres != 1.0 && result.epsg != 0)
    throw InputError(path + ": is not in metres; reproject it (gdalwarp -t_srs EPSG:326<zone>)");
  for (double* value : {&t.a, &t.b, &t.c, &t.d, &t.e, &t.f}) *value *= metres;
}

/// Pixels a centimetre along rows and columns, for image programs.
void write_resolution(TIFF* tiff, const PixelToModel& t) {
  TIFFSetField(tiff, TIFFTAG_RESOLUTIONUNIT, RESUNIT_CENTIMETER);
  TIFFSetField(tiff, TIFFTAG_XRESOLUTION, 0.01 / std::hypot(t.a, t.d));
  TIFFSetField(tiff, TIFFTAG_YRESOLUTION, 0.01 / std::hypot(t.b, t.e));
}

void write_georeference(TIFF* tiff, const PixelToModel& t, int epsg) {
  write_resolution(tiff, t);
  if (t.b == 0.0 && t.d == 0.0 && t.a > 0.0 && t.e < 0.0) {
    const double scale[3] = {t.a, -t.e, 0.0};
    const double tie[6] = {0.0, 0.0, 0.0, t.c, t.f, 0.0};
    TIFFSetField(tiff, TIFFTAG_GEOPIXELSCALE, 3, scale);
    TIFFSetField(tiff, TIFFTAG_GEOTIEPOINTS, 6, tie);
  } else {
    const double matrix[16] = {t.a, t.b, 0.0, t.c, t.d, t.e, 0.0, t.f, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 1.0};
    TIFFSetField(tiff, TIFFTAG_GEOTRANSMATRIX, 16, matrix);
  }
  const GeoKeys keys(GTIFNewEx(tiff, ignore, nullptr));
  GTIFKeySet(keys.get(), GTRasterTypeGeoKey, TYPE_SHORT, 1, RasterPixelIsArea);
  GTIFKeySet(keys.get(), ProjLinearUnitsGeoKey, TYPE_SHORT, 1, Linear_Meter);
  if (epsg != 0) {
    GTIFKeySet(keys.get(), GTModelTypeGeoKey, TYPE_SHORT, 1, ModelTypeProjected);
    GTIFKeySet(keys.get(), ProjectedCSTypeGeoKey, TYPE_SHORT, 1, epsg);
  } else {  // GDAL takes a user-defined model with a name and a unit for an engineering CRS
    GTIFKeySet(keys.get(), GTModelTypeGeoKey, TYPE_SHORT, 1, kUserDefined);
    GTIFKeySet(keys.get(), GTCitationGeoKey, TYPE_ASCII, 0, "local metric map frame");
  }
  GTIFWriteKeys(keys.get());
}

void write_pixels(TIFF* tiff, const RgbImage& image, const std::string& path, const TiffComplaint& complaint) {
  const auto row_size = static_cast<std::size_t>(image.width) * 3;
  for (unsigned strip = 0, y = 0; y < static_cast<unsigned>(image.height); ++strip, y += kRowsPerStrip) {
    const std::size_t rows = std::min(kRowsPerStrip, static_cast<unsigned>(image.height) - y);
    auto* const data = const_cast<std::uint8_t*>(image.rgb.data() + y * row_size);  // libtiff's interface; only read
    if (TIFFWriteEncodedStrip(tiff, strip, data, static_cast<tmsize_t>(rows * row_size)) < 0)
      throw RunError(path + ": cannot be written (" + complaint.text + ")");
  }
}

/// Goes to the largest page: others are thumbnails, or what the map was drawn over.
void find_page(TIFF* tiff, TiffComplaint& complaint, RichTiff& result) {
  constexpr int kMostPages = 64;
  std::uint64_t largest = 0;
  result.pages = 0;
  do {
    std::uint32_t width = 0, height = 0;
    TIFFGetField(tiff, TIFFTAG_IMAGEWIDTH, &width);
    TIFFGetField(tiff, TIFFTAG_IMAGELENGTH, &height);
    ++result.pages;
    if (std::uint64_t{width} * height <= largest) continue;
    largest = std::uint64_t{width} * height;
    result.page = result.pages;
  } while (result.pages < kMostPages && TIFFReadDirectory(tiff) == 1);
  if (result.pages > 1) TIFFSetDirectory(tiff, static_cast<tdir_t>(result.page - 1));
  complaint = {};
}

}  // namespace

void write_geotiff(const std::string& path, const GeoTiff& tiff) {
  assert(tiff.image.width > 0 && tiff.image.height > 0);
  assert(tiff.image.rgb.size() ==
         3 * static_cast<std::size_t>(tiff.image.width) * static_cast<std::size_t>(tiff.image.height));
  assert(!tiff.transform || is_invertible(*tiff.transform));
  std::string bytes;
  TiffComplaint complaint;
  {
    const TiffFile file = create_tiff(bytes, complaint);
    TIFF* const t = file.get();
    TIFFSetField(t, TIFFTAG_IMAGEWIDTH, static_cast<std::uint32_t>(tiff.image.width));
    TIFFSetField(t, TIFFTAG_IMAGELENGTH, static_cast<std::uint32_t>(tiff.image.height));
    TIFFSetField(t, TIFFTAG_BITSPERSAMPLE, 8);
    TIFFSetField(t, TIFFTAG_SAMPLESPERPIXEL, 3);
    TIFFSetField(t, TIFFTAG_PHOTOMETRIC, PHOTOMETRIC_RGB);
    TIFFSetField(t, TIFFTAG_PLANARCONFIG, PLANARCONFIG_CONTIG);
    TIFFSetField(t, TIFFTAG_ORIENTATION, ORIENTATION_TOPLEFT);
    TIFFSetField(t, TIFFTAG_COMPRESSION, COMPRESSION_ADOBE_DEFLATE);
    TIFFSetField(t, TIFFTAG_ROWSPERSTRIP, kRowsPerStrip);
    if (!tiff.description.empty()) TIFFSetField(t, TIFFTAG_IMAGEDESCRIPTION, tiff.description.c_str());
    if (tiff.transform) write_georeference(t, *tiff.transform, tiff.epsg);
    write_pixels(t, tiff.image, path, complaint);
    if (TIFFFlush(t) != 1) throw RunError(path + ": cannot be written (" + complaint.text + ")");
  }
  write_text_file(path, bytes);
}

RichTiff read_rich_tiff(const std::string& path, const Rgb& behind) {
  TiffComplaint complaint;
  const TiffFile tiff = open_tiff(path, complaint);
  RichTiff rich;
  GeoTiff& result = rich.tiff;
  find_page(tiff.get(), complaint, rich);
  read_georeference(tiff.get(), path, result);
  std::uint16_t orientation = ORIENTATION_TOPLEFT;
  if (TIFFGetField(tiff.get(), TIFFTAG_ORIENTATION, &orientation) == 1) rich.orientation = orientation;
  if (result.transform && !is_invertible(*result.transform))
    throw InputError(path + ": its scale or position tags are zero or no numbers; remove them and give a world file");
  const char* description = nullptr;
  if (TIFFGetField(tiff.get(), TIFFTAG_IMAGEDESCRIPTION, &description) == 1) result.description = description;
  try {
    result.image = read_pixels(tiff.get(), path, complaint, behind, rich.notes);
  } catch (const std::bad_alloc&) {
    throw InputError(path + ": does not fit into memory; scale it down");
  }
  return rich;
}

GeoTiff read_geotiff(const std::string& path, const Rgb& behind) { return read_rich_tiff(path, behind).tiff; }

}  // namespace rubble
