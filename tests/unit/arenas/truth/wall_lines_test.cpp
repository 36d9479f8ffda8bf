#include "arenas/truth/wall_lines.h"
#include "tests/support/source_dir.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <sstream>

#include "arenas/files/arena_file.h"
#include "arenas/generate/generate.h"
#include "arenas/truth/truth_map.h"
#include "tests/support/arenas_draw.h"

namespace rubble::arenas {
namespace {

using mrpt::math::TPoint2D;

/// A line of the CSV.
struct Row {
  TPoint2D a, b;
  double bottom, top, thickness, bottom_end, top_end;
  std::string kind;
  int part;
};

std::vector<Row> read_csv(const std::string& text) {
  std::istringstream stream(text);
  std::string line;
  std::getline(stream, line);
  EXPECT_EQ(line, "x0,y0,x1,y1,bottom,top,kind,thickness,part,bottom_end,top_end");
  std::vector<Row> rows;
  while (std::getline(stream, line)) {
    std::vector<std::string> f;
    std::istringstream fields(line);
    for (std::string field; std::getline(fields, field, ',');) f.push_back(field);
    EXPECT_EQ(f.size(), 11u) << line;
    const auto number = [&](std::size_t i) { return std::stod(f[i]); };
    rows.push_back({{number(0), number(1)},
                    {number(2), number(3)},
                    number(4),
                    number(5),
                    number(7),
                    number(9),
                    number(10),
                    f[6],
                    std::stoi(f[8])});
  }
  return rows;
}

/// How far p lies outside (positive) or inside (negative) of a set of rows that make one part; `p_part`: 0..1 along it.
double outside(const std::vector<Row>& part, const TPoint2D& p, double& share) {
  const Row& first = part.front();
  if (part.size() == 1) {
    const TPoint2D along = first.b - first.a;
    const double length = std::hypot(along.x, along.y);
    const TPoint2D d = p - first.a;
    const double t = (d.x * along.x + d.y * along.y) / length;
    const double off = std::abs(d.x * along.y - d.y * along.x) / length;
    share = std::clamp(t / length, 0.0, 1.0);
    return std::max({-t, t - length, off - 0.5 * first.thickness});
  }
  double most = -1e9;  // convex and counter-clockwise
  for (const Row& row : part) {
    const TPoint2D along = row.b - row.a;
    const TPoint2D d = p - row.a;
    most = std::max(most, (d.x * along.y - d.y * along.x) / std::hypot(along.x, along.y));
  }
  return most;
}

/// By sampling, from the vectors alone: -1 no wall near the cell's cross, 1 surely one, 0 too close to call.
int is_wall(const std::vector<std::vector<Row>>& parts, const Arena& arena, const TPoint2D& c, double half,
            double slice) {
  constexpr double kDoubt = 0.002;  // [m]
  std::vector<double> floors;
  for (const TPoint2D& p : {c, TPoint2D{c.x - half, c.y}, TPoint2D{c.x + half, c.y}, TPoint2D{c.x, c.y - half},
                            TPoint2D{c.x, c.y + half}}) {
    if (const double z = floor_height(arena, p); std::isfinite(z)) floors.push_back(z);
  }
  if (floors.empty()) floors.push_back(0.0);
  int verdict = -1;
  for (const std::vector<Row>& part : parts) {
    const Row& row = part.front();
    if (row.kind == "rim") continue;
    const double reach = half + 0.1;
    if (part.size() == 1 && (std::min(row.a.x, row.b.x) > c.x + reach || std::max(row.a.x, row.b.x) < c.x - reach ||
                             std::min(row.a.y, row.b.y) > c.y + reach || std::max(row.a.y, row.b.y) < c.y - reach))
      continue;
    for (int k = -50; k <= 50; ++k) {
      for (const TPoint2D& p : {TPoint2D{c.x + half * k / 50.0, c.y}, TPoint2D{c.x, c.y + half * k / 50.0}}) {
        double share = 0.0;
        const double gap = outside(part, p, share);
        if (gap > kDoubt) continue;
        if (row.kind == "step") {
          const double high = row.top + share * (row.top_end - row.top);
          const double low = row.bottom + share * (row.bottom_end - row.bottom);
          if (high - low > slice - kDoubt)
            verdict = std::max(verdict, high - low > slice + 0.03 && gap < 0.0006 ? 1 : 0);
          continue;
        }
        for (const double z : floors) {
          const bool is_met = row.bottom <= z + slice + 1e-4 && z + slice <= row.top + 1e-4;
          const bool is_sure = row.bottom <= z + slice - 1e-4 && z + slice <= row.top - 1e-4 && gap < -kDoubt;
          if (is_met) verdict = std::max(verdict, is_sure ? 1 : 0);
        }
      }
    }
  }
  return verdict;
}

void expect_the_same_walls(const Arena& arena, double resolution, double slice) {
  std::map<int, std::vector<Row>> by_part;
  for (const Row& row : read_csv(walls_csv(wall_lines(arena)))) by_part[row.part].push_back(row);
  std::vector<std::vector<Row>> parts;
  for (const auto& [number, rows] : by_part) parts.push_back(rows);
  const OccupancyGrid map = truth_map(arena, resolution, slice);
  int walls = 0, doubtful = 0;
  for (int y = 1; y + 1 < map.height(); ++y) {
    for (int x = 1; x + 1 < map.width(); ++x) {
      bool is_seen = false;
      for (int v = y - 1; v <= y + 1; ++v)
        for (int u = x - 1; u <= x + 1; ++u) is_seen = is_seen || map[{u, v}] == Occupancy::Free;
      if (!is_seen) continue;  // what nobody sees is unknown in the truth
      const TPoint2D c = map.frame().centre({x, y});
      const int verdict = is_wall(parts, arena, c, 0.5 * resolution - 1e-6, slice);
      const bool is_occupied = map[{x, y}] == Occupancy::Occupied;
      if (verdict != 0) {
        EXPECT_EQ(is_occupied, verdict == 1) << c.x << " " << c.y;
      }
      walls += is_occupied ? 1 : 0;
      doubtful += verdict == 0 ? 1 : 0;
    }
  }
  EXPECT_GT(walls, 100);
  EXPECT_LT(doubtful, walls / 4);
}

/// The oracle: the vectors, drawn at the slice height, are the truth map's walls.
TEST(WallLines, DrawnAtTheSliceTheyAreTheWallsOfTheTruth) {
  GenerateConfig config;
  config.seed = 4;
  config.columns = config.rows = 4;
  const Arena yellow = parse_arena(generate_arena(config), "generated");
  for (const double slice : {0.35, 0.1, 0.9}) {
    SCOPED_TRACE(slice);
    expect_the_same_walls(yellow, 0.05, slice);
  }
  expect_the_same_walls(yellow, 0.08, 0.35);
}

TEST(WallLines, SoForRampsAndTheLeaguesParts) {
  GenerateConfig config;
  config.seed = 2;
  config.columns = config.rows = 5;
  config.rough = 0.4;
  config.kind = ArenaKind::Red;
  const Arena red = parse_arena(generate_arena(config), "red");
  config.kind = ArenaKind::Orange;
  const Arena orange = parse_arena(generate_arena(config), "orange");
  for (const double slice : {0.35, 0.115}) {  // between the steps of 0.05 m by which columns differ
    SCOPED_TRACE(slice);
    expect_the_same_walls(load_arena(std::string(RUBBLE_SOURCE_DIR) + "/arenas/shipped/demo_ramps.yaml"), 0.05, slice);
    expect_the_same_walls(red, 0.05, slice);
    expect_the_same_walls(orange, 0.05, slice);
  }
}

TEST(WallLines, ABoardIsOneLineAndABlockFour) {
  const Arena a = rubble::testing::arena({"+---+---+",  //
                                          "| S   # |",  //
                                          "+---+---+"});
  const std::vector<WallLine> lines = wall_lines(a);
  const auto count = [&](const std::string& kind) {
    return std::count_if(lines.begin(), lines.end(), [&](const WallLine& line) { return line.kind == kind; });
  };
  EXPECT_EQ(count("wall"), 4);
  EXPECT_EQ(count("block"), 4);
  EXPECT_NE(walls_csv(lines).find("\n0,0,2.4,0,0,1.2,wall,0.02,"), std::string::npos) << walls_csv(lines);
}

}  // namespace
}  // namespace rubble::arenas
