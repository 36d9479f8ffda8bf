#include "scoring/maps/pois.h"
#include "base/text/csv.h"

#include <algorithm>
#include <filesystem>
#include <optional>
#include <sstream>
#include <string_view>

#include "arenas/files/arena_file.h"
#include "base/error.h"
#include "base/text/number_text.h"
#include "base/text/text_file.h"

namespace rubble::scoring {
namespace {

/// Where the columns we need stand.
struct Header {
  std::size_t name = 0;
  std::size_t x = 0;
  std::size_t y = 0;
  std::optional<std::size_t> type;  ///< the league's form has one
};

std::optional<std::size_t> column(const std::vector<std::string>& fields, const std::string& name) {
  const auto at = std::find(fields.begin(), fields.end(), name);
  if (at == fields.end()) return std::nullopt;
  return static_cast<std::size_t>(at - fields.begin());
}

std::optional<Header> header_of(const std::vector<std::string>& fields) {
  const auto name = column(fields, "name");
  const auto x = column(fields, "x");
  const auto y = column(fields, "y");
  if (!name || !x || !y) return std::nullopt;
  return Header{*name, *x, *y, column(fields, "type")};
}

double coordinate(const std::string& path, int line, const std::string& text) {
  const std::optional<double> value = parse_number(text);
  if (!value) throw InputError(at(path, line, 1, "'" + text + "' is no coordinate; give metres, for example 2.45"));
  return *value;
}

/// "victim 3", as all else calls it, for what the list of a run calls victim_3.
std::string as_it_is_called(const std::string& name) {
  constexpr std::string_view kListed = "victim_";
  const bool is_listed = name.rfind(kListed, 0) == 0 && name.size() > kListed.size() &&
                         name.find_first_not_of("0123456789", kListed.size()) == std::string::npos;
  return is_listed ? "victim " + name.substr(kListed.size()) : name;
}

PoiList read_csv(const std::string& path) {
  PoiList out;
  std::optional<Header> header;
  std::stringstream lines(read_text_file(path));
  int number = 0;
  for (std::string line; std::getline(lines, line);) {
    ++number;
    if (!line.empty() && line.back() == '\r') line.pop_back();
    if (line.empty()) continue;
    const std::vector<std::string> fields = csv_fields(line);
    if (!header) {
      header = header_of(fields);  // the preamble before it is skipped
      continue;
    }
    const std::size_t last = std::max({header->name, header->x, header->y, header->type.value_or(0)});
    if (fields.size() <= last)
      throw InputError(
          at(path, number, 1,
             "has " + std::to_string(fields.size()) + " fields, but the header needs " + std::to_string(last + 1)));
    if (header->type && fields[*header->type] != "victim") continue;
    const double x = coordinate(path, number, fields[header->x]);
    const double y = coordinate(path, number, fields[header->y]);
    out.pois.push_back({as_it_is_called(fields[header->name]),
                        header->type ? mrpt::math::TPoint2D(-y, x) : mrpt::math::TPoint2D(x, y)});
  }
  if (!header) throw InputError(path + ": has no header line with name, x and y; is it a list of victims?");
  if (header->type) out.form = PoiForm::League;
  return out;
}

}  // namespace

PoiList read_poi_list(const std::string& path) {
  const std::string extension = std::filesystem::path(path).extension().string();
  if (extension != ".yaml" && extension != ".yml") return read_csv(path);
  PoiList out;
  out.form = PoiForm::Arena;
  for (const arenas::Victim& victim : arenas::load_arena(path).victims)
    out.pois.push_back({victim.name, {victim.position.x, victim.position.y}});
  return out;
}

}  // namespace rubble::scoring
