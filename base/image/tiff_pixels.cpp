#include "base/image/tiff_pixels.h"

#include <sys/stat.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>
#include <cstring>
#include <limits>
#include <memory>
#include <new>
#include <optional>
#include <vector>

#include "base/error.h"
#include "base/image/sample_range.h"
#include "base/text/number_text.h"

namespace rubble {
namespace {

using Bytes = std::vector<std::uint8_t>;

constexpr std::uint32_t kMaxSide = 20000;
constexpr std::uint64_t kMaxPixels = 100000000;
constexpr std::uint32_t kMaxSamples = 16;
constexpr std::uint64_t kMaxChunk = 64u << 20;  ///< [bytes] of one strip or tile, unpacked, or twice the picture

/// The most bytes that one stored byte can stand for: by the formats of deflate (RFC 1951: 258 bytes by two bits), LZW
/// (the longest string of a table of 4096 codes) and PackBits; 0: not bounded, or not known.
std::uint64_t most_expansion(std::uint16_t compression) {
  switch (compression) {
    case COMPRESSION_NONE:
      return 1;
    case COMPRESSION_PACKBITS:
      return 64;
    case COMPRESSION_LZW:
      return 4096;
    case COMPRESSION_DEFLATE:
    case COMPRESSION_ADOBE_DEFLATE:
      return 1032;
    default:
      return 0;
  }
}

/// How the samples of a TIFF are stored.
struct Layout {
  std::uint32_t width = 0, height = 0;
  std::uint32_t chunk_width = 0, chunk_height = 0;  ///< of a strip or tile
  std::uint16_t bits = 1, samples = 1, photometric = PHOTOMETRIC_MINISBLACK, planes = PLANARCONFIG_CONTIG;
  std::uint16_t format = SAMPLEFORMAT_UINT;
  bool tiled = false;
  int alpha = -1;              ///< sample that is the opacity; -1: none
  bool premultiplied = false;  ///< colours are already scaled by it
};

using Samples = std::array<std::uint32_t, kMaxSamples>;  ///< of one pixel

class Reader {
 public:
  Reader(TIFF* tiff, const std::string& path, const TiffComplaint& complaint, const Rgb& behind, SampleNotes& notes)
      : tiff_(tiff), path_(path), complaint_(complaint), behind_(behind), notes_(notes) {}

  RgbImage read() {
    read_layout();
    check_chunks();
    if (!is_measure() && !is_simple()) return read_by_libtiff();
    // Of a damaged file nothing can be unpacked, as a rule: that is known before memory is taken for a large picture.
    if (picture_bytes() > kMaxChunk) read_first_chunk();
    RgbImage image(static_cast<int>(layout_.width), static_cast<int>(layout_.height));
    find_no_data();
    if (is_measure()) {
      read_measures(image);
    } else {
      find_white();
      if (is_odd_white(white_, (1u << layout_.bits) - 1)) image.white = white_;
      read_tables();
      read_chunks(image);
    }
    return image;
  }

 private:
  [[noreturn]] void fail(const std::string& message) const { throw InputError(path_ + ": " + message); }
  [[noreturn]] void fail_read() const {
    fail("is damaged or truncated (" + (complaint_.text.empty() ? "short read" : complaint_.text) + "); copy it again");
  }

  void read_layout() {
    Layout& l = layout_;
    if (TIFFGetField(tiff_, TIFFTAG_IMAGEWIDTH, &l.width) != 1 ||
        TIFFGetField(tiff_, TIFFTAG_IMAGELENGTH, &l.height) != 1 || l.width == 0 || l.height == 0)
      fail("has no size; it is no image");
    if (l.width > kMaxSide || l.height > kMaxSide || std::uint64_t{l.width} * l.height > kMaxPixels)
      fail("has " + std::to_string(l.width) + " x " + std::to_string(l.height) + " pixels; at most " +
           std::to_string(kMaxSide) + " a side and 10000 x 10000 in all, scale it down");
    TIFFGetFieldDefaulted(tiff_, TIFFTAG_BITSPERSAMPLE, &l.bits);
    TIFFGetFieldDefaulted(tiff_, TIFFTAG_SAMPLESPERPIXEL, &l.samples);
    TIFFGetFieldDefaulted(tiff_, TIFFTAG_PLANARCONFIG, &l.planes);
    TIFFGetFieldDefaulted(tiff_, TIFFTAG_SAMPLEFORMAT, &l.format);
    if (TIFFGetField(tiff_, TIFFTAG_PHOTOMETRIC, &l.photometric) != 1)
      l.photometric = l.samples >= 3 ? PHOTOMETRIC_RGB : PHOTOMETRIC_MINISBLACK;
    if (l.photometric == PHOTOMETRIC_CIELAB || l.photometric == PHOTOMETRIC_ICCLAB ||
        l.photometric == PHOTOMETRIC_ITULAB)
      fail("its colours are Lab; convert it to RGB with any image tool");
    const bool whole = l.bits == 8 || l.bits == 16 || l.bits == 32;
    const bool known = l.format == SAMPLEFORMAT_UINT || l.format == SAMPLEFORMAT_VOID ||
                       (l.format == SAMPLEFORMAT_INT && whole) ||
                       (l.format == SAMPLEFORMAT_IEEEFP && (l.bits == 32 || l.bits == 64));
    if (!known || (is_measure() && l.photometric != PHOTOMETRIC_MINISBLACK))
      fail("has signed or floating samples that are no grey map; convert it: gdal_translate -ot Byte -scale");
    if (l.bits < 1 || (l.bits > 16 && !is_measure()) || l.samples < 1 || l.samples > kMaxSamples)
      fail("has " + std::to_string(l.samples) + " samples of " + std::to_string(l.bits) +
           " bits a pixel; convert it: gdal_translate -ot Byte");
    const std::uint16_t colours = l.photometric == PHOTOMETRIC_RGB ? 3 : 1;
    if (l.samples < colours) fail("says RGB but has " + std::to_string(l.samples) + " samples a pixel");
    std::uint16_t extra_count = 0;
    std::uint16_t* extra = nullptr;
    TIFFGetFieldDefaulted(tiff_, TIFFTAG_EXTRASAMPLES, &extra_count, &extra);
    for (int i = 0; i < extra_count && l.alpha < 0; ++i)
      if (extra[i] == EXTRASAMPLE_ASSOCALPHA || extra[i] == EXTRASAMPLE_UNASSALPHA) {
        l.alpha = static_cast<int>(l.samples) - static_cast<int>(extra_count) + i;
        l.premultiplied = extra[i] == EXTRASAMPLE_ASSOCALPHA;
      }
    if (l.alpha < static_cast<int>(colours)) l.alpha = -1;
    // Three bands or more of which nothing is said: programs for many bands store colours so.
    const int bands = static_cast<int>(l.samples) - (l.alpha >= 0 ? 1 : 0);
    if (l.photometric == PHOTOMETRIC_MINISBLACK && bands >= 3 && !is_measure()) l.photometric = PHOTOMETRIC_RGB;
    read_chunk_size();
  }

  void read_chunk_size() {
    Layout& l = layout_;
    l.tiled = TIFFIsTiled(tiff_) != 0;
    if (l.tiled) {
      TIFFGetField(tiff_, TIFFTAG_TILEWIDTH, &l.chunk_width);
      TIFFGetField(tiff_, TIFFTAG_TILELENGTH, &l.chunk_height);
    } else {
      l.chunk_width = l.width;
      TIFFGetFieldDefaulted(tiff_, TIFFTAG_ROWSPERSTRIP, &l.chunk_height);
      l.chunk_height = std::min(l.chunk_height, l.height);
    }
    if (l.chunk_width == 0 || l.chunk_height == 0) fail("has strips or tiles of no size; it is damaged");
  }

  /// Every strip or tile lies inside the file: a truncated file is known before its pixels are unpacked.
  void check_chunks() const {
    struct stat status {};
    if (fstat(TIFFFileno(tiff_), &status) != 0) return;
    const std::uint32_t count = layout_.tiled ? TIFFNumberOfTiles(tiff_) : TIFFNumberOfStrips(tiff_);
    std::uint64_t stored = 0;
    for (std::uint32_t i = 0; i < count; ++i) {
      const std::uint64_t offset = TIFFGetStrileOffset(tiff_, i);
      const std::uint64_t size = TIFFGetStrileByteCount(tiff_, i);
      const auto end = static_cast<std::uint64_t>(status.st_size);
      if (size > end || offset > end - size) fail("is truncated: its pixels end after the file; copy it again");
      stored += size;
    }
    std::uint16_t compression = COMPRESSION_NONE;
    TIFFGetFieldDefaulted(tiff_, TIFFTAG_COMPRESSION, &compression);
    if (const std::uint64_t most = most_expansion(compression); most > 0 && stored < picture_bytes() / most)
      fail("is damaged: " + std::to_string(layout_.width) + " x " + std::to_string(layout_.height) +
           " pixels cannot be packed into " + std::to_string(stored) + " bytes; copy it again");
    const auto chunk = static_cast<std::uint64_t>(layout_.tiled ? TIFFTileSize64(tiff_) : TIFFStripSize64(tiff_));
    if (chunk == 0 || chunk > std::max(kMaxChunk, 2 * picture_bytes()))
      fail("has strips or tiles of an absurd size; it is damaged");
  }

  /// Of all samples, unpacked.
  std::uint64_t picture_bytes() const {
    const auto row = static_cast<std::uint64_t>(TIFFScanlineSize64(tiff_));
    return row * layout_.height * (layout_.planes == PLANARCONFIG_SEPARATE ? layout_.samples : 1);
  }

  /// Signed, floating or 32-bit: not colours but what was measured.
  bool is_measure() const {
    return layout_.format == SAMPLEFORMAT_INT || layout_.format == SAMPLEFORMAT_IEEEFP || layout_.bits == 32;
  }

  /// The value that means "no data" (GDAL's tag 42113, a text).
  void find_no_data() {
    constexpr std::uint32_t kTag = 42113;
    const TIFFField* const field = TIFFFindField(tiff_, kTag, TIFF_ANY);
    if (field == nullptr) return;
    const char* text = nullptr;
    std::uint32_t count = 0;
    std::uint16_t short_count = 0;
    if (TIFFFieldPassCount(field) == 0) {
      if (TIFFGetField(tiff_, kTag, &text) != 1 || text == nullptr) return;
      count = static_cast<std::uint32_t>(std::char_traits<char>::length(text));
    } else if (TIFFFieldReadCount(field) == TIFF_VARIABLE2) {
      if (TIFFGetField(tiff_, kTag, &count, &text) != 1 || text == nullptr) return;
    } else {
      if (TIFFGetField(tiff_, kTag, &short_count, &text) != 1 || text == nullptr) return;
      count = short_count;
    }
    std::string word(text, count);
    while (!word.empty() && (word.back() == '\0' || word.back() == ' ')) word.pop_back();
    no_data_ = parse_number(word);
  }

  double measure(const std::uint8_t* row, std::size_t i) const {
    const auto as = [&](auto value) {
      std::memcpy(&value, row + i * sizeof value, sizeof value);
      return static_cast<double>(value);
    };
    if (layout_.format == SAMPLEFORMAT_IEEEFP) return layout_.bits == 32 ? as(float{}) : as(double{});
    if (layout_.format == SAMPLEFORMAT_INT)
      return layout_.bits == 8 ? as(std::int8_t{}) : layout_.bits == 16 ? as(std::int16_t{}) : as(std::int32_t{});
    return as(std::uint32_t{});
  }

  /// `take` gets the first sample of every pixel; NaN where there is none.
  template <class Take>
  void visit_measures(const Take& take) const {
    const std::size_t stride = layout_.planes == PLANARCONFIG_SEPARATE ? 1 : layout_.samples;
    visit_chunks([&](std::uint32_t x0, std::uint32_t y0, const std::vector<Bytes>& planes) {
      const std::uint32_t rows = std::min(layout_.chunk_height, layout_.height - y0);
      const std::uint32_t columns = std::min(layout_.chunk_width, layout_.width - x0);
      for (std::uint32_t y = 0; y < rows; ++y)
        for (std::uint32_t x = 0; x < columns; ++x) {
          double value = measure(planes[0].data() + y * row_size(), x * stride);
          if (!std::isfinite(value) || is_no_data(value)) value = std::nan("");
          take(static_cast<int>(x0 + x), static_cast<int>(y0 + y), value);
        }
    });
  }

  bool is_no_data(double value) const {
    return no_data_ && std::abs(value - *no_data_) <= 1e-6 * std::max(1.0, std::abs(*no_data_));
  }

  /// All colours have the value.
  bool is_no_data(const Samples& values) const {
    const std::size_t colours = layout_.photometric == PHOTOMETRIC_RGB ? 3 : 1;
    return std::all_of(values.begin(), values.begin() + static_cast<std::ptrdiff_t>(colours),
                       [&](std::uint32_t v) { return is_no_data(static_cast<double>(v)); });
  }

  /// Of single precision as people write it: 0.05, not 0.05000000074505806.
  static std::string brief(double value) {
    constexpr double kDigits = 1e6;
    return number_text(std::round(value * kDigits) / kDigits + 0.0);
  }

  /// 0 (wall), 255 (free) and 128 (neither), of P(occupied) or per cent.
  static std::uint8_t usual_grey(double value, bool probable) {
    constexpr double kFree = 0.4, kOccupied = 0.6;
    if (std::isnan(value) || value == -1.0) return 128;
    const double p = probable ? value : 0.01 * value;
    return p <= kFree ? 255 : p >= kOccupied ? 0 : 128;
  }

  /// More than these are no labels.
  static constexpr std::size_t kMostLabels = 8;

  /// The whole numbers that samples have, in order; nothing where there are too many, or others.
  class WholeNumbers {
   public:
    void add(double value) {
      if (!few_ || value == last_) return;
      last_ = value;
      const auto at = std::lower_bound(values_.begin(), values_.end(), value);
      if (at != values_.end() && *at == value) return;
      few_ = values_.size() < kMostLabels && value == std::round(value);
      if (few_) values_.insert(at, value);
    }
    std::vector<double> values() const { return few_ ? values_ : std::vector<double>(); }

   private:
    std::vector<double> values_;
    double last_ = std::nan("");
    bool few_ = true;
  };

  /// Whole numbers that are labels: not those of greys, but where three of them are next to each other, and not those
  /// of walls alone or of free ground alone.
  std::vector<SampleLabel> labels_of(const std::vector<double>& values, bool probable, bool percent) const {
    std::vector<SampleLabel> out;
    bool wall = false, free = false;
    for (const double v : values) {
      const std::uint8_t grey = usual_grey(v, probable);
      out.push_back({v, grey});
      wall = wall || grey == 0;
      free = free || grey == 255;
    }
    constexpr double kNext = 12.0;  // of 255: nearer greys are alike
    bool crowded = false;
    for (std::size_t i = 2; i < values.size(); ++i) crowded = crowded || values[i] - values[i - 2] <= kNext;
    if (!probable && !percent && !(crowded && values.size() >= 4)) return {};
    if (values.size() < 3 && probable && !(wall && free)) return {};
    return values.size() < 2 ? std::vector<SampleLabel>() : out;
  }

  void read_measures(RgbImage& image) const {
    double least = std::numeric_limits<double>::infinity();
    double most = -least;
    WholeNumbers whole;
    visit_measures([&](int, int, double value) {
      if (std::isnan(value)) return;
      whole.add(value);
      if (value == -1.0) return;
      least = std::min(least, value);
      most = std::max(most, value);
    });
    constexpr double kSlack = 1e-6;
    if (!(least >= -kSlack && most <= 255.0 + kSlack))
      fail("has samples from " + number_text(least) + " to " + number_text(most) +
           ", which are neither P(occupied) from 0 to 1 nor per cent from 0 to 100 nor grey levels; convert it");
    const bool probable = most <= 1.0 + kSlack;
    const bool percent = !probable && most <= 100.0 + kSlack;
    notes_.labels = labels_of(whole.values(), probable, percent);
    const auto has = [&](int grey) {
      return std::any_of(notes_.labels.begin(), notes_.labels.end(),
                         [&](const SampleLabel& label) { return label.grey == grey; });
    };
    if ((probable || percent) && (notes_.labels.empty() || (has(0) && has(255))))
      notes_.meaning =
          std::string(probable ? "P(occupied)" : "per cent occupied") + " from " + brief(least) + " to " + brief(most);
    notes_.no_data.resize(image.rgb.size() / 3);
    visit_measures([&](int x, int y, double value) {
      int grey = 128;
      if (std::isnan(value) || (value == -1.0 && notes_.labels.empty())) {
        notes_.no_data[image.index(x, y)] = 1;
      } else if (!notes_.labels.empty()) {
        grey = 0;
        while (notes_.labels[static_cast<std::size_t>(grey)].value < value) ++grey;
      } else if (probable || percent) {
        grey = usual_grey(value, probable);
      } else {
        grey = static_cast<int>(std::lround(value));
      }
      std::fill_n(image.pixel(x, y), 3, static_cast<std::uint8_t>(grey));
    });
  }

  bool is_simple() const {
    return layout_.photometric == PHOTOMETRIC_MINISBLACK || layout_.photometric == PHOTOMETRIC_MINISWHITE ||
           layout_.photometric == PHOTOMETRIC_RGB || layout_.photometric == PHOTOMETRIC_PALETTE;
  }

  /// What stands for white and for opaque. Deep samples are read once more than needed: many hold 0..255 unscaled. So
  /// is opacity: a layer that is nowhere opaque, as viewers save it, counts as opaque where it is most so.
  void find_white() {
    white_ = opaque_ = full_opacity_ = (1u << layout_.bits) - 1;
    if (layout_.bits <= 8 && layout_.alpha < 0) return;
    std::uint32_t brightest = 0;
    std::uint32_t most_opaque = 0;
    visit_chunks([&](std::uint32_t x0, std::uint32_t y0, const std::vector<Bytes>& planes) {
      visit_samples(x0, y0, planes, [&](int, int, const Samples& values) {
        for (std::size_t s = 0; s < layout_.samples; ++s) {
          if (!is_used(s)) continue;
          std::uint32_t& most = static_cast<int>(s) == layout_.alpha ? most_opaque : brightest;
          most = std::max(most, values[s]);
        }
      });
    });
    if (layout_.bits > 8 && layout_.photometric != PHOTOMETRIC_PALETTE) white_ = white_of(brightest, white_);
    if (most_opaque == 0) return;
    // Colours that were multiplied by their opacity grow with it, but for those scaled by their brightest already.
    const bool is_scaled = is_odd_white(white_, (1u << layout_.bits) - 1);
    full_opacity_ = is_scaled ? most_opaque : white_of(most_opaque, opaque_, true);
    opaque_ = most_opaque;
  }

  /// The 8-bit value of every sample value, and the colours of a palette.
  void read_tables() {
    const std::uint32_t values = 1u << layout_.bits;
    level_.resize(values);
    for (std::uint32_t v = 0; v < values; ++v) {
      const std::uint32_t linear = (std::min(v, white_) * 255u + white_ / 2) / white_;
      level_[v] = static_cast<std::uint8_t>(layout_.photometric == PHOTOMETRIC_MINISWHITE ? 255u - linear : linear);
    }
    if (layout_.photometric != PHOTOMETRIC_PALETTE) return;
    std::array<std::uint16_t*, 3> map{};
    if (TIFFGetField(tiff_, TIFFTAG_COLORMAP, &map[0], &map[1], &map[2]) != 1) fail("has a palette without colours");
    bool is_wide = false;  // some writers store 8-bit colours in the 16-bit table
    for (const std::uint16_t* channel : map)
      for (std::uint32_t v = 0; v < values; ++v) is_wide = is_wide || channel[v] > 255;
    for (std::size_t c = 0; c < 3; ++c) {
      palette_[c].resize(values);
      for (std::uint32_t v = 0; v < values; ++v)
        palette_[c][v] = static_cast<std::uint8_t>(is_wide ? map[c][v] >> 8 : map[c][v]);
    }
  }

  /// Stored as it is returned.
  bool is_plain_rgb() const {
    return layout_.photometric == PHOTOMETRIC_RGB && layout_.bits == 8 && layout_.samples == 3 &&
           layout_.planes == PLANARCONFIG_CONTIG;
  }

  /// The sample is a colour or the opacity.
  bool is_used(std::size_t sample) const {
    return sample < (layout_.photometric == PHOTOMETRIC_RGB ? 3u : 1u) || static_cast<int>(sample) == layout_.alpha;
  }

  void read_chunks(RgbImage& image) {
    if (layout_.alpha >= 0) image.alpha.resize(image.rgb.size() / 3);
    if (no_data_) notes_.no_data.resize(image.rgb.size() / 3);
    visit_chunks([&](std::uint32_t x0, std::uint32_t y0, const std::vector<Bytes>& planes) {
      if (is_plain_rgb() && !no_data_)
        copy_chunk(x0, y0, planes[0], image);
      else
        visit_samples(x0, y0, planes, [&](int x, int y, const Samples& values) {
          draw_pixel(values, image.pixel(x, y));
          if (layout_.alpha >= 0) image.alpha[image.index(x, y)] = opacity(values);
          if (no_data_) notes_.no_data[image.index(x, y)] = is_no_data(values) ? 1 : 0;
        });
    });
  }

  void read_first_chunk() const {
    Bytes bytes(chunk_size());
    read_chunk(0, 0, 0, bytes);
  }

  std::size_t chunk_size() const {
    return static_cast<std::size_t>(layout_.tiled ? TIFFTileSize(tiff_) : TIFFStripSize(tiff_));
  }

  /// Unpacks strip after strip or tile after tile: `take` gets its corner and its planes.
  template <class Take>
  void visit_chunks(const Take& take) const {
    const bool separate = layout_.planes == PLANARCONFIG_SEPARATE;
    const std::size_t size = chunk_size();
    std::vector<Bytes> planes(separate ? layout_.samples : 1);
    for (std::size_t plane = 0; plane < planes.size(); ++plane)
      if (is_used(plane)) planes[plane].resize(size);
    for (std::uint32_t y = 0; y < layout_.height; y += layout_.chunk_height)
      for (std::uint32_t x = 0; x < layout_.width; x += layout_.chunk_width) {
        for (std::size_t plane = 0; plane < planes.size(); ++plane)
          if (!planes[plane].empty()) read_chunk(x, y, static_cast<std::uint16_t>(plane), planes[plane]);
        take(x, y, planes);
      }
  }

  void read_chunk(std::uint32_t x, std::uint32_t y, std::uint16_t plane, Bytes& bytes) const {
    const auto size = static_cast<tmsize_t>(bytes.size());
    std::fill(bytes.begin(), bytes.end(), std::uint8_t{0});
    const std::uint32_t rows = std::min(layout_.chunk_height, layout_.height - y);
    const tmsize_t wanted = layout_.tiled ? size : TIFFVStripSize(tiff_, rows);
    const tmsize_t got =
        layout_.tiled
            ? TIFFReadEncodedTile(tiff_, TIFFComputeTile(tiff_, x, y, 0, plane), bytes.data(), size)
            : TIFFReadEncodedStrip(tiff_, TIFFComputeStrip(tiff_, y, plane), bytes.data(), std::min(size, wanted));
    if (got < wanted) fail_read();
  }

  /// Sample number i of a row: big-endian bits, but whole 16-bit words are in the machine's order.
  std::uint32_t sample(const std::uint8_t* row, std::size_t i) const {
    if (layout_.bits == 8) return row[i];
    if (layout_.bits == 16) return reinterpret_cast<const std::uint16_t*>(row)[i];
    std::uint32_t value = 0;
    std::size_t bit = i * layout_.bits;
    for (std::uint32_t left = layout_.bits; left > 0; --left, ++bit)
      value = (value << 1) | ((row[bit >> 3] >> (7 - (bit & 7))) & 1u);
    return value;
  }

  void copy_chunk(std::uint32_t x0, std::uint32_t y0, const Bytes& bytes, RgbImage& image) const {
    const std::uint32_t rows = std::min(layout_.chunk_height, layout_.height - y0);
    const std::uint32_t columns = std::min(layout_.chunk_width, layout_.width - x0);
    for (std::uint32_t y = 0; y < rows; ++y)
      std::copy_n(bytes.data() + y * row_size(), std::size_t{3} * columns,
                  image.pixel(static_cast<int>(x0), static_cast<int>(y0 + y)));
  }

  std::size_t row_size() const {
    return static_cast<std::size_t>(layout_.tiled ? TIFFTileRowSize(tiff_) : TIFFScanlineSize(tiff_));
  }

  /// `take` gets every pixel of a strip or tile.
  template <class Take>
  void visit_samples(std::uint32_t x0, std::uint32_t y0, const std::vector<Bytes>& planes, const Take& take) const {
    const std::size_t row_bytes = row_size();
    const std::uint32_t rows = std::min(layout_.chunk_height, layout_.height - y0);
    const std::uint32_t columns = std::min(layout_.chunk_width, layout_.width - x0);
    const bool separate = planes.size() > 1;
    Samples values{};
    for (std::uint32_t y = 0; y < rows; ++y)
      for (std::uint32_t x = 0; x < columns; ++x) {
        for (std::size_t s = 0; s < layout_.samples; ++s) {
          if (!is_used(s)) continue;
          const std::uint8_t* const row = planes[separate ? s : 0].data() + y * row_bytes;
          values[s] = sample(row, separate ? x : static_cast<std::size_t>(x) * layout_.samples + s);
        }
        take(static_cast<int>(x0 + x), static_cast<int>(y0 + y), values);
      }
  }

  std::uint8_t opacity(const Samples& values) const {
    const std::uint32_t alpha = std::min(values[static_cast<std::size_t>(layout_.alpha)], opaque_);
    return static_cast<std::uint8_t>((alpha * 255u + opaque_ / 2) / opaque_);
  }

  void draw_pixel(const Samples& values, std::uint8_t* rgb) const {
    for (std::size_t c = 0; c < 3; ++c) {
      const std::uint32_t value = values[layout_.photometric == PHOTOMETRIC_RGB ? c : 0];
      std::uint32_t colour = layout_.photometric == PHOTOMETRIC_PALETTE ? palette_[c][value] : level_[value];
      if (layout_.alpha >= 0) {
        const std::uint32_t top = opaque_;
        const std::uint32_t alpha = std::min(values[static_cast<std::size_t>(layout_.alpha)], top);
        const std::uint32_t behind = (behind_[c] * (top - alpha) + top / 2) / top;
        colour = (colour * (layout_.premultiplied ? full_opacity_ : alpha) + top / 2) / top + behind;
      }
      rgb[c] = static_cast<std::uint8_t>(std::min(colour, 255u));
    }
  }

  RgbImage read_by_libtiff() {
    TIFFSetField(tiff_, TIFFTAG_ORIENTATION, ORIENTATION_TOPLEFT);
    const std::size_t pixels = static_cast<std::size_t>(layout_.width) * layout_.height;
    // Zeros that the system hands out when they are touched: a damaged file takes none.
    const std::unique_ptr<std::uint32_t[], void (*)(void*)> raster(
        static_cast<std::uint32_t*>(std::calloc(pixels, sizeof(std::uint32_t))), std::free);
    if (!raster) throw std::bad_alloc();
    if (TIFFReadRGBAImageOriented(tiff_, layout_.width, layout_.height, raster.get(), ORIENTATION_TOPLEFT, 1) != 1)
      fail("cannot be read (" + complaint_.text +
           "); convert it to RGB: gdal_translate -expand rgb, or any image tool");
    RgbImage image(static_cast<int>(layout_.width), static_cast<int>(layout_.height));
    for (std::size_t i = 0; i < pixels; ++i) {
      image.rgb[3 * i] = static_cast<std::uint8_t>(TIFFGetR(raster[i]));
      image.rgb[3 * i + 1] = static_cast<std::uint8_t>(TIFFGetG(raster[i]));
      image.rgb[3 * i + 2] = static_cast<std::uint8_t>(TIFFGetB(raster[i]));
    }
    return image;
  }

  TIFF* tiff_;
  const std::string& path_;
  const TiffComplaint& complaint_;
  const Rgb& behind_;
  SampleNotes& notes_;
  Layout layout_;
  std::optional<double> no_data_;
  std::uint32_t white_ = 255;         ///< sample value
  std::uint32_t opaque_ = 255;        ///< sample value
  std::uint32_t full_opacity_ = 255;  ///< the sample value by which opacity was multiplied into colours
  Bytes level_;
  std::array<Bytes, 3> palette_;
};

}  // namespace

RgbImage read_pixels(TIFF* tiff, const std::string& path, const TiffComplaint& complaint, const Rgb& behind,
                     SampleNotes& notes) {
  return Reader(tiff, path, complaint, behind, notes).read();
}

}  // namespace rubble
