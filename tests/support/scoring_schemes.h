#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <functional>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include "base/rng.h"
#include "tests/support/scoring_attacks.h"
#include "tests/support/scoring_grounds.h"

/// Further schemes to earn more than a map knows, each beside what an honest team would hand in. They were written when
/// the score stood, to try it on what it was not made for.
namespace rubble::scoring::testing {

/// The cells for which `in` holds, taken from `other`.
template <class In>
OccupancyGrid replaced(const OccupancyGrid& map, const OccupancyGrid& other, const In& in) {
  OccupancyGrid out = map;
  for (int y = 0; y < map.height(); ++y)
    for (int x = 0; x < map.width(); ++x)
      if (in(map.centre({x, y}))) out[{x, y}] = other[{x, y}];
  return out;
}

inline TPoint2D middle_of(const OccupancyGrid& map) {
  const GridFrame f = known_frame(map, 0.0).value_or(map.frame());
  return {f.x0 + 0.5 * f.width * f.resolution, f.y0 + 0.5 * f.height * f.resolution};
}

/// What is beyond the line through the middle in direction `angle` becomes unknown.
inline OccupancyGrid cut_at(const OccupancyGrid& map, double angle, double past_middle = 0.0) {
  const TPoint2D m = middle_of(map);
  return replaced(map, OccupancyGrid(map.frame()), [&](const TPoint2D& p) {
    return (p.x - m.x) * std::cos(angle) + (p.y - m.y) * std::sin(angle) > past_middle;
  });
}

/// Only what lies in `share` of the squares of a metre and a half stays known.
inline OccupancyGrid patches_of(const OccupancyGrid& map, double share, std::uint64_t seed) {
  Rng rng(seed, "patches");
  const int across = static_cast<int>(std::ceil(map.width() * map.resolution() / 1.5)) + 1;
  const int along = static_cast<int>(std::ceil(map.height() * map.resolution() / 1.5)) + 1;
  std::vector<bool> kept;
  for (int i = 0; i < across * along; ++i) kept.push_back(rng.uniform() < share);
  return replaced(map, OccupancyGrid(map.frame()), [&](const TPoint2D& p) {
    const int x = static_cast<int>((p.x - map.frame().x0) / 1.5);
    const int y = static_cast<int>((p.y - map.frame().y0) / 1.5);
    return !kept[static_cast<std::size_t>(y * across + x)];
  });
}

/// The drawing moved by a pose about its middle, on the same canvas.
inline OccupancyGrid displaced(const OccupancyGrid& map, double dx, double dy, double turn) {
  const TPoint2D m = middle_of(map);
  const TPose2D T = TPose2D(m.x + dx, m.y + dy, turn) + TPose2D(-m.x, -m.y, 0.0);
  OccupancyGrid out(map.frame());
  for (int y = 0; y < map.height(); ++y)
    for (int x = 0; x < map.width(); ++x) {
      const Cell from = map.cell(T.inverseComposePoint(map.centre({x, y})));
      if (map.inside(from)) out[{x, y}] = map[from];
    }
  return out;
}

/// The walls of both, over what either knows.
inline OccupancyGrid blended(const OccupancyGrid& a, const OccupancyGrid& b) {
  OccupancyGrid out = filled(a, b);
  for (std::size_t i = 0; i < out.cells().size(); ++i)
    if (b.cells()[i] == Occupancy::Occupied) out.cells()[i] = Occupancy::Occupied;
  return out;
}

/// Unknown cells take the class of the known cell nearest to the west or east, up to `reach` [m] away.
inline OccupancyGrid smeared(const OccupancyGrid& map, double reach) {
  OccupancyGrid out = map;
  const int cells = static_cast<int>(reach / map.resolution());
  for (int y = 0; y < map.height(); ++y)
    for (int x = 0; x < map.width(); ++x) {
      if (map[{x, y}] != Occupancy::Unknown) continue;
      for (int d = 1; d <= cells; ++d) {
        if (x >= d && map[{x - d, y}] != Occupancy::Unknown) {
          out[{x, y}] = map[{x - d, y}];
          break;
        }
        if (x + d < map.width() && map[{x + d, y}] != Occupancy::Unknown) {
          out[{x, y}] = map[{x + d, y}];
          break;
        }
      }
    }
  return out;
}

/// Free space within the outline of `truth`, with strips on its lattice of `what`, `width` wide and, where `dash` > 0,
/// as long as the gaps between them.
inline OccupancyGrid lattice_of(const OccupancyGrid& truth, Occupancy what, double width, double dash = 0.0) {
  const GridFrame known = known_frame(truth, 0.0).value_or(truth.frame());
  OccupancyGrid out(truth.frame());
  for (int y = 0; y < out.height(); ++y)
    for (int x = 0; x < out.width(); ++x) {
      const TPoint2D p = out.centre({x, y});
      const double u = p.x - known.x0 - 0.05;
      const double v = p.y - known.y0 - 0.05;
      if (u < -0.05 || v < -0.05 || u > known.width * known.resolution || v > known.height * known.resolution) continue;
      const double off_x = std::abs(std::remainder(u, kLattice));
      const double off_y = std::abs(std::remainder(v, kLattice));
      const bool dashed_x = dash > 0.0 && std::fmod(v + 10.0 * dash, 2.0 * dash) < dash;
      const bool dashed_y = dash > 0.0 && std::fmod(u + 10.0 * dash, 2.0 * dash) < dash;
      const bool on = (off_x <= 0.5 * width && !dashed_x) || (off_y <= 0.5 * width && !dashed_y);
      out[{x, y}] = on ? what : Occupancy::Free;
    }
  return out;
}

/// Every wall broken into pieces: a gap of `gap` [m] each `period` [m] along either axis.
inline OccupancyGrid dashed(const OccupancyGrid& map, double gap, double period) {
  OccupancyGrid out = map;
  for (int y = 0; y < map.height(); ++y)
    for (int x = 0; x < map.width(); ++x) {
      const TPoint2D p = map.centre({x, y});
      if (map[{x, y}] == Occupancy::Occupied && std::fmod(p.x + p.y + 1000.0 * period, period) < gap)
        out[{x, y}] = Occupancy::Free;
    }
  return out;
}

/// Walls grow by so many cells, but only to the north-east.
inline OccupancyGrid fatter_on_one_side(const OccupancyGrid& map, int cells) {
  OccupancyGrid out = map;
  for (int y = 0; y < map.height(); ++y)
    for (int x = 0; x < map.width(); ++x) {
      if (map[{x, y}] != Occupancy::Occupied) continue;
      for (int dy = 0; dy <= cells; ++dy)
        for (int dx = 0; dx <= cells; ++dx)
          if (map.inside({x + dx, y + dy}) && map[{x + dx, y + dy}] != Occupancy::Unknown)
            out[{x + dx, y + dy}] = Occupancy::Occupied;
    }
  return out;
}

/// Cells within `reach` [m] of walls become unknown, the walls stay.
inline OccupancyGrid haloed(const OccupancyGrid& map, double reach) {
  OccupancyGrid out = map;
  const int cells = static_cast<int>(std::lround(reach / map.resolution()));
  for (int y = 0; y < map.height(); ++y)
    for (int x = 0; x < map.width(); ++x) {
      if (map[{x, y}] != Occupancy::Occupied) continue;
      for (int dy = -cells; dy <= cells; ++dy)
        for (int dx = -cells; dx <= cells; ++dx)
          if (map.inside({x + dx, y + dy}) && map[{x + dx, y + dy}] == Occupancy::Free)
            out[{x + dx, y + dy}] = Occupancy::Unknown;
    }
  return out;
}

/// Free cells within `reach` [m] of where a wall ends become unknown: there it may go on.
inline OccupancyGrid with_unsure_ends(const OccupancyGrid& map, double reach) {
  OccupancyGrid out = map;
  const int cells = static_cast<int>(std::lround(reach / map.resolution()));
  for (int y = 3; y + 3 < map.height(); ++y)
    for (int x = 3; x + 3 < map.width(); ++x) {
      if (map[{x, y}] != Occupancy::Occupied) continue;
      int around = 0;
      for (int dy = -3; dy <= 3; ++dy)
        for (int dx = -3; dx <= 3; ++dx) around += map[{x + dx, y + dy}] == Occupancy::Occupied ? 1 : 0;
      if (around > 9) continue;  // of a wall of two cells that goes on there are 14
      for (int dy = -cells; dy <= cells; ++dy)
        for (int dx = -cells; dx <= cells; ++dx)
          if (map.inside({x + dx, y + dy}) && map[{x + dx, y + dy}] == Occupancy::Free)
            out[{x + dx, y + dy}] = Occupancy::Unknown;
    }
  return out;
}

/// The half turned about the middle fills the other one.
inline OccupancyGrid with_its_half_turn(const OccupancyGrid& map, const TPoint2D& about) {
  OccupancyGrid turned(map.frame());
  for (int y = 0; y < map.height(); ++y)
    for (int x = 0; x < map.width(); ++x) {
      const TPoint2D p = map.centre({x, y});
      const Cell from = map.cell({2.0 * about.x - p.x, 2.0 * about.y - p.y});
      if (map.inside(from)) turned[{x, y}] = map[from];
    }
  return filled(map, turned);
}

/// A second drawing beside the first, joined to it by a strip of free space so that they are one piece.
inline OccupancyGrid joined_to(const OccupancyGrid& first, const OccupancyGrid& second) {
  const GridFrame a = known_frame(first, 0.0).value_or(first.frame());
  const GridFrame b = known_frame(second, 0.0).value_or(second.frame());
  constexpr int kBetween = 16;  // [cells]
  GridFrame frame = first.frame();
  const Cell a_low = first.cell({a.x0 + 0.5 * a.resolution, a.y0 + 0.5 * a.resolution});
  const Cell b_low = second.cell({b.x0 + 0.5 * b.resolution, b.y0 + 0.5 * b.resolution});
  frame.width = a_low.x + a.width + kBetween + b.width + 10;
  frame.height = std::max(first.height(), a_low.y + b.height + 10);
  OccupancyGrid out(frame);
  for (int y = 0; y < first.height(); ++y)
    for (int x = 0; x < a_low.x + a.width; ++x) out[{x, y}] = first[{x, y}];
  for (int y = 0; y < b.height; ++y)
    for (int x = 0; x < b.width; ++x)
      out[{a_low.x + a.width + kBetween + x, a_low.y + y}] = second[{b_low.x + x, b_low.y + y}];
  const int row = a_low.y + std::min(a.height, b.height) / 2;
  for (int y = row - 8; y < row + 8; ++y)
    for (int x = 0; x < frame.width - 12; ++x)
      if (out[{x, y}] == Occupancy::Unknown) out[{x, y}] = Occupancy::Free;
  return out;
}

/// Free floor within the outline of `truth`, with the walls around it or without.
inline OccupancyGrid hall_like(const OccupancyGrid& truth, bool with_walls) {
  const GridFrame known = known_frame(truth, 0.0).value_or(truth.frame());
  OccupancyGrid out(truth.frame());
  constexpr double kWall = 0.1;  // [m]
  for (int y = 0; y < out.height(); ++y)
    for (int x = 0; x < out.width(); ++x) {
      const TPoint2D p = out.centre({x, y});
      const double in = std::min({p.x - known.x0, p.y - known.y0, known.x0 + known.width * known.resolution - p.x,
                                  known.y0 + known.height * known.resolution - p.y});
      if (in > 0.0) out[{x, y}] = in < kWall && with_walls ? Occupancy::Occupied : Occupancy::Free;
    }
  return out;
}

/// Twelve arenas of about that size, which are not the truth.
inline std::vector<OccupancyGrid> drawn_arenas(const OccupancyGrid& truth) {
  const GridFrame known = known_frame(truth, 0.0).value_or(truth.frame());
  const auto pallets = [&](int cells) {
    return std::max(3, static_cast<int>(std::lround(cells * known.resolution / kLattice)));
  };
  static std::map<std::pair<int, int>, std::vector<OccupancyGrid>> drawn;  // several schemes ask for the same
  std::vector<OccupancyGrid>& out = drawn[{pallets(known.width), pallets(known.height)}];
  for (std::uint64_t seed = 60001; out.size() < 12; ++seed)
    out.push_back(truth_of({"yellow", pallets(known.width), pallets(known.height), seed}));
  return out;
}

/// The walls that more than `least` of `others` (a share) have there, each laid with the middle of its outline on that
/// of `truth`.
inline OccupancyGrid most_probable(const OccupancyGrid& truth, const std::vector<OccupancyGrid>& others, double least) {
  OccupancyGrid out = hall_like(truth, true);
  constexpr double kNear = 0.05;  // by which lattices may be off each other [m]
  Grid<int> walls(out.frame(), 0);
  for (const OccupancyGrid& other : others) {
    const OccupancyGrid wide = thickened(other, static_cast<int>(std::lround(kNear / other.resolution())));
    const TPoint2D off = middle_of(other) - middle_of(truth);
    for (int y = 0; y < out.height(); ++y)
      for (int x = 0; x < out.width(); ++x) {
        const Cell from = wide.cell(out.centre({x, y}) + off);
        if (wide.inside(from) && wide[from] == Occupancy::Occupied) ++walls[{x, y}];
      }
  }
  for (std::size_t i = 0; i < out.cells().size(); ++i)
    if (out.cells()[i] == Occupancy::Free && walls.cells()[i] > least * static_cast<double>(others.size()))
      out.cells()[i] = Occupancy::Occupied;
  return out;
}

/// The map with specks of wall, as many as a third of its wall cells, on free ground within `reach` [m] of them (per
/// axis).
inline OccupancyGrid scribbled(const OccupancyGrid& map, double reach, std::uint64_t seed) {
  OccupancyGrid out = map;
  Rng rng(seed, "scribbles");
  for (int y = 0; y < map.height(); ++y)
    for (int x = 0; x < map.width(); ++x) {
      if (map[{x, y}] != Occupancy::Occupied || rng.uniform() > 0.3) continue;
      const Cell to{x + static_cast<int>(std::lround((2.0 * rng.uniform() - 1.0) * reach / map.resolution())),
                    y + static_cast<int>(std::lround((2.0 * rng.uniform() - 1.0) * reach / map.resolution()))};
      if (map.inside(to) && map[to] == Occupancy::Free) out[to] = Occupancy::Occupied;
    }
  return out;
}

/// Walls of a single cell, broken into dashes: of each wall the cells with free or unknown ground to the west or south.
inline OccupancyGrid thin_dashes(const OccupancyGrid& map, double gap, double period) {
  OccupancyGrid out = map;
  for (int y = 1; y < map.height(); ++y)
    for (int x = 1; x < map.width(); ++x) {
      if (map[{x, y}] != Occupancy::Occupied) continue;
      const bool first = map[{x - 1, y}] != Occupancy::Occupied || map[{x, y - 1}] != Occupancy::Occupied;
      if (!first) out[{x, y}] = Occupancy::Free;
    }
  return dashed(out, gap, period);
}

/// On each edge of the lattice over what the truth knows a stroke of `length` [m] in the middle: a wall of less
/// strength.
inline OccupancyGrid strokes_on_lattice(const OccupancyGrid& truth, double length) {
  const GridFrame known = known_frame(truth, 0.0).value_or(truth.frame());
  OccupancyGrid out = lattice_of(truth, Occupancy::Occupied, 0.1);
  for (int y = 0; y < out.height(); ++y)
    for (int x = 0; x < out.width(); ++x) {
      if (out[{x, y}] != Occupancy::Occupied) continue;
      const TPoint2D p = out.centre({x, y});
      const double u = p.x - known.x0 - 0.05, v = p.y - known.y0 - 0.05;
      const double off_x = std::abs(std::remainder(u, kLattice)), off_y = std::abs(std::remainder(v, kLattice));
      const double along = std::max(off_x, off_y);  // 0.6 in the middle of an edge
      if (0.5 * kLattice - along > 0.5 * length) out[{x, y}] = Occupancy::Free;
    }
  return out;
}

/// Free floor in strips of `width` [m] along the lattice that is not within 0.3 m of a wall of the map becomes unknown.
inline OccupancyGrid open_edges_unknown(const OccupancyGrid& map, double width) {
  const OccupancyGrid strips = lattice_of(map, Occupancy::Unknown, width);
  const int cells = static_cast<int>(std::lround(0.3 / map.resolution()));
  OccupancyGrid out = map;
  for (int y = 0; y < map.height(); ++y)
    for (int x = 0; x < map.width(); ++x) {
      if (map[{x, y}] != Occupancy::Free || strips[{x, y}] != Occupancy::Unknown) continue;
      bool near = false;
      for (int dy = -cells; dy <= cells && !near; ++dy)
        for (int dx = -cells; dx <= cells && !near; ++dx)
          near = map.inside({x + dx, y + dy}) && map[{x + dx, y + dy}] == Occupancy::Occupied;
      if (!near) out[{x, y}] = Occupancy::Unknown;
    }
  return out;
}

/// Walls all along where free floor meets unknown ground: the outline closed.
inline OccupancyGrid with_closed_outline(const OccupancyGrid& map) {
  OccupancyGrid out = map;
  for (int y = 1; y + 1 < map.height(); ++y)
    for (int x = 1; x + 1 < map.width(); ++x) {
      if (map[{x, y}] != Occupancy::Unknown) continue;
      bool beside = false;
      for (int dy = -1; dy <= 1; ++dy)
        for (int dx = -1; dx <= 1; ++dx) beside = beside || map[{x + dx, y + dy}] == Occupancy::Free;
      if (beside) out[{x, y}] = Occupancy::Occupied;
    }
  return out;
}

/// One scheme: what may be handed in honestly (their mean counts: a team that cannot tell its hypotheses apart draws
/// one of them), and what is handed in instead.
struct Scheme {
  std::string name;
  std::function<std::vector<OccupancyGrid>(const OccupancyGrid& truth, std::uint64_t seed)> honest;
  std::function<OccupancyGrid(const OccupancyGrid& truth, const OccupancyGrid& stranger, std::uint64_t seed)> attack;
};

inline std::vector<Scheme> schemes() {
  using Grid = const OccupancyGrid&;
  using Seed = std::uint64_t;
  const auto part = [](Grid truth, Seed seed) { return cut_at(truth, 0.7 * static_cast<double>(seed)); };
  const auto only_part = [=](Grid truth, Seed seed) { return std::vector<OccupancyGrid>{part(truth, seed)}; };
  const auto nothing = [](Grid truth, Seed) { return std::vector<OccupancyGrid>{OccupancyGrid(truth.frame())}; };
  const auto worn = [](Grid truth, Seed seed) { return with_gaps(with_phantoms(truth, 6, seed), 12, seed); };
  const auto only_worn = [=](Grid truth, Seed seed) { return std::vector<OccupancyGrid>{worn(truth, seed)}; };
  // One half may have slipped.
  const auto slipped = [](Grid truth, double by) {
    const TPoint2D m = middle_of(truth);
    return replaced(truth, displaced(truth, by, 0.6 * by, 0.0), [&](const TPoint2D& p) { return p.x > m.x; });
  };
  const auto poses = [](Grid truth) {
    return std::vector<OccupancyGrid>{truth, displaced(truth, 0.35, 0.0, 0.03), displaced(truth, 0.0, -0.35, -0.03)};
  };
  return {
      {"part, the rest another arena", only_part,
       [=](Grid truth, Grid stranger, Seed seed) {
         const TPoint2D a = middle_of(truth);
         const TPoint2D b = middle_of(stranger);
         OccupancyGrid there(truth.frame());
         for (int y = 0; y < there.height(); ++y)
           for (int x = 0; x < there.width(); ++x) {
             const Cell from = stranger.cell(there.centre({x, y}) - a + b);
             if (stranger.inside(from)) there[{x, y}] = stranger[from];
           }
         return filled(part(truth, seed), there);
       }},
      {"part, the rest a full lattice", only_part,
       [=](Grid truth, Grid, Seed seed) {
         return filled(part(truth, seed), lattice_of(truth, Occupancy::Occupied, 0.1));
       }},
      {"part, the rest a dashed lattice", only_part,
       [=](Grid truth, Grid, Seed seed) {
         return filled(part(truth, seed), lattice_of(truth, Occupancy::Occupied, 0.1, 0.2));
       }},
      {"part, the rest free but for unknown strips", only_part,
       [=](Grid truth, Grid, Seed seed) {
         return filled(part(truth, seed), lattice_of(truth, Occupancy::Unknown, 0.25));
       }},
      {"part, the rest free but for broad unknown strips", only_part,
       [=](Grid truth, Grid, Seed seed) {
         return filled(part(truth, seed), lattice_of(truth, Occupancy::Unknown, 0.5));
       }},
      {"part, carried on by 0.5 m", only_part,
       [=](Grid truth, Grid, Seed seed) { return smeared(part(truth, seed), 0.5); }},
      {"part, carried on by 1.2 m", only_part,
       [=](Grid truth, Grid, Seed seed) { return smeared(part(truth, seed), 1.2); }},
      {"part, the rest its half turn", only_part,
       [=](Grid truth, Grid, Seed seed) { return with_its_half_turn(part(truth, seed), middle_of(truth)); }},
      {"nothing: a full lattice", nothing,
       [](Grid truth, Grid, Seed) { return lattice_of(truth, Occupancy::Occupied, 0.1); }},
      {"nothing: a dashed lattice", nothing,
       [](Grid truth, Grid, Seed) { return lattice_of(truth, Occupancy::Occupied, 0.1, 0.2); }},
      {"nothing: broad unknown strips", nothing,
       [](Grid truth, Grid, Seed) { return lattice_of(truth, Occupancy::Unknown, 0.5); }},
      {"nothing: unknown strips", nothing,
       [](Grid truth, Grid, Seed) { return lattice_of(truth, Occupancy::Unknown, 0.25); }},
      {"one half slipped or not: both drawn",
       [=](Grid truth, Seed) {
         return std::vector<OccupancyGrid>{truth, slipped(truth, 0.5)};
       },
       [=](Grid truth, Grid, Seed) { return blended(truth, slipped(truth, 0.5)); }},
      {"one half slipped or not: left unknown where they differ",
       [=](Grid truth, Seed) {
         return std::vector<OccupancyGrid>{truth, slipped(truth, 0.5)};
       },
       [=](Grid truth, Grid, Seed) {
         OccupancyGrid out = truth;
         const OccupancyGrid other = slipped(truth, 0.5);
         for (std::size_t i = 0; i < out.cells().size(); ++i)
           if (out.cells()[i] != other.cells()[i]) out.cells()[i] = Occupancy::Unknown;
         return out;
       }},
      {"three poses: all drawn", [=](Grid truth, Seed) { return poses(truth); },
       [=](Grid truth, Grid, Seed) {
         const std::vector<OccupancyGrid> all = poses(truth);
         return blended(blended(all[0], all[1]), all[2]);
       }},
      {"right or of another size: both, joined by a strip",
       [=](Grid truth, Seed seed) {
         return std::vector<OccupancyGrid>{worn(truth, seed), stretched(worn(truth, seed), 1.15)};
       },
       [=](Grid truth, Grid, Seed seed) { return joined_to(worn(truth, seed), stretched(worn(truth, seed), 1.15)); }},
      {"worn: walls dashed", only_worn,
       [=](Grid truth, Grid, Seed seed) { return dashed(worn(truth, seed), 0.1, 0.5); }},
      {"worn: a halo of unknown around walls", only_worn,
       [=](Grid truth, Grid, Seed seed) { return haloed(worn(truth, seed), 0.15); }},
      {"worn: a halo of 0.2 m", only_worn, [=](Grid truth, Grid, Seed seed) { return haloed(worn(truth, seed), 0.2); }},
      {"worn: a broad halo of unknown around walls", only_worn,
       [=](Grid truth, Grid, Seed seed) { return haloed(worn(truth, seed), 0.3); }},
      {"worn: unknown around the ends of walls", only_worn,
       [=](Grid truth, Grid, Seed seed) { return with_unsure_ends(worn(truth, seed), 0.35); }},
      {"worn: unknown in a third of the squares", only_worn,
       [=](Grid truth, Grid, Seed seed) { return patches_of(worn(truth, seed), 0.67, seed); }},
      {"worn: walls fatter on one side by 10 cm", only_worn,
       [=](Grid truth, Grid, Seed seed) { return fatter_on_one_side(worn(truth, seed), 2); }},
      {"worn: salt in 2 % of the free space", only_worn,
       [=](Grid truth, Grid, Seed seed) { return with_salt(worn(truth, seed), 0.02, seed); }},
      {"nothing: the walls around", nothing, [](Grid truth, Grid, Seed) { return hall_like(truth, true); }},
      {"nothing: free floor of the outline", nothing, [](Grid truth, Grid, Seed) { return hall_like(truth, false); }},
      {"nothing: walls that half of twelve arenas have", nothing,
       [](Grid truth, Grid, Seed) { return most_probable(truth, drawn_arenas(truth), 0.5); }},
      {"part, the rest walls that half of twelve arenas have", only_part,
       [=](Grid truth, Grid, Seed seed) {
         return filled(part(truth, seed), most_probable(truth, drawn_arenas(truth), 0.5));
       }},
      {"nothing: walls that a third of twelve arenas have", nothing,
       [](Grid truth, Grid, Seed) { return most_probable(truth, drawn_arenas(truth), 0.33); }},
      {"part, the rest the part moved on by a pallet", only_part,
       [=](Grid truth, Grid, Seed seed) {
         OccupancyGrid out = part(truth, seed);
         const double angle = 0.7 * static_cast<double>(seed);
         const int way = std::abs(std::cos(angle)) > std::abs(std::sin(angle)) ? 0 : 1;
         const double sign = (way == 0 ? std::cos(angle) : std::sin(angle)) > 0.0 ? 1.0 : -1.0;
         for (int k = 0; k < 8; ++k)
           out = filled(out, displaced(out, way == 0 ? sign * kLattice : 0.0, way == 1 ? sign * kLattice : 0.0, 0.0));
         return out;
       }},
      {"part, the rest strokes of 0.2 m on the lattice", only_part,
       [=](Grid truth, Grid, Seed seed) { return filled(part(truth, seed), strokes_on_lattice(truth, 0.2)); }},
      {"part, the rest strokes of 0.1 m on the lattice", only_part,
       [=](Grid truth, Grid, Seed seed) { return filled(part(truth, seed), strokes_on_lattice(truth, 0.1)); }},
      {"worn: scribbles within 0.2 m of walls", only_worn,
       [=](Grid truth, Grid, Seed seed) { return scribbled(worn(truth, seed), 0.2, seed); }},
      {"worn: scribbles within 0.4 m of walls", only_worn,
       [=](Grid truth, Grid, Seed seed) { return scribbled(worn(truth, seed), 0.4, seed); }},
      {"worn: thin dashes", only_worn,
       [=](Grid truth, Grid, Seed seed) { return thin_dashes(worn(truth, seed), 0.15, 0.3); }},
      {"worn: thin sparse dashes", only_worn,
       [=](Grid truth, Grid, Seed seed) { return thin_dashes(worn(truth, seed), 0.3, 0.45); }},
      {"worn: open edges of the lattice unknown", only_worn,
       [=](Grid truth, Grid, Seed seed) { return open_edges_unknown(worn(truth, seed), 0.7); }},
      {"worn: the outline closed", only_worn,
       [=](Grid truth, Grid, Seed seed) { return with_closed_outline(worn(truth, seed)); }},
  };
}

}  // namespace rubble::scoring::testing
