#include <algorithm>
#include <array>
#include <sstream>
#include <string_view>

#include "base/error.h"
#include "base/image/rich_tiff.h"
#include "base/text/number_text.h"
#include "base/text/text_file.h"
#include "base/text/words.h"

namespace rubble {
namespace {

constexpr const char* kMeaning[] = {
    "x size of a pixel",         "row rotation", "column rotation", "y size of a pixel", "x of the upper-left centre",
    "y of the upper-left centre"};

std::string_view trimmed(std::string_view text) {
  const std::size_t first = text.find_first_not_of(" \t\r");
  if (first == std::string_view::npos) return {};
  return text.substr(first, text.find_last_not_of(" \t\r") - first + 1);
}

}  // namespace

void write_world_file(const std::string& path, const PixelToModel& t) {
  std::string text;
  for (const double value : {t.a, t.d, t.b, t.e, t.c + 0.5 * (t.a + t.b), t.f + 0.5 * (t.d + t.e)})
    text += number_text(value) + "\n";
  write_text_file(path, text);
}

PixelToModel read_world_file(const std::string& path) {
  std::istringstream stream(read_text_file(path));
  std::array<double, 6> v{};
  std::size_t count = 0;
  std::string line;
  for (int number = 1; std::getline(stream, line); ++number) {
    const std::string_view word = trimmed(line);
    if (word.empty()) continue;
    if (count == v.size()) throw InputError(at(path, number, 1, "a seventh line; a world file has six numbers"));
    const auto value = parse_number(word);
    if (!value)
      throw InputError(at(path, number, 1, in_quotes(word) + " is no number; give the " + kMeaning[count] + " [m]"));
    v[count++] = *value;
  }
  if (count < v.size())
    throw InputError(at(path, static_cast<int>(count) + 1, 1, std::string("missing the ") + kMeaning[count] + " [m]"));
  const auto [a, d, b, e, x, y] = v;
  if (a * e - b * d == 0.0) throw InputError(at(path, 1, 1, "pixels of no size; give the size of a pixel in metres"));
  return {a, b, x - 0.5 * (a + b), d, e, y - 0.5 * (d + e)};
}

std::optional<PixelToModel> read_aux_xml(const std::string& path) {
  const std::string text = read_text_file(path);
  const std::string tag = "<GeoTransform>";
  const std::size_t begin = text.find(tag);
  if (begin == std::string::npos) return std::nullopt;
  const std::size_t end = text.find('<', begin + tag.size());
  std::string numbers = text.substr(begin + tag.size(), end - begin - tag.size());
  std::replace(numbers.begin(), numbers.end(), ',', ' ');
  std::istringstream stream(numbers);
  std::array<double, 6> v{};
  std::size_t count = 0;
  for (std::string word; stream >> word; ++count) {
    const auto value = parse_number(word);
    if (!value || count == v.size()) throw InputError(path + ": its GeoTransform is no list of six numbers");
    v[count] = *value;
  }
  if (count != v.size() || v[1] * v[5] - v[2] * v[4] == 0.0)
    throw InputError(path + ": its GeoTransform is no list of six numbers, or of pixels of no size");
  return PixelToModel{v[1], v[2], v[0], v[4], v[5], v[3]};
}

}  // namespace rubble
