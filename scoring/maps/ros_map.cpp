#include "scoring/maps/ros_map.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <cmath>
#include <cstddef>
#include <filesystem>
#include <opencv2/imgproc.hpp>
#include <sstream>
#include <string>
#include <utility>
#include <vector>

#include "base/error.h"
#include "base/image/rich_tiff.h"
#include "base/text/number_text.h"
#include "base/text/shell.h"
#include "base/text/text_file.h"
#include "base/text/words.h"
#include "base/yaml/strict_yaml.h"
#include "scoring/maps/colours/grey_levels.h"
#include "scoring/maps/colours/league_colours.h"
#include "scoring/maps/colours/league_palette.h"
#include "scoring/maps/colours/lettering.h"
#include "scoring/maps/colours/map_colours.h"
#include "scoring/maps/colours/reading_doubts.h"
#include "scoring/maps/known_box.h"
#include "scoring/maps/raster_image.h"

namespace rubble::scoring {
namespace {

bool has_tiff_ending(const std::filesystem::path& path) {
  std::string ending = path.extension().string();
  std::transform(ending.begin(), ending.end(), ending.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return ending == ".tif" || ending == ".tiff";
}

/// The picture alone: where it lies says the yaml.
RichTiff upright_tiff(const std::string& path) {
  RichTiff out = read_rich_tiff(path, league::kUnexplored);
  check_image_size(path, out.tiff.image.width, out.tiff.image.height);
  turn_upright(out);
  return out;
}

/// Its channels in the order that they have.
RgbImage rgb_of(const cv::Mat& raster) {
  RgbImage out(raster.cols, raster.rows);
  const int channels = raster.channels();
  for (int y = 0; y < raster.rows; ++y) {
    const unsigned char* p = raster.ptr<unsigned char>(y);
    for (int x = 0; x < raster.cols; ++x, p += channels)
      for (int i = 0; i < 3; ++i) out.pixel(x, y)[i] = p[channels >= 3 ? i : 0];
  }
  return out;
}

/// With a fourth channel where there is opacity.
cv::Mat raster_of(const RgbImage& image) {
  cv::Mat out(image.height, image.width, image.alpha.empty() ? CV_8UC3 : CV_8UC4);
  unsigned char* to = out.ptr<unsigned char>();
  for (int y = 0; y < image.height; ++y)
    for (int x = 0; x < image.width; ++x) {
      const std::uint8_t* const p = image.pixel(x, y);
      to = std::copy(p, p + 3, to);
      if (!image.alpha.empty()) *to++ = image.alpha[image.index(x, y)];
    }
  return out;
}

/// The greys of a picture that the thresholds took for free ground, each of which covers much of it.
std::vector<int> broad_greys_of_free(const cv::Mat& grey, const cv::Mat& classes) {
  constexpr int kOneIn = 20;  // pixels
  std::array<int, 256> count{};
  for (int y = 0; y < grey.rows; ++y)
    for (int x = 0; x < grey.cols; ++x)
      if (classes.at<unsigned char>(y, x) == static_cast<unsigned char>(Occupancy::Free))
        ++count[grey.at<unsigned char>(y, x)];
  std::vector<int> out;
  for (int level = 0; level < 256; ++level)
    if (kOneIn * static_cast<std::size_t>(count[static_cast<std::size_t>(level)]) >= grey.total()) out.push_back(level);
  return out;
}

/// Samples from 0 to 100 and 255 alone, and more at 0 than near 100: per cent occupied, with unknown ground at 255.
bool looks_like_per_cent(const cv::Mat& grey) {
  constexpr int kSure = 66;
  constexpr int kOneIn = 20;  // pixels that are free
  const int free = cv::countNonZero(grey == 0), likely = cv::countNonZero((grey >= kSure) & (grey <= 100));
  return cv::countNonZero((grey > 100) & (grey < 255)) == 0 && likely > 0 && free > likely &&
         kOneIn * static_cast<std::size_t>(free) >= grey.total();
}

/// What of the picture does not fit the classes that the yaml makes of it: thresholds and mode of another program, or a
/// picture that is more than a map. The class of each pixel is the yaml's word; it is not judged by what greys mean.
std::string doubts_of(const cv::Mat& raster, const OccupancyGrid& grid, const std::string& mode) {
  constexpr int kApart = 20;               // greys of two grounds
  constexpr std::size_t kMost = 40000000;  // pixels: larger ones would take more memory than is promised
  if (raster.total() > kMost) return "";
  cv::Mat classes(grid.height(), grid.width(), CV_8U);
  for (int y = 0; y < classes.rows; ++y)
    for (int x = 0; x < classes.cols; ++x)
      classes.at<unsigned char>(y, x) = static_cast<unsigned char>(grid[{x, classes.rows - 1 - y}]);
  const auto has = [&](Occupancy o) { return cv::countNonZero(classes == static_cast<int>(o)) > 0; };
  std::string out;
  for (const auto& [what, name] : {std::pair{Occupancy::Occupied, "occupied"}, {Occupancy::Free, "free"}})
    if (!has(what))
      out += std::string(kDoubt) + "nothing of it is " + name + " by the yaml (mode " + mode +
             ", negate, thresholds): does it belong to this picture?";
  const RgbImage image = rgb_of(raster);
  const cv::Mat grey = grey_of(image);
  if (const std::vector<int> free = broad_greys_of_free(grey, classes);
      mode == "trinary" && !has(Occupancy::Unknown) && free.size() > 1 && free.back() - free.front() >= kApart)
    out += cv::format(
        "%sgreys %d and %d are both free by free_thresh, and nothing is unknown: programs save unknown "
        "ground as 205, which needs a free_thresh of 0.196",
        kDoubt, free.front(), free.back());
  if (mode != "raw" && looks_like_per_cent(grey))
    out += std::string(kDoubt) + "its samples are 0 to 100 and 255, as per cent occupied have them: is it of mode raw?";
  if (erase_lettering(classes) > 0)
    out += std::string(kDoubt) + "words stand on free ground: by the yaml they are walls";
  return out + doubts_about(image, image, {classes, false, true});
}

}  // namespace

RosMap read_ros_map(const std::string& yaml_path) {
  const YamlMap root = YamlMap::load(yaml_path);
  if (!root.has("image") && (root.has("maze") || root.has("walls")))
    throw InputError(yaml_path + ": is an arena, not a map; 'rubble arena " + shell_word(yaml_path) +
                     "' writes its truth map");
  const std::string image_name = root.text("image", std::nullopt);
  const double resolution = root.number("resolution", std::nullopt, kMinResolution, kMaxResolution);
  const double occupied_thresh = root.number("occupied_thresh", 0.65, 0.0, 1.0);
  const double free_thresh = root.number("free_thresh", 0.196, 0.0, 1.0);
  const std::vector<double> origin = root.numbers("origin");
  if (!origin.empty() && origin.size() < 2) root.fail("origin", "must be [x, y, yaw]");
  for (std::size_t i = 0; i < std::min<std::size_t>(origin.size(), 2); ++i)
    if (!(std::abs(origin[i]) <= kFarthestPlace))
      root.fail("origin", "lies farther off than any place on Earth; give x and y of the lower left corner [m]");
  if (free_thresh > occupied_thresh) root.fail("free_thresh", "must not be above occupied_thresh");
  // map_server accepts 0/1 as well as true/false.
  const std::string negate_text = root.text("negate", "0");
  const bool negate = negate_text == "1" || negate_text == "true" || negate_text == "True";
  if (!negate && negate_text != "0" && negate_text != "false" && negate_text != "False")
    root.fail("negate", "is " + in_quotes(negate_text) + "; there are 0 and 1");
  if (image_name.empty()) root.fail("image", "is empty; give the name of the picture");

  const std::string mode = root.text("mode", "trinary");
  if (mode != "trinary" && mode != "scale" && mode != "raw")
    root.fail("mode", "is '" + mode + "'; there are trinary, scale and raw");

  const std::filesystem::path image_path = std::filesystem::path(yaml_path).parent_path() / image_name;
  const bool is_tiff = has_tiff_ending(image_path);
  RichTiff tiff;
  if (is_tiff) tiff = upright_tiff(image_path.string());
  cv::Mat image = is_tiff ? raster_of(tiff.tiff.image) : read_raster(image_path.string());
  OccupancyGrid grid(GridFrame{image.cols, image.rows, resolution, origin.empty() ? 0.0 : origin[0],
                               origin.empty() ? 0.0 : origin[1]});
  if (image.channels() >= 3) {
    const RgbImage read = is_tiff ? RgbImage() : read_rgb(image_path.string());
    const RgbImage& coloured = is_tiff ? tiff.tiff.image : read;
    if (tiff.notes.are_measured() || is_league_map(coloured)) {
      image.release();  // of the largest pictures one copy is enough
      ClassImage read = classify(coloured, tiff.notes);
      if (!read.refusal.empty()) throw InputError(image_path.string() + ": " + read.refusal);
      grid.cells() = std::move(read.classes.cells());
      return {std::move(grid), ", " + read.recognised};
    }
  }
  const int channels = image.channels();
  const int colours = channels >= 3 ? 3 : 1;
  for (int y = 0; y < image.rows; ++y) {
    const unsigned char* row = image.ptr<unsigned char>(image.rows - 1 - y);
    for (int x = 0; x < image.cols; ++x) {
      const unsigned char* p = row + x * channels;
      if ((channels == 4 || channels == 2) && p[channels - 1] < 128) continue;
      int sum = 0;
      for (int i = 0; i < colours; ++i) sum += p[i];
      const double light = sum / (255.0 * colours);
      const double occupancy = negate ? light : 1.0 - light;
      // raw: the sample itself is per cent occupied, and what is above is unknown. scale differs from trinary in what
      // lies between the thresholds only, and there nothing is known well enough.
      if (mode == "raw") {
        const double percent = std::round(255.0 * (negate ? 1.0 - light : light));
        if (percent > 100.0) continue;
        if (percent > 100.0 * occupied_thresh) grid[{x, y}] = Occupancy::Occupied;
        if (percent < 100.0 * free_thresh) grid[{x, y}] = Occupancy::Free;
        continue;
      }
      if (occupancy > occupied_thresh)
        grid[{x, y}] = Occupancy::Occupied;
      else if (occupancy < free_thresh)
        grid[{x, y}] = Occupancy::Free;
    }
  }
  std::string recognised = (mode == "trinary" ? "" : ", " + mode) + doubts_of(image, grid, mode);
  return {std::move(grid), std::move(recognised)};
}

void write_ros_map(const std::string& stem, const OccupancyGrid& grid, double occupied_threshold) {
  const GridFrame& f = grid.frame();
  const KnownBox box = known_box(f, f.resolution, [&](Cell c) { return grid[c] != Occupancy::Unknown; });
  const auto index = [&](double v, double origin) {
    return static_cast<int>(std::lround((v - origin) / f.resolution));
  };
  const int x0 = std::clamp(index(box.x0, f.x0), 0, f.width), x1 = std::clamp(index(box.x1, f.x0), 0, f.width);
  const int y0 = std::clamp(index(box.y0, f.y0), 0, f.height), y1 = std::clamp(index(box.y1, f.y0), 0, f.height);
  std::string pgm = "P5\n" + std::to_string(x1 - x0) + " " + std::to_string(y1 - y0) + "\n255\n";
  for (int y = y1 - 1; y >= y0; --y)
    for (int x = x0; x < x1; ++x) {
      const Occupancy o = grid[{x, y}];
      pgm.push_back(static_cast<char>(o == Occupancy::Unknown ? 205 : o == Occupancy::Free ? 254 : 0));
    }
  write_text_file(stem + ".pgm", pgm);
  std::ostringstream yaml;
  yaml << "image: " << stem.substr(stem.find_last_of('/') + 1) << ".pgm\nresolution: " << number_text(f.resolution)
       << "\norigin: [" << number_text(f.x0 + x0 * f.resolution) << ", " << number_text(f.y0 + y0 * f.resolution)
       << ", 0.0]\nnegate: 0\noccupied_thresh: " << number_text(std::max(occupied_threshold, 0.25))
       << "\nfree_thresh: 0.196\n";
  write_text_file(stem + ".yaml", yaml.str());
}

}  // namespace rubble::scoring
