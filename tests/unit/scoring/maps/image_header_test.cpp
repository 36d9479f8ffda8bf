#include "scoring/maps/image_header.h"

#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <opencv2/imgcodecs.hpp>

#include "base/error.h"
#include "base/rng.h"
#include "scoring/maps/raster_image.h"

namespace rubble::scoring {
namespace {

std::string encoded(const std::string& extension, const cv::Mat& image) {
  std::vector<unsigned char> bytes;
  cv::imencode(extension, image, bytes);
  return std::string(bytes.begin(), bytes.end());
}

/// A progressive JPEG whose last scan is written `times` times more, empty.
std::string with_empty_scans(std::string jpeg, int times) {
  const std::string_view scan("\xFF\xDA\x00\x08\x01\x01\x00\x3F\x3F\x00", 10);
  jpeg.resize(jpeg.size() - 2);
  for (int i = 0; i < times; ++i) jpeg += scan;
  return jpeg + "\xFF\xD9";
}

TEST(ImageHeader, ScansOfAJpegAreCountedAndManyRefused) {
  std::vector<unsigned char> bytes;
  const cv::Mat image(200, 200, CV_8UC3, cv::Scalar(90, 120, 200));
  cv::imencode(".jpg", image, bytes, {cv::IMWRITE_JPEG_PROGRESSIVE, 1});
  const std::string progressive(bytes.begin(), bytes.end());
  const std::size_t scans = jpeg_scans(progressive);
  EXPECT_GE(scans, 5u);
  EXPECT_LE(scans, 12u);
  EXPECT_EQ(jpeg_scans(encoded(".jpg", image)), 1u);
  EXPECT_EQ(jpeg_scans(with_empty_scans(progressive, 5000)), scans + 5000);
  const std::string path =
      (std::filesystem::temp_directory_path() / ("scans" + std::to_string(getpid()) + ".jpg")).string();
  std::ofstream(path, std::ios::binary) << with_empty_scans(progressive, 5000);
  try {
    read_raster(path);
    ADD_FAILURE() << "read";
  } catch (const InputError& e) {
    EXPECT_NE(std::string(e.what()).find("scans"), std::string::npos) << e.what();
  }
  std::filesystem::remove(path);
}

TEST(ImageHeader, SaysTheSizeThatTheDecoderFinds) {
  for (const char* extension : {".png", ".jpg", ".bmp", ".pgm", ".ppm", ".pbm"}) {
    const bool is_grey = extension[2] == 'g' || extension[2] == 'b';
    const cv::Mat image(37, 300, is_grey ? CV_8UC1 : CV_8UC3, cv::Scalar::all(90));
    const auto header = image_header(encoded(extension, image));
    ASSERT_TRUE(header) << extension;
    EXPECT_EQ(header->width, 300) << extension;
    EXPECT_EQ(header->height, 37) << extension;
  }
}

TEST(ImageHeader, DamagedHeadersAreReadWithinTheirBytes) {
  const std::uint64_t seed = 4;
  SCOPED_TRACE("seed " + std::to_string(seed));
  Rng rng(seed, "headers");
  for (const char* extension : {".png", ".jpg", ".bmp", ".pgm"}) {
    const std::string whole = encoded(extension, cv::Mat(9, 11, CV_8UC1, cv::Scalar(3)));
    for (std::size_t size = 0; size <= whole.size(); ++size) {
      // A string of its own without spare bytes, so that a sanitizer sees what lies beyond.
      std::string bytes(whole.data(), size);
      if (size > 2) bytes[2 + rng.below(static_cast<std::uint32_t>(size - 2))] = static_cast<char>(rng.below(256));
      image_header(bytes);
    }
  }
  EXPECT_FALSE(image_header("P5 # comment without an end"));
  EXPECT_FALSE(image_header("GIF89a"));
}

TEST(ImageHeader, SizeIsRefusedBeforeItIsUnpacked) {
  std::string png = encoded(".png", cv::Mat(4, 4, CV_16UC4, cv::Scalar::all(0)));
  for (const std::size_t at : {std::size_t{16}, std::size_t{20}}) {  // 20,000 a side: 3.2 GB of 16-bit RGBA
    png[at + 2] = '\x4e';
    png[at + 3] = '\x20';
  }
  const std::string path =
      (std::filesystem::temp_directory_path() / ("rubble_header_" + std::to_string(getpid()))).string();
  std::ofstream(path, std::ios::binary) << png;
  try {
    read_raster(path);
    ADD_FAILURE() << "was read";
  } catch (const InputError& e) {
    EXPECT_NE(std::string(e.what()).find("20000 x 20000 pixels is too large"), std::string::npos) << e.what();
  }
  std::filesystem::remove(path);
}

}  // namespace
}  // namespace rubble::scoring
