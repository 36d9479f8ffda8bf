#include "robot/model.h"

namespace rubble::robot {
namespace {

/// Hokuyo's data sheet: 0.1 to 30 m, +-30 mm up to 10 m, +-50 mm beyond, 40 scans a second. SCIP 2.0 specification,
/// table 2: 1440 steps a revolution, of which 0 to 1080 measure, 540 in front.
LaserModel utm_30lx() {
  LaserModel laser;
  laser.name = "UTM-30LX";
  laser.beams = 1081;
  laser.angle_step = deg_to_rad(0.25);
  laser.angle_min = deg_to_rad(-135.0);
  laser.range_min = 0.1;
  laser.range_max = 30.0;
  laser.scan_period = 0.025;
  laser.beam_period = 0.025 / 1440.0;
  laser.accuracy_near = 0.03;
  laser.accuracy_near_to = 10.0;
  laser.accuracy_far = 0.05;
  laser.accuracy_far_share = 0.0;
  laser.has_codes = false;
  return laser;
}

/// Something to start from: 270 deg in half degrees, ten times a second, up to 10 m.
LaserModel generic() {
  LaserModel laser;
  laser.name = kGenericLaser;
  laser.beams = 541;
  laser.range_min = 0.05;
  laser.range_max = 10.0;
  laser.accuracy_near = 0.03;
  laser.accuracy_near_to = 10.0;
  laser.accuracy_far = 0.03;
  laser.accuracy_far_share = 0.0;
  laser.has_codes = false;
  spread_beams(laser, 270.0, 0.075);
  return laser;
}

const std::vector<LaserModel>& known_lasers() {
  static const std::vector<LaserModel> lasers{LaserModel(), utm_30lx(), generic()};
  return lasers;
}

}  // namespace

const std::vector<std::string>& laser_names() {
  static const std::vector<std::string> names = [] {
    std::vector<std::string> out;
    for (const LaserModel& laser : known_lasers()) out.push_back(laser.name);
    return out;
  }();
  return names;
}

LaserModel laser_model(const std::string& name) {
  for (const LaserModel& laser : known_lasers())
    if (laser.name == name) return laser;
  return known_lasers().front();
}

void set_geometry(LaserScan& scan, const LaserModel& laser) {
  scan.angle_min = laser.angle_min;
  scan.angle_step = laser.angle_step;
  scan.beam_period = laser.beam_period;
  scan.range_min = laser.range_min;
  scan.range_max = laser.range_max;
}

void spread_beams(LaserModel& laser, double field_of_view_deg, double sweep) {
  laser.angle_step = deg_to_rad(field_of_view_deg / (laser.beams - 1));
  laser.angle_min = deg_to_rad(-0.5 * field_of_view_deg);
  laser.beam_period = sweep / (laser.beams - 1);
}

}  // namespace rubble::robot
