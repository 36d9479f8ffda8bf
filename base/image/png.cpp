#include "base/image/png.h"

#include <png.h>

#include <new>
#include <opencv2/imgproc.hpp>
#include <stdexcept>

#include "base/error.h"
#include "base/text/text_file.h"

namespace rubble {
namespace {

constexpr int kCompression = 3;  // of 9: map-like pictures hardly shrink further

cv::Mat bgr_of(const RgbImage& image) {
  cv::Mat bgr;
  const cv::Mat rgb(image.height, image.width, CV_8UC3, const_cast<std::uint8_t*>(image.rgb.data()));
  cv::cvtColor(rgb, bgr, cv::COLOR_RGB2BGR);
  return bgr;
}

void append(png_structp png, png_bytep data, std::size_t count) {
  bool kept = true;
  try {
    static_cast<std::string*>(png_get_io_ptr(png))->append(reinterpret_cast<const char*>(data), count);
  } catch (const std::exception&) {  // libpng is C: nothing may be thrown through it
    kept = false;
  }
  if (!kept) png_error(png, "out of memory");  // jumps, hence not within the catch
}

void keep_quiet(png_structp, png_const_charp) {}

/// libpng comes back from an error by longjmp(), so nothing with a destructor lives in here. False: an error.
bool pack(png_structp png, png_infop info, const cv::Mat& bgr) {
  if (setjmp(png_jmpbuf(png)) != 0) return false;
  png_set_compression_level(png, kCompression);
  png_set_IHDR(png, info, static_cast<png_uint_32>(bgr.cols), static_cast<png_uint_32>(bgr.rows), 8, PNG_COLOR_TYPE_RGB,
               PNG_INTERLACE_NONE, PNG_COMPRESSION_TYPE_DEFAULT, PNG_FILTER_TYPE_DEFAULT);
  png_write_info(png, info);
  png_set_bgr(png);
  for (int y = 0; y < bgr.rows; ++y) png_write_row(png, bgr.ptr(y));
  png_write_end(png, info);
  return true;
}

}  // namespace

std::string png_bytes(const cv::Mat& bgr) {
  if (bgr.type() != CV_8UC3) throw std::logic_error("png_bytes: three channels of 8 bits");
  std::string bytes;
  png_structp png = png_create_write_struct(PNG_LIBPNG_VER_STRING, nullptr, nullptr, keep_quiet);
  png_infop info = png == nullptr ? nullptr : png_create_info_struct(png);
  bool packed = false;
  if (info != nullptr) {
    png_set_write_fn(png, &bytes, append, nullptr);
    packed = pack(png, info, bgr);
  }
  png_destroy_write_struct(&png, &info);
  if (!packed) throw RunError("a picture cannot be packed as PNG");
  return bytes;
}

std::string png_bytes(const RgbImage& image) { return png_bytes(bgr_of(image)); }

void write_png(const std::string& path, const cv::Mat& bgr) { write_text_file(path, png_bytes(bgr)); }

void write_png(const std::string& path, const RgbImage& image) { write_png(path, bgr_of(image)); }

}  // namespace rubble
