#include <cstdio>
#include <filesystem>

#include "app/commands.h"
#include "arenas/elements/elements.h"
#include "arenas/files/arena_file.h"
#include "arenas/generate/generate.h"
#include "arenas/raf/raf.h"
#include "arenas/truth/render.h"
#include "arenas/truth/truth_map.h"
#include "arenas/truth/visible.h"
#include "arenas/truth/wall_lines.h"
#include "base/error.h"
#include "base/image/geotiff.h"
#include "base/text/text_file.h"
#include "base/text/words.h"
#include "scenarios/run/league_map.h"

namespace rubble::app {

namespace {

bool ends_with(const std::string& text, const std::string& end) {
  return text.size() > end.size() && text.compare(text.size() - end.size(), end.size(), end) == 0;
}

/// A league's file may have parts nobody knows: they are named, and the rest is shown.
arenas::Arena load(const std::string& path) {
  if (!ends_with(path, ".raf")) return arenas::load_arena(path);
  const arenas::RafImport import = arenas::import_raf(path);
  for (const std::string& note : import.notes())
    std::fprintf(stderr, "rubble: %s\n", one_line(path + ": " + note).c_str());
  return import.arena;
}

}  // namespace

int arena(const ArenaArguments& arguments) {
  namespace fs = std::filesystem;
  const bool is_geojson = ends_with(arguments.walls, ".geojson") || ends_with(arguments.walls, ".json");
  if (!arguments.walls.empty() && !is_geojson && !ends_with(arguments.walls, ".csv"))
    throw UsageError("--walls " + arguments.walls + ": the name must end in .csv or .geojson");
  const std::string source = arguments.generate ? "generated arena" : arguments.file;
  const std::string yaml = arguments.generate ? arenas::generate_arena(arguments.config) : std::string();
  const arenas::Arena arena = arguments.generate ? arenas::parse_arena(yaml, source) : load(source);
  arenas::check(arena, source);

  const std::string stem = arguments.generate ? arguments.config.kind + "-" + std::to_string(arguments.config.columns) +
                                                    "x" + std::to_string(arguments.config.rows) + "-seed" +
                                                    std::to_string(arguments.config.seed)
                                              : fs::path(arguments.file).stem().string();
  const std::string out = arguments.out.empty() ? "." : arguments.out;
  std::error_code error;
  fs::create_directories(out, error);
  if (error) throw InputError(out + ": cannot be created (" + error.message() + "); give a writable folder with --out");
  const std::string base = out + "/" + stem;

  if (!arguments.walls.empty()) {  // first: its folder may be missing, and then nothing is written
    const std::vector<arenas::WallLine> lines = arenas::wall_lines(arena);
    write_text_file(arguments.walls, is_geojson ? arenas::walls_geojson(lines) : arenas::walls_csv(lines));
  }
  if (arguments.generate) {
    write_text_file(base + ".yaml", yaml);
    std::printf("%s.yaml\n", base.c_str());
  }
  scenarios::write_png(base + ".png", arenas::render(arena, 60.0));
  const OccupancyGrid truth = arenas::truth_map(arena, arguments.resolution, arguments.slice_height);
  write_geotiff(base + "-truth.tif", scenarios::draw_truth(truth));
  arenas::Viewer viewer;
  viewer.range = arguments.range;
  write_geotiff(base + "-visible.tif", scenarios::draw_truth(arenas::visible_truth(arena, truth, viewer)));
  std::printf("%s.png\n%s-truth.tif\n%s-visible.tif\n", base.c_str(), base.c_str(), base.c_str());
  if (!arguments.walls.empty()) std::printf("%s\n", arguments.walls.c_str());
  return kOk;
}

void list_elements() {
  for (const std::string& type : arenas::element_types()) {
    std::printf("%-26s%-10s%s\n", type.c_str(), arenas::name_of(arenas::kind_of(type)).c_str(),
                arenas::description_of(type).c_str());
  }
}

}  // namespace rubble::app
