#include <algorithm>
#include <array>
#include <cstdio>
#include <filesystem>
#include <memory>

#include "app/commands.h"
#include "app/terminal.h"
#include "arenas/elements/elements.h"
#include "arenas/files/arena_file.h"
#include "arenas/generate/generate.h"
#include "arenas/raf/raf.h"
#include "arenas/truth/render.h"
#include "arenas/truth/start_region.h"
#include "arenas/truth/truth_map.h"
#include "arenas/truth/unseen.h"
#include "arenas/truth/visible.h"
#include "arenas/truth/wall_lines.h"
#include "base/error.h"
#include "base/image/geotiff.h"
#include "base/image/png.h"
#include "base/text/shell.h"
#include "base/text/text_file.h"
#include "base/text/words.h"
#include "base/yaml/binder.h"
#include "scenarios/run/mission_figures.h"
#include "scoring/maps/league_map.h"

namespace rubble::app {
namespace {

struct ArenaArguments {
  std::string file;
  bool elements = false;
  std::string cells;
  std::string kind = "yellow";
  arenas::GenerateConfig config;
  double resolution = 0.05;
  double slice_height = 0.35;
  double range = 4.0;  ///< of the laser that NAME-visible.tif is for [m]
  std::string walls;   ///< .csv or .geojson to write
  std::string out;
  bool force = false;

  bool generate() const { return file == "generate"; }
};

void parse_cells(const std::string& cells, arenas::GenerateConfig& config) {
  if (cells.empty()) return;
  char rest = 0;
  if (std::sscanf(cells.c_str(), "%dx%d%c", &config.columns, &config.rows, &rest) != 2)
    throw UsageError("--cells " + cells + ": needs the form COLUMNSxROWS, for example --cells 10x12");
  if (std::min(config.columns, config.rows) < 2 || std::max(config.columns, config.rows) > 60)
    throw UsageError("--cells " + cells + ": an arena has 2 to 60 pallets a side");
}

/// Those that say nothing about an arena that is read from a file.
constexpr const char* kGeneratorOptions[] = {"--kind",  "--cells", "--seed",    "--ramps",       "--rough",
                                             "--paper", "--loops", "--victims", "--sound-alone", "--co2-alone"};

/// A league's file may have parts nobody knows, any file a poor start: that is told, and the arena is shown.
arenas::Arena load(const std::string& path) {
  if (!arenas::is_raf(path)) {
    arenas::Arena arena = arenas::load_arena(path);
    if (const auto note = arenas::small_start(arena)) tell(path + ": " + *note);
    return arena;
  }
  const arenas::RafImport import = arenas::import_raf(path);
  for (const std::string& note : import.notes()) tell(path + ": " + note);
  return import.arena;
}

/// The files are written together, so one without the others is somebody's own; and the arena file is there to be
/// edited. Throws InputError.
void refuse_foreign(const std::string& base, const std::string& yaml) {
  const std::string remedy = "; give another folder with --out, or --force to replace it";
  std::error_code error;
  std::vector<std::string> there;
  const std::vector<std::string> pictures = {base + ".png", base + "-truth.tif", base + "-visible.tif"};
  for (const std::string& path : pictures)
    if (std::filesystem::exists(path, error)) there.push_back(path);
  if (!yaml.empty() && std::filesystem::exists(base + ".yaml", error) && read_text_file(base + ".yaml") != yaml)
    throw InputError(base + ".yaml: exists and is another arena, perhaps by your edits" + remedy);
  if (!there.empty() && there.size() < pictures.size())
    throw InputError(there.front() + ": exists, and not from here (its companions are missing)" + remedy);
}

/// The line that runs an arena with everything else as in the main job; it holds wherever it is typed.
std::string how_to_run(const std::string& arena_file) {
  const std::string path = std::filesystem::absolute(arena_file).lexically_normal().string();
  return "rubble run --set " + shell_word("arena={file: " + yaml_quoted(path) + "}");
}

int arena(const ArenaArguments& arguments) {
  namespace fs = std::filesystem;
  const bool is_geojson = ends_with(arguments.walls, ".geojson") || ends_with(arguments.walls, ".json");
  if (!arguments.walls.empty() && !is_geojson && !ends_with(arguments.walls, ".csv"))
    throw UsageError("--walls " + arguments.walls + ": the name must end in .csv or .geojson");
  const std::string source = arguments.generate() ? "generated arena" : arguments.file;
  const std::string yaml = arguments.generate() ? arenas::generate_arena(arguments.config) : std::string();
  const arenas::Arena arena = arguments.generate() ? arenas::parse_arena(yaml, source) : load(source);
  arenas::check(arena, source);

  const std::string stem = arguments.generate() ? arguments.kind + "-" + std::to_string(arguments.config.columns) +
                                                      "x" + std::to_string(arguments.config.rows) + "-seed" +
                                                      std::to_string(arguments.config.seed)
                                                : fs::path(arguments.file).stem().string();
  const std::string out = arguments.out.empty() ? "." : arguments.out;
  std::error_code error;
  fs::create_directories(out, error);
  if (error) throw InputError(out + ": cannot be created (" + error.message() + "); give a writable folder with --out");
  const std::string base = out + "/" + stem;
  if (!arguments.force) refuse_foreign(base, yaml);

  if (!arguments.walls.empty()) {  // first: its folder may be missing, and then nothing is written
    const std::vector<arenas::WallLine> lines = arenas::wall_lines(arena);
    write_text_file(arguments.walls, is_geojson ? arenas::walls_geojson(lines) : arenas::walls_csv(lines));
  }
  if (arguments.generate()) {
    if (!fs::exists(base + ".yaml") || arguments.force) write_text_file(place_in(out, stem + ".yaml"), yaml);
    print_line(base + ".yaml");
  }
  show_share("draws the arena", 0.0);
  write_png(place_in(out, stem + ".png"), arenas::render_with_legend(arena, 60.0));
  show_share("draws its truth", 0.01);
  const OccupancyGrid truth = arenas::truth_map(arena, arguments.resolution, arguments.slice_height);
  write_geotiff(place_in(out, stem + "-truth.tif"), scoring::draw_truth(truth));
  arenas::Viewer viewer;
  viewer.range = arguments.range;
  const OccupancyGrid visible = arenas::visible_truth(
      arena, truth, viewer, [](double share) { show_share("looks at it from everywhere", share); });
  write_geotiff(place_in(out, stem + "-visible.tif"), scoring::draw_truth(visible));
  show_share("asks what cannot be seen", 0.99);
  const std::vector<arenas::Unseen> unseen = arenas::unseen_by_cause(arena, truth, visible, viewer);
  end_progress();
  for (const char* ending : {".png", "-truth.tif", "-visible.tif"}) print_line(base + ending);
  if (!arguments.walls.empty()) print_line(arguments.walls);
  for (const arenas::Unseen& cause : unseen) {
    std::array<char, 16> share{};
    std::snprintf(share.data(), share.size(), "%.2f %%", 100.0 * cause.share);
    print_line("not asked for: " + std::string(share.data()) + " " + cause.why);
  }
  if (const auto names = scenarios::unseen_victims(arena, {}); !names.empty()) print_line(kOutOfSight + joined(names));
  if (arguments.generate()) print_line("to run it: " + how_to_run(base + ".yaml"));
  return kOk;
}

void list_elements() {
  for (const std::string& type : arenas::element_types()) {
    std::printf("%-26s%-10s%s\n", type.c_str(), arenas::name_of(arenas::kind_of(type)).c_str(),
                arenas::description_of(type).c_str());
  }
}

void check_kind(const std::string& kind) {
  if (kind == arenas::kBlueArena) throw UsageError("--kind blue: " + std::string(arenas::kNoBlueArena));
  const std::vector<std::string>& kinds = arenas::arena_kinds();
  if (std::find(kinds.begin(), kinds.end(), kind) == kinds.end())
    throw UsageError("--kind " + kind + " is no kind of arena: use yellow, orange or red");
}

int arena_or_list(ArenaArguments arguments, const Options& options) {
  check_kind(arguments.kind);
  arguments.config.kind = arenas::arena_kind(arguments.kind);
  if (arguments.generate() && arguments.config.kind == arenas::ArenaKind::Yellow && options.given("--rough"))
    throw UsageError("--rough: a yellow arena has no obstacles; add --kind orange or --kind red");
  if (arguments.elements) {
    list_elements();
    return kOk;
  }
  if (arguments.file.empty()) throw UsageError("file is required; see rubble arena --help");
  parse_cells(arguments.cells, arguments.config);
  for (const char* name : kGeneratorOptions)
    if (!arguments.generate() && options.given(name))
      throw UsageError(std::string(name) + " is for 'rubble arena generate'; an arena file has its own layout");
  return arena(arguments);
}

void declare_generator(Options& o, ArenaArguments& a) {
  arenas::GenerateConfig& config = a.config;
  o.text("--kind", a.kind, "Kind of arena: yellow, orange or red");
  o.text("--cells", a.cells, "Pallets west-east x south-north (default 8x8)");
  o.seed("--seed", config.seed, "Seed of the layout");
  o.number("--ramps", config.ramps, 0.0, 1.0, "Share of pallets that are ramps, 0..1");
  o.number("--rough", config.rough, 0.0, 1.0, "Share of pallets with obstacles (orange, red), 0..1, default 0.25");
  o.number("--paper", config.paper, 0.0, 1.0, "Share of pallets with paper, 0..1");
  o.number("--loops", config.loops, 0.0, 1.0, "Share of inner walls taken away, 0..1");
  o.whole("--victims", config.victims, 0, 1000, "Number of victims");
  o.number("--sound-alone", config.sound_alone, 0.0, 1.0, "Share of the victims that are heard only, 0..1");
  o.number("--co2-alone", config.co2_alone, 0.0, 1.0, "Share of the victims that are smelt only, 0..1");
}

}  // namespace

Command arena_command() {
  return {"arena", "Picture and truth map of an arena file, or of a generated arena",
          "Examples:\n  rubble arena arenas/shipped/yellow_8x8.yaml\n"
          "  rubble arena arenas/shipped/yellow_8x8.yaml --resolution 0.02 --slice-height 0.2 --walls walls.geojson\n"
          "  rubble arena generate --cells 10x12 --seed 3 --ramps 0.4 --paper 0.2 --victims 6 --loops 0.2",
          [](Options& o) -> Action {
            auto a = std::make_shared<ArenaArguments>();
            o.argument("file", a->file, "Arena file, or the word 'generate'", Options::Need::Optional);
            declare_generator(o, *a);
            o.number("--resolution", a->resolution, 0.005, 1.0, "Metres a pixel of the truth map");
            o.number("--slice-height", a->slice_height, 0.01, 5.0,
                     "Height above each floor at which the truth map is cut, default 0.35 [m]");
            o.number("--range", a->range, 0.1, 100.0, "How far the laser sees of NAME-visible.tif, default 4 [m]");
            o.text("--walls", a->walls, "Also write the walls as lines: FILE.csv or FILE.geojson");
            o.flag("--elements", a->elements, "List the league's parts that arena files can place, and what they are");
            o.text("--out", a->out, "Folder for the files (default: here)");
            o.flag("--force", a->force, "Replace an arena file that was edited, and pictures that are not from here");
            return [a, &o] { return arena_or_list(*a, o); };
          }};
}

}  // namespace rubble::app
