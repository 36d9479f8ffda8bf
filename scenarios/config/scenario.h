#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "arenas/generate/generate.h"
#include "arenas/model/arena.h"
#include "base/image/geotiff.h"
#include "base/yaml/strict_yaml.h"
#include "explore/explorers.h"
#include "robot/levelling.h"
#include "robot/model.h"
#include "scoring/scorecard.h"
#include "sim/sim_robot.h"
#include "slam/mappers.h"

namespace rubble::scenarios {

/// A bound on one number of score.json; a run that breaks it ends with exit code 1.
struct Expectation {
  std::string key;
  std::optional<double> min;
  std::optional<double> max;
};

/// Everything that decides a run: arena, robot, seed, limits, and what is expected of the result.
struct Scenario {
  std::string name = "run";
  std::string team = "rubble";
  std::string mission = "mission";
  std::uint64_t seed = 1;
  double time_limit = 1200.0;  ///< of simulated time [s]
  bool has_arena = true;       ///< false: a log is mapped
  std::string arena_file;      ///< empty: the arena is generated
  arenas::GenerateConfig generate;
  bool generate_seed_given = false;  ///< else the arena follows the run's seed
  std::optional<GeoAnchor> geo;      ///< where the start pose lies on Earth
  robot::RobotModel robot;
  robot::LevellingConfig levelling;
  sim::SimConfig sim;
  slam::MapperConfig mapper;
  explore::ExplorerConfig explorer;
  scoring::ScoreConfig scoring;
  bool visible_truth = true;  ///< what the robot can never see does not count
  std::vector<Expectation> expect;

  std::uint64_t arena_seed() const { return generate_seed_given ? generate.seed : seed; }
};

/// `--set dotted.key=value`, or the same of a list or a sweep.
struct Override {
  Override(std::string its_key, std::string its_value, std::string its_place = "")
      : key(std::move(its_key)), value(std::move(its_value)), place(std::move(its_place)) {}

  std::string key;
  std::string value;
  std::string place;  ///< `file:line:column` where it stands; empty: typed
};

/// What `arena.generate.kind` takes.
const std::vector<std::string>& generated_kinds();

/// Reads a scenario file strictly; overrides are applied before anything is read. Throws InputError.
Scenario load_scenario(const std::string& path, const std::vector<Override>& overrides = {});

/// Reads what a scenario shares with a robot file: all but arena, name and expectations. Throws InputError.
void read_settings(const YamlMap& root, Scenario& scenario);

/// The settings of a recorded run, which has no arena when a real robot was driven. Throws InputError.
Scenario load_recorded(const std::string& path, const std::vector<Override>& overrides = {});

/// The defaults with overrides: what `rubble map` uses. Throws InputError.
Scenario default_scenario(const std::vector<Override>& overrides = {});

/// All values, defaults included, as YAML that load_scenario reads back to the same scenario.
std::string resolved_yaml(const Scenario& scenario);

/// The arena's YAML text: the file's with all it includes, or the generated one. Throws InputError.
std::string arena_yaml(const Scenario& scenario);

}  // namespace rubble::scenarios
