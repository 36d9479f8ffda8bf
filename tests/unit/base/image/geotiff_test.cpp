#include "base/image/geotiff.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <sys/resource.h>
#include <tiffio.h>
#include <zlib.h>
#include <GeographicLib/LocalCartesian.hpp>
#include <GeographicLib/UTMUPS.hpp>

#include <array>
#include <cmath>
#include <fstream>
#include <functional>
#include <nlohmann/json.hpp>

#include "base/angle.h"
#include "base/error.h"
#include "base/image/rich_tiff.h"
#include "base/rng.h"
#include "base/text/text_file.h"
#include "tests/support/base_files.h"

namespace rubble {
namespace {

using test::run;
using testing::HasSubstr;

/// Four colours in blocks, so that every variant of the file must keep them.
RgbImage picture(int width, int height, bool grey = false) {
  RgbImage image(width, height);
  Rng rng(7, "picture");
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x)
      for (int c = 0; c < 3; ++c) {
        const auto value = static_cast<std::uint8_t>(((x / 5) * 60 + (y / 7) * 25) & 255);
        const auto noise = static_cast<std::uint8_t>(rng.below(256));
        image.pixel(x, y)[c] = grey ? value : noise;
      }
  return image;
}

GeoTiff geotiff(const RgbImage& image, const std::optional<GeoAnchor>& anchor) {
  GeoTiff tiff;
  tiff.image = image;
  tiff.transform = georeference(-3.5, 4.25, 0.05, anchor, tiff.epsg);
  tiff.description = "{\"map\": \"test\"}";
  return tiff;
}

void expect_near(const PixelToModel& p, const PixelToModel& q, double tolerance) {
  EXPECT_NEAR(p.a, q.a, tolerance);
  EXPECT_NEAR(p.b, q.b, tolerance);
  EXPECT_NEAR(p.c, q.c, tolerance);
  EXPECT_NEAR(p.d, q.d, tolerance);
  EXPECT_NEAR(p.e, q.e, tolerance);
  EXPECT_NEAR(p.f, q.f, tolerance);
}

nlohmann::json gdalinfo(const std::string& path) {
  const auto finished = run("gdalinfo -json '" + path + "' 2>/dev/null");
  EXPECT_EQ(finished.code, 0);
  return nlohmann::json::parse(finished.output);
}

/// Skips a test without GDAL's programs, which are its oracle.
#define NEED_GDAL()                                                           \
  if (!test::has_program("gdalinfo") || !test::has_program("gdal_translate")) \
  GTEST_SKIP() << "gdal-bin is not installed"

std::string error_of(const std::function<void()>& act) {
  try {
    act();
  } catch (const InputError& error) {
    EXPECT_EQ(std::string(error.what()).find('\n'), std::string::npos) << error.what();
    return error.what();
  }
  return "no error";
}

TEST(GeoTiff, ReadsBackWhatItWrote) {
  const test::TempFolder folder;
  for (const auto& anchor : {std::optional<GeoAnchor>{}, std::optional<GeoAnchor>{GeoAnchor{50.36, 7.56, 33.0}}}) {
    const GeoTiff tiff = geotiff(picture(131, 77), anchor);
    write_geotiff(folder / "a.tif", tiff);
    const GeoTiff again = read_geotiff(folder / "a.tif");
    EXPECT_EQ(again.image.width, 131);
    EXPECT_EQ(again.image.height, 77);
    EXPECT_EQ(again.image.rgb, tiff.image.rgb);
    EXPECT_EQ(again.epsg, tiff.epsg);
    EXPECT_EQ(again.description, tiff.description);
    ASSERT_TRUE(again.transform);
    expect_near(*again.transform, *tiff.transform, 0.0);
  }
}

TEST(GeoTiff, APlainImageHasNoScale) {
  const test::TempFolder folder;
  GeoTiff tiff;
  tiff.image = picture(5, 3);
  write_geotiff(folder / "a.tif", tiff);
  const GeoTiff again = read_geotiff(folder / "a.tif");
  EXPECT_FALSE(again.transform);
  EXPECT_EQ(again.epsg, 0);
  EXPECT_TRUE(again.description.empty());
}

TEST(Upright, IsUndoneByTheOppositeOrientation) {
  RgbImage image = picture(7, 4);
  image.alpha.resize(28);
  for (std::size_t i = 0; i < image.alpha.size(); ++i) image.alpha[i] = static_cast<std::uint8_t>(i);
  for (const auto& [there, back] :
       {std::pair{1, 1}, {2, 2}, {3, 3}, {4, 4}, {5, 5}, {6, 8}, {7, 7}, {8, 6}, {0, 1}, {9, 1}}) {
    const RgbImage turned = upright(image, there);
    const RgbImage again = upright(turned, back);
    EXPECT_EQ(turned.width, there >= 5 && there <= 8 ? image.height : image.width);
    EXPECT_EQ(again.rgb, image.rgb) << there;
    EXPECT_EQ(again.alpha, image.alpha) << there;
    if (there > 1 && there < 9) {
      EXPECT_NE(turned.alpha, image.alpha) << there;
    }
  }
  // TIFF 6.0: orientation 6 has row 0 at the right and column 0 at the top.
  EXPECT_EQ(upright(image, 6).alpha[3], image.alpha[0]);
  EXPECT_EQ(upright(image, 8).alpha[upright(image, 8).index(0, 6)], image.alpha[0]);
}

TEST(GeoTiff, SameInputSameBytes) {
  const test::TempFolder folder;
  const GeoTiff tiff = geotiff(picture(100, 100), GeoAnchor{50.36, 7.56, 33.0});
  write_geotiff(folder / "a.tif", tiff);
  write_geotiff(folder / "b.tif", tiff);
  EXPECT_EQ(read_text_file(folder / "a.tif"), read_text_file(folder / "b.tif"));
}

TEST(GeoTiff, GdalSeesALocalMetricFrame) {
  NEED_GDAL();
  const test::TempFolder folder;
  write_geotiff(folder / "a.tif", geotiff(picture(200, 100), std::nullopt));
  const auto info = gdalinfo(folder / "a.tif");
  EXPECT_EQ(info["size"], (std::vector<int>{200, 100}));
  EXPECT_EQ(info["geoTransform"], (std::vector<double>{-3.5, 0.05, 0.0, 4.25, 0.0, -0.05}));
  const std::string wkt = info["coordinateSystem"]["wkt"];
  EXPECT_NE(wkt.find("ENGCRS"), std::string::npos) << wkt;
  EXPECT_NE(wkt.find("metre"), std::string::npos) << wkt;
  EXPECT_EQ(info["metadata"][""]["AREA_OR_POINT"], "Area");
  EXPECT_EQ(info["metadata"][""]["TIFFTAG_IMAGEDESCRIPTION"], "{\"map\": \"test\"}");
  EXPECT_EQ(info["metadata"]["IMAGE_STRUCTURE"]["COMPRESSION"], "DEFLATE");
  EXPECT_EQ(info["metadata"][""]["TIFFTAG_RESOLUTIONUNIT"], "3 (pixels/cm)");
  EXPECT_NEAR(std::stod(info["metadata"][""]["TIFFTAG_XRESOLUTION"].get<std::string>()), 0.2, 1e-6);
  EXPECT_EQ(info["bands"].size(), 3u);
}

TEST(GeoTiff, GdalSeesTheUtmZoneAndTheCorners) {
  NEED_GDAL();
  const test::TempFolder folder;
  struct Place {
    GeoAnchor anchor;
    int epsg;
  };
  for (const Place& place : {Place{{50.36, 7.56, 33.0}, 32632}, Place{{-33.9, 151.2, -120.0}, 32756},
                             Place{{35.7, 139.7, 90.0}, 32654}, Place{{60.4, 5.3, 10.0}, 32632}}) {
    const GeoTiff tiff = geotiff(picture(200, 100), place.anchor);
    EXPECT_EQ(tiff.epsg, place.epsg);
    write_geotiff(folder / "a.tif", tiff);
    const auto info = gdalinfo(folder / "a.tif");
    const std::string wkt = info["coordinateSystem"]["wkt"];
    EXPECT_NE(wkt.find("ID[\"EPSG\"," + std::to_string(place.epsg) + "]"), std::string::npos) << wkt;
    const PixelToModel& t = *tiff.transform;
    const auto corner = [&](const char* name, double column, double row) {
      const std::vector<double> seen = info["cornerCoordinates"][name];
      EXPECT_NEAR(seen[0], t.a * column + t.b * row + t.c, 1e-3);
      EXPECT_NEAR(seen[1], t.d * column + t.e * row + t.f, 1e-3);
    };
    corner("upperLeft", 0, 0);
    corner("upperRight", 200, 0);
    corner("lowerLeft", 0, 100);
    corner("lowerRight", 200, 100);
  }
}

// The way round by geodesy: map point -> east, north, up at the anchor -> latitude, longitude -> UTM.
TEST(Georeference, AgreesWithGeodesyTo2MillimetresAt500Metres) {
  Rng rng(3, "anchors");
  for (int i = 0; i < 200; ++i) {
    GeoAnchor anchor;
    anchor.latitude_deg = rng.uniform(-79.0, 83.0);
    anchor.longitude_deg = rng.uniform(-180.0, 180.0);
    anchor.heading_deg = rng.uniform(-360.0, 360.0);
    SCOPED_TRACE(std::to_string(anchor.latitude_deg) + " " + std::to_string(anchor.longitude_deg));
    int epsg = 0;
    const double x = rng.uniform(-350.0, 350.0);
    const double y = rng.uniform(-350.0, 350.0);
    const PixelToModel t = georeference(-400.0, 400.0, 0.05, anchor, epsg);
    const double column = (x + 400.0) / 0.05;
    const double row = (400.0 - y) / 0.05;

    int zone = 0;
    bool north = true;
    double e = 0.0, n = 0.0;
    GeographicLib::UTMUPS::Forward(anchor.latitude_deg, anchor.longitude_deg, zone, north, e, n);
    const double h = deg_to_rad(anchor.heading_deg);
    const GeographicLib::LocalCartesian local(anchor.latitude_deg, anchor.longitude_deg);
    double latitude = 0.0, longitude = 0.0, height = 0.0;
    local.Reverse(x * std::sin(h) - y * std::cos(h), x * std::cos(h) + y * std::sin(h), 0.0, latitude, longitude,
                  height);
    int zone2 = 0;
    bool north2 = true;
    GeographicLib::UTMUPS::Forward(latitude, longitude, zone2, north2, e, n, zone);
    if (north2 != north) n += (north ? -1.0 : 1.0) * GeographicLib::UTMUPS::UTMShift();
    EXPECT_NEAR(t.a * column + t.b * row + t.c, e, 2e-3);
    EXPECT_NEAR(t.d * column + t.e * row + t.f, n, 2e-3);
  }
}

TEST(Georeference, RefusesAnImpossibleAnchor) {
  int epsg = 0;
  EXPECT_THROW(georeference(0, 0, 0.05, GeoAnchor{91.0, 0.0, 0.0}, epsg), InputError);
  EXPECT_THROW(georeference(0, 0, 0.05, GeoAnchor{std::nan(""), 0.0, 0.0}, epsg), InputError);
  EXPECT_THROW(georeference(0, 0, 0.05, GeoAnchor{0.0, INFINITY, 0.0}, epsg), InputError);
}

/// What GDAL makes of our file by `options`, read back.
GeoTiff translated(const test::TempFolder& folder, const GeoTiff& tiff, const std::string& options) {
  write_geotiff(folder / "in.tif", tiff);
  const auto finished =
      run("gdal_translate -q " + options + " '" + (folder / "in.tif") + "' '" + (folder / "out.tif") + "' 2>&1");
  EXPECT_EQ(finished.code, 0) << finished.output;
  return read_geotiff(folder / "out.tif");
}

TEST(GeoTiff, ReadsEveryLayoutThatGdalWrites) {
  NEED_GDAL();
  const test::TempFolder folder;
  const GeoTiff tiff = geotiff(picture(131, 77), GeoAnchor{50.36, 7.56, 33.0});
  for (const char* options :
       {"-co TILED=YES -co BLOCKXSIZE=16 -co BLOCKYSIZE=32", "-co COMPRESS=LZW", "-co COMPRESS=LZW -co PREDICTOR=2",
        "-co COMPRESS=PACKBITS -co BLOCKYSIZE=5", "-co COMPRESS=DEFLATE -co TILED=YES", "-co INTERLEAVE=BAND",
        "-co INTERLEAVE=BAND -co TILED=YES -co COMPRESS=LZW", "-co BIGTIFF=YES", "-co ENDIANNESS=BIG",
        "-co COMPRESS=PACKBITS -co TILED=YES -co INTERLEAVE=BAND", "-co COMPRESS=ZSTD", "-co COMPRESS=LZMA",
        "-ot UInt16 -scale 0 255 0 65535",
        "-ot UInt16 -scale 0 255 0 65535 -co ENDIANNESS=BIG -co COMPRESS=LZW -co PREDICTOR=2"}) {
    SCOPED_TRACE(options);
    const GeoTiff read = translated(folder, tiff, options);
    EXPECT_EQ(read.image.rgb, tiff.image.rgb);
    EXPECT_EQ(read.epsg, tiff.epsg);
    ASSERT_TRUE(read.transform);
    expect_near(*read.transform, *tiff.transform, 1e-9);
  }
}

TEST(GeoTiff, ReadsGreyOfEveryDepth) {
  NEED_GDAL();
  const test::TempFolder folder;
  for (const int bits : {1, 2, 3, 4, 7, 8, 9, 12, 15, 16}) {
    SCOPED_TRACE(bits);
    const int top = (1 << bits) - 1;
    GeoTiff tiff = geotiff(picture(131, 77, true), std::nullopt);
    for (auto& value : tiff.image.rgb) value = static_cast<std::uint8_t>(value >= 128 ? 255 : bits == 1 ? 0 : value);
    const std::string options = "-b 1 -ot " + std::string(bits > 8 ? "UInt16" : "Byte") + " -scale 0 255 0 " +
                                std::to_string(top) + " -co NBITS=" + std::to_string(bits);
    const GeoTiff read = translated(folder, tiff, options + (bits % 2 == 0 ? " -co TILED=YES" : ""));
    ASSERT_EQ(read.image.rgb.size(), tiff.image.rgb.size());
    for (std::size_t i = 0; i < read.image.rgb.size(); ++i) {
      const double exact = std::floor(tiff.image.rgb[i] * top / 255.0 + 0.5) * 255.0 / top;
      ASSERT_NEAR(read.image.rgb[i], exact, 0.51) << i;
    }
  }
}

// Many programs widen a picture to 16 bits without scaling it; GDAL's own Byte of it is the oracle.
TEST(GeoTiff, DeepSamplesThatUseFewBitsAreScaledFromThose) {
  NEED_GDAL();
  const test::TempFolder folder;
  const GeoTiff tiff = geotiff(picture(131, 77), std::nullopt);
  for (const char* options :
       {"-ot UInt16", "-ot UInt16 -co TILED=YES -co COMPRESS=LZW -co PREDICTOR=2", "-ot UInt16 -co INTERLEAVE=BAND",
        "-ot UInt16 -co ENDIANNESS=BIG -co COMPRESS=DEFLATE", "-ot UInt16 -co NBITS=12 -co COMPRESS=PACKBITS"}) {
    SCOPED_TRACE(options);
    EXPECT_EQ(translated(folder, tiff, options).image.rgb, tiff.image.rgb);
    ASSERT_EQ(
        run("gdal_translate -q -ot Byte '" + (folder / "out.tif") + "' '" + (folder / "byte.tif") + "' 2>&1").code, 0);
    EXPECT_EQ(read_geotiff(folder / "byte.tif").image.rgb, tiff.image.rgb);
  }
  for (const int top : {1023, 4095, 16383, 65535}) {
    SCOPED_TRACE(top);
    const GeoTiff read = translated(folder, tiff, "-ot UInt16 -scale 0 255 0 " + std::to_string(top));
    for (std::size_t i = 0; i < read.image.rgb.size(); ++i) ASSERT_NEAR(read.image.rgb[i], tiff.image.rgb[i], 1) << i;
  }
  GeoTiff black = geotiff(RgbImage(20, 10), std::nullopt);
  EXPECT_EQ(translated(folder, black, "-ot UInt16").image.rgb, black.image.rgb);
  GeoTiff grey = geotiff(picture(131, 77, true), std::nullopt);
  EXPECT_EQ(translated(folder, grey, "-b 1 -ot UInt16").image.rgb, grey.image.rgb);
  RgbImage inverse = grey.image;
  for (auto& value : inverse.rgb) value = static_cast<std::uint8_t>(255 - value);
  EXPECT_EQ(translated(folder, grey, "-b 1 -ot UInt16 -co PHOTOMETRIC=MINISWHITE").image.rgb, inverse.rgb);
}

TEST(GeoTiff, ReadsPalettesOfFourBits) {
  NEED_GDAL();
  const test::TempFolder folder;
  GeoTiff tiff = geotiff(picture(131, 77, true), std::nullopt);
  for (auto& value : tiff.image.rgb) value = static_cast<std::uint8_t>(value / 16);
  write_geotiff(folder / "in.tif", tiff);
  std::string entries;
  for (int i = 0; i < 16; ++i)
    entries += "<Entry c1=\"" + std::to_string(i * 17) + "\" c2=\"" + std::to_string(255 - i * 10) + "\" c3=\"" +
               std::to_string(i * i) + "\"/>";
  std::ofstream(folder / "palette.vrt")
      << "<VRTDataset rasterXSize=\"131\" rasterYSize=\"77\"><VRTRasterBand dataType=\"Byte\" band=\"1\">"
      << "<ColorInterp>Palette</ColorInterp><ColorTable>" << entries << "</ColorTable><SimpleSource><SourceFilename "
      << "relativeToVRT=\"1\">in.tif</SourceFilename><SourceBand>1</SourceBand></SimpleSource></VRTRasterBand>"
      << "</VRTDataset>";
  for (const char* options : {"-co NBITS=4", "-co NBITS=4 -co TILED=YES -co COMPRESS=LZW", "-co COMPRESS=PACKBITS"}) {
    SCOPED_TRACE(options);
    ASSERT_EQ(run("cd '" + folder.path() + "' && gdal_translate -q " + options + " palette.vrt palette.tif 2>&1 && " +
                  "gdal_translate -q -expand rgb palette.tif expanded.tif 2>&1")
                  .code,
              0);
    const RgbImage read = read_geotiff(folder / "palette.tif").image;
    EXPECT_EQ(read.rgb, read_geotiff(folder / "expanded.tif").image.rgb);
    const int value = tiff.image.pixel(100, 50)[0];
    EXPECT_EQ(read.pixel(100, 50)[0], value * 17);
    EXPECT_EQ(read.pixel(100, 50)[1], 255 - value * 10);
  }
}

TEST(GeoTiff, ReadsMinIsWhitePalettesAndFaxCompression) {
  NEED_GDAL();
  const test::TempFolder folder;
  GeoTiff tiff = geotiff(picture(131, 77, true), std::nullopt);
  for (auto& value : tiff.image.rgb) value = value >= 128 ? 255 : 0;
  const std::string bilevel = "-b 1 -ot Byte -scale 0 255 0 1 -co NBITS=1";
  EXPECT_EQ(translated(folder, tiff, bilevel + " -co COMPRESS=CCITTFAX4").image.rgb, tiff.image.rgb);
  RgbImage inverse = tiff.image;
  for (auto& value : inverse.rgb) value = static_cast<std::uint8_t>(255 - value);
  EXPECT_EQ(translated(folder, tiff, bilevel + " -co PHOTOMETRIC=MINISWHITE").image.rgb, inverse.rgb);

  std::ofstream(folder / "palette.vrt") << "<VRTDataset rasterXSize=\"131\" rasterYSize=\"77\"><VRTRasterBand "
                                           "dataType=\"Byte\" band=\"1\"><ColorInterp>Palette</ColorInterp><ColorTable>"
                                           "<Entry c1=\"10\" c2=\"20\" c3=\"30\"/><Entry c1=\"200\" c2=\"100\" "
                                           "c3=\"50\"/></ColorTable><SimpleSource><SourceFilename relativeToVRT=\"1\">"
                                           "in1.tif</SourceFilename></SimpleSource></VRTRasterBand></VRTDataset>";
  ASSERT_EQ(run("cd '" + folder.path() + "' && gdal_translate -q " + bilevel +
                " in.tif in1.tif && gdal_translate -q palette.vrt palette.tif 2>&1")
                .code,
            0);
  const RgbImage coloured = read_geotiff(folder / "palette.tif").image;
  for (int y = 0; y < 77; ++y)
    for (int x = 0; x < 131; ++x) {
      const bool high = tiff.image.pixel(x, y)[0] != 0;
      ASSERT_EQ(coloured.pixel(x, y)[0], high ? 200 : 10);
      ASSERT_EQ(coloured.pixel(x, y)[1], high ? 100 : 20);
      ASSERT_EQ(coloured.pixel(x, y)[2], high ? 50 : 30);
    }
}

TEST(GeoTiff, ReadsJpegInTiff) {
  NEED_GDAL();
  const test::TempFolder folder;
  GeoTiff tiff = geotiff(picture(128, 64, true), std::nullopt);
  for (auto& value : tiff.image.rgb) value = static_cast<std::uint8_t>(value / 4 + 90);
  for (const char* options :
       {"-co COMPRESS=JPEG -co PHOTOMETRIC=YCBCR -co TILED=YES", "-co COMPRESS=JPEG -co JPEG_QUALITY=95"}) {
    const GeoTiff read = translated(folder, tiff, options);
    double error = 0.0;
    for (std::size_t i = 0; i < read.image.rgb.size(); ++i) error += std::abs(read.image.rgb[i] - tiff.image.rgb[i]);
    EXPECT_LT(error / static_cast<double>(read.image.rgb.size()), 6.0);
  }
}

/// A 4 x 1 RGBA file, pixels of opacity 0, 1/3, 2/3 and 1, all divided by `thinner`. `white` is white and opaque; 0:
/// all bits.
void write_rgba(const std::string& path, int bits, std::uint16_t kind, const std::array<int, 3>& colour, bool planes,
                int white = 0, int thinner = 1) {
  TIFF* const tiff = TIFFOpen(path.c_str(), "w");
  TIFFSetField(tiff, TIFFTAG_IMAGEWIDTH, 4);
  TIFFSetField(tiff, TIFFTAG_IMAGELENGTH, 1);
  TIFFSetField(tiff, TIFFTAG_BITSPERSAMPLE, bits);
  TIFFSetField(tiff, TIFFTAG_SAMPLESPERPIXEL, 4);
  TIFFSetField(tiff, TIFFTAG_PHOTOMETRIC, PHOTOMETRIC_RGB);
  TIFFSetField(tiff, TIFFTAG_PLANARCONFIG, planes ? PLANARCONFIG_SEPARATE : PLANARCONFIG_CONTIG);
  TIFFSetField(tiff, TIFFTAG_ROWSPERSTRIP, 1);
  TIFFSetField(tiff, TIFFTAG_EXTRASAMPLES, 1, &kind);
  const int top = white > 0 ? white : (1 << bits) - 1;
  const auto sample = [&](int x, int s) {
    const int full = s < 3 ? colour[static_cast<std::size_t>(s)] * top / 255 : top;
    return s == 3 || kind == EXTRASAMPLE_ASSOCALPHA ? full * x / (3 * thinner) : full;
  };
  for (int plane = 0; plane < (planes ? 4 : 1); ++plane) {
    std::vector<std::uint8_t> bytes;
    for (int x = 0; x < 4; ++x)
      for (int s = planes ? plane : 0; s < (planes ? plane + 1 : 4); ++s) {
        bytes.push_back(static_cast<std::uint8_t>(sample(x, s)));
        if (bits == 16) bytes.push_back(static_cast<std::uint8_t>(sample(x, s) >> 8));
      }
    TIFFWriteEncodedStrip(tiff, static_cast<std::uint32_t>(plane), bytes.data(), static_cast<tmsize_t>(bytes.size()));
  }
  TIFFClose(tiff);
}

TEST(GeoTiff, TransparentPixelsShowWhatIsBehind) {
  const test::TempFolder folder;
  const std::array<int, 3> colour{200, 50, 0};
  for (const auto& [bits, white] : {std::pair{8, 0}, {16, 0}, {16, 255}, {16, 4095}})
    for (const std::uint16_t kind : std::array<std::uint16_t, 2>{EXTRASAMPLE_ASSOCALPHA, EXTRASAMPLE_UNASSALPHA})
      for (const bool planes : {false, true}) {
        write_rgba(folder / "a.tif", bits, kind, colour, planes, white);
        const RgbImage image = read_geotiff(folder / "a.tif", {226, 226, 227}).image;
        EXPECT_EQ(image.alpha, (std::vector<std::uint8_t>{0, 85, 170, 255}));
        for (int x = 0; x < 4; ++x)
          for (std::size_t c = 0; c < 3; ++c) {
            const double grey = c == 2 ? 227 : 226;
            EXPECT_NEAR(image.pixel(x, 0)[c], grey + (colour[c] - grey) * x / 3.0, 1.0) << bits << kind << planes;
          }
      }
}

/// Viewers save layers that are nowhere opaque.
TEST(GeoTiff, WhatIsNowhereOpaqueCountsAsOpaqueWhereItIsMostSo) {
  const test::TempFolder folder;
  const std::array<int, 3> colour{240, 60, 0};
  for (const int bits : {8, 16})
    for (const std::uint16_t kind : std::array<std::uint16_t, 2>{EXTRASAMPLE_ASSOCALPHA, EXTRASAMPLE_UNASSALPHA})
      for (const bool planes : {false, true}) {
        write_rgba(folder / "a.tif", bits, kind, colour, planes, 0, 3);
        const RgbImage image = read_geotiff(folder / "a.tif", {226, 226, 227}).image;
        for (int x = 0; x < 4; ++x) {
          EXPECT_NEAR(image.alpha[static_cast<std::size_t>(x)], 85 * x, 2) << bits << kind << planes;  // of 28, 56, 85
          if (bits == 16 && kind == EXTRASAMPLE_ASSOCALPHA) continue;  // so dark that its brightest counts as white
          for (std::size_t c = 0; c < 3; ++c) {
            const double grey = c == 2 ? 227 : 226;
            EXPECT_NEAR(image.pixel(x, 0)[c], grey + (colour[c] - grey) * x / 3.0, 3.0) << bits << kind << planes;
          }
        }
      }
}

TEST(GeoTiff, APixelThatIsAPointHasItsCornerHalfAPixelAway) {
  NEED_GDAL();
  const test::TempFolder folder;
  const GeoTiff tiff = geotiff(picture(40, 30), std::nullopt);
  const GeoTiff read = translated(folder, tiff, "-mo AREA_OR_POINT=Point");
  ASSERT_TRUE(read.transform);
  EXPECT_EQ(gdalinfo(folder / "out.tif")["metadata"][""]["AREA_OR_POINT"], "Point");
  expect_near(*read.transform, *tiff.transform, 1e-9);
}

TEST(GeoTiff, FilesInDegreesAreRefused) {
  NEED_GDAL();
  const test::TempFolder folder;
  const GeoTiff tiff = geotiff(picture(40, 30), std::nullopt);
  EXPECT_NE(error_of([&] { translated(folder, tiff, "-a_srs EPSG:4326"); }).find("is in degrees"), std::string::npos);
}

TEST(GeoTiff, ALocalFrameInFeetIsReadInMetres) {
  NEED_GDAL();
  const test::TempFolder folder;
  const GeoTiff tiff = geotiff(picture(40, 30), std::nullopt);
  const GeoTiff read = translated(folder, tiff, "-a_srs 'LOCAL_CS[\"hall\",UNIT[\"foot\",0.3048]]'");
  ASSERT_TRUE(read.transform);
  EXPECT_NEAR(read.transform->a, 0.05 * 0.3048, 1e-12);
  EXPECT_NEAR(read.transform->f, 4.25 * 0.3048, 1e-12);
  EXPECT_NE(error_of([&] { translated(folder, tiff, "-a_srs EPSG:2263"); }).find("not in metres"), std::string::npos);
}

TEST(GeoTiff, SignedAndFloatingSamplesAreRefused) {
  NEED_GDAL();
  const test::TempFolder folder;
  const GeoTiff tiff = geotiff(picture(40, 30), std::nullopt);
  for (const char* type : {"Int16", "Float32", "UInt32", "Float64", "CFloat32"})
    EXPECT_NE(error_of([&] { translated(folder, tiff, std::string("-ot ") + type); }).find("gdal_translate -ot Byte"),
              std::string::npos);
}

TEST(GeoTiff, WhatIsNoTiffIsRefusedQuietly) {
  const test::TempFolder folder;
  testing::internal::CaptureStderr();
  EXPECT_NE(error_of([&] { read_geotiff(folder / "absent.tif"); }).find("cannot be opened"), std::string::npos);
  EXPECT_NE(error_of([&] { read_geotiff(folder.path()); }).find("is a folder"), std::string::npos);
  write_text_file(folder / "text.tif", "no picture");
  EXPECT_NE(error_of([&] { read_geotiff(folder / "text.tif"); }).find("is no TIFF"), std::string::npos);
  write_text_file(folder / "empty.tif", "");
  EXPECT_NE(error_of([&] { read_geotiff(folder / "empty.tif"); }).find("is no TIFF"), std::string::npos);
  EXPECT_EQ(testing::internal::GetCapturedStderr(), "");
}

TEST(GeoTiff, ATruncatedFileIsNamedWhereverItEnds) {
  const test::TempFolder folder;
  write_geotiff(folder / "a.tif", geotiff(picture(131, 177), GeoAnchor{50.36, 7.56, 33.0}));
  const std::string bytes = read_text_file(folder / "a.tif");
  testing::internal::CaptureStderr();
  for (std::size_t size = 0; size + 1 < bytes.size(); size += 1 + size / 20) {
    write_text_file(folder / "b.tif", bytes.substr(0, size));
    EXPECT_NE(error_of([&] { read_geotiff(folder / "b.tif"); }), "no error") << size;
  }
  EXPECT_EQ(testing::internal::GetCapturedStderr(), "");
}

TEST(GeoTiff, ATruncatedFileOfAnyLayoutIsNamed) {
  NEED_GDAL();
  const test::TempFolder folder;
  write_geotiff(folder / "in.tif", geotiff(picture(131, 177), std::nullopt));
  for (const char* options : {"-co TILED=YES", "-co COMPRESS=LZW", "-co COMPRESS=PACKBITS",
                              "-co COMPRESS=DEFLATE -co INTERLEAVE=BAND", "-co COMPRESS=JPEG -co PHOTOMETRIC=YCBCR",
                              "-ot UInt16 -co COMPRESS=DEFLATE", "-b 1 -scale 0 255 0 15 -co NBITS=4"}) {
    SCOPED_TRACE(options);
    ASSERT_EQ(run("gdal_translate -q " + std::string(options) + " '" + (folder / "in.tif") + "' '" +
                  (folder / "out.tif") + "' 2>/dev/null")
                  .code,
              0);
    const std::string bytes = read_text_file(folder / "out.tif");
    testing::internal::CaptureStderr();
    for (const double share : {0.1, 0.5, 0.9}) {
      write_text_file(folder / "cut.tif",
                      bytes.substr(0, static_cast<std::size_t>(share * static_cast<double>(bytes.size()))));
      EXPECT_NE(error_of([&] { read_geotiff(folder / "cut.tif"); }).find("cut.tif"), std::string::npos);
    }
    EXPECT_EQ(testing::internal::GetCapturedStderr(), "");
  }
}

// Whatever stands in the file: an image or one line of InputError, and nothing on stderr.
TEST(GeoTiff, DamagedFilesNeverCrash) {
  const test::TempFolder folder;
  write_geotiff(folder / "a.tif", geotiff(picture(31, 70), GeoAnchor{50.36, 7.56, 33.0}));
  const std::string bytes = read_text_file(folder / "a.tif");
  testing::internal::CaptureStderr();
  for (std::uint64_t seed = 0; seed < 600; ++seed) {
    Rng rng(seed, "damage");
    std::string damaged = bytes;
    const std::uint32_t count = 1 + rng.below(6);
    for (std::uint32_t i = 0; i < count; ++i) {
      const bool in_tags = rng.below(4) != 0;  // the directory stands at the end
      const auto size = static_cast<std::uint32_t>(damaged.size());
      const std::uint32_t at = in_tags ? size - 1 - rng.below(std::min(size, 700u)) : rng.below(size);
      damaged[at] = static_cast<char>(rng.below(256));
    }
    std::ofstream(folder / "b.tif", std::ios::binary) << damaged;
    error_of([&] { read_geotiff(folder / "b.tif"); });
  }
  EXPECT_EQ(testing::internal::GetCapturedStderr(), "");
}

// A gigabyte was once made for one tile of a picture of 100 pixels.
TEST(GeoTiff, ATileIsNotMuchLargerThanThePicture) {
  const test::TempFolder folder;
  const auto with_tiles_of = [&](std::uint32_t side) {
    const std::string path = folder / "tile.tif";
    TIFF* const tiff = TIFFOpen(path.c_str(), "w");
    for (const auto& [tag, value] : {std::pair(TIFFTAG_IMAGEWIDTH, 10u), std::pair(TIFFTAG_IMAGELENGTH, 10u),
                                     std::pair(TIFFTAG_TILEWIDTH, side), std::pair(TIFFTAG_TILELENGTH, side)})
      TIFFSetField(tiff, static_cast<std::uint32_t>(tag), value);
    for (const auto& [tag, value] :
         {std::pair(TIFFTAG_BITSPERSAMPLE, 8), std::pair(TIFFTAG_SAMPLESPERPIXEL, 1),
          std::pair(TIFFTAG_PHOTOMETRIC, PHOTOMETRIC_MINISBLACK), std::pair(TIFFTAG_COMPRESSION, COMPRESSION_PACKBITS)})
      TIFFSetField(tiff, static_cast<std::uint32_t>(tag), value);
    std::string packed;  // runs of 128 zeros
    for (std::uint32_t i = 0; i < side * (side / 128); ++i) packed += std::string("\x81\0", 2);
    TIFFWriteRawTile(tiff, 0, packed.data(), static_cast<tmsize_t>(packed.size()));
    TIFFClose(tiff);
    return read_geotiff(path).image.width;
  };
  EXPECT_EQ(with_tiles_of(4096), 10);
  EXPECT_THROW(with_tiles_of(16384), InputError);
}

// 618 bytes that said 9543 x 8374 pixels took 240 MB before it showed that there are none.
TEST(GeoTiff, AFileThatIsTooSmallForItsPictureIsRefusedBeforeMemoryIsTaken) {
  const test::TempFolder folder;
  const std::string path = folder / "small.tif";
  const auto packed = [&](int compression, int photometric, std::uint32_t side, const std::string& bytes) {
    TIFF* const tiff = TIFFOpen(path.c_str(), "w");
    for (const auto& [tag, value] : {std::pair(TIFFTAG_IMAGEWIDTH, side), std::pair(TIFFTAG_IMAGELENGTH, side),
                                     std::pair(TIFFTAG_ROWSPERSTRIP, side)})
      TIFFSetField(tiff, static_cast<std::uint32_t>(tag), value);
    for (const auto& [tag, value] :
         {std::pair(TIFFTAG_BITSPERSAMPLE, 8), std::pair(TIFFTAG_SAMPLESPERPIXEL, 3),
          std::pair(TIFFTAG_PHOTOMETRIC, photometric), std::pair(TIFFTAG_COMPRESSION, compression)})
      TIFFSetField(tiff, static_cast<std::uint32_t>(tag), value);
    std::string copy = bytes;
    TIFFWriteRawStrip(tiff, 0, copy.data(), static_cast<tmsize_t>(copy.size()));
    TIFFClose(tiff);
    return error_of([&] { read_geotiff(path); });
  };
  const auto peak_mb = [] {
    struct rusage usage {};
    getrusage(RUSAGE_SELF, &usage);
    return usage.ru_maxrss / 1024;
  };
  const auto before = peak_mb();
  const std::string junk(600, 'x');
  for (const int compression : {COMPRESSION_LZW, COMPRESSION_ADOBE_DEFLATE, COMPRESSION_PACKBITS})
    EXPECT_THAT(packed(compression, PHOTOMETRIC_RGB, 9000, junk), HasSubstr("cannot be packed into 600 bytes"));
  EXPECT_THAT(packed(COMPRESSION_NONE, PHOTOMETRIC_RGB, 9000, junk), HasSubstr("is truncated"));
  EXPECT_THAT(packed(COMPRESSION_LZMA, PHOTOMETRIC_RGB, 6000, junk), HasSubstr("is damaged or truncated"));
  EXPECT_THAT(packed(COMPRESSION_CCITTFAX4, PHOTOMETRIC_YCBCR, 9000, junk), HasSubstr("cannot be read"));
  EXPECT_LT(peak_mb() - before, 200);
  // The most that deflate can pack is read: zeros.
  const std::string zeros(3u * 3000 * 3000, '\0');
  std::string best(100000, '\0');
  uLongf size = best.size();
  ASSERT_EQ(compress2(reinterpret_cast<Bytef*>(best.data()), &size, reinterpret_cast<const Bytef*>(zeros.data()),
                      zeros.size(), 9),
            Z_OK);
  best.resize(size);
  EXPECT_GT(zeros.size() / size, 1000u);
  packed(COMPRESSION_ADOBE_DEFLATE, PHOTOMETRIC_RGB, 3000, best);
  EXPECT_EQ(read_geotiff(path).image.width, 3000);
}

TEST(GeoTiff, AnUnwritablePathIsARunError) {
  const GeoTiff tiff = geotiff(picture(4, 4), std::nullopt);
  EXPECT_THROW(write_geotiff("/nowhere/at/all.tif", tiff), RunError);
  const test::TempFolder folder;
  EXPECT_THROW(write_geotiff(folder.path(), tiff), RunError);
}

TEST(WorldFile, ReadsBackWhatItWrote) {
  const test::TempFolder folder;
  int epsg = 0;
  const PixelToModel t = georeference(-3.5, 4.25, 0.05, GeoAnchor{50.36, 7.56, 33.0}, epsg);
  write_world_file(folder / "a.tfw", t);
  expect_near(read_world_file(folder / "a.tfw"), t, 1e-9);
}

TEST(WorldFile, GdalReadsTheSame) {
  NEED_GDAL();
  const test::TempFolder folder;
  int epsg = 0;
  GeoTiff tiff;
  tiff.image = picture(20, 10);
  write_geotiff(folder / "a.tif", tiff);
  const PixelToModel t = georeference(-3.5, 4.25, 0.05, GeoAnchor{50.36, 7.56, 33.0}, epsg);
  write_world_file(folder / "a.tfw", t);
  const std::vector<double> seen = gdalinfo(folder / "a.tif")["geoTransform"];
  expect_near({seen[1], seen[2], seen[0], seen[4], seen[5], seen[3]}, t, 1e-9);
}

TEST(WorldFile, AMistakeIsNamedByItsLine) {
  const test::TempFolder folder;
  const std::string path = folder / "a.tfw";
  const auto error = [&](const std::string& text) {
    write_text_file(path, text);
    return error_of([&] { read_world_file(path); }).substr(path.size());
  };
  EXPECT_EQ(error("0.05\n0\n0\n-0,05\n1\n2\n"), ":4:1: '-0,05' is no number; give the y size of a pixel [m]");
  EXPECT_EQ(error("0.05\n0\n0\n-0.05\n1\n"), ":6:1: missing the y of the upper-left centre [m]");
  EXPECT_EQ(error("0.05\n0\n0\n-0.05\n1\n2\n3\n"), ":7:1: a seventh line; a world file has six numbers");
  EXPECT_EQ(error("0\n0\n0\n-0.05\n1\n2\n"), ":1:1: pixels of no size; give the size of a pixel in metres");
  EXPECT_THROW(read_world_file(folder / "absent.tfw"), InputError);
  write_text_file(path, " 0.05 \r\n0\r\n0\r\n-0.05\r\n1\r\n2\r\n\r\n");
  EXPECT_EQ(read_world_file(path).a, 0.05);
}

}  // namespace
}  // namespace rubble
