#include "arenas/truth/render.h"

#include <algorithm>
#include <cmath>

#include "arenas/model/geometry.h"
#include "arenas/model/patch_index.h"
#include "arenas/truth/canvas.h"
#include "base/error.h"
#include "base/image/legend.h"

namespace rubble::arenas {
namespace {

using mrpt::math::TPoint2D;

constexpr Colour kGround{236, 233, 228};
constexpr Colour kWood{214, 190, 152};
constexpr Colour kSeam{150, 125, 90};
constexpr Colour kUphill{120, 84, 44};
constexpr Colour kWall{58, 56, 60};
constexpr Colour kTall{96, 24, 96};  ///< walls higher than a yellow arena's
constexpr Colour kBox{122, 72, 50};
constexpr Colour kHanging{120, 120, 150};
constexpr Colour kPaper{252, 252, 248};
constexpr Colour kCrease{170, 170, 165};
constexpr Colour kBottle{60, 120, 200};
constexpr Colour kRadio{200, 150, 30};
constexpr Colour kVictim{205, 38, 38};
constexpr Colour kStart{28, 128, 76};
constexpr double kSteep = 0.5;          ///< slopes above it get two arrows [rise a metre]
constexpr double kTallFrom = 1.5;       ///< [m]
constexpr double kMargin = 0.3;         ///< ground shown round the arena [m]
constexpr double kMostPixels = 6000.0;  ///< a side
constexpr int kBand = 256;              ///< rows painted at a time

Colour scaled(const Colour& colour, double factor) {
  Colour result{};
  for (std::size_t i = 0; i < 3; ++i) result[i] = std::clamp(colour[i] * factor, 0.0, 255.0);
  return result;
}

double highest(const FloorPatch& patch) {
  double z = patch.z;
  for (const TPoint2D& p : patch.outline) z = std::max(z, patch.height(p));
  return z;
}

/// How much light falls on a slope; the lamp stands in the north-west. Exaggerated, for 10 deg are hard to see.
double lit(const FloorPatch& patch) {
  const double towards_light = patch.gx - patch.gy;  // a slope that rises to the south-east faces the light
  return std::clamp(1.0 + 0.45 * towards_light / std::sqrt(1.0 + patch.gx * patch.gx + patch.gy * patch.gy), 0.75, 1.2);
}

/// Higher floor is lighter; most of the change lies in the first half metre, where ramps are.
Colour floor_colour(const FloorPatch& patch, const TPoint2D& p, double light) {
  const double z = std::max(0.0, patch.height(p));
  return scaled(kWood, std::min(1.14, light * (0.93 + 0.28 * z / (z + 0.35))));
}

TPoint2D middle(const Outline& outline) {
  TPoint2D sum;
  for (const TPoint2D& p : outline) sum = sum + p;
  return sum * (1.0 / static_cast<double>(outline.size()));
}

void draw_outline(const Outline& outline, double width, const Colour& colour, double opacity, Canvas& canvas) {
  for (std::size_t i = 0; i < outline.size(); ++i) {
    canvas.line(outline[i], outline[(i + 1) % outline.size()], width, colour, opacity);
  }
}

void draw_floor(const Arena& arena, Canvas& canvas) {
  std::vector<const FloorPatch*> patches;
  for (const FloorPatch& patch : arena.floor) patches.push_back(&patch);
  std::stable_sort(patches.begin(), patches.end(),
                   [](const FloorPatch* a, const FloorPatch* b) { return highest(*a) < highest(*b); });
  for (const FloorPatch* patch : patches) {
    const double light = lit(*patch);
    canvas.fill(patch->outline, [&](const TPoint2D& p) { return floor_colour(*patch, p, light); });
    draw_outline(patch->outline, 0.012, kSeam, 0.55, canvas);
    const double slope = std::hypot(patch->gx, patch->gy);
    const double size = std::sqrt(signed_area(patch->outline));
    if (slope < 0.02 || size < 0.3) continue;
    const TPoint2D uphill{patch->gx / slope, patch->gy / slope};
    const TPoint2D m = middle(patch->outline);
    const TPoint2D aside{-uphill.y, uphill.x};
    for (const double shift : slope > kSteep ? std::vector<double>{-0.12, 0.12} : std::vector<double>{0.0}) {
      const TPoint2D p = m + aside * (shift * size);
      canvas.arrow(p - uphill * (0.24 * size), p + uphill * (0.24 * size), 0.03 * size, kUphill, 0.75);
    }
  }
}

void draw_paper(const Arena& arena, Canvas& canvas) {
  for (const PaperSheet& sheet : arena.sheets) {
    canvas.fill(sheet.outline, kPaper, 0.88);
    draw_outline(sheet.outline, 0.008, kCrease, 0.9, canvas);
  }
  for (const PaperBall& ball : arena.balls) {
    const TPoint2D& p = ball.position;
    const double r = ball.radius;
    canvas.disc(p + TPoint2D{0.18 * r, -0.18 * r}, r, {60, 50, 40}, 0.35);  // shadow
    canvas.disc(p, r, kCrease);
    canvas.disc(p + TPoint2D{-0.06 * r, 0.06 * r}, 0.88 * r, kPaper);
    canvas.line(p + TPoint2D{-0.5 * r, -0.1 * r}, p + TPoint2D{0.1 * r, 0.35 * r}, 0.1 * r, kCrease);
    canvas.line(p + TPoint2D{0.1 * r, 0.35 * r}, p + TPoint2D{0.45 * r, -0.3 * r}, 0.1 * r, kCrease);
  }
}

/// Drawn at least 0.1 m wide, so that a bottle is seen.
void draw_objects(const Arena& arena, Canvas& canvas) {
  for (const LooseObject& object : arena.objects) {
    const double r = std::max(0.05, object.radius);
    const Colour& colour = object.kind == ObjectKind::Bottle ? kBottle : kRadio;
    canvas.disc(object.position + TPoint2D{0.25 * r, -0.25 * r}, r, {60, 50, 40}, 0.35);  // shadow
    canvas.disc(object.position, r, colour);
    canvas.disc(object.position, 0.4 * r, object.kind == ObjectKind::Bottle ? kPaper : kWall);
  }
}

const Colour& solid_colour(const Solid& solid, const PatchIndex& floors) {
  if (solid.element == kVictimBoxElement) return kBox;
  const double floor = floors.floor_height(middle(solid.outline));
  if (solid.z_bottom > (std::isfinite(floor) ? floor : 0.0) + 0.3) return kHanging;
  return solid.element == kWallElement && solid.z_top > kTallFrom ? kTall : kWall;
}

/// Thin walls are drawn at least 40 mm wide, so that a small picture still shows them.
void draw_solids(const Arena& arena, Canvas& canvas) {
  const PatchIndex floors(arena);
  for (const Solid& solid : arena.solids) {
    const Colour& colour = solid_colour(solid, floors);
    const bool is_box = colour == kBox;
    const bool is_ceiling = colour == kHanging && signed_area(solid.outline) > 1.0;  // the floor below it shows through
    canvas.fill(solid.outline, colour, is_ceiling ? 0.45 : 1.0);
    draw_outline(solid.outline, is_box ? 0.012 : 0.03, colour, 1.0, canvas);
  }
}

void draw_victims(const Arena& arena, Canvas& canvas) {
  for (const Victim& victim : arena.victims) {
    const TPoint2D p{victim.position.x, victim.position.y};
    canvas.disc(p, 0.12, kVictim);
    canvas.disc(p, 0.075, kPaper);
    canvas.disc(p, 0.045, kVictim);
    const TPoint2D facing{std::cos(victim.facing), std::sin(victim.facing)};
    canvas.arrow(p + facing * 0.13, p + facing * 0.32, 0.028, kVictim);
  }
}

void draw_start(const Arena& arena, Canvas& canvas) {
  const TPoint2D p{arena.start.x, arena.start.y};
  const TPoint2D heading{std::cos(arena.start.phi), std::sin(arena.start.phi)};
  canvas.disc(p, 0.3, kStart, 0.25);
  canvas.disc(p, 0.09, kStart);
  canvas.arrow(p, p + heading * 0.46, 0.055, kStart);
}

/// As the arena has it: nobody looks for what is not there.
std::vector<LegendEntry> legend_of(const Arena& arena) {
  std::vector<LegendEntry> entries;
  const auto add = [&](bool is_there, const Colour& colour, const std::string& words, Sign sign = Sign::Field) {
    const auto channel = [&](std::size_t i) { return static_cast<std::uint8_t>(std::lround(colour[i])); };
    if (is_there) entries.emplace_back(Bgr{channel(2), channel(1), channel(0)}, words, sign);
  };
  const auto has_solid = [&, floors = PatchIndex(arena)](const Colour& colour, bool is_wall = true) {
    return std::any_of(arena.solids.begin(), arena.solids.end(), [&](const Solid& solid) {
      return solid_colour(solid, floors) == colour && (is_wall || solid.element != kWallElement);
    });
  };
  const auto has_object = [&](bool bottle) {
    return std::any_of(arena.objects.begin(), arena.objects.end(),
                       [&](const LooseObject& object) { return (object.kind == ObjectKind::Bottle) == bottle; });
  };
  const auto has_floor = [&](const auto& is_such) {
    return std::any_of(arena.floor.begin(), arena.floor.end(), is_such);
  };
  const auto has_part = [&](const char* element) {
    return has_floor([&](const FloorPatch& patch) { return patch.element == element; });
  };
  const auto slope = [](const FloorPatch& patch) { return std::hypot(patch.gx, patch.gy); };
  const Colour wood = scaled(kWood, 0.93);
  const bool raised = has_floor([](const FloorPatch& patch) { return highest(patch) > 0.02; });
  add(!arena.floor.empty(), wood, raised ? "floor, the higher the lighter" : "floor");
  add(true, kGround, "no floor");
  add(has_floor([&](const FloorPatch& patch) { return slope(patch) >= 0.02; }), kUphill, "uphill", Sign::Arrow);
  add(has_floor([&](const FloorPatch& patch) { return slope(patch) > kSteep; }), kUphill, "uphill, steeper than 27 deg",
      Sign::Arrows);
  add(has_part("step_field"), wood, "step field", Sign::Grid);
  const bool crossing = has_part("crossing_ramp"), elevated = has_part("elevated_ramp");
  add(crossing || elevated, wood,
      crossing && elevated ? "crossing or elevated ramps"
      : crossing           ? "crossing ramps"
                           : "elevated ramps",
      Sign::Quarters);
  add(has_part("stair"), wood, "stairs", Sign::Stripes);
  add(has_solid(kWall), kWall, has_solid(kWall, false) ? "wall, block or other part" : "wall");
  add(has_solid(kTall), kTall, "wall above 1.5 m");
  add(has_solid(kHanging), kHanging, "hangs above the floor");
  add(has_solid(kBox), kBox, "victim's box");
  add(!arena.sheets.empty(), kPaper, "paper");
  add(!arena.balls.empty(), kPaper, "paper ball", Sign::Dot);
  add(has_object(true), kBottle, "bottle", Sign::Dot);
  add(has_object(false), kRadio, "radio", Sign::Dot);
  add(!arena.victims.empty(), kVictim, "victim and its facing", Sign::Ring);
  add(true, kStart, "start and heading", Sign::Arrow);
  return entries;
}

}  // namespace

RgbImage render(const Arena& arena, double pixels_per_metre) {
  const TPoint2D margin{kMargin, kMargin};
  const TPoint2D min = arena.min_corner - margin;
  const TPoint2D max = arena.max_corner + margin;
  const double side = std::max(max.x - min.x, max.y - min.y);
  const double scale = std::min(pixels_per_metre, (kMostPixels - 1.0) / side);
  RgbImage picture;
  for (int row = 0; row == 0 || row < picture.height; row += kBand) {
    Canvas canvas(min, max, scale, kGround, row, kBand);
    if (row == 0) picture = RgbImage(canvas.width(), canvas.height());
    draw_floor(arena, canvas);
    draw_paper(arena, canvas);
    draw_objects(arena, canvas);
    draw_solids(arena, canvas);
    draw_victims(arena, canvas);
    draw_start(arena, canvas);
    canvas.copy_to(picture);
  }
  return picture;
}

RgbImage render_with_legend(const Arena& arena, double pixels_per_metre) {
  const TPoint2D size = arena.max_corner - arena.min_corner + TPoint2D{2.0 * kMargin, 2.0 * kMargin};
  const double wanted = std::clamp(kLeastWidth / size.x, pixels_per_metre, 2.0 * pixels_per_metre);
  RgbImage picture = render(arena, wanted);
  draw_legend(picture, legend_of(arena), picture.width / size.x);
  return picture;
}

}  // namespace rubble::arenas
