#include "scoring/maps/raster_image.h"

#include <algorithm>
#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>

#include "base/error.h"
#include "base/image/sample_range.h"
#include "base/text/input_file.h"
#include "scoring/maps/colours/league_palette.h"
#include "scoring/maps/image_codecs.h"
#include "scoring/maps/image_damage.h"
#include "scoring/maps/image_header.h"

namespace rubble::scoring {
namespace {

/// 16-bit channels as 8 bit, each by the range it uses: colours by theirs, the opacity by its own.
/// `white`: set to the sample that stands for it where that is no usual one.
cv::Mat narrowed(const cv::Mat& image, std::uint32_t& white) {
  const int channels = image.channels();
  const int colours = channels == 4 ? 3 : channels;
  cv::Mat one;  // channel by channel: all of them at once would take as much as the picture again
  const auto most_of = [&](int from, int to) {
    double most = 0.0;
    for (int i = from; i < to; ++i) {
      double here = 0.0;
      cv::extractChannel(image, one, i);
      cv::minMaxLoc(one, nullptr, &here);
      most = std::max(most, here);
    }
    return static_cast<std::uint32_t>(most);
  };
  const std::uint32_t brightest = most_of(0, colours);
  cv::Mat out(image.size(), CV_8UC(channels));
  for (int i = 0; i < channels; ++i) {
    const std::uint32_t here = white_of(i < colours ? brightest : most_of(i, i + 1), 65535, i >= colours);
    if (i == 0 && is_odd_white(here, 65535)) white = here;
    cv::extractChannel(image, one, i);
    cv::Mat narrow;
    one.convertTo(narrow, CV_8U, 255.0 / here);
    cv::insertChannel(narrow, out, i);
  }
  return out;
}

/// Transparent pixels fade into the league's grey of unexplored ground, as in a TIFF. A layer that is nowhere opaque,
/// as viewers save it, counts as opaque where it is most so.
void work_in_alpha(const cv::Mat& bgra, RgbImage& out) {
  out.alpha.resize(bgra.total());
  int most = 0;
  for (int y = 0; y < bgra.rows; ++y)
    for (int x = 0; x < bgra.cols; ++x) most = std::max(most, int{bgra.at<cv::Vec4b>(y, x)[3]});
  const int opaque = most > 0 ? most : 255;
  for (int y = 0; y < bgra.rows; ++y)
    for (int x = 0; x < bgra.cols; ++x) {
      const int alpha = (255 * bgra.at<cv::Vec4b>(y, x)[3] + opaque / 2) / opaque;
      out.alpha[out.index(x, y)] = static_cast<std::uint8_t>(alpha);
      std::uint8_t* const p = out.pixel(x, y);
      for (std::size_t c = 0; c < 3; ++c)
        p[c] = static_cast<std::uint8_t>((p[c] * alpha + league::kUnexplored[c] * (255 - alpha) + 127) / 255);
    }
}

}  // namespace

void check_image_size(const std::string& path, std::int64_t width, std::int64_t height) {
  if (width < 1 || height < 1) throw InputError(path + ": the image is empty");
  if (width > kMaxImageSide || height > kMaxImageSide || width * height > kMaxImageArea)
    throw InputError(path + ": " + std::to_string(width) + " x " + std::to_string(height) +
                     " pixels is too large for a map; scale it down to at most 10000 x 10000");
}

namespace {

constexpr std::size_t kMostScans = 100;  ///< of a JPEG; usual progressive ones have about ten

/// The header decides before anything is unpacked: a few bytes may stand for gigabytes, or for minutes of work.
void check_header(const std::string& path) {
  InputFile file(path, image_rules());
  std::string bytes(std::size_t{1} << 20, '\0');  // colour profiles may come before the size of a JPEG
  bytes.resize(file.read(bytes.data(), bytes.size()));
  const auto header = image_header(bytes);
  if (const std::string other = other_format(bytes); !header && !other.empty())
    throw InputError(path + ": is " + other + ", which is not read; save the map as PNG or GeoTIFF");
  if (!header) throw InputError(path + ": not an image that can be read (PNG, PGM, BMP, JPEG), or damaged");
  check_image_size(path, header->width, header->height);
  if (bytes.rfind("\xFF\xD8\xFF", 0) != 0) return;
  std::string rest(std::size_t{1} << 20, '\0');
  for (std::size_t got = file.read(rest.data(), rest.size()); got > 0; got = file.read(rest.data(), rest.size()))
    bytes.append(rest, 0, got);
  if (const std::size_t scans = jpeg_scans(bytes); scans > kMostScans)
    throw InputError(path + ": a JPEG of " + std::to_string(scans) + " scans; pictures have at most " +
                     std::to_string(kMostScans) + ", save it again as PNG");
}

cv::Mat read_raster(const std::string& path, Upright upright, std::uint32_t& white) {
  check_header(path);
  if (is_cut_short(path)) throw InputError(path + ": the image is cut short; copy the file again");
  const ImageCodecs& codecs = image_codecs();
  cv::Mat image;
  const StderrCapture capture;
  try {
    image = codecs.read(path, cv::IMREAD_UNCHANGED);
    // This flag is the one that leaves pictures as they are stored; a picture with opacity is stored upright.
    if (upright == Upright::AsSeen && image.channels() != 4) {
      image.release();
      image = codecs.read(path, cv::IMREAD_ANYCOLOR | cv::IMREAD_ANYDEPTH);
    }
  } catch (const cv::Exception&) {
    throw InputError(path + ": the image cannot be decoded; is it complete, and at most 10000 x 10000 pixels?");
  }
  if (image.empty()) throw InputError(path + ": not an image that can be read (PNG, PGM, BMP, JPEG), or damaged");
  if (tells_of_damage(capture.text())) throw InputError(path + ": the image is damaged; copy the file again");
  check_image_size(path, image.cols, image.rows);
  if (image.depth() == CV_16U)
    image = narrowed(image, white);
  else if (image.depth() != CV_8U)
    throw InputError(path + ": pixels must have 8 or 16 bit a channel; convert the image");
  return image;
}

}  // namespace

cv::Mat read_raster(const std::string& path, Upright upright) {
  std::uint32_t white = 0;
  return read_raster(path, upright, white);
}

RgbImage read_rgb(const std::string& path, Upright upright) {
  std::uint32_t white = 0;
  const cv::Mat image = read_raster(path, upright, white);
  RgbImage out(image.cols, image.rows);
  out.white = white;
  cv::Mat view(image.rows, image.cols, CV_8UC3, out.rgb.data());
  const int channels = image.channels();
  if (channels == 1)
    cv::cvtColor(image, view, cv::COLOR_GRAY2RGB);
  else if (channels == 3)
    cv::cvtColor(image, view, cv::COLOR_BGR2RGB);
  else if (channels == 4) {
    cv::cvtColor(image, view, cv::COLOR_BGRA2RGB);
    work_in_alpha(image, out);
  } else
    throw InputError(path + ": " + std::to_string(channels) + " channels; convert the image to grey or RGB");
  return out;
}

}  // namespace rubble::scoring
