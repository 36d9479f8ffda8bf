#include "app/maps/score_tools.h"

#include <cmath>
#include <cstdio>
#include <filesystem>
#include <sstream>
#include <system_error>
#include <vector>

#include "base/angle.h"
#include "base/error.h"
#include "base/text/number_text.h"
#include "base/text/shell.h"
#include "base/text/text_file.h"
#include "base/text/words.h"

namespace rubble::app {

namespace {

void require_near(const std::string& option, double x, double y, double deg) {
  constexpr double kFarthest = 10e3;  // [m]
  if (!(std::abs(x) <= kFarthest && std::abs(y) <= kFarthest && std::abs(deg) <= 3600.0))
    throw UsageError(option + ": X and Y must be within 10000 m, DEG within 3600");
}

}  // namespace

std::string map_file(const std::string& path, const std::string& name) {
  namespace fs = std::filesystem;
  std::error_code error;
  if (!fs::is_directory(path, error)) return path;
  const std::string inside = (fs::path(path) / name).string();
  if (!fs::exists(inside, error))
    throw InputError(path + ": is a folder without " + name + "; give a run folder, or a map file");
  return inside;
}

std::optional<GivenPose> parse_pose(const std::string& text) {
  if (text.empty()) return std::nullopt;
  std::vector<double> numbers;
  std::stringstream fields(text);
  for (std::string field; std::getline(fields, field, ',');) {
    const std::optional<double> number = parse_number(field);
    if (!number) break;
    numbers.push_back(*number);
  }
  const bool whole = fields.eof() && text.back() != ',';
  if (!whole || numbers.size() < 3 || numbers.size() > 4)
    throw UsageError("--pose " + text + ": needs the form X,Y,DEG or X,Y,DEG,SCALE, for example --pose=1.5,-2,90");
  GivenPose pose{{numbers[0], numbers[1], deg_to_rad(numbers[2])}, numbers.size() == 4 ? numbers[3] : 1.0};
  require_near("--pose " + text, numbers[0], numbers[1], numbers[2]);
  if (!(pose.scale >= 0.1 && pose.scale <= 10.0))
    throw UsageError("--pose " + text + ": the scale must be from 0.1 to 10");
  return pose;
}

std::optional<scoring::KnownStart> parse_start(const std::string& text, const std::string& path,
                                               const scoring::LoadedMap& map) {
  if (text.empty()) return std::nullopt;
  double x = 0.0;
  double y = 0.0;
  double deg = 0.0;
  char rest = 0;
  if (std::sscanf(text.c_str(), "%lf,%lf,%lf%c", &x, &y, &deg, &rest) != 3)
    throw UsageError("--start " + text + ": needs the form X,Y,DEG, for example --start=1.5,-2,90");
  require_near("--start " + text, x, y, deg);
  const bool ros = map.origin == scoring::MapOrigin::Ros;
  if (!ros && map.origin != scoring::MapOrigin::Local)
    throw InputError(
        path +
        ": does not say where the robot started, which --start needs; give a ROS map or a GeoTIFF or world "
        "file that counts from there");
  // The league's pictures have the heading at the start upwards.
  const mrpt::math::TPoint2D p = ros ? mrpt::math::TPoint2D(0.0, 0.0) : scoring::in_grid(map, {0.0, 0.0});
  const mrpt::math::TPose2D T_map_start(p.x, p.y, ros ? 0.0 : deg_to_rad(90.0));
  return scoring::KnownStart{mrpt::math::TPose2D(x, y, deg_to_rad(deg)) + (mrpt::math::TPose2D() - T_map_start), p};
}

std::string command_of(const ScoreArguments& a) {
  return scoring::words_of({a.map, a.truth, a.map_resolution, a.truth_resolution, a.tau, a.pois, a.victims});
}

void make_folder(const std::string& path) {
  std::error_code error;
  std::filesystem::create_directories(path, error);
  if (error)
    throw InputError(path + ": cannot be created (" + error.message() + "); give a writable folder with --out");
}

void make_score_folder(const std::string& path, bool force) {
  std::error_code error;
  if (!force && std::filesystem::exists(std::filesystem::path(path) / "estimate.tum", error))
    throw InputError(path + ": is the folder of a run, whose pictures and score.json these would take the place of; " +
                     "give another folder with --out, or --force to replace them");
  make_folder(path);
}

void write_evaluation_page(const std::string& path, const OccupancyGrid& map, const OccupancyGrid& truth,
                           const scoring::EvaluationStart& start) {
  write_text_file(path, scoring::evaluation_page(map, truth, start));
  std::fprintf(stderr, "page: %s\n", one_line(path).c_str());
}

}  // namespace rubble::app
