#include <array>
#include <cmath>
#include <cstdio>
#include <memory>
#include <optional>
#include <string>

#include "app/commands.h"
#include "app/maps/score_tools.h"
#include "app/terminal.h"
#include "base/error.h"
#include "base/text/text_file.h"
#include "explore/plan_picture.h"
#include "scoring/maps/normalise.h"
#include "scoring/maps/raster_image.h"

namespace rubble::app {
namespace {

struct PlanArguments {
  std::string map;
  explore::PlannerConfig config;
  std::string discomfort = "per_metre";
  std::optional<double> resolution;
  std::string from, to;  ///< "X,Y"
  std::string out = "plan.png";
};

std::optional<mrpt::math::TPoint2D> place(const std::string& option, const std::string& text) {
  if (text.empty()) return std::nullopt;
  mrpt::math::TPoint2D p;
  char rest = 0;
  if (std::sscanf(text.c_str(), "%lf,%lf%c", &p.x, &p.y, &rest) != 2 || std::isnan(p.x) || std::isnan(p.y))
    throw UsageError(option + " " + text + ": needs the form X,Y in metres, for example " + option + " 1.5,-2");
  if (!(std::abs(p.x) <= scoring::kFarthestPlace && std::abs(p.y) <= scoring::kFarthestPlace))
    throw UsageError(option + " " + text + ": lies farther off than any place on Earth; give X,Y in metres");
  return p;
}

/// The map's extent and axes, for who named a place that is not on its floor.
std::string extent(const scoring::LoadedMap& map) {
  const GridFrame& frame = map.grid.frame();
  const char* axes = map.origin == scoring::MapOrigin::Local   ? "x easting, y northing: of a robot's map -y and x"
                     : map.origin == scoring::MapOrigin::Ros   ? "x and y of the yaml's frame"
                     : map.origin == scoring::MapOrigin::Earth ? "x easting, y northing"
                                                               : "from the lower left corner, x right, y up";
  std::array<char, 240> text{};
  std::snprintf(text.data(), text.size(), " (the map reaches from %.2f,%.2f to %.2f,%.2f m; %s)", frame.x0, frame.y0,
                frame.x0 + frame.width * frame.resolution, frame.y0 + frame.height * frame.resolution, axes);
  return text.data();
}

int plan(PlanArguments a) {
  explore::TransformConfig& transform = a.config.transform;
  if (a.discomfort == "per_cell") transform.discomfort = explore::Discomfort::PerCell;
  if (transform.d_opt < transform.d_min) throw UsageError("--d-opt must not be smaller than --d-min");
  const explore::PlanEnds ends{place("--from", a.from), place("--to", a.to)};
  scoring::LoadOptions options;
  options.resolution = a.resolution;
  const scoring::LoadedMap map = scoring::load_map(map_file(a.map), options);
  explore::PlanPicture picture;
  try {
    picture = explore::plan_picture(map.grid, a.config, ends);
  } catch (const InputError& error) {
    const std::string what = error.what();
    throw InputError(a.map + ": " + what + (what.rfind("--", 0) == 0 ? extent(map) : ""));
  }
  write_text_file(a.out, picture.png);

  if (!ends.to) print_row("frontiers", std::to_string(picture.frontiers));
  if (picture.way) {
    std::array<char, 80> line{};
    std::snprintf(line.data(), line.size(), "%.2f m, cost %.2f m, %.2f m from walls and more", picture.way->length,
                  picture.way->cost, picture.way->least_clearance);
    print_row("way", line.data());
  } else if (ends.from) {
    print_row("way", ends.to ? "none: the target cannot be reached from there"
                             : "none: no frontier can be reached from there; give a target with --to X,Y");
  } else if (!picture.reached) {
    print_row("way", ends.to ? "none: the target cannot be reached from anywhere"
                             : "none: no frontier can be reached from anywhere; give a target with --to X,Y");
  }
  char scale[60];
  std::snprintf(scale, sizeof scale, ", %g pixels a metre", picture.pixels_per_metre);
  print_row("picture", a.out + scale);
  return kOk;
}

}  // namespace

Command plan_command() {
  return {"plan", "Picture of the Exploration Transform over a map, and the way to the nearest frontier or a target",
          "Dark: near to a frontier, or to the target. White: none can be reached. Blue: frontiers. Red: the way.\n"
          "Discs: where it starts (green) and ends (blue).\n"
          "Examples:\n  rubble plan runs/latest/map.yaml --from 0,0 --to 0.5,8.4 --out way.png\n"
          "  rubble plan runs/latest/map.yaml --from 0,0 --to 0.5,8.4 --alpha 0 --out short.png\n"
          "  rubble plan map.yaml --discomfort per_cell --alpha 5 --d-min 0.3 --from 1.5,-2",
          [](Options& o) -> Action {
            auto a = std::make_shared<PlanArguments>();
            explore::TransformConfig& transform = a->config.transform;
            o.argument("map", a->map, "Map: GeoTIFF, ROS yaml, or an image with --resolution");
            o.number("--alpha", transform.alpha, 0.0, 1000.0, "Weight of the discomfort against length, default 20");
            o.number("--d-min", transform.d_min, 0.0, 2.0, "Never nearer to walls, default 0.4 [m]");
            o.number("--d-opt", transform.d_opt, 0.0, 5.0, "The distance to walls that is liked best, default 0.6 [m]");
            o.choice("--discomfort", a->discomfort, {"per_metre", "per_cell"},
                     "How it is summed: a metre of way, or a cell as eq. (3) is printed, with no cap");
            o.whole("--min-frontier-cells", a->config.min_frontier_cells, 1, 10000, "Smaller frontiers are no targets");
            o.number("--resolution", a->resolution, 0.001, 1.0, "Metres a pixel, where the map does not say");
            o.text("--from", a->from, "X,Y in the map [m]: draw the way from there");
            o.text("--to", a->to, "X,Y in the map [m]: the target, instead of the frontiers");
            o.text("--out", a->out, "Picture to write (default: plan.png)");
            return [a] { return plan(*a); };
          }};
}

}  // namespace rubble::app
