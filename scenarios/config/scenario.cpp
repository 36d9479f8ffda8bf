#include "scenarios/config/scenario.h"

#include <algorithm>
#include <array>
#include <cstdio>
#include <filesystem>
#include <limits>
#include <utility>

#include "arenas/files/arena_file.h"
#include "arenas/files/include.h"
#include "arenas/raf/raf.h"
#include "base/angle.h"
#include "base/error.h"
#include "base/text/file_name.h"
#include "base/text/input_file.h"
#include "base/text/number_text.h"
#include "base/text/words.h"
#include "base/yaml/binder.h"
#include "base/yaml/strict_yaml.h"
#include "robot/battery_watch.h"
#include "scenarios/config/needed_key.h"
#include "scoring/figures/figures.h"
#include "sim/battery.h"

namespace rubble::scenarios {
namespace {

/// A scanner by its name, then what differs from it. Written are only the differences, so that a name given later, on
/// the command line, is not undone by the numbers of the one before.
void bind(Binder& b, robot::LaserModel& laser) {
  std::string name = laser.name;
  b.choice("model", name, robot::laser_names());
  if (!b.writes() && name != laser.name) laser = robot::laser_model(name);
  const robot::LaserModel usual = robot::laser_model(name);
  const bool is_generic = name == robot::kGenericLaser;  // has nothing that is usual
  const auto bind_number = [&](const char* key, double robot::LaserModel::*field, double low, double high) {
    if (is_generic || !b.writes() || laser.*field != usual.*field) b.number(key, laser.*field, low, high);
  };
  const auto bind_degrees = [&](const char* key, double robot::LaserModel::*field, double low, double high) {
    if (is_generic || !b.writes() || laser.*field != usual.*field) b.degrees(key, laser.*field, low, high);
  };
  if (is_generic || !b.writes() || laser.beams != usual.beams) b.integer("beams", laser.beams, 2, 20000);
  bind_number("scan_period_s", &robot::LaserModel::scan_period, 0.01, 1.0);
  if (is_generic && !b.writes()) {
    double field_of_view_deg = 270.0;
    b.number("field_of_view_deg", field_of_view_deg, 1.0, 360.0);
    double sweep = laser.scan_period * field_of_view_deg / 360.0;
    b.number("sweep_s", sweep, 0.0, 1.0);
    robot::spread_beams(laser, field_of_view_deg, sweep);
  }
  bind_degrees("first_beam_deg", &robot::LaserModel::angle_min, -180.0, 180.0);
  bind_degrees("step_deg", &robot::LaserModel::angle_step, 0.01, 180.0);
  bind_number("beam_period_s", &robot::LaserModel::beam_period, 0.0, 0.1);
  bind_number("min_range_m", &robot::LaserModel::range_min, 0.0, 1.0);
  bind_number("max_range_m", &robot::LaserModel::range_max, 0.5, 100.0);
  bind_number("accuracy_m", &robot::LaserModel::accuracy_near, 0.0, 1.0);
  bind_number("accuracy_to_m", &robot::LaserModel::accuracy_near_to, 0.0, 100.0);
  bind_number("far_accuracy_m", &robot::LaserModel::accuracy_far, 0.0, 1.0);
  bind_number("far_accuracy_share", &robot::LaserModel::accuracy_far_share, 0.0, 0.5);
}

void bind(Binder& b, robot::RobotModel& r, robot::LevellingConfig& levelling) {
  b.boolean("levelling", levelling.on);
  b.number("max_v", r.max_v, 0.05, 2.0);
  b.degrees("max_w_deg", r.max_w, 5.0, 360.0);
  b.number("max_accel", r.max_accel, 0.05, 5.0);
  b.degrees("max_turn_accel_deg", r.max_turn_accel, 5.0, 1000.0);
  b.number("effective_track_m", r.effective_track, 0.2, 2.0);
  b.number("climbable_step_m", r.climbable_step, 0.0, 0.5);
  b.section("laser", [&](Binder& l) {
    l.number("x_m", r.T_base_laser.x, -0.5, 0.5);
    l.number("y_m", r.T_base_laser.y, -0.5, 0.5);
    l.number("z_m", r.T_base_laser.z, 0.05, 1.1);
    bind(l, r.laser);
  });
}

void bind(Binder& b, robot::LevellingConfig& c, robot::AccelerometerMount& accelerometer) {
  b.choice("mount", accelerometer, robot::mount_names());
  b.number("kp", c.kp, 0.0, 10.0);
  b.number("ki", c.ki, 0.0, 100.0);
  b.number("kd", c.kd, 0.0, 10.0);
  b.number("filter_hz", c.filter_hz, 0.1, 100.0);
  b.degrees("max_rate_deg", c.max_rate, 1.0, 1000.0);
  b.degrees("max_angle_deg", c.max_angle, 0.0, 60.0);
  b.degrees("dead_zone_deg", c.dead_zone, 0.0, 10.0);
  b.boolean("feed_forward", c.feed_forward);
}

void bind(Binder& b, sim::SimConfig& c) {
  b.number("physics_step_s", c.physics_step, 0.001, 0.02);
  b.number("range_noise", c.range_noise, 0.0, 100.0);
  b.number("acceleration_noise", c.acceleration_noise, 0.0, 100.0);
  b.boolean("sweep", c.sweep);
  b.boolean("microphones", c.microphones);
  b.boolean("co2_probe", c.co2_probe);
  b.number("battery_wh", c.battery_wh, 0.0, 10000.0);
  b.choice("levelling_fault", c.levelling_fault, sim::levelling_faults());
  b.number("levelling_fault_s", c.levelling_fault_from, 0.0, 1e6);
  b.degrees("levelling_fault_deg", c.levelling_fault_tilt, 0.0, 30.0);
}

void bind(Binder& b, scoring::ScoreConfig& c) {
  b.number("tau_m", c.tau, 0.05, 10.0);
  b.number("colour_absent_cap_m", c.colour_absent_cap, 0.1, 1000.0);
}

/// The arena, geo and expect parts have a form of their own; everything else is a plain list of fields.
void bind_sections(Binder& b, Scenario& s) {
  b.number("time_limit_s", s.time_limit, 1.0, 1e6);
  b.text("team", s.team);
  b.text("mission", s.mission);
  b.section("robot", [&](Binder& in) { bind(in, s.robot, s.levelling); });
  b.section("levelling", [&](Binder& in) { bind(in, s.levelling, s.robot.accelerometer_mount); });
  b.section("sim", [&](Binder& in) { bind(in, s.sim); });
  b.section("mapper", [&](Binder& in) { s.mapper.bind(in); });
  b.section("explorer", [&](Binder& in) { s.explorer.bind(in); });
  b.section("scoring", [&](Binder& in) {
    bind(in, s.scoring);
    in.boolean("visible_truth", s.visible_truth);
  });
}

void bind_generate(Binder& b, arenas::GenerateConfig& g) {
  b.choice("kind", g.kind, arenas::arena_kinds());
  b.integer("columns", g.columns, 2, 60);
  b.integer("rows", g.rows, 2, 60);
  b.number("ramps", g.ramps, 0.0, 1.0);
  b.number("paper", g.paper, 0.0, 1.0);
  b.number("loops", g.loops, 0.0, 1.0);
  b.integer("victims", g.victims, 0, 1000);
  b.number("sound_alone", g.sound_alone, 0.0, 1.0);
  b.number("co2_alone", g.co2_alone, 0.0, 1.0);
  b.number("ramp_deg", g.ramp_deg, 0.0, 45.0);
  b.number("rough", g.rough, 0.0, 1.0);
}

/// Who gives an arena file where a scenario is played is told so.
void refuse_arena_file(const YamlMap& root, const std::string& path) {
  if (root.has("arena")) return;
  for (const char* key : {"maze", "floors", "walls", "boxes", "elements", "include", "start"})
    if (root.has(key))
      root.fail(key, "'" + std::string(key) +
                         "' is of an arena, and what is played is a scenario; write one, of this line: arena: {file: " +
                         std::filesystem::absolute(path).lexically_normal().string() + "}");
}

void read_arena(const YamlMap& root, const std::string& path, Scenario& s) {
  refuse_misspelt(root, "arena");
  refuse_arena_file(root, path);
  const YamlMap arena = root.map("arena");
  if (arena.has("file") == arena.has("generate"))
    root.fail("arena", std::string(root.has("arena") ? "" : "'arena' is missing: it ") +
                           "needs exactly one of 'file: arena.yaml' or 'generate: {columns: 8, rows: 8}'" +
                           (arena.has("file") ? "; --set 'arena={file: arena.yaml}' takes the place of both" : ""));
  if (arena.has("file")) {
    const std::filesystem::path file = arena.text("file", std::nullopt);
    s.arena_file = (file.is_absolute() ? file : std::filesystem::path(path).parent_path() / file).string();
    if (!std::filesystem::exists(s.arena_file))
      arena.fail("file", "there is no arena file '" + s.arena_file + "'; the path is relative to the scenario file");
    // A file that names a stream of this terminal would wait at it.
    InputRules rules;
    rules.thing = "an arena file";
    rules.pipes = Pipes::None;
    require_input(s.arena_file, rules);
    return;
  }
  const YamlMap generate = arena.map("generate");
  s.generate_seed_given = generate.has("seed");
  s.generate.seed = static_cast<std::uint64_t>(
      generate.integer("seed", std::int64_t{1}, 0, std::numeric_limits<std::int64_t>::max()));
  if (generate.has("kind") && generate.text("kind", std::nullopt) == arenas::kBlueArena)
    generate.fail("kind", arenas::kNoBlueArena);
  YamlReader reader(generate);
  bind_generate(reader, s.generate);
}

void read_expect(const YamlMap& root, Scenario& s) {
  const YamlMap expect = root.map("expect");
  for (const auto& key : expect.keys()) {
    const auto is_bounded = [](const scoring::Figure& f) { return !f.is(scoring::kText) && !f.is(scoring::kSpecial); };
    const scoring::Figure* figure = scoring::find_figure(key);
    if (figure == nullptr || !is_bounded(*figure)) {
      std::vector<std::string> numbers;
      for (const auto& known : scoring::figures())
        if (is_bounded(known)) numbers.push_back(known.key);
      expect.fail(key, "'" + key + "' is not a number of score.json" + did_you_mean(key, numbers) + "; known are " +
                           joined(numbers));
    }
    const YamlMap bounds = expect.map(key);
    Expectation expectation{key, {}, {}};
    if (bounds.has("min")) expectation.min = bounds.number("min", std::nullopt, -1e12, 1e12);
    if (bounds.has("max")) expectation.max = bounds.number("max", std::nullopt, -1e12, 1e12);
    if (!expectation.min && !expectation.max) expect.fail(key, "needs 'min' or 'max', for example {min: 0.8}");
    s.expect.push_back(expectation);
  }
}

/// What one key alone cannot say.
void check_laser(const YamlMap& map, const robot::LaserModel& laser) {
  for (const char* key : {"field_of_view_deg", "sweep_s"})
    if (map.has(key) && laser.name != robot::kGenericLaser)
      map.fail(key, std::string("is for 'model: generic'; the ") + laser.name + " has its own");
  if (map.has("field_of_view_deg") && (map.has("first_beam_deg") || map.has("step_deg")))
    map.fail("field_of_view_deg", "beside 'first_beam_deg' or 'step_deg'; keep one way to say it");
  if (map.has("sweep_s") && map.has("beam_period_s"))
    map.fail("sweep_s", "beside 'beam_period_s'; keep one way to say it");
  const double turn = 2.0 * kPi + 1e-9;
  if (laser.field_of_view() > turn)
    map.fail("beams", "beams times step_deg is more than a full turn; take fewer beams or a smaller step");
  if (laser.scan_period < (laser.beams - 1) * laser.beam_period)
    map.fail("scan_period_s",
             "laser.scan_period_s is shorter than the sweep of all beams; lengthen it, or shorten "
             "sweep_s or beam_period_s");
  if (laser.range_max <= laser.range_min) map.fail("max_range_m", "max_range_m must be above min_range_m");
}

/// One that is empty before the robot could notice that it is low is a slip of the unit.
void check_battery(const YamlMap& map, double battery_wh) {
  const double lasts = battery_wh * 3600.0 / sim::Battery::kStanding;  // [s]
  if (battery_wh <= 0.0 || lasts >= robot::BatteryWatch::kLasts) return;
  std::array<char, 200> text{};
  std::snprintf(text.data(), text.size(),
                "%g Wh last %.2g s where the robot stands (%.0f W), and that a battery is low shows after %.0f s; give "
                "some Wh, or 0 for one that never ends",
                battery_wh, lasts, sim::Battery::kStanding, robot::BatteryWatch::kLasts);
  map.fail("battery_wh", text.data());
}

}  // namespace

void read_settings(const YamlMap& root, Scenario& s) {
  constexpr std::size_t kMostLetters = 100;  // [bytes]
  s.seed =
      static_cast<std::uint64_t>(root.integer("seed", std::int64_t{1}, 0, std::numeric_limits<std::int64_t>::max()));
  if (root.has("geo")) {
    const YamlMap geo = root.map("geo");
    s.geo = GeoAnchor{geo.number("latitude_deg", std::nullopt, -80.0, 84.0),
                      geo.number("longitude_deg", std::nullopt, -180.0, 180.0),
                      geo.number("heading_deg", 0.0, -360.0, 360.0)};
  }
  YamlReader reader(root);
  bind_sections(reader, s);
  for (const auto& [key, text] : {std::pair("team", &s.team), std::pair("mission", &s.mission)})
    if (text->size() > kMostLetters)
      root.fail(key, "is written on the map, and " + std::to_string(text->size()) + " bytes long; give at most " +
                         std::to_string(kMostLetters));
  check_laser(root.map("robot").map("laser"), s.robot.laser);
  if (s.sim.levelling_fault != sim::LevellingFault::None && !s.levelling.on)
    root.map("sim").fail("levelling_fault", "of a robot with 'levelling: false'; there is no unit that could fail");
  check_battery(root.map("sim"), s.sim.battery_wh);
  if (const std::string mistake = s.explorer.mistake(); !mistake.empty()) root.fail("explorer", mistake);
  s.sim.time_limit = s.time_limit;
}

namespace {

Scenario load(const std::string& path, const std::vector<Override>& overrides, bool recorded) {
  YamlMap root = YamlMap::load(path);
  for (const Override& o : overrides) root.set(o.key, o.value, o.place);
  Scenario s;
  s.name = root.text("name", as_file_name(std::filesystem::path(path).stem().string()));
  if (const auto trouble = file_name_trouble(s.name)) root.fail("name", *trouble);
  s.has_arena = !recorded || root.has("arena");
  if (s.has_arena) read_arena(root, path, s);
  read_settings(root, s);
  read_expect(root, s);
  root.finish();
  return s;
}

}  // namespace

const std::vector<std::string>& generated_kinds() { return arenas::arena_kinds(); }

Scenario load_scenario(const std::string& path, const std::vector<Override>& overrides) {
  return load(path, overrides, false);
}

Scenario load_recorded(const std::string& path, const std::vector<Override>& overrides) {
  return load(path, overrides, true);
}

Scenario default_scenario(const std::vector<Override>& overrides) {
  YamlMap root = YamlMap::parse("{}", "defaults");
  for (const Override& o : overrides) root.set(o.key, o.value, o.place);
  Scenario s;
  s.has_arena = false;
  s.name = root.text("name", std::string("map"));
  if (const auto trouble = file_name_trouble(s.name)) root.fail("name", *trouble);
  read_settings(root, s);
  root.finish();
  return s;
}

std::string resolved_yaml(const Scenario& scenario) {
  Scenario s = scenario;  // binding needs a mutable object; nothing is changed
  std::string out = "name: " + yaml_quoted(s.name) + "\nseed: " + std::to_string(s.seed) + "\n";
  if (s.has_arena && !s.arena_file.empty()) {
    out += "arena:\n  file: " + yaml_quoted(s.arena_file) + "\n";
  } else if (s.has_arena) {
    YamlWriter generate(4);
    bind_generate(generate, s.generate);
    out += "arena:\n  generate:\n    seed: " + std::to_string(s.arena_seed()) + "\n" + generate.yaml();
  }
  if (s.geo)
    out += "geo:\n  latitude_deg: " + number_text(s.geo->latitude_deg) +
           "\n  longitude_deg: " + number_text(s.geo->longitude_deg) +
           "\n  heading_deg: " + number_text(s.geo->heading_deg) + "\n";
  YamlWriter writer;
  bind_sections(writer, s);
  out += writer.yaml();
  if (!s.expect.empty()) out += "expect:\n";
  for (const auto& e : s.expect) {
    out += "  " + e.key + ": {";
    if (e.min) out += "min: " + number_text(*e.min);
    if (e.max) out += std::string(e.min ? ", " : "") + "max: " + number_text(*e.max);
    out += "}\n";
  }
  return out;
}

std::string arena_yaml(const Scenario& scenario) {
  if (scenario.arena_file.empty()) {
    arenas::GenerateConfig config = scenario.generate;
    config.seed = scenario.arena_seed();
    return arenas::generate_arena(config);
  }
  if (arenas::is_raf(scenario.arena_file)) return arenas::to_yaml(arenas::import_raf(scenario.arena_file));
  return arenas::self_contained_arena(scenario.arena_file);
}

}  // namespace rubble::scenarios
