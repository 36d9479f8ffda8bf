#include "arenas/generate/generate.h"

#include <algorithm>
#include <cmath>

#include "arenas/generate/furnish.h"
#include "arenas/generate/maze.h"
#include "arenas/generate/rough.h"
#include "arenas/model/drawing.h"
#include "arenas/model/relief.h"
#include "base/error.h"
#include "base/rng.h"

namespace rubble::arenas {
namespace {

using mrpt::math::TPoint2D;

/// Fixed decimals with a point in any locale; no negative zero.
std::string fixed(double value, int decimals) {
  long long scale = 1;
  for (int i = 0; i < decimals; ++i) scale *= 10;
  const long long units = std::llround(value * static_cast<double>(scale));
  const long long whole = std::llabs(units) / scale;
  std::string fraction = std::to_string(std::llabs(units) % scale);
  fraction.insert(0, static_cast<std::size_t>(decimals) - fraction.size(), '0');
  return (units < 0 ? "-" : "") + std::to_string(whole) + (decimals > 0 ? "." + fraction : "");
}

/// The shortest of the forms with up to three decimals.
std::string number(double value) {
  std::string text = fixed(value, 3);
  text.erase(text.find_last_not_of('0') + 1);
  if (text.back() == '.') text.pop_back();
  return text;
}

void require(bool is_good, const std::string& message) {
  if (!is_good) throw InputError("generate: " + message);
}

void check_config(const GenerateConfig& config) {
  require(config.columns >= 2 && config.columns <= 60, "columns must be 2 to 60");
  require(config.rows >= 2 && config.rows <= 60, "rows must be 2 to 60");
  require(config.ramps >= 0.0 && config.ramps <= 1.0, "ramps must be a share, 0 to 1");
  require(config.paper >= 0.0 && config.paper <= 1.0, "paper must be a share, 0 to 1");
  require(config.loops >= 0.0 && config.loops <= 1.0, "loops must be a share, 0 to 1");
  require(config.rough >= 0.0 && config.rough <= 1.0, "rough must be a share, 0 to 1");
  require(config.sound_alone >= 0.0 && config.co2_alone >= 0.0 && config.sound_alone + config.co2_alone <= 1.0,
          "sound_alone and co2_alone must be shares, together 0 to 1");
  require(config.ramp_deg >= 1.0 && config.ramp_deg <= 45.0, "ramp_deg must be 1 to 45");
}

void check_victims(const GenerateConfig& config, std::size_t taken) {
  const int room = config.columns * config.rows - static_cast<int>(taken);
  require(config.victims >= 0 && config.victims <= room,
          "victims must be 0 to " + std::to_string(room) + ", one a pallet, none at the start or on an obstacle");
}

Drawing drawing_of(const Relief& relief, const Maze& maze, Cell start) {
  Drawing drawing{Grid<DrawnCell>(relief.frame()), {}, {}};
  for (int y = 0; y <= relief.height(); ++y) {
    for (int x = 0; x < relief.width(); ++x) {
      drawing.lying.push_back(is_open(maze, {x, y - 1}, {x, y}) ? ' ' : '-');
    }
    if (y == relief.height()) break;
    for (int x = 0; x <= relief.width(); ++x) {
      drawing.upright.push_back(is_open(maze, {x - 1, y}, {x, y}) ? ' ' : '|');
    }
    for (int x = 0; x < relief.width(); ++x) {
      DrawnCell& cell = drawing.cells[{x, y}];
      cell.shape = relief[{x, y}].shape;
      cell.level = relief[{x, y}].level;
      if (Cell{x, y} == start) cell.mark = 'S';
    }
  }
  return drawing;
}

/// Bearing along a random open side of the start pallet [deg].
int start_heading(const Maze& maze, Cell start, Rng& rng) {
  const std::vector<Cell> ways = open_neighbours(maze, start);
  const Cell next = ways[rng.below(static_cast<std::uint32_t>(ways.size()))];
  if (next.x != start.x) return next.x > start.x ? 0 : 180;
  return next.y > start.y ? 90 : -90;
}

/// Every step field is a throw of its own.
std::string elements_text(const std::vector<RoughPallet>& rough, Rng& throws) {
  constexpr std::uint32_t kThrows = 1000000;
  std::string text;
  for (const RoughPallet& pallet : rough) {
    const TPoint2D p = centre_of(pallet.cell);
    text += text.empty() ? "\nelements:\n" : "";
    text += "  - {type: " + pallet.type + ", x_m: " + number(p.x) + ", y_m: " + number(p.y) +
            ", rotation_deg: " + std::to_string(90 * pallet.turn);
    if (pallet.type.rfind("stepfield", 0) == 0) text += ", throw: " + std::to_string(1 + throws.below(kThrows));
    text += "}\n";
  }
  return text;
}

/// Walls that stand on those of the maze, so that elevated floors are closed in.
std::string parapets_text(const std::vector<RoughPallet>& rough, const Maze& maze) {
  std::string text;
  for (const RoughPallet& pallet : rough) {
    if (pallet.top == 0.0) continue;
    const Cell c = pallet.cell;
    const TPoint2D p = centre_of(c);
    for (const Cell step : kCellSides) {
      if (is_open(maze, c, {c.x + step.x, c.y + step.y})) continue;
      const TPoint2D m{p.x + kHalfPallet * step.x, p.y + kHalfPallet * step.y};
      text += text.empty() ? "\nwalls:\n" : "";
      text += "  - {from_m: [" + number(m.x - kHalfPallet * std::abs(step.y)) + ", " +
              number(m.y - kHalfPallet * std::abs(step.x)) + "], to_m: [" +
              number(m.x + kHalfPallet * std::abs(step.y)) + ", " + number(m.y + kHalfPallet * std::abs(step.x)) +
              "], bottom_m: 1.2, height_m: 1.2}\n";
    }
  }
  return text;
}

/// As a list in square brackets.
std::string cues_text(const PlacedVictim& victim) {
  std::string text;
  const auto add = [&](bool gives, const char* cue) {
    if (gives) text += (text.empty() ? "" : ", ") + std::string(cue);
  };
  add(victim.appearance, "appearance");
  add(victim.heat, "heat");
  add(victim.sound, "sound");
  add(victim.co2, "co2");
  return "[" + text + "]";
}

std::string victims_text(const std::vector<PlacedVictim>& victims) {
  std::string text;
  for (std::size_t i = 0; i < victims.size(); ++i) {
    const PlacedVictim& victim = victims[i];
    text += i == 0 ? "\nvictims:\n" : "";
    text += "  - {name: victim" + std::to_string(i + 1) + ", x_m: " + number(victim.position.x) +
            ", y_m: " + number(victim.position.y) +
            ", facing_deg: " + std::to_string(victim.facing == 3 ? -90 : 90 * victim.facing) +
            ", cues: " + cues_text(victim) + "}\n";
  }
  return text;
}

std::string paper_text(const Furniture& furniture) {
  std::string text;
  for (const Outline& sheet : furniture.sheets) {
    text += text.empty() ? "\npaper:\n" : "";
    text += "  - outline_m: [";
    for (std::size_t i = 0; i < sheet.size(); ++i) {
      text += (i > 0 ? ", " : "") + number(sheet[i].x) + ", " + number(sheet[i].y);
    }
    text += "]\n";
  }
  for (std::size_t i = 0; i < furniture.balls.size(); ++i) {
    const PaperBall& ball = furniture.balls[i];
    text += i == 0 ? "\nballs:\n" : "";
    text += "  - {x_m: " + number(ball.position.x) + ", y_m: " + number(ball.position.y) +
            ", radius_m: " + number(ball.radius) + "}\n";
  }
  return text;
}

/// What the head of the file says of victims that no camera finds.
std::string hidden_text(const GenerateConfig& config) {
  return (config.sound_alone > 0.0 ? ", sound alone " + number(config.sound_alone) : "") +
         (config.co2_alone > 0.0 ? ", CO2 alone " + number(config.co2_alone) : "");
}

}  // namespace

const std::vector<std::string>& arena_kinds() {
  static const std::vector<std::string> names = {"yellow", "orange", "red"};
  return names;
}

std::string name_of(ArenaKind kind) { return arena_kinds().at(static_cast<std::size_t>(kind)); }

ArenaKind arena_kind(const std::string& name) {
  require(name != kBlueArena, kNoBlueArena);
  const auto found = std::find(arena_kinds().begin(), arena_kinds().end(), name);
  require(found != arena_kinds().end(), "unknown kind '" + name + "': use yellow, orange or red");
  return static_cast<ArenaKind>(found - arena_kinds().begin());
}

std::string generate_arena(const GenerateConfig& config) {
  check_config(config);
  // One stream a concern: asking for more paper leaves the maze as it was.
  Rng start_rng(config.seed, "arena start");
  Rng relief_rng(config.seed, "arena relief");
  Rng maze_rng(config.seed, "arena maze");
  Rng rough_rng(config.seed, "arena rough");
  Rng throw_rng(config.seed, "arena step fields");
  Rng victim_rng(config.seed, "arena victims");
  Rng signs_rng(config.seed, "arena victim signs");
  Rng paper_rng(config.seed, "arena paper");

  const int cells = config.columns * config.rows;
  const int start_x = static_cast<int>(start_rng.below(static_cast<std::uint32_t>(config.columns)));
  const int start_y = static_cast<int>(start_rng.below(static_cast<std::uint32_t>(config.rows)));
  const Cell start{start_x, start_y};
  const int ramps = static_cast<int>(std::llround(config.ramps * cells));
  const int tallest = config.kind == ArenaKind::Yellow ? 1 : 2;
  const Relief relief = grow_relief(config.columns, config.rows, ramps, start, tallest, relief_rng);
  Maze maze = carve_maze(relief, config.loops, maze_rng);
  const std::vector<RoughPallet> rough = lay_rough(config.kind, relief, start, config.rough, maze, rough_rng);
  const int heading_deg = start_heading(maze, start, start_rng);
  std::vector<Cell> taken{start};
  for (const RoughPallet& pallet : rough) taken.push_back(pallet.cell);
  check_victims(config, taken.size());
  Furniture furniture;
  furniture.victims = place_victims(relief, maze, taken, config.victims, victim_rng);
  const int sound = static_cast<int>(std::llround(config.sound_alone * config.victims));
  const int co2 = std::min(static_cast<int>(std::llround(config.co2_alone * config.victims)), config.victims - sound);
  hide_victims(sound, co2, signs_rng, furniture.victims);
  scatter_paper(relief, taken, static_cast<int>(std::llround(config.paper * cells)), paper_rng, furniture);

  const std::string size = std::to_string(config.columns) + "x" + std::to_string(config.rows);
  const std::string seed = std::to_string(config.seed);
  const std::string obstacles = config.kind == ArenaKind::Yellow ? "" : ", rough " + number(config.rough);
  std::string text = "# A random " + name_of(config.kind) + " arena: " + size + " pallets, seed " + seed + ", ramps " +
                     number(config.ramps) + obstacles + ", paper " + number(config.paper) + ", loops " +
                     number(config.loops) + ", victims " + std::to_string(config.victims) + hidden_text(config) + ".\n";
  text += "name: " + name_of(config.kind) + "_" + size + "_" + seed + "\n";
  text += "ramp_deg: " + number(config.ramp_deg) + "\n\nmaze: |\n";
  for (const std::string& line : draw(drawing_of(relief, maze, start))) text += "  " + line + "\n";
  text += "\nstart: {heading_deg: " + std::to_string(heading_deg) + "}\n";
  text += elements_text(rough, throw_rng) + parapets_text(rough, maze);
  return text + victims_text(furniture.victims) + paper_text(furniture);
}

}  // namespace rubble::arenas
