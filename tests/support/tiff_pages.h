#pragma once

#include <tiffio.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <functional>
#include <opencv2/core.hpp>
#include <string>
#include <vector>

/// TIFFs of any samples, as programs write them.
namespace rubble::scoring::testing {

/// How samples are stored.
struct TiffStyle {
  std::uint16_t bits = 8;
  std::uint16_t format = SAMPLEFORMAT_UINT;
  std::uint16_t photometric = 0xFFFF;  ///< by the drawing
  std::uint16_t compression = COMPRESSION_NONE;
  std::uint16_t orientation = ORIENTATION_TOPLEFT;
  bool tiled = false;
  bool separate = false;
  std::vector<std::uint16_t> extra;            ///< samples behind the colours, all opaque
  std::function<double(int)> value = nullptr;  ///< of a grey level, in the file
  std::string no_data;
};

inline constexpr std::uint32_t kNoDataTag = 42113;

/// `bgr`: CV_8UC1 or BGR.
inline void write_page(TIFF* t, const cv::Mat& bgr, const TiffStyle& s) {
  const bool grey = bgr.channels() == 1;
  const int colours = grey ? 1 : 3;
  const int samples = colours + static_cast<int>(s.extra.size());
  TIFFSetField(t, TIFFTAG_IMAGEWIDTH, static_cast<std::uint32_t>(bgr.cols));
  TIFFSetField(t, TIFFTAG_IMAGELENGTH, static_cast<std::uint32_t>(bgr.rows));
  TIFFSetField(t, TIFFTAG_BITSPERSAMPLE, s.bits);
  TIFFSetField(t, TIFFTAG_SAMPLESPERPIXEL, samples);
  TIFFSetField(t, TIFFTAG_SAMPLEFORMAT, s.format);
  const bool white_is_zero = s.photometric == PHOTOMETRIC_MINISWHITE;
  TIFFSetField(t, TIFFTAG_PHOTOMETRIC,
               s.photometric != 0xFFFF ? s.photometric : (grey ? PHOTOMETRIC_MINISBLACK : PHOTOMETRIC_RGB));
  TIFFSetField(t, TIFFTAG_PLANARCONFIG, s.separate ? PLANARCONFIG_SEPARATE : PLANARCONFIG_CONTIG);
  TIFFSetField(t, TIFFTAG_COMPRESSION, s.compression);
  TIFFSetField(t, TIFFTAG_ORIENTATION, s.orientation);
  if (!s.extra.empty()) TIFFSetField(t, TIFFTAG_EXTRASAMPLES, s.extra.size(), s.extra.data());
  if (!s.no_data.empty()) {
    static const TIFFFieldInfo info[] = {
        {kNoDataTag, -1, -1, TIFF_ASCII, FIELD_CUSTOM, 1, 0, const_cast<char*>("GDAL_NODATA")}};
    TIFFMergeFieldInfo(t, info, 1);
    TIFFSetField(t, kNoDataTag, s.no_data.c_str());
  }
  if (s.photometric == PHOTOMETRIC_PALETTE) {
    std::vector<std::uint16_t> ramp(256);
    for (std::size_t i = 0; i < 256; ++i) ramp[i] = static_cast<std::uint16_t>(257 * (255 - i));
    TIFFSetField(t, TIFFTAG_COLORMAP, ramp.data(), ramp.data(), ramp.data());
  }
  const std::uint32_t side = 64;
  if (s.tiled) {
    TIFFSetField(t, TIFFTAG_TILEWIDTH, side);
    TIFFSetField(t, TIFFTAG_TILELENGTH, side);
  } else {
    TIFFSetField(t, TIFFTAG_ROWSPERSTRIP, 32);
  }
  const std::size_t bytes = s.bits / 8u;
  const auto put = [&](std::string& out, int x, int y, int sample) {
    int level = 255;
    if (sample < colours && y < bgr.rows && x < bgr.cols)
      level = grey ? bgr.at<unsigned char>(y, x) : bgr.at<cv::Vec3b>(y, x)[2 - sample];
    if (sample < colours && (white_is_zero || s.photometric == PHOTOMETRIC_PALETTE)) level = 255 - level;
    const double value = s.value ? s.value(level) : level * (s.bits == 16 ? 257.0 : 1.0);
    if (s.format == SAMPLEFORMAT_IEEEFP) {
      const auto f = static_cast<float>(value);
      out.append(s.bits == 32 ? reinterpret_cast<const char*>(&f) : reinterpret_cast<const char*>(&value), bytes);
    } else {
      const auto whole = static_cast<std::int64_t>(std::lround(value));
      out.append(reinterpret_cast<const char*>(&whole), bytes);
    }
  };
  const auto block = [&](int x0, int y0, int w, int h, int plane) {
    std::string out;
    for (int y = y0; y < y0 + h; ++y)
      for (int x = x0; x < x0 + w; ++x)
        for (int i = 0; i < samples; ++i)
          if (plane < 0 || plane == i) put(out, x, y, i);
    return out;
  };
  for (int plane = s.separate ? 0 : -1; plane < (s.separate ? samples : 0); ++plane) {
    const auto p = static_cast<std::uint16_t>(std::max(0, plane));
    if (s.tiled) {
      for (int y = 0; y < bgr.rows; y += static_cast<int>(side))
        for (int x = 0; x < bgr.cols; x += static_cast<int>(side)) {
          std::string data = block(x, y, static_cast<int>(side), static_cast<int>(side), plane);
          TIFFWriteEncodedTile(t,
                               TIFFComputeTile(t, static_cast<std::uint32_t>(x), static_cast<std::uint32_t>(y), 0, p),
                               data.data(), static_cast<tmsize_t>(data.size()));
        }
    } else {
      for (int y = 0; y < bgr.rows; y += 32) {
        std::string data = block(0, y, bgr.cols, std::min(32, bgr.rows - y), plane);
        TIFFWriteEncodedStrip(t, TIFFComputeStrip(t, static_cast<std::uint32_t>(y), p), data.data(),
                              static_cast<tmsize_t>(data.size()));
      }
    }
  }
  TIFFWriteDirectory(t);
}

}  // namespace rubble::scoring::testing
