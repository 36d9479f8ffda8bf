#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <tiffio.h>

#include <algorithm>
#include <array>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <functional>
#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>

#include "base/error.h"
#include "base/planar.h"
#include "base/rigid.h"
#include "scoring/maps/normalise.h"
#include "scoring/measures/sight_lines.h"
#include "scoring/walls/overlap.h"
#include "tests/support/long_suite.h"
#include "tests/support/map_pictures.h"
#include "tests/support/scoring_grounds.h"
#include "tests/support/tiff_pages.h"

/// The reader matrix: every way to store a map x every way to draw one has the score of the plain PNG of the same
/// drawing, or is refused by the sentence that stands here.
namespace rubble::scoring {
namespace {

using namespace testing;
namespace fs = std::filesystem;

constexpr double kResolution = 0.05;  // [m]

/// Large enough for the fee of most arenas: a score that is off here is off as much there.
const Ground kGround{"maze", 7, 7, 5};

struct Drawing {
  std::string name;
  cv::Mat image;  ///< CV_8UC1, or BGR
  bool is_grey() const { return image.channels() == 1; }
};

/// A file as it was written.
struct Stored {
  std::string path;
  bool tells_scale = false;
  cv::Mat turn{};      ///< 2 x 3, drawing -> image, where it is not the drawing's own raster
  double scale = 1.0;  ///< pixels of the image a pixel of the drawing
};

struct Format {
  std::string name;
  std::function<Stored(const std::string& base, const Drawing&)> write;
  std::string refusal;                                    ///< words of it; empty: is read
  std::function<bool(const Drawing&)> applies = nullptr;  ///< null: to all
};

void spit(const std::string& path, const std::string& bytes) { std::ofstream(path, std::ios::binary) << bytes; }

cv::Mat grey_of(const cv::Mat& image) {
  if (image.channels() == 1) return image;
  cv::Mat out;
  cv::cvtColor(image, out, cv::COLOR_BGR2GRAY);
  return out;
}

bool only_grey(const Drawing& d) { return d.is_grey(); }
/// Walls dark, free light.
bool only_ros(const Drawing& d) { return d.is_grey() && d.name.find("grey") == 0; }

/// Any file that OpenCV writes.
Format plain(const std::string& extension, const std::vector<int>& options = {}, const std::string& refusal = {}) {
  std::string name = extension;
  for (const int o : options) name += " " + std::to_string(o);
  return {name,
          [=](const std::string& base, const Drawing& d) {
            const std::string path = base + "." + extension;
            EXPECT_TRUE(cv::imwrite(path, d.image, options));
            return Stored{path};
          },
          refusal};
}

Format changed(const std::string& name, const std::function<cv::Mat(const cv::Mat&)>& change,
               const std::string& extension = "png", std::function<bool(const Drawing&)> applies = nullptr) {
  return {name,
          [=](const std::string& base, const Drawing& d) {
            const std::string path = base + "." + extension;
            EXPECT_TRUE(cv::imwrite(path, change(d.image)));
            return Stored{path};
          },
          "", std::move(applies)};
}

Format turned_by(double degrees, int interpolation, int canvas, const std::string& extension = "png",
                 const std::vector<int>& options = {}, double scale = 1.0) {
  std::string name = "turned by " + std::to_string(static_cast<int>(degrees)) + ", interpolation " +
                     std::to_string(interpolation) + ", canvas " + std::to_string(canvas) + ", " + extension;
  for (const int o : options) name += " " + std::to_string(o);
  if (scale != 1.0) name += ", scale " + std::to_string(scale);
  return {name,
          [=](const std::string& base, const Drawing& d) {
            // Canvas -1: what the drawing has in its corner.
            const cv::Scalar colour = canvas >= 0   ? cv::Scalar::all(canvas)
                                      : d.is_grey() ? cv::Scalar::all(d.image.at<unsigned char>(0, 0))
                                                    : cv::Scalar(227, 226, 226);
            const TurnedImage t = turned(d.image, degrees, interpolation, colour, scale);
            const std::string path = base + "." + extension;
            EXPECT_TRUE(cv::imwrite(path, t.image, options));
            return Stored{path, false, t.turn, scale};
          },
          ""};
}

/// Every second pixel of every second row, from the first or the second on: half the size by nearest neighbour.
Format halved(int phase) {
  return {"every second pixel from " + std::to_string(phase),
          [=](const std::string& base, const Drawing& d) {
            cv::Mat o((d.image.rows - phase + 1) / 2, (d.image.cols - phase + 1) / 2, d.image.type());
            for (int y = 0; y < o.rows; ++y)
              for (int x = 0; x < o.cols; ++x)
                std::copy_n(d.image.ptr(2 * y + phase) + (2 * x + phase) * d.image.elemSize(), d.image.elemSize(),
                            o.ptr(y) + x * o.elemSize());
            const std::string path = base + ".png";
            EXPECT_TRUE(cv::imwrite(path, o));
            return Stored{path, false, (cv::Mat_<double>(2, 3) << 0.5, 0, -0.5 * phase, 0, 0.5, -0.5 * phase), 0.5};
          },
          ""};
}

/// As a viewer that follows the orientation tag has to store it.
cv::Mat stored_for(const cv::Mat& image, int orientation) {
  cv::Mat out;
  if (orientation >= 5)
    cv::transpose(image, out);
  else
    out = image;
  const int flips[] = {9, 9, 1, -1, 0, 9, 0, -1, 1};
  if (flips[orientation] != 9) {
    cv::Mat flipped;
    cv::flip(out, flipped, flips[orientation]);
    out = flipped;
  }
  return out;
}

Format tiff(const std::string& name, const TiffStyle& style, std::function<bool(const Drawing&)> applies = nullptr,
            const std::string& refusal = {}, const char* mode = "w") {
  return {"TIFF " + name,
          [=](const std::string& base, const Drawing& d) {
            const std::string path = base + ".tif";
            TIFF* const t = TIFFOpen(path.c_str(), mode);
            write_page(t, stored_for(d.image, style.orientation), style);
            TIFFClose(t);
            return Stored{path};
          },
          refusal, std::move(applies)};
}

Format paged_tiff(bool thumbnail_first) {
  return {thumbnail_first ? "TIFF, thumbnail first" : "TIFF, thumbnail last",
          [=](const std::string& base, const Drawing& d) {
            cv::Mat small;
            cv::resize(d.image, small, {}, 0.25, 0.25, cv::INTER_AREA);
            TIFF* const t = TIFFOpen((base + ".tif").c_str(), "w");
            for (const bool first : {true, false}) write_page(t, first == thumbnail_first ? small : d.image, {});
            TIFFClose(t);
            return Stored{base + ".tif"};
          },
          ""};
}

/// The image and a world file beside it of this name: `%` stands for the path without extension.
Format world_file(const std::string& extension, const std::string& beside) {
  return {"world file " + beside + " of " + extension,
          [=](const std::string& base, const Drawing& d) {
            const std::string path = base + "." + extension;
            if (extension == "tif" || extension == "TIFF") {
              TIFF* const t = TIFFOpen(path.c_str(), "w");
              write_page(t, d.image, {});
              TIFFClose(t);
            } else {
              EXPECT_TRUE(cv::imwrite(path, d.image));
            }
            std::string name = beside;
            name.replace(name.find('%'), 1, base);
            const double f = kResolution;
            const double top = d.image.rows * f;
            if (name.find(".xml") != std::string::npos)
              spit(name, "<PAMDataset>\n  <GeoTransform>  0.0, " + std::to_string(f) + ", 0.0, " + std::to_string(top) +
                             ", 0.0, -" + std::to_string(f) + "</GeoTransform>\n</PAMDataset>\n");
            else
              spit(name, "0.05\r\n0\r\n0\r\n-0.05\r\n0.025\r\n" + std::to_string(top - 0.025) + "\r\n");
            return Stored{path, true};
          },
          ""};
}

/// ROS yaml with an image of the drawing; `level` makes its grey.
Format ros(const std::string& name, const std::string& lines, const std::function<int(int)>& level = nullptr) {
  return {"ROS " + name,
          [=](const std::string& base, const Drawing& d) {
            cv::Mat image = d.image.clone();
            if (level)
              for (int y = 0; y < image.rows; ++y)
                for (int x = 0; x < image.cols; ++x)
                  image.at<unsigned char>(y, x) = static_cast<unsigned char>(level(image.at<unsigned char>(y, x)));
            EXPECT_TRUE(cv::imwrite(base + ".pgm", image));
            spit(base + ".yaml", "image: " + fs::path(base).filename().string() +
                                     ".pgm\nresolution: 0.05\norigin: [0, 0, 0]\n" + lines);
            return Stored{base + ".yaml", true};
          },
          "", only_ros};
}

/// A grey map by hand: maxval 100 or 1000, ASCII or not.
Format pgm(int most, bool ascii) {
  return {"PGM of maxval " + std::to_string(most) + (ascii ? " in ASCII" : ""),
          [=](const std::string& base, const Drawing& d) {
            const cv::Mat grey = grey_of(d.image);
            std::string out = std::string(ascii ? "P2" : "P5") + "\n# by hand\n" + std::to_string(grey.cols) + " " +
                              std::to_string(grey.rows) + "\n" + std::to_string(most) + "\n";
            for (int y = 0; y < grey.rows; ++y)
              for (int x = 0; x < grey.cols; ++x) {
                const int v = (grey.at<unsigned char>(y, x) * most + 127) / 255;
                if (ascii) {
                  out += std::to_string(v) + (x % 16 == 15 ? "\n" : " ");
                } else {
                  if (most > 255) out += static_cast<char>(v >> 8);
                  out += static_cast<char>(v & 255);
                }
              }
            spit(base + ".pgm", out);
            return Stored{base + ".pgm"};
          },
          "", only_grey};
}

/// A JPEG that says in its EXIF how to be turned.
Format exif(int orientation) {
  return {"JPEG, EXIF orientation " + std::to_string(orientation),
          [=](const std::string& base, const Drawing& d) {
            std::vector<unsigned char> jpeg;
            cv::imencode(".jpg", stored_for(d.image, orientation), jpeg, {cv::IMWRITE_JPEG_QUALITY, 95});
            const unsigned char segment[] = {
                0xFF, 0xE1, 0, 34, 'E', 'x',  'i',  'f', 0, 0, 'M', 'M', 0, 42, 0,
                0,    0,    8, 0,  1,   0x01, 0x12, 0,   3, 0, 0,   0,   1, 0,  static_cast<unsigned char>(orientation),
                0,    0,    0, 0,  0,   0};
            jpeg.insert(jpeg.begin() + 2, std::begin(segment), std::end(segment));
            spit(base + ".jpg", std::string(jpeg.begin(), jpeg.end()));
            return Stored{base + ".jpg"};
          },
          ""};
}

Format bytes(const std::string& extension, const std::string& content, const std::string& refusal) {
  return {extension,
          [=](const std::string& base, const Drawing&) {
            spit(base + "." + extension, content);
            return Stored{base + "." + extension};
          },
          refusal};
}

cv::Mat gamma(const cv::Mat& image, double power) {
  cv::Mat table(1, 256, CV_8U);
  for (int i = 0; i < 256; ++i)
    table.at<unsigned char>(i) = cv::saturate_cast<unsigned char>(255.0 * std::pow(i / 255.0, power));
  cv::Mat out;
  cv::LUT(image, table, out);
  return out;
}

/// What people do to a picture before they hand it in: read as it was, or refused by a sentence that says what is
/// wrong.
std::vector<Format> edits() {
  std::vector<Format> out;
  const auto edit = [&](const std::string& name, const std::function<cv::Mat(const cv::Mat&)>& change) {
    out.push_back(changed(name, change));
  };
  const auto linear = [](double gain, double offset) {
    return [=](const cv::Mat& i) {
      cv::Mat o;
      i.convertTo(o, CV_8U, gain, offset);
      return o;
    };
  };
  for (const double power : {0.45, 0.6, 0.8, 1.25, 1.5, 2.2})
    edit("gamma " + std::to_string(power), [=](const cv::Mat& i) { return gamma(i, power); });
  for (const double offset : {-60.0, -30.0, -15.0, 10.0, 30.0})
    edit("brightness " + std::to_string(offset), linear(1.0, offset));
  for (const double gain : {0.5, 0.7, 0.85, 1.15, 1.5}) {
    edit("contrast " + std::to_string(gain), linear(gain, 128.0 * (1.0 - gain)));
    edit("gain " + std::to_string(gain), linear(gain, 0.0));
  }
  for (const double amount : {0.5, 1.0, 2.0})
    edit("sharpened " + std::to_string(amount), [=](const cv::Mat& i) {
      cv::Mat smooth, o;
      cv::GaussianBlur(i, smooth, {}, 1.5);
      cv::addWeighted(i, 1.0 + amount, smooth, -amount, 0.0, o);
      return o;
    });
  edit("sepia", [](const cv::Mat& i) {
    cv::Mat colour, o;
    if (i.channels() == 1)
      cv::cvtColor(i, colour, cv::COLOR_GRAY2BGR);
    else
      colour = i;
    const cv::Mat mix = (cv::Mat_<double>(3, 3) << 0.131, 0.534, 0.272, 0.168, 0.686, 0.349, 0.189, 0.769, 0.393);
    cv::transform(colour, o, mix);
    return o;
  });
  for (const double amount : {0.15, 0.4})
    edit("vignette " + std::to_string(amount), [=](const cv::Mat& i) {
      cv::Mat o = i.clone();
      const double r = 0.25 * (i.rows * i.rows + i.cols * i.cols);
      for (int y = 0; y < i.rows; ++y)
        for (int x = 0; x < i.cols * i.channels(); ++x) {
          const double dx = x / i.channels() - 0.5 * i.cols, dy = y - 0.5 * i.rows;
          o.ptr(y)[x] = cv::saturate_cast<unsigned char>(i.ptr(y)[x] * (1.0 - amount * (dx * dx + dy * dy) / r));
        }
      return o;
    });
  for (const double sigma : {2.0, 5.0, 10.0, 20.0})
    edit("noise " + std::to_string(sigma), [=](const cv::Mat& i) {
      cv::Mat noise(i.size(), CV_MAKETYPE(CV_16S, i.channels())), o;
      cv::RNG random(7);
      random.fill(noise, cv::RNG::NORMAL, 0.0, sigma);
      cv::add(i, noise, o, cv::noArray(), CV_8U);
      return o;
    });
  for (const int levels : {4, 8, 16})
    edit("posterised to " + std::to_string(levels), [=](const cv::Mat& i) {
      cv::Mat table(1, 256, CV_8U), o;
      for (int g = 0; g < 256; ++g)
        table.at<unsigned char>(g) =
            cv::saturate_cast<unsigned char>(std::round(g * (levels - 1) / 255.0) * 255.0 / (levels - 1));
      cv::LUT(i, table, o);
      return o;
    });
  edit("median of 3", [](const cv::Mat& i) {
    cv::Mat o;
    cv::medianBlur(i, o, 3);
    return o;
  });
  for (const double share : {0.0, 0.5})
    out.push_back(changed(
        "saturation " + std::to_string(share),
        [=](const cv::Mat& i) {
          cv::Mat grey, o;
          cv::cvtColor(i, grey, cv::COLOR_BGR2GRAY);
          cv::cvtColor(grey, grey, cv::COLOR_GRAY2BGR);
          cv::addWeighted(i, share, grey, 1.0 - share, 0.0, o);
          return o;
        },
        "png", [](const Drawing& d) { return !d.is_grey(); }));
  edit("histogram equalised", [](const cv::Mat& i) {
    cv::Mat o;
    if (i.channels() == 1) {
      cv::equalizeHist(i, o);
      return o;
    }
    std::vector<cv::Mat> planes;
    cv::cvtColor(i, o, cv::COLOR_BGR2YCrCb);
    cv::split(o, planes);
    cv::equalizeHist(planes[0], planes[0]);
    cv::merge(planes, o);
    cv::cvtColor(o, o, cv::COLOR_YCrCb2BGR);
    return o;
  });
  for (const double share : {0.3, 0.6})
    edit("see-through on white " + std::to_string(share), linear(1.0 - share, 255.0 * share));
  return out;
}

std::vector<Format> formats() {
  std::vector<Format> out = {plain("png"),
                             plain("bmp"),
                             plain("pnm"),
                             plain("tif"),
                             plain("tiff"),
                             plain("PNG"),
                             plain("pnm", {cv::IMWRITE_PXM_BINARY, 0}),
                             plain("jpg", {cv::IMWRITE_JPEG_QUALITY, 95}),
                             plain("jpg", {cv::IMWRITE_JPEG_QUALITY, 85}),
                             plain("jpeg", {cv::IMWRITE_JPEG_QUALITY, 75}),
                             plain("jpg", {cv::IMWRITE_JPEG_QUALITY, 60}),
                             plain("webp", {}, "is a WebP picture"),
                             plain("jp2", {}, "is a JPEG 2000 picture"),
                             plain("ras", {}, "is a Sun raster"),
                             pgm(255, false),
                             pgm(255, true),
                             pgm(100, false),
                             pgm(100, true),
                             pgm(1000, false),
                             pgm(65535, false),
                             exif(1),
                             exif(2),
                             exif(3),
                             exif(6),
                             exif(8)};
  out.push_back(changed("16 bit", [](const cv::Mat& i) {
    cv::Mat o;
    i.convertTo(o, CV_16U, 257.0);
    return o;
  }));
  out.push_back(changed("opaque alpha", [](const cv::Mat& i) {
    cv::Mat o;
    cv::cvtColor(i, o, i.channels() == 1 ? cv::COLOR_GRAY2BGRA : cv::COLOR_BGR2BGRA);
    return o;
  }));
  out.push_back(changed(
      "grey as RGB",
      [](const cv::Mat& i) {
        cv::Mat o;
        cv::cvtColor(i, o, cv::COLOR_GRAY2BGR);
        return o;
      },
      "png", only_grey));
  out.push_back(changed("padded by 40", [](const cv::Mat& i) { return i; }));
  out.back().write = [](const std::string& base, const Drawing& d) {
    const cv::Scalar colour =
        d.is_grey() ? cv::Scalar::all(d.image.at<unsigned char>(0, 0)) : cv::Scalar(227, 226, 226);
    cv::Mat o;
    cv::copyMakeBorder(d.image, o, 40, 40, 40, 40, cv::BORDER_CONSTANT, colour);
    cv::imwrite(base + ".png", o);
    return Stored{base + ".png", false, (cv::Mat_<double>(2, 3) << 1, 0, 40, 0, 1, 40)};
  };
  for (const double power : {0.45, 0.7, 1.5, 2.2})
    out.push_back(changed(
        "gamma " + std::to_string(power), [=](const cv::Mat& i) { return gamma(i, power); }, "png", only_grey));
  for (const double sigma : {0.6, 1.0})
    out.push_back(changed("blur " + std::to_string(sigma), [=](const cv::Mat& i) {
      cv::Mat o;
      cv::GaussianBlur(i, o, {}, sigma);
      return o;
    }));
  for (const double sigma : {1.4, 1.8, 2.2})
    out.push_back(changed(
        "blur " + std::to_string(sigma),
        [=](const cv::Mat& i) {
          cv::Mat o;
          cv::GaussianBlur(i, o, {}, sigma);
          return o;
        },
        "png", [](const Drawing& d) { return !d.is_grey(); }));
  out.push_back(changed(
      "inverted", [](const cv::Mat& i) { return cv::Mat(~i); }, "png", only_grey));
  for (const int interpolation : {cv::INTER_NEAREST, cv::INTER_LINEAR, cv::INTER_CUBIC})
    for (const int canvas : {-1, 0, 255}) {
      out.push_back(turned_by(37, interpolation, canvas));
      out.push_back(turned_by(8, interpolation, canvas));
    }
  out.push_back(turned_by(90, cv::INTER_NEAREST, 0));
  for (const int quality : {95, 85, 75, 60})
    for (const int degrees : {13, 37})
      out.push_back(turned_by(degrees, cv::INTER_LINEAR, -1, "jpg", {cv::IMWRITE_JPEG_QUALITY, quality}));
  for (const int quality : {90, 75, 50, 35})
    for (const int interpolation : {cv::INTER_NEAREST, cv::INTER_LINEAR, cv::INTER_CUBIC})
      for (const int canvas : {-1, 0, 255})
        for (const int degrees : {4, 24})
          out.push_back(turned_by(degrees, interpolation, canvas, "jpg", {cv::IMWRITE_JPEG_QUALITY, quality}));
  for (const int phase : {0, 1}) out.push_back(halved(phase));
  out.push_back(turned_by(0, cv::INTER_NEAREST, -1, "png", {}, 0.5));
  out.push_back(turned_by(7, cv::INTER_NEAREST, -1, "png", {}, 0.5));
  out.push_back(turned_by(0, cv::INTER_LINEAR, -1, "png", {}, 0.8));
  out.push_back(turned_by(0, cv::INTER_LINEAR, -1, "png", {}, 1.3));
  out.push_back(turned_by(0, cv::INTER_NEAREST, -1, "png", {}, 2.0));
  out.push_back(turned_by(0, cv::INTER_AREA, -1, "png", {}, 0.8));

  TiffStyle s;
  out.push_back(tiff("bare", s));
  out.push_back(tiff("big", s, nullptr, "", "w8"));
  out.push_back(tiff("big-endian", s, nullptr, "", "wb"));
  for (const auto c :
       std::initializer_list<std::uint16_t>{COMPRESSION_LZW, COMPRESSION_ADOBE_DEFLATE, COMPRESSION_PACKBITS}) {
    s.compression = c;
    out.push_back(tiff("compression " + std::to_string(c), s));
  }
  s = {};
  s.tiled = true;
  out.push_back(tiff("tiled", s));
  s.separate = true;
  out.push_back(tiff("tiled planes", s));
  s = {};
  s.bits = 16;
  out.push_back(tiff("16 bit", s));
  s = {};
  s.photometric = PHOTOMETRIC_MINISWHITE;
  out.push_back(tiff("white is zero", s, only_grey));
  s.photometric = PHOTOMETRIC_PALETTE;
  out.push_back(tiff("palette", s, only_grey));
  s = {};
  s.extra = {EXTRASAMPLE_UNASSALPHA};
  out.push_back(tiff("with opacity", s));
  s.extra = {EXTRASAMPLE_UNSPECIFIED};
  out.push_back(tiff("with another band", s));
  s.extra = {EXTRASAMPLE_UNSPECIFIED, EXTRASAMPLE_UNSPECIFIED, EXTRASAMPLE_UNASSALPHA};
  out.push_back(tiff("with three more bands", s));
  for (std::uint16_t o = 2; o <= 8; ++o) {
    s = {};
    s.orientation = o;
    out.push_back(tiff("orientation " + std::to_string(o), s));
  }
  const auto occupancy = [](int level) { return level == 0 ? 0.97 : level > 220 ? 0.05 : 0.5; };
  for (const auto bits : std::initializer_list<std::uint16_t>{32, 64}) {
    s = {};
    s.bits = bits;
    s.format = SAMPLEFORMAT_IEEEFP;
    s.value = occupancy;
    out.push_back(tiff("P(occupied) of " + std::to_string(bits) + " bit", s, only_ros));
    s.value = [=](int level) { return occupancy(level) == 0.5 ? std::nan("") : occupancy(level); };
    out.push_back(tiff("P(occupied) of " + std::to_string(bits) + " bit, NaN unknown", s, only_ros));
    s.value = [=](int level) { return occupancy(level) == 0.5 ? -9999.0 : occupancy(level); };
    s.no_data = "-9999";
    out.push_back(tiff("P(occupied) of " + std::to_string(bits) + " bit, no data -9999", s, only_ros));
    s.value = [=](int level) { return occupancy(level) == 0.5 ? -1.0 : 100.0 * occupancy(level); };
    s.no_data = "";
    out.push_back(tiff("percent occupied of " + std::to_string(bits) + " bit, -1 unknown", s, only_ros));
  }
  s = {};
  s.format = SAMPLEFORMAT_INT;
  s.value = [=](int level) { return occupancy(level) == 0.5 ? -1.0 : occupancy(level) > 0.5 ? 100.0 : 0.0; };
  out.push_back(tiff("ROS occupancy -1, 0, 100 of signed bytes", s, only_ros));
  s.bits = 16;
  out.push_back(tiff("ROS occupancy -1, 0, 100 of signed 16 bit", s, only_ros));
  s = {};
  s.value = [=](int level) { return occupancy(level) == 0.5 ? 255.0 : occupancy(level) > 0.5 ? 100.0 : 0.0; };
  out.push_back(tiff("ROS occupancy 255, 0, 100 of bytes", s, only_ros));
  s.value = [=](int level) { return level == 0 ? 0.0 : level > 220 ? 254.0 : 128.0; };
  s.no_data = "128";
  out.push_back(tiff("no data 128", s, only_ros));
  s.value = [=](int level) { return level == 0 ? 1.0 : level > 220 ? 2.0 : 0.0; };
  s.no_data = "0";
  out.push_back(tiff("labels 0, 1, 2, no data 0", s, only_ros));
  s.no_data = "";
  out.push_back(tiff("labels 0, 1, 2", s, only_ros));
  s = {};
  s.photometric = PHOTOMETRIC_CIELAB;
  out.push_back(tiff(
      "Lab", s, [](const Drawing& d) { return !d.is_grey(); }, "colours are Lab"));
  s.photometric = PHOTOMETRIC_SEPARATED;
  s.extra = {EXTRASAMPLE_UNSPECIFIED};
  out.push_back(paged_tiff(true));
  out.push_back(paged_tiff(false));

  for (const char* beside :
       {"%.tfw", "%.TFW", "%.Tfw", "%.tifw", "%.tfwx", "%.tif.tfw", "%.tifwx", "%.wld", "%.WLD", "%.tif.aux.xml"})
    out.push_back(world_file("tif", beside));
  for (const char* beside : {"%.tfw", "%.tiffw", "%.TFWX"}) out.push_back(world_file("TIFF", beside));
  for (const char* beside : {"%.pgw", "%.PGW", "%.pngw", "%.pgwx", "%.wld", "%.png.wld", "%.png.aux.xml", "%.pngwx"})
    out.push_back(world_file("png", beside));
  for (const char* beside : {"%.bpw", "%.bmpw"}) out.push_back(world_file("bmp", beside));

  out.push_back(ros("trinary", "negate: 0\noccupied_thresh: 0.65\nfree_thresh: 0.196\n", [=](int l) {
    return occupancy(l) == 0.5 ? 205 : l == 0 ? 0 : 254;
  }));
  out.push_back(ros("mode trinary", "mode: trinary\nnegate: 0\noccupied_thresh: 0.65\nfree_thresh: 0.196\n",
                    [=](int l) { return occupancy(l) == 0.5 ? 205
                                        : l == 0            ? 0
                                                            : 254; }));
  out.push_back(ros("negated", "negate: 1\noccupied_thresh: 0.65\nfree_thresh: 0.196\n", [=](int l) {
    return occupancy(l) == 0.5 ? 128 : l == 0 ? 254 : 0;
  }));
  out.push_back(ros("scale", "mode: scale\nnegate: 0\noccupied_thresh: 0.65\nfree_thresh: 0.196\n", [=](int l) {
    return occupancy(l) == 0.5 ? 128 : l == 0 ? 10 : 250;
  }));
  out.push_back(ros("raw", "mode: raw\nnegate: 0\noccupied_thresh: 0.65\nfree_thresh: 0.196\n", [=](int l) {
    return occupancy(l) == 0.5 ? 255 : l == 0 ? 100 : 0;
  }));

  out.push_back(bytes("gif", std::string("GIF89a\x10\0\x10\0\xF0\0\0", 13) + std::string(60, ' '), "is a GIF"));
  out.push_back(bytes("tga", std::string("\0\0\2\0\0\0\0\0\0\0\0\0\x10\0\x10\0\x18\0", 18) + std::string(800, ' '),
                      "is a Targa picture"));
  out.push_back(bytes("pdf", "%PDF-1.4\n" + std::string(200, ' '), "is a PDF"));
  out.push_back(bytes("svg", "<?xml version=\"1.0\"?>\n<svg width=\"10\" height=\"10\"></svg>\n", "is an SVG drawing"));
  return out;
}

std::vector<Drawing> drawings(const OccupancyGrid& grid) {
  return {{"league, all drawings", league_image(grid, true)},
          {"league, no drawings", league_image(grid, false)},
          {"grey 0, 205, 254", grey_image(grid, 0, 205, 254)},
          {"grey 0, 127, 255", grey_image(grid, 0, 127, 255)},
          {"grey 0, 150, 225", grey_image(grid, 0, 150, 225)},
          {"other grey 255, 128, 0", grey_image(grid, 255, 128, 0)},
          {"other grey 20, 255, 190", grey_image(grid, 20, 255, 190)},
          {"other grey 100, 255, 0", grey_image(grid, 100, 255, 0)},
          {"other grey 128, 0, 255", grey_image(grid, 128, 0, 255)}};
}

class ReaderMatrix : public ::testing::Test {
 protected:
  void SetUp() override {
    std::string name = (fs::temp_directory_path() / "rubble_readers_XXXXXX").string();
    ASSERT_NE(mkdtemp(name.data()), nullptr);
    folder_ = name;
  }
  void TearDown() override { fs::remove_all(folder_); }
  fs::path folder_;
};

/// Where the file's grid lies on the truth from which the drawing of `rows` rows was made.
PlanarTransform pose_of(const Stored& file, const OccupancyGrid& read, const OccupancyGrid& truth, int rows) {
  const double f = kResolution / file.scale;
  if (file.turn.empty())
    return PlanarTransform({truth.frame().x0 - read.frame().x0, truth.frame().y0 - read.frame().y0, 0.0});
  cv::Mat back;
  cv::invertAffineTransform(file.turn, back);
  const auto onto = [&](const TPoint2D& p) {
    const double column = (p.x - read.frame().x0) / f - 0.5;
    const double row = read.height() - (p.y - read.frame().y0) / f - 0.5;
    const double c = back.at<double>(0, 0) * column + back.at<double>(0, 1) * row + back.at<double>(0, 2) + 0.5;
    const double r = back.at<double>(1, 0) * column + back.at<double>(1, 1) * row + back.at<double>(1, 2) + 0.5;
    return TPoint2D(truth.frame().x0 + c * kResolution, truth.frame().y0 + (rows - r) * kResolution);
  };
  const TPoint2D o(read.frame().x0, read.frame().y0), a = o + TPoint2D(5, 0), b = o + TPoint2D(0, 5);
  return PlanarTransform(fit_rigid({o, a, b}, {onto(o), onto(a), onto(b)}));
}

TEST_F(ReaderMatrix, EveryFileHasTheScoreOfThePlainPictureOrIsRefusedByName) {
  const OccupancyGrid truth = truth_of(kGround);
  const SightLines sights(truth);
  const OccupancyGrid map = with_gaps(with_phantoms(truth, 3, 5), 5, 5);
  const double drawn = sights.at(map, PlanarTransform()).score;
  const double drawn_overlap = overlap(map, truth, {}, 0.5).score;
  ASSERT_GT(drawn, 0.6);
  const std::string base = (folder_ / "map").string();
  int cases = 0, refused = 0, bad = 0, lost = 0;
  std::size_t turn = 0;
  std::vector<Drawing> all = drawings(map);
  all.push_back({"league, searched", with_searched_floor(all.front().image)});
  for (const Drawing& drawing : all) {
    double expected = drawn;
    std::size_t place = turn++;
    for (const Format& format : formats()) {
      const bool tried = is_tried(place++) || format.name == "png";  // which the others are held against
      if (!tried || (format.applies && !format.applies(drawing))) continue;
      // Black ground half a metre wide between a white canvas and white floor is a wall to anybody.
      if (drawing.name == "other grey 128, 0, 255" && format.name.find("canvas 255") != std::string::npos) continue;
      for (const auto& entry : fs::directory_iterator(folder_)) fs::remove(entry);
      const Stored file = format.write(base, drawing);
      std::string what;
      ++cases;
      try {
        const LoadedMap read =
            load_map(file.path, {file.tells_scale ? std::optional<double>() : kResolution / file.scale});
        what = read.recognised;
        // Lines of sight do not ask for the walls around; the overlap does.
        const PlanarTransform T = pose_of(file, read.grid, truth, drawing.image.rows);
        const double score = sights.at(read.grid, T).score;
        const double walls = overlap(read.grid, truth, T.pose(), 0.5).score;
        if (format.refusal.empty() &&
            std::abs(walls - drawn_overlap) > (read.grid.resolution() > 0.055 ? 0.04 : 0.02)) {
          ++lost;
          std::printf("walls around lost: %s of %s: overlap %.3f instead of %.3f; %s\n", format.name.c_str(),
                      drawing.name.c_str(), walls, drawn_overlap, what.c_str());
        }
        // Cells twice as wide: a gap ends within one of them. Quality 35 leaves some walls no colour at all.
        const bool coarser = read.grid.resolution() > 0.055;
        const double bound = format.name.find("jpg 1 35") != std::string::npos ? 0.035 : coarser ? 0.025 : 0.02;
        if (format.name == "png") {
          expected = score;
          EXPECT_NEAR(score, drawn, 0.02);
        }
        if (!format.refusal.empty() || std::abs(score - expected) > bound) {
          ++bad;
          ADD_FAILURE() << format.name << " of " << drawing.name << ": " << score << " instead of " << expected << "; "
                        << what;
        }
      } catch (const InputError& error) {
        ++refused;
        // Walls between two areas look like the blended border of these.
        const bool no_way = (drawing.name == "other grey 100, 255, 0" || drawing.name == "other grey 128, 0, 255") &&
                            std::string(error.what()).find("save it without interpolation") != std::string::npos;
        if (no_way) continue;
        if (format.refusal.empty() || std::string(error.what()).find(format.refusal) == std::string::npos) {
          ++bad;
          ADD_FAILURE() << format.name << " of " << drawing.name << ": refused: " << error.what();
        }
      }
    }
  }
  std::printf("%d cases, %d refused, %d bad, %d without walls around\n", cases, refused, bad, lost);
  EXPECT_LE(lost, 1);
  EXPECT_GE(cases, at_least(900));
}

TEST_F(ReaderMatrix, EditedPicturesAreReadAsTheyWereOrRefusedWithTheReason) {
  const OccupancyGrid truth = truth_of(kGround);
  const SightLines sights(truth);
  const OccupancyGrid map = with_gaps(with_phantoms(truth, 3, 5), 5, 5);
  const double expected = sights.at(map, PlanarTransform()).score;
  GridFrame wider = map.frame();  // ground that was never seen around it, as most maps have
  const int margin = 50;
  wider.width += 2 * margin;
  wider.height += 2 * margin;
  wider.x0 -= margin * wider.resolution;
  wider.y0 -= margin * wider.resolution;
  OccupancyGrid canvas(wider, Occupancy::Unknown);
  for (int y = 0; y < map.height(); ++y)
    for (int x = 0; x < map.width(); ++x) canvas[{x + margin, y + margin}] = map[{x, y}];
  const std::string base = (folder_ / "map").string();
  int cases = 0, right = 0, refused = 0, wrong = 0;
  std::size_t turn = 0;
  for (const Drawing& drawing : drawings(canvas)) {
    std::size_t place = turn++;
    for (const Format& format : edits()) {
      if (!is_tried(place++) || (format.applies && !format.applies(drawing))) continue;
      const Stored file = format.write(base, drawing);
      ++cases;
      try {
        const LoadedMap read = load_map(file.path, {kResolution});
        const double score = sights.at(read.grid, pose_of(file, read.grid, canvas, drawing.image.rows)).score;
        if (std::abs(score - expected) <= 0.02) {
          ++right;
        } else {
          ++wrong;
          std::printf("wrong: %s of %s: %.3f instead of %.3f; %s\n", format.name.c_str(), drawing.name.c_str(), score,
                      expected, read.recognised.c_str());
        }
      } catch (const InputError& error) {
        ++refused;
        EXPECT_THAT(error.what(), ::testing::ContainsRegex("colour|blended|evenly bright"))
            << format.name << " of " << drawing.name;
      }
    }
  }
  std::printf("%d cases, %d right, %d refused, %d wrong\n", cases, right, refused, wrong);
  // Those that are wrong and not told: white clipped away, walls sharpened black.
  EXPECT_GE(right, at_least(310));
  EXPECT_LE(wrong, 3);
}

}  // namespace
}  // namespace rubble::scoring
