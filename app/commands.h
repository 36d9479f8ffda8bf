#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "app/mapper_choice.h"
#include "scenarios/config/scenario.h"

namespace rubble::app {

/// Exit codes of the program.
enum Exit : int { kOk = 0, kBroken = 1, kUsage = 2, kBadInput = 3, kFailed = 4, kInterrupted = 130 };

/// What the subcommands that make a run folder share.
struct CommonOptions {
  std::string out;
  bool force = false;
  MapperChoice mapper;
  std::vector<scenarios::Override> overrides;
};

struct RunArguments {
  std::string scenario;
  std::optional<std::uint64_t> seed;
  CommonOptions common;
};

struct MapArguments {
  std::string log;
  std::optional<std::uint64_t> seed;
  CommonOptions common;
};

struct ScoreArguments {
  std::string map;
  std::string truth;
  std::optional<double> map_resolution;
  std::optional<double> truth_resolution;
  std::string align = "auto";
  bool warp = false;
  double tau = 0.5;
  std::string out;
  bool json = false;
  std::string pose;     ///< X,Y,DEG[,SCALE]: score there instead of aligning
  std::string html;     ///< the evaluation page to write
  std::string league;   ///< folder of maps to rank; `map` is the truth then
  std::string judge;    ///< CSV of the judge's points
  std::string pois;     ///< list of the victims that the map reports; empty: those drawn on it
  std::string victims;  ///< list of the true victims
};

struct ReplayArguments {
  std::string run;
  MapperChoice mapper;
  std::string out;
};

struct ExportArguments {
  std::string log;
  std::string out;
};

struct ArenaArguments {
  std::string file;
  bool generate = false;
  arenas::GenerateConfig config;
  double resolution = 0.05;
  double slice_height = 0.35;
  double range = 4.0;  ///< of the laser that NAME-visible.tif is for [m]
  std::string walls;   ///< .csv or .geojson to write
  std::string out;
};

struct DevicesArguments {
  std::vector<std::string> ports;  ///< empty: all serial lines of this machine
  double radius = 4.0;             ///< of the picture of a scan [m]
};

/// A log file, or the log inside a run folder.
std::string recorded_log(const std::string& path);

int run(const RunArguments& arguments);
int map(const MapArguments& arguments);
int score(const ScoreArguments& arguments);
int score_league(const ScoreArguments& arguments);
bool is_trajectory(const std::string& path);
int score_trajectory(const ScoreArguments& arguments);
int replay(const ReplayArguments& arguments);
int export_log(const ExportArguments& arguments);
int arena(const ArenaArguments& arguments);
int devices(const DevicesArguments& arguments);
void list_elements();

}  // namespace rubble::app
