#include "arenas/truth/wall_lines.h"

#include <cmath>

#include "arenas/model/risers.h"
#include "base/text/number_text.h"

namespace rubble::arenas {
namespace {

using mrpt::math::TPoint2D;

constexpr double kBoard = 0.05;  ///< a rectangle no thicker than this is a board [m]

/// A tenth of a millimetre: arena files have no more, and sums do not show their rounding.

double length(const TPoint2D& v) { return std::hypot(v.x, v.y); }

/// Whether the outline is a rectangle that is thin one way; `first`: the corner where one of its long sides starts.
bool is_board(const Outline& o, std::size_t& first) {
  if (o.size() != 4) return false;
  const TPoint2D u = o[1] - o[0];
  const TPoint2D v = o[2] - o[1];
  const TPoint2D w = o[3] - o[2];
  if (std::abs(u.x * v.x + u.y * v.y) > 1e-6 || length(u + w) > 1e-6) return false;
  first = length(u) >= length(v) ? 0 : 1;
  return std::min(length(u), length(v)) <= kBoard;
}

void add_solid(const Solid& solid, int part, std::vector<WallLine>& lines) {
  WallLine line;
  line.bottom_a = line.bottom_b = solid.z_bottom;
  line.top_a = line.top_b = solid.z_top;
  line.kind = solid.element;
  line.part = part;
  const Outline& o = solid.outline;
  std::size_t i = 0;
  if (is_board(o, i)) {
    line.a = (o[i] + o[(i + 3) % 4]) * 0.5;
    line.b = (o[i + 1] + o[(i + 2) % 4]) * 0.5;
    line.thickness = length(o[(i + 3) % 4] - o[i]);
    lines.push_back(line);
    return;
  }
  for (i = 0; i < o.size(); ++i) {
    line.a = o[i];
    line.b = o[(i + 1) % o.size()];
    lines.push_back(line);
  }
}

/// The fields of a line in the order of the columns, as name and text.
std::vector<std::pair<const char*, std::string>> numbers_of(const WallLine& line) {
  return {{"bottom", metres_text(line.bottom_a)},     {"top", metres_text(line.top_a)},
          {"thickness", metres_text(line.thickness)}, {"part", std::to_string(line.part)},
          {"bottom_end", metres_text(line.bottom_b)}, {"top_end", metres_text(line.top_b)}};
}

std::string plain(const std::string& kind) {
  std::string text;
  for (const char c : kind) text += c == '"' || c == '\\' || c == ',' || static_cast<unsigned char>(c) < 0x20 ? '_' : c;
  return text;
}

}  // namespace

std::vector<WallLine> wall_lines(const Arena& arena) {
  std::vector<WallLine> lines;
  int part = 0;
  for (const Solid& solid : arena.solids) add_solid(solid, part++, lines);
  for (const Riser& riser : risers(arena)) {
    lines.push_back({riser.a, riser.b, riser.low_a, riser.high_a, riser.low_b, riser.high_b,
                     riser.above_floor ? "step" : "rim", 0.0, part++});
  }
  return lines;
}

std::string walls_csv(const std::vector<WallLine>& lines) {
  std::string text = "x0,y0,x1,y1,bottom,top,kind,thickness,part,bottom_end,top_end\n";
  for (const WallLine& line : lines) {
    const auto fields = numbers_of(line);
    text +=
        metres_text(line.a.x) + "," + metres_text(line.a.y) + "," + metres_text(line.b.x) + "," + metres_text(line.b.y);
    for (std::size_t i = 0; i < fields.size(); ++i)
      text += (i == 2 ? "," + plain(line.kind) : "") + "," + fields[i].second;
    text += "\n";
  }
  return text;
}

std::string walls_geojson(const std::vector<WallLine>& lines) {
  std::string text = "{\"type\": \"FeatureCollection\", \"crs\": null, \"features\": [\n";
  for (std::size_t i = 0; i < lines.size(); ++i) {
    const WallLine& line = lines[i];
    text += "{\"type\": \"Feature\", \"properties\": {\"kind\": \"" + plain(line.kind) + "\"";
    for (const auto& [name, value] : numbers_of(line)) text += std::string(", \"") + name + "\": " + value;
    text += "}, \"geometry\": {\"type\": \"LineString\", \"coordinates\": [[" + metres_text(line.a.x) + ", " +
            metres_text(line.a.y) + "], [" + metres_text(line.b.x) + ", " + metres_text(line.b.y) + "]]}}" +
            (i + 1 < lines.size() ? ",\n" : "\n");
  }
  return text + "]}\n";
}

}  // namespace rubble::arenas
